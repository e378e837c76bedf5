/* Camera paths from CSV; see path_csv.h. */
#include "common/path_csv.h"

#include "common/csv.h"

#include <stdlib.h>
#include <string.h>

/* X(field, required, standard): the columns that are read. */
#define PATH_COLUMNS(X)                                                                                                        \
    X(time, true, 0) X(x, true, 0) X(y, true, 0) X(z, true, 0) X(yaw, true, 0) X(pitch, false, 0) X(inside, false, 1)

enum {
#define COLUMN_ENUM(name, required, standard) COLUMN_##name,
    PATH_COLUMNS(COLUMN_ENUM)
#undef COLUMN_ENUM
        COLUMN_COUNT
};

static const EnfCsvColumn columns[] = {
#define COLUMN_ROW(name, required, standard) {#name, required, standard},
    PATH_COLUMNS(COLUMN_ROW)
#undef COLUMN_ROW
};

typedef struct Growing {
    EnfPathCsv *path;
    uint32_t capacity;
} Growing;

static EnfResult add_row(void *user, uint32_t line, const double *values, EnfError *error) {
    Growing *growing = user;
    EnfPathCsv *path = growing->path;
    (void)line;
    if (path->count == growing->capacity) {
        uint32_t capacity = growing->capacity ? growing->capacity * 2 : 1024;
        EnfPathRow *grown = realloc(path->rows, capacity * sizeof *grown);
        if (!grown) {
            return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory");
        }
        path->rows = grown;
        growing->capacity = capacity;
    }
    path->rows[path->count++] = (EnfPathRow){values[COLUMN_time],       values[COLUMN_x],   values[COLUMN_y],
                                             values[COLUMN_z],          values[COLUMN_yaw], values[COLUMN_pitch],
                                             values[COLUMN_inside] != 0};
    return ENF_OK;
}

EnfResult enf_path_csv_read(EnfPathCsv *path, const char *file_name, EnfError *error) {
    memset(path, 0, sizeof *path);
    Growing growing = {path, 0};
    EnfCsvTable table = {columns, COLUMN_COUNT, add_row, &growing};
    EnfResult result = enf_csv_read(file_name, &table, error);
    if (result != ENF_OK) {
        enf_path_csv_free(path);
    }
    return result;
}

void enf_path_csv_free(EnfPathCsv *path) {
    free(path->rows);
    memset(path, 0, sizeof *path);
}
