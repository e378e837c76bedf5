/* Tables for a terminal: columns as wide as their widest cell, text to the left, numbers to the right. */
#ifndef ENFINFO_TABLE_H
#define ENFINFO_TABLE_H

#include <stdbool.h>
#include <stdint.h>

#define TABLE_COLUMNS_MAX 16

/** Zero-initialise; free with table_free. */
typedef struct Table {
    char *titles[TABLE_COLUMNS_MAX];
    bool numbers[TABLE_COLUMNS_MAX];
    uint32_t columns;
    char **cells; /**< row by row */
    uint32_t count, capacity;
    bool failed; /**< out of memory: what there is is printed, and a line that says so */
} Table;

/** `titles`: separated by '|'; one that begins with '#' (which is not shown) is of numbers. */
void table_titles(Table *table, const char *titles);
/** The next cell, row by row. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void table_cell(Table *table, const char *format, ...);
/** Prints titles and at most `rows` rows to stdout, then how many more there are and `more`. */
void table_print(const Table *table, uint32_t rows, const char *more);
void table_free(Table *table);

#endif
