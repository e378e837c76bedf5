/* Tables for a terminal; see table.h. */
#include "enfinfo/table.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *copy_text(const char *text, size_t length) {
    char *copy = malloc(length + 1);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = '\0';
    }
    return copy;
}

/* What a terminal shows of UTF-8: a column a code point, near enough. */
static uint32_t width_of(const char *text) {
    uint32_t width = 0;
    for (; *text; text++) {
        width += ((unsigned char)*text & 0xc0) != 0x80;
    }
    return width;
}

void table_titles(Table *table, const char *titles) {
    while (titles && table->columns < TABLE_COLUMNS_MAX) {
        const char *end = strchr(titles, '|');
        table->numbers[table->columns] = *titles == '#';
        titles += *titles == '#';
        char *title = copy_text(titles, end ? (size_t)(end - titles) : strlen(titles));
        table->failed |= !title;
        table->titles[table->columns++] = title;
        titles = end ? end + 1 : NULL;
    }
}

void table_cell(Table *table, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (table->count == table->capacity) {
        uint32_t capacity = 2 * table->capacity + 64;
        char **cells = realloc(table->cells, capacity * sizeof *cells);
        if (!cells) {
            table->failed = true;
            return;
        }
        table->cells = cells;
        table->capacity = capacity;
    }
    char *copy = copy_text(text, strlen(text));
    table->failed |= !copy;
    if (copy) {
        table->cells[table->count++] = copy;
    }
}

static void print_cell(const Table *table, uint32_t column, const char *text, uint32_t width) {
    uint32_t pad = width - width_of(text);
    bool last = column + 1 == table->columns;
    if (table->numbers[column]) {
        printf("%*s%s%s", (int)pad, "", text, last ? "\n" : "  ");
    } else {
        printf("%s%*s%s", text, last ? 0 : (int)pad, "", last ? "\n" : "  ");
    }
}

void table_print(const Table *table, uint32_t rows, const char *more) {
    uint32_t widths[TABLE_COLUMNS_MAX] = {0};
    uint32_t total = table->columns ? table->count / table->columns : 0, shown = total < rows ? total : rows;
    if (table->failed) {
        printf("(out of memory)\n");
        return;
    }
    for (uint32_t i = 0; i < table->columns; i++) {
        widths[i] = width_of(table->titles[i]);
    }
    for (uint32_t i = 0; i < shown * table->columns; i++) {
        uint32_t width = width_of(table->cells[i]), *widest = &widths[i % table->columns];
        *widest = width > *widest ? width : *widest;
    }
    for (uint32_t i = 0; i < table->columns; i++) {
        print_cell(table, i, table->titles[i], widths[i]);
    }
    for (uint32_t i = 0; i < shown * table->columns; i++) {
        print_cell(table, i % table->columns, table->cells[i], widths[i % table->columns]);
    }
    if (shown < total) {
        printf("... and %u more%s\n", total - shown, more);
    }
}

void table_free(Table *table) {
    for (uint32_t i = 0; i < table->columns; i++) {
        free(table->titles[i]);
    }
    for (uint32_t i = 0; i < table->count; i++) {
        free(table->cells[i]);
    }
    free(table->cells);
    memset(table, 0, sizeof *table);
}
