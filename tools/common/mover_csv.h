/* Recorded objects as paths: CSV files with a header line whose columns include object, time, x, y, z (others are ignored). */
#ifndef ENFILADE_COMMON_MOVER_CSV_H
#define ENFILADE_COMMON_MOVER_CSV_H

#include <enfilade/world.h>

/** One object: its keys in the order of time. */
typedef struct EnfMoverRows {
    int64_t object;
    float *times;  /**< count, seconds from its first key; ascending strictly */
    float *points; /**< 3 × count, metres */
    float *
        curve; /**< 9 × count: in-tangent, point, out-tangent of a Catmull–Rom curve through the points; made by enf_mover_csv_motion */
    uint32_t count, capacity;
} EnfMoverRows;

typedef struct EnfMoverCsv {
    EnfMoverRows *objects; /**< in the order in which the file first names them */
    uint32_t count, capacity;
} EnfMoverCsv;

enum { ENF_MOVER_CSV_OBJECTS = 1 << 16, ENF_MOVER_CSV_KEYS = 1 << 22 }; /**< a file with more is refused */

/** Reads recorded objects; rows of several may alternate. A row that is not later than the one before it of its object is left out.
 *  Errors name file, line and column: FORMAT (a column is missing, or no finite number), SIZE, MEMORY, IO. Free with
 *  enf_mover_csv_free. */
EnfResult enf_mover_csv_read(EnfMoverCsv *csv, const char *file_name, EnfError *error);
void enf_mover_csv_free(EnfMoverCsv *csv);

/** The object's motion: through its points in time with them, `smooth` along a Catmull–Rom curve, else straight; from tick 0 on. Borrows
 *  the object's arrays. False if memory is out. */
bool enf_mover_csv_motion(EnfMoverRows *rows, bool smooth, EnfWrap wrap, EnfMotion *motion);

#endif
