/* Writing JSON into memory: reports and statistics. Numbers are printed so that they read back as the same double, with the
 * fewest digits that do. */
#ifndef ENFILADE_COMMON_REPORT_H
#define ENFILADE_COMMON_REPORT_H

#include <enfilade/base.h>

#define ENF_REPORT_DEPTH 32

/** A growing text. After running out of memory it stays empty and `failed`; so errors are checked once, at the end. */
typedef struct EnfReport {
    char *text; /**< zero-terminated, owned; NULL while empty */
    size_t size, capacity;
    bool failed;
    bool pretty; /**< a line a member of the outer two levels */
    uint32_t depth;
    bool filled[ENF_REPORT_DEPTH]; /**< has this level a member already? */
} EnfReport;

/** Zero-initialise, write, take `text`, free. Keys are NULL inside arrays and at the top. */
void enf_report_object(EnfReport *report, const char *key);
void enf_report_array(EnfReport *report, const char *key);
void enf_report_end_object(EnfReport *report);
void enf_report_end_array(EnfReport *report);
void enf_report_text(EnfReport *report, const char *key, const char *value); /**< UTF-8; broken bytes become U+FFFD */
void enf_report_number(EnfReport *report, const char *key, double value);    /**< not finite: null */
void enf_report_count(EnfReport *report, const char *key, uint64_t value);
void enf_report_bool(EnfReport *report, const char *key, bool value);
void enf_report_null(EnfReport *report, const char *key);
void enf_report_free(EnfReport *report);

/** The shortest of %.15g, %.16g, %.17g that reads back as `value` ("null" if not finite). Returns `out`. */
const char *enf_report_print_number(double value, char out[32]);

/** Writes the finished text and a line feed to `path` atomically; "-" is stdout. */
EnfResult enf_report_save(const EnfReport *report, const char *path, EnfError *error);

#endif
