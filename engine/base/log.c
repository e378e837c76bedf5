/* Messages to whoever listens; silence by default. The engine itself never prints. */
#include <enfilade/base.h>

#include <stdio.h>

static EnfLogFn *log_function;
static void *log_user;

void enf_set_log(EnfLogFn *log, void *user) {
    log_function = log;
    log_user = user;
}

void enf_log(EnfLogLevel level, const char *format, ...) {
    if (!log_function) {
        return;
    }
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    log_function(log_user, level, message);
}
