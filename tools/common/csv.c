/* Tables of numbers from CSV; see csv.h. No quoting is understood: the columns hold plain numbers. */
#include "common/csv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_IN_FILE_MAX = 64 };
#define FILE_SIZE_MAX ((size_t)1 << 30)

typedef struct Reader {
    const EnfCsvTable *table;
    const char *at, *end;
    uint32_t line;
    int place[COLUMNS_IN_FILE_MAX]; /* column in the file → table's column, or -1 */
    uint32_t place_count;
} Reader;

/* The next field of the line at *at, without blanks around it; false at the line's end. */
static bool next_field(const char **at, const char *end, const char **field, size_t *length) {
    if (!*at) {
        return false;
    }
    const char *comma = memchr(*at, ',', (size_t)(end - *at));
    const char *stop = comma ? comma : end;
    const char *first = *at;
    while (first < stop && (*first == ' ' || *first == '\t')) {
        first++;
    }
    while (stop > first && (stop[-1] == ' ' || stop[-1] == '\t' || stop[-1] == '\r')) {
        stop--;
    }
    *field = first;
    *length = (size_t)(stop - first);
    *at = comma ? comma + 1 : NULL;
    return true;
}

/* The next line that is not empty or a comment. */
static bool next_line(Reader *reader, const char **line, const char **line_end) {
    while (reader->at < reader->end) {
        const char *feed = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
        *line = reader->at;
        *line_end = feed ? feed : reader->end;
        reader->at = feed ? feed + 1 : reader->end;
        reader->line++;
        const char *at = *line, *field;
        size_t length;
        if (**line != '#' && next_field(&at, *line_end, &field, &length) && (length > 0 || at)) {
            return true;
        }
    }
    return false;
}

static EnfResult read_header(Reader *reader, EnfError *error) {
    const char *line, *line_end, *field;
    size_t length;
    bool found[ENF_CSV_COLUMNS_MAX] = {false};
    const EnfCsvColumn *columns = reader->table->columns;
    if (!next_line(reader, &line, &line_end)) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "the file is empty");
    }
    while (next_field(&line, line_end, &field, &length)) {
        if (reader->place_count == COLUMNS_IN_FILE_MAX) {
            return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "more than %d columns", COLUMNS_IN_FILE_MAX);
        }
        int place = -1;
        for (int i = 0; i < (int)reader->table->column_count; i++) {
            if (strlen(columns[i].name) == length && memcmp(columns[i].name, field, length) == 0 && !found[i]) {
                place = i;
                found[i] = true;
            }
        }
        reader->place[reader->place_count++] = place;
    }
    for (int i = 0; i < (int)reader->table->column_count; i++) {
        if (columns[i].required && !found[i]) {
            return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "the header has no column `%s`", columns[i].name);
        }
    }
    return ENF_OK;
}

static bool parse_field(const char *field, size_t length, double *value) {
    char text[64], *stop;
    if (length == 0 || length >= sizeof text) {
        return false;
    }
    memcpy(text, field, length);
    text[length] = '\0';
    *value = strtod(text, &stop);
    return *stop == '\0' && isfinite(*value);
}

static EnfResult read_row(const Reader *reader, const char *line, const char *line_end, EnfError *error) {
    const EnfCsvColumn *columns = reader->table->columns;
    double values[ENF_CSV_COLUMNS_MAX];
    for (uint32_t i = 0; i < reader->table->column_count; i++) {
        values[i] = columns[i].standard;
    }
    const char *field;
    size_t length;
    uint32_t column = 0;
    for (; column < reader->place_count && next_field(&line, line_end, &field, &length); column++) {
        int place = reader->place[column];
        if (place >= 0 && !parse_field(field, length, &values[place])) {
            return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u: `%s` is not a number: %.*s", reader->line,
                                 columns[place].name, (int)(length < 40 ? length : 40), field);
        }
    }
    for (; column < reader->place_count; column++) {
        int place = reader->place[column];
        if (place >= 0 && columns[place].required) {
            return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u: column `%s` is missing", reader->line,
                                 columns[place].name);
        }
    }
    return reader->table->row(reader->table->user, reader->line, values, error);
}

static EnfResult read_rows(Reader *reader, EnfError *error) {
    const char *line, *line_end;
    uint64_t rows = 0;
    EnfResult result = read_header(reader, error);
    while (result == ENF_OK && next_line(reader, &line, &line_end)) {
        result = read_row(reader, line, line_end, error);
        rows++;
    }
    return result == ENF_OK && rows == 0 ? enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "no row below the header")
                                         : result;
}

EnfResult enf_csv_read(const char *file_name, const EnfCsvTable *table, EnfError *error) {
    EnfFile file;
    ENF_ASSERT(table->column_count <= ENF_CSV_COLUMNS_MAX);
    EnfResult result = enf_file_read(&file, file_name, FILE_SIZE_MAX, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    const char *text = file.size ? (const char *)file.data : ""; /* an empty file has no data */
    Reader reader = {table, text, text + file.size, 0, {0}, 0};
    if (file.size >= 3 && memcmp(file.data, "\xef\xbb\xbf", 3) == 0) {
        reader.at += 3;
    }
    result = read_rows(&reader, error);
    enf_file_free(&file);
    return result == ENF_OK ? ENF_OK : enf_error_file(error, result, file_name);
}
