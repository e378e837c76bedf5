/* Tables of numbers from CSV files with a header line. A byte-order mark, CRLF line ends, empty lines and lines that start with '#' are
 * accepted; columns may stand in any order, and those that nobody asks for are skipped. */
#ifndef ENFILADE_COMMON_CSV_H
#define ENFILADE_COMMON_CSV_H

#include <enfilade/base.h>

enum { ENF_CSV_COLUMNS_MAX = 16 };

typedef struct EnfCsvColumn {
    const char *name;
    bool required;
    double standard; /**< its value where it is absent */
} EnfCsvColumn;

/** Called for each row with a finite number for each column of the table; an error ends the reading. */
typedef EnfResult EnfCsvRowFn(void *user, uint32_t line, const double *values, EnfError *error);

typedef struct EnfCsvTable {
    const EnfCsvColumn *columns;
    uint32_t column_count; /**< at most ENF_CSV_COLUMNS_MAX */
    EnfCsvRowFn *row;
    void *user;
} EnfCsvTable;

/** Reads a file of at most 1 GiB. Errors name file, line and column: FORMAT, SIZE, MEMORY, IO; a file without a row is FORMAT. */
EnfResult enf_csv_read(const char *file_name, const EnfCsvTable *table, EnfError *error);

#endif
