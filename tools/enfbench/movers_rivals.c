/* The plain ways to find moving objects: move every one in every frame, and then look at arrays. No tree, no volume, no memory of
 * what was seen. They are tuned, for only then is the comparison worth anything: positions and steps stand in arrays of floats,
 * moved eight at a time; an object changes its room's list only when it changes its room; a sweep tests middles against planes
 * that were moved out by an object's size. These cheap positions may be a little wrong; the object's own box decides what is
 * shown, so the answer is the same as everyone's. */
#include "enfbench/movers.h"
#include "simd/simd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half the size of a cheap box: a little more than the object's, for what single precision and STRIDE steps round. */
#define CHEAP_WIDTH (MOVER_REACH + 0.0625)
#define CHEAP_HEIGHT (MOVER_HEIGHT + 0.0625)
/* Steps that are added up at most before a position is worked out anew. */
enum { STRIDE = 256, LANES = 8 };

/* A loop over all objects, and the same compiled for AVX2; WIDE names what chooses between them. */
#if defined(__GNUC__) && defined(__x86_64__)
#define ENF_WIDE_INLINE inline __attribute__((always_inline))
#define WIDE(type, name, parameters, arguments)                                                                                \
    __attribute__((target("avx2"))) static type avx2_##name parameters {                                                       \
        return name arguments;                                                                                                 \
    }                                                                                                                          \
    static type wide_##name parameters {                                                                                       \
        return enf_simd_avx2() != NULL ? avx2_##name arguments : name arguments;                                               \
    }
#else
#define ENF_WIDE_INLINE inline
#define WIDE(type, name, parameters, arguments)                                                                                \
    static type wide_##name parameters {                                                                                       \
        return name arguments;                                                                                                 \
    }
#endif

/* Eight numbers at once, as gcc and clang write it. */
typedef float Float8 __attribute__((vector_size(32)));
typedef int32_t Whole8 __attribute__((vector_size(32)));
typedef int64_t Long4 __attribute__((vector_size(32)));

static ENF_WIDE_INLINE void add_eight(float *to, const float *step) {
    Float8 a, b;
    memcpy(&a, to, sizeof a);
    memcpy(&b, step, sizeof b);
    a += b;
    memcpy(to, &a, sizeof a);
}

#define any(lanes)                                                                                                             \
    (((Long4)(lanes))[0] != 0 || ((Long4)(lanes))[1] != 0 || ((Long4)(lanes))[2] != 0 || ((Long4)(lanes))[3] != 0)

struct Rival {
    const MoversScene *scene;
    bool sweep;
    int64_t tick;
    float *x, *y, *z, *dx, *dy, *dz;        /* positions, steps a tick */
    int32_t *until;                         /* the last tick to which steps lead */
    uint32_t *cells, *next, *before;        /* flat: the room of an object, and its neighbours in the room's list */
    uint32_t *heads;                        /* flat: a room's list */
    uint32_t *near;                         /* sweep: the frame in which a room was seen or next to one */
    uint32_t *asked, *found;                /* the frame in which an object was asked about; the answer */
    uint32_t count, cell_count, frame;      /* count: objects, rounded up to whole blocks */
    float origin_x, origin_z, per_x, per_z; /* rooms a metre */
};

void bench_rival_destroy(Rival *rival) {
    if (rival != NULL) {
        void *arrays[] = {rival->x,     rival->y,    rival->z,      rival->dx,    rival->dy,   rival->dz,    rival->until,
                          rival->cells, rival->next, rival->before, rival->heads, rival->near, rival->asked, rival->found};
        for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
            free(arrays[i]);
        }
        free(rival);
    }
}

static bool allocate(Rival *rival) {
    size_t count = rival->count + 1U;
    size_t cells = rival->cell_count + 1U;
    float **floats[] = {&rival->x, &rival->y, &rival->z, &rival->dx, &rival->dy, &rival->dz};
    uint32_t **numbers[] = {&rival->cells, &rival->next, &rival->before, &rival->asked, &rival->found};
    bool ok = true;
    for (size_t i = 0; i < sizeof floats / sizeof *floats; i++) {
        *floats[i] = calloc(count, sizeof(float));
        ok = ok && *floats[i] != NULL;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        *numbers[i] = calloc(count, sizeof(uint32_t));
        ok = ok && *numbers[i] != NULL;
    }
    rival->until = calloc(count, sizeof *rival->until);
    rival->heads = calloc(cells, sizeof *rival->heads);
    rival->near = calloc(cells, sizeof *rival->near);
    return ok && rival->until && rival->heads && rival->near;
}

Rival *bench_rival_create(const MoversScene *scene, bool sweep) {
    Rival *rival = calloc(1, sizeof *rival);
    if (rival == NULL) {
        return NULL;
    }
    const EnfRoomsDef *d = &scene->rooms.def;
    rival->scene = scene;
    rival->sweep = sweep;
    rival->tick = -2; /* nothing is worked out yet */
    rival->count = (scene->def.movers + LANES - 1) / LANES * LANES;
    rival->cell_count = d->nx * d->nz;
    rival->origin_x = (float)d->origin.x;
    rival->origin_z = (float)d->origin.z;
    rival->per_x = (float)(1.0 / d->room.x);
    rival->per_z = (float)(1.0 / d->room.z);
    if (!allocate(rival)) {
        bench_rival_destroy(rival);
        return NULL;
    }
    memset(rival->cells, 0xff, rival->count * sizeof *rival->cells); /* ENF_NONE */
    memset(rival->heads, 0xff, rival->cell_count * sizeof *rival->heads);
    for (uint32_t i = scene->def.movers; i < rival->count; i++) {
        rival->until[i] = INT32_MAX; /* lanes beyond the last object stay at the origin, in no list */
    }
    return rival;
}

/* ---- motion ----------------------------------------------------------------------------------------------------- */

static void set_position(Rival *rival, uint32_t object, EnfVec3 p) {
    rival->x[object] = (float)p.x;
    rival->y[object] = (float)p.y;
    rival->z[object] = (float)p.z;
}

/* Where a straight way is at `tick`, and the step that leads on to its next corner. */
static void start_leg(Rival *rival, uint32_t object, int64_t tick) {
    const Mover *mover = &rival->scene->movers[object];
    double left = 0.0;
    EnfVec3 step = bench_mover_step(mover, tick, &left);
    set_position(rival, object, bench_mover_at(mover, tick));
    rival->dx[object] = (float)step.x;
    rival->dy[object] = (float)step.y;
    rival->dz[object] = (float)step.z;
    rival->until[object] = (int32_t)tick + (int32_t)(left < STRIDE ? left : STRIDE);
}

/* A step of eight; true if one of them is beyond its leg. */
static ENF_WIDE_INLINE bool step_block(Rival *rival, uint32_t first, int32_t tick) {
    add_eight(rival->x + first, rival->dx + first);
    add_eight(rival->y + first, rival->dy + first);
    add_eight(rival->z + first, rival->dz + first);
    Whole8 until;
    memcpy(&until, rival->until + first, sizeof until);
    return any(until < tick);
}

/* Where a motion costs something it is worked out whole; a straight way has nothing but a position. */
static bool is_plain(const MoversDef *def) {
    return (def->motion == MOVERS_FREE || def->motion == MOVERS_LINEAR) && def->polygons == 0;
}

static ENF_WIDE_INLINE bool step_all(Rival *rival, int64_t tick) {
    uint32_t movers = rival->scene->def.movers;
    bool follows = rival->tick + 1 == tick;
    for (uint32_t b = 0; b < rival->count; b += LANES) {
        if (follows && !step_block(rival, b, (int32_t)tick)) {
            continue;
        }
        for (uint32_t i = b; i < b + LANES && i < movers; i++) {
            if (!follows || rival->until[i] < tick) {
                start_leg(rival, i, tick);
            }
        }
    }
    return true;
}
WIDE(bool, step_all, (Rival * rival, int64_t tick), (rival, tick))

static void move_all(Rival *rival, int64_t tick) {
    const MoversScene *scene = rival->scene;
    if (is_plain(&scene->def)) {
        (void)wide_step_all(rival, tick);
    } else {
        for (uint32_t i = 0; i < scene->def.movers; i++) {
            set_position(rival, i, bench_mover_state(&scene->movers[i], tick).position);
        }
    }
    rival->tick = tick;
}

/* ---- what is shown ---------------------------------------------------------------------------------------------- */

static void look_at(Rival *rival, const MoversWindows *windows, uint32_t object, uint32_t *count) {
    if (rival->asked[object] != rival->frame) {
        rival->asked[object] = rival->frame;
        EnfPose pose = bench_mover_pose(&rival->scene->movers[object], rival->tick); /* the rest was done in move_all */
        if (bench_movers_shown(rival->scene, windows, bench_mover_box(&pose))) {
            rival->found[(*count)++] = object;
        }
    }
}

static ENF_WIDE_INLINE uint32_t cell_at(const Rival *rival, float x, float z) {
    const EnfRoomsDef *d = &rival->scene->rooms.def;
    int32_t ix = (int32_t)((x - rival->origin_x) * rival->per_x); /* what lies before the origin is in the first room */
    int32_t iz = (int32_t)((z - rival->origin_z) * rival->per_z);
    int32_t mx = (int32_t)d->nx - 1;
    int32_t mz = (int32_t)d->nz - 1;
    ix = ix < 0 ? 0 : ix > mx ? mx : ix;
    iz = iz < 0 ? 0 : iz > mz ? mz : iz;
    return (uint32_t)iz * d->nx + (uint32_t)ix;
}

/* The rooms around a seen one, and itself: who stands in one may reach into the other. */
typedef struct Around {
    uint32_t x0, x1, z0, z1;
} Around;

static Around around(const Rival *rival, uint32_t cell) {
    const EnfRoomsDef *d = &rival->scene->rooms.def;
    uint32_t x = cell % d->nx;
    uint32_t z = cell / d->nx;
    Around out = {x > 0 ? x - 1 : 0, x + 1 < d->nx ? x + 1 : x, z > 0 ? z - 1 : 0, z + 1 < d->nz ? z + 1 : z};
    return out;
}

/* ---- flat ------------------------------------------------------------------------------------------------------- */

static void change_room(Rival *rival, uint32_t object, uint32_t cell) {
    uint32_t next = rival->next[object];
    uint32_t before = rival->before[object];
    uint32_t old = rival->cells[object];
    if (old != ENF_NONE) {
        if (next != ENF_NONE) {
            rival->before[next] = before;
        }
        if (before != ENF_NONE) {
            rival->next[before] = next;
        } else {
            rival->heads[old] = next;
        }
    }
    rival->cells[object] = cell;
    rival->before[object] = ENF_NONE;
    rival->next[object] = rival->heads[cell];
    if (rival->heads[cell] != ENF_NONE) {
        rival->before[rival->heads[cell]] = object;
    }
    rival->heads[cell] = object;
}

static ENF_WIDE_INLINE bool bin(Rival *rival) {
    uint32_t movers = rival->scene->def.movers;
    for (uint32_t b = 0; b < rival->count; b += LANES) {
        uint32_t cells[LANES];
        uint32_t changed = 0;
        for (uint32_t k = 0; k < LANES; k++) {
            cells[k] = cell_at(rival, rival->x[b + k], rival->z[b + k]);
            changed |= cells[k] ^ rival->cells[b + k];
        }
        for (uint32_t k = 0; k < LANES && changed != 0 && b + k < movers; k++) {
            if (cells[k] != rival->cells[b + k]) {
                change_room(rival, b + k, cells[k]);
            }
        }
    }
    return true;
}
WIDE(bool, bin, (Rival * rival), (rival))

static void look_into(Rival *rival, const MoversWindow *window, const MoversWindows *windows, uint32_t *count) {
    Around rooms = around(rival, window->cell);
    EnfBox3 room = enf_rooms_box(&rival->scene->rooms, window->cell);
    for (uint32_t z = rooms.z0; z <= rooms.z1; z++) {
        for (uint32_t x = rooms.x0; x <= rooms.x1; x++) {
            uint32_t i = rival->heads[z * rival->scene->rooms.def.nx + x];
            for (; i != ENF_NONE; i = rival->next[i]) {
                double px = (double)rival->x[i];
                double pz = (double)rival->z[i];
                if (px > room.min.x - CHEAP_WIDTH && px < room.max.x + CHEAP_WIDTH && pz > room.min.z - CHEAP_WIDTH &&
                    pz < room.max.z + CHEAP_WIDTH) {
                    look_at(rival, windows, i, count);
                }
            }
        }
    }
}

/* ---- sweep ------------------------------------------------------------------------------------------------------ */

/* The picture's planes, moved out by the size of a cheap box. */
static EnfPyramid picture(const Rival *rival, const EnfView *view) {
    const EnfRooms *rooms = &rival->scene->rooms;
    EnfBox3 all = enf_box3_union(enf_rooms_box(rooms, 0), enf_rooms_box(rooms, rooms->map->cells_count - 1));
    EnfPyramid planes;
    enf_pyramid(&view->camera, enf_window_full(&view->camera), NULL, enf_v3(0.0, 0.0, 0.0), enf_box3f_outward(all), &planes);
    for (uint32_t p = 0; p < planes.count; p++) {
        double out = (fabs((double)planes.nx[p]) + fabs((double)planes.nz[p])) * CHEAP_WIDTH;
        planes.d[p] += (float)(out + fabs((double)planes.ny[p]) * CHEAP_HEIGHT);
    }
    return planes;
}

/* The lanes of a block whose middles are behind no plane, a bit each. */
static ENF_WIDE_INLINE uint32_t inside(const float *px, const float *py, const float *pz, const EnfPyramid *planes) {
    Float8 x, y, z;
    memcpy(&x, px, sizeof x);
    memcpy(&y, py, sizeof y);
    memcpy(&z, pz, sizeof z);
    Whole8 in = {1, 2, 4, 8, 16, 32, 64, 128};
    for (uint32_t p = 0; p < planes->count; p++) {
        in &= planes->nx[p] * x + planes->ny[p] * y + planes->nz[p] * z + planes->d[p] >= 0.0F;
    }
    Long4 pairs = (Long4)in;
    uint64_t both = (uint64_t)(pairs[0] | pairs[1] | pairs[2] | pairs[3]);
    return (uint32_t)(both | both >> 32) & 0xffU;
}

static ENF_WIDE_INLINE uint32_t sweep_all(Rival *rival, const EnfPyramid *planes, uint32_t *kept) {
    uint32_t count = 0;
    for (uint32_t b = 0; b < rival->count; b += LANES) {
        uint32_t mask = inside(rival->x + b, rival->y + b, rival->z + b, planes);
        for (uint32_t k = 0; k < LANES && mask != 0; k++) { /* a branch an object costs more */
            kept[count] = b + k;
            count += mask >> k & 1U;
        }
    }
    return count;
}
WIDE(uint32_t, sweep_all, (Rival * rival, const EnfPyramid *planes, uint32_t *kept), (rival, planes, kept))

static void look_everywhere(Rival *rival, const EnfView *view, const MoversWindows *windows, uint32_t *count) {
    EnfPyramid planes = picture(rival, view);
    for (uint32_t i = 0; i < windows->count; i++) {
        Around rooms = around(rival, windows->items[i].cell);
        for (uint32_t z = rooms.z0; z <= rooms.z1; z++) {
            for (uint32_t x = rooms.x0; x <= rooms.x1; x++) {
                rival->near[z * rival->scene->rooms.def.nx + x] = rival->frame;
            }
        }
    }
    uint32_t *kept = rival->cells; /* flat's */
    uint32_t kept_count = wide_sweep_all(rival, &planes, kept);
    for (uint32_t k = 0; k < kept_count && kept[k] < rival->scene->def.movers; k++) {
        uint32_t cell = cell_at(rival, rival->x[kept[k]], rival->z[kept[k]]);
        if (rival->near[cell] == rival->frame) {
            look_at(rival, windows, kept[k], count);
        }
    }
}

RivalLists bench_rival_lists(Rival *rival, int64_t tick) {
    move_all(rival, tick);
    (void)wide_bin(rival);
    RivalLists lists = {rival->x, rival->y, rival->z, rival->heads, rival->next};
    return lists;
}

/* ---- both ------------------------------------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a;
    uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

const uint32_t *bench_rival_frame(Rival *rival, const EnfView *view, const MoversWindows *windows, int64_t tick,
                                  uint32_t *count) {
    rival->frame++;
    *count = 0;
    move_all(rival, tick);
    if (rival->sweep) {
        look_everywhere(rival, view, windows, count);
        return rival->found; /* in order already */
    }
    (void)wide_bin(rival);
    for (uint32_t i = 0; i < windows->count; i++) {
        look_into(rival, &windows->items[i], windows, count);
    }
    if (*count > 1) {
        qsort(rival->found, *count, sizeof *rival->found, ascending);
    }
    return rival->found;
}
