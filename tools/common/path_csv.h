/* Camera paths: CSV files with a header line whose columns include time, x, y, z, yaw, pitch (others are ignored). */
#ifndef ENFILADE_COMMON_PATH_CSV_H
#define ENFILADE_COMMON_PATH_CSV_H

#include <enfilade/base.h>

typedef struct EnfPathRow {
    double time;      /**< seconds */
    double x, y, z;   /**< the eye, metres, world */
    double yaw_deg;   /**< counter-clockwise about +Y, 0 looks down -Z */
    double pitch_deg; /**< up positive */
    bool inside;      /**< false where a column `inside` says 0: recorded eyes that stand in no cell of the static level */
} EnfPathRow;

typedef struct EnfPathCsv {
    EnfPathRow *rows;
    uint32_t count;
} EnfPathCsv;

/** Reads a path. Columns may stand in any order; `pitch` may be absent (0), the others may not. A
 *  byte-order mark, CRLF line ends, empty lines and lines that start with '#' are accepted. Errors name file, line, column. Free with enf_path_csv_free. */
EnfResult enf_path_csv_read(EnfPathCsv *path, const char *file_name, EnfError *error);
void enf_path_csv_free(EnfPathCsv *path);

#endif
