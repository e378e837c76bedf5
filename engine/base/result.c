/* Results and errors: the catalogue's texts, the filling of EnfError, and what a failed assertion does. */
#include <enfilade/base.h>

#include <stdio.h>
#include <string.h>

const char *enf_result_text(EnfResult result) {
    static const char *const texts[] = {
#define ENF_RESULT_TEXT(name, text) text,
        ENF_RESULTS(ENF_RESULT_TEXT)
#undef ENF_RESULT_TEXT
    };
    /* Through size_t: a negative value of a damaged enum is out of range too. */
    size_t index = (size_t)result;
    return index < ENF_RESULT_COUNT ? texts[index] : "unknown error";
}

EnfResult enf_error_set(EnfError *error, EnfResult code, uint64_t offset, const char *format, ...) {
    if (!error) {
        return code;
    }
    error->code = code;
    error->offset = offset;
    error->file[0] = '\0';
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    return code;
}

EnfResult enf_error_file(EnfError *error, EnfResult code, const char *file) {
    if (error && !error->file[0]) {
        snprintf(error->file, sizeof error->file, "%s", file);
    }
    return code;
}

/* ---- assertions ------------------------------------------------------------------------------------------------- */

static void print_and_trap(const char *expression, const char *file, int line) {
    fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, expression);
    fflush(stderr);
    __builtin_trap();
}

static EnfAssertFn *assert_handler = print_and_trap;

void enf_set_assert_handler(EnfAssertFn *handler) {
    assert_handler = handler ? handler : print_and_trap;
}

void enf_assert_failed(const char *expression, const char *file, int line) {
    assert_handler(expression, file, line);
}
