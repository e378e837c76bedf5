/* Recorded objects from CSV; see mover_csv.h. */
#include "common/mover_csv.h"

#include "common/csv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMN_OBJECT, COLUMN_TIME, COLUMN_X, COLUMN_Y, COLUMN_Z, COLUMN_COUNT };
static const EnfCsvColumn columns[COLUMN_COUNT] = {
    {"object", true, 0}, {"time", true, 0}, {"x", true, 0}, {"y", true, 0}, {"z", true, 0}};

/* A pass is at most as many ticks as EnfPathMotion.period_ticks holds; a year is enough for a recording. */
#define SECONDS_MAX 3.2e7

typedef struct Building {
    EnfMoverCsv *csv;
    double *first; /* a time an object: of its first key */
    uint32_t first_capacity;
    uint32_t last; /* the object of the row before */
    uint64_t keys;
} Building;

static EnfResult no_memory(EnfError *error) {
    return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory");
}

/* The object of this name; rows of one object mostly follow one another. */
static EnfMoverRows *find_object(Building *building, int64_t name) {
    EnfMoverCsv *csv = building->csv;
    for (uint32_t k = 0; k < csv->count; k++) {
        uint32_t i = (building->last + k) % csv->count;
        if (csv->objects[i].object == name) {
            building->last = i;
            return &csv->objects[i];
        }
    }
    return NULL;
}

static EnfMoverRows *add_object(Building *building, int64_t name, double time) {
    EnfMoverCsv *csv = building->csv;
    if (csv->count == csv->capacity) {
        uint32_t capacity = csv->capacity ? 2 * csv->capacity : 64;
        EnfMoverRows *objects = realloc(csv->objects, capacity * sizeof *objects);
        csv->objects = objects ? objects : csv->objects;
        double *first = realloc(building->first, capacity * sizeof *first);
        building->first = first ? first : building->first;
        if (!objects || !first) {
            return NULL;
        }
        csv->capacity = capacity;
    }
    building->last = csv->count;
    building->first[csv->count] = time;
    csv->objects[csv->count] = (EnfMoverRows){.object = name};
    return &csv->objects[csv->count++];
}

static bool reserve_key(EnfMoverRows *rows) {
    if (rows->count < rows->capacity) {
        return true;
    }
    uint32_t capacity = rows->capacity ? 2 * rows->capacity : 16;
    float *times = realloc(rows->times, capacity * sizeof *times);
    rows->times = times ? times : rows->times;
    float *points = realloc(rows->points, 3 * (size_t)capacity * sizeof *points);
    rows->points = points ? points : rows->points;
    rows->capacity = times && points ? capacity : rows->capacity;
    return times && points;
}

static EnfResult add_row(void *user, uint32_t line, const double *values, EnfError *error) {
    Building *building = user;
    if (fabs(values[COLUMN_OBJECT]) > 9e15 || values[COLUMN_OBJECT] != floor(values[COLUMN_OBJECT])) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u: `object` is no whole number", line);
    }
    int64_t name = (int64_t)values[COLUMN_OBJECT];
    EnfMoverRows *rows = find_object(building, name);
    if (!rows && building->csv->count == ENF_MOVER_CSV_OBJECTS) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "line %u: more than %d objects", line, ENF_MOVER_CSV_OBJECTS);
    }
    rows = rows ? rows : add_object(building, name, values[COLUMN_TIME]);
    if (!rows || !reserve_key(rows)) {
        return no_memory(error);
    }
    double seconds = values[COLUMN_TIME] - building->first[building->last];
    if (seconds > SECONDS_MAX || ++building->keys > ENF_MOVER_CSV_KEYS) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "line %u: too %s", line,
                             seconds > SECONDS_MAX ? "long after the object's first row" : "many rows");
    }
    EnfVec3f p = enf_v3f(enf_v3(values[COLUMN_X], values[COLUMN_Y], values[COLUMN_Z]));
    if (rows->count > 0 && !((float)seconds > rows->times[rows->count - 1])) {
        return ENF_OK; /* two rows of one moment: the first stands */
    }
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u: a place beyond what a float holds", line);
    }
    rows->times[rows->count] = (float)seconds;
    memcpy(rows->points + 3 * (size_t)rows->count++, &p, sizeof p);
    return ENF_OK;
}

EnfResult enf_mover_csv_read(EnfMoverCsv *csv, const char *file_name, EnfError *error) {
    memset(csv, 0, sizeof *csv);
    Building building = {csv, NULL, 0, 0, 0};
    EnfCsvTable table = {columns, COLUMN_COUNT, add_row, &building};
    EnfResult result = enf_csv_read(file_name, &table, error);
    free(building.first);
    if (result != ENF_OK) {
        enf_mover_csv_free(csv);
    }
    return result;
}

void enf_mover_csv_free(EnfMoverCsv *csv) {
    for (uint32_t i = 0; i < csv->count; i++) {
        free(csv->objects[i].times);
        free(csv->objects[i].points);
        free(csv->objects[i].curve);
    }
    free(csv->objects);
    memset(csv, 0, sizeof *csv);
}

bool enf_mover_csv_motion(EnfMoverRows *rows, bool smooth, EnfWrap wrap, EnfMotion *motion) {
    memset(motion, 0, sizeof *motion);
    motion->kind = ENF_MOTION_PATH;
    EnfPathMotion *path = &motion->as.path;
    *path = (EnfPathMotion){.rest = enf_pose_identity(), .wrap = wrap};
    path->seconds = rows->count > 1 ? (double)rows->times[rows->count - 1] : 1.0;
    double ticks = ceil(path->seconds * ENF_TICK_RATE);
    path->period_ticks = ticks < 1.0 ? 1U : (uint32_t)ticks;
    path->translation = (EnfTrack){ENF_PATH_LINEAR, rows->count, rows->times, rows->points};
    if (smooth && rows->count > 1) {
        rows->curve = rows->curve ? rows->curve : malloc(9 * (size_t)rows->count * sizeof *rows->curve);
        if (!rows->curve) {
            return false;
        }
        enf_catmull_rom(rows->times, rows->points, rows->count, rows->curve);
        path->translation.kind = ENF_PATH_CUBIC;
        path->translation.values = rows->curve;
    }
    return true;
}
