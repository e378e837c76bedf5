/* EnfWorld: objects with generational ids, integer time, and the list of what changed this tick. Nothing moves by itself: a pose is
 * worked out when it is asked for (DESIGN §5), and each such evaluation is counted. */
#include <enfilade/tolerances.h>
#include <enfilade/world.h>

#include <math.h>
#include <string.h>

/* All that is kept of an object, in one place: who is asked for after a long sleep is cold, and costs a page's look-up less. */
typedef struct Object {
    uint32_t generation; /* odd: alive */
    uint32_t mesh;
    uint64_t user;
    double max_speed;
    EnfBox3 local;
    EnfMotion motion;
} Object;

struct EnfWorld {
    const EnfMap *map;
    const EnfAllocator *allocator;
    int64_t tick;
    bool trail; /* boxes hold the tick before, too */
    uint64_t evaluations, pushes;
    Object *objects;
    uint32_t *free_indices; /* a stack of the dead */
    uint32_t limit, capacity, free_count;
    uint32_t *changes;
    uint32_t change_count, change_capacity;
};

EnfObjectDef enf_object_def_default(void) {
    EnfObjectDef def;
    memset(&def, 0, sizeof def);
    def.motion.kind = ENF_MOTION_STILL;
    def.motion.as.still = enf_pose_identity();
    def.local.min = enf_v3(-0.5, -0.5, -0.5);
    def.local.max = enf_v3(0.5, 0.5, 0.5);
    def.max_speed = HUGE_VAL;
    return def;
}

/* Grows an array that lives as long as the world; false leaves it as it was. */
static bool grow(EnfWorld *world, void **array, uint32_t old_count, uint32_t new_count, size_t size) {
    void *block = enf_alloc(world->allocator, new_count, size);
    if (block == NULL) {
        return false;
    }
    if (old_count > 0) {
        memcpy(block, *array, old_count * size);
        enf_free(world->allocator, *array, old_count, size);
    }
    *array = block;
    return true;
}

/* Room for `capacity` objects: all arrays grow, or none. */
static bool reserve_objects(EnfWorld *world, uint32_t capacity) {
    Object *objects = enf_alloc(world->allocator, capacity, sizeof *objects);
    uint32_t *indices = enf_alloc(world->allocator, capacity, sizeof *indices);
    if (objects == NULL || indices == NULL) {
        enf_free(world->allocator, objects, capacity, sizeof *objects);
        enf_free(world->allocator, indices, capacity, sizeof *indices);
        return false;
    }
    if (world->limit > 0) {
        memcpy(objects, world->objects, world->limit * sizeof *objects);
        memcpy(indices, world->free_indices, world->free_count * sizeof *indices);
    }
    enf_free(world->allocator, world->objects, world->capacity, sizeof *objects);
    enf_free(world->allocator, world->free_indices, world->capacity, sizeof *indices);
    world->objects = objects;
    world->free_indices = indices;
    world->capacity = capacity;
    return true;
}

EnfResult enf_world_create(EnfWorld **out, const EnfMap *map, uint32_t capacity, const EnfAllocator *allocator,
                           EnfError *error) {
    *out = NULL;
    EnfWorld *world = enf_alloc(allocator, 1, sizeof *world);
    if (world != NULL) {
        world->map = map;
        world->allocator = allocator;
        if (!reserve_objects(world, capacity > 0 ? capacity : 16)) {
            enf_world_destroy(world);
            world = NULL;
        }
    }
    if (world == NULL) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "a world of %u objects", capacity);
    }
    *out = world;
    return ENF_OK;
}

void enf_world_destroy(EnfWorld *world) {
    if (world == NULL) {
        return;
    }
    const EnfAllocator *allocator = world->allocator;
    enf_free(allocator, world->objects, world->capacity, sizeof *world->objects);
    enf_free(allocator, world->free_indices, world->capacity, sizeof *world->free_indices);
    enf_free(allocator, world->changes, world->change_capacity, sizeof *world->changes);
    enf_free(allocator, world, 1, sizeof *world);
}

const EnfMap *enf_world_map(const EnfWorld *world) {
    return world->map;
}

int64_t enf_world_tick(const EnfWorld *world) {
    return world->tick;
}

void enf_world_advance(EnfWorld *world, int64_t ticks) {
    ENF_ASSERT(ticks >= 0);
    world->tick += ticks;
    if (ticks > 0) {
        world->change_count = 0;
    }
}

/* ---- changes ---------------------------------------------------------------------------------------------------- */

static bool reserve_change(EnfWorld *world) {
    if (world->change_count < world->change_capacity) {
        return true;
    }
    uint32_t capacity = world->change_capacity == 0 ? 64 : world->change_capacity * 2;
    void *changes = world->changes;
    bool ok = grow(world, &changes, world->change_capacity, capacity, sizeof *world->changes);
    world->changes = changes;
    world->change_capacity = ok ? capacity : world->change_capacity;
    return ok;
}

static void note_change(EnfWorld *world, uint32_t index) {
    world->objects[index].motion.set_tick = (uint32_t)world->tick;
    world->changes[world->change_count++] = index;
}

const uint32_t *enf_world_changes(const EnfWorld *world, uint32_t *count) {
    *count = world->change_count;
    return world->changes;
}

/* ---- life ------------------------------------------------------------------------------------------------------- */

/* Free objects ask where they are, so that their bound counts from now. */
static void ask_free(EnfWorld *world, uint32_t index) {
    EnfMotion *motion = &world->objects[index].motion;
    if (motion->kind == ENF_MOTION_FREE && motion->as.free.ask != NULL) {
        world->evaluations++;
        enf_free_push(motion, world->tick, motion->as.free.ask(motion->as.free.user, world->tick));
    }
}

/* Asking may cost a skeleton: once a tick. */
static void refresh_free(EnfWorld *world, uint32_t index) {
    if (world->objects[index].motion.as.free.push_tick != world->tick) {
        ask_free(world, index);
    }
}

EnfObjectId enf_world_add(EnfWorld *world, const EnfObjectDef *def, EnfError *error) {
    EnfObjectId id = {0, 0};
    bool room = world->free_count > 0 || world->limit < world->capacity ||
                (world->capacity < UINT32_MAX / 2 && reserve_objects(world, world->capacity * 2));
    if (!room || !reserve_change(world)) {
        (void)enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for object %u", world->limit);
        return id;
    }
    id.index = world->free_count > 0 ? world->free_indices[--world->free_count] : world->limit++;
    Object *object = &world->objects[id.index];
    object->generation += 1;
    object->local = def->local;
    object->max_speed = def->motion.kind == ENF_MOTION_FREE ? def->motion.as.free.max_speed : def->max_speed;
    object->mesh = def->mesh;
    object->user = def->user;
    world->objects[id.index].motion = def->motion;
    ask_free(world, id.index);
    id.generation = object->generation;
    note_change(world, id.index);
    return id;
}

bool enf_world_alive(const EnfWorld *world, EnfObjectId id) {
    return id.index < world->limit && id.generation % 2 == 1 && world->objects[id.index].generation == id.generation;
}

bool enf_world_remove(EnfWorld *world, EnfObjectId id) {
    if (!enf_world_alive(world, id) || !reserve_change(world)) {
        return false;
    }
    world->objects[id.index].generation += 1;
    if (world->objects[id.index].generation != UINT32_MAX - 1) { /* an index whose generations are used up rests for ever */
        world->free_indices[world->free_count++] = id.index;
    }
    note_change(world, id.index);
    return true;
}

bool enf_world_set_motion(EnfWorld *world, EnfObjectId id, const EnfMotion *motion) {
    if (!enf_world_alive(world, id) || !reserve_change(world)) {
        return false;
    }
    world->objects[id.index].motion = *motion;
    if (motion->kind == ENF_MOTION_FREE) {
        world->objects[id.index].max_speed = motion->as.free.max_speed;
    }
    ask_free(world, id.index);
    note_change(world, id.index);
    return true;
}

bool enf_world_swing(EnfWorld *world, EnfObjectId id, double target) {
    if (!enf_world_alive(world, id) || !reserve_change(world)) {
        return false;
    }
    enf_swing_set(&world->objects[id.index].motion, world->tick, target);
    note_change(world, id.index);
    return true;
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

uint32_t enf_world_object_limit(const EnfWorld *world) {
    return world->limit;
}

EnfObjectId enf_world_object(const EnfWorld *world, uint32_t index) {
    EnfObjectId id = {0, 0};
    if (index < world->limit && world->objects[index].generation % 2 == 1) {
        id.index = index;
        id.generation = world->objects[index].generation;
    }
    return id;
}

uint32_t enf_world_mesh(const EnfWorld *world, uint32_t index) {
    return world->objects[index].mesh;
}

const EnfMotion *enf_world_motion(const EnfWorld *world, uint32_t index) {
    ENF_ASSERT(index < world->limit);
    return &world->objects[index].motion;
}

EnfPose enf_world_pose(EnfWorld *world, uint32_t index) {
    const EnfMotion *motion = &world->objects[index].motion;
    if (motion->kind == ENF_MOTION_FREE) {
        refresh_free(world, index);
        return motion->as.free.pose;
    }
    world->evaluations++;
    return enf_motion_state(&world->objects[index].motion, world->tick);
}

/* ---- trails ----------------------------------------------------------------------------------------------------- */

void enf_world_set_trail(EnfWorld *world, bool on) {
    world->trail = on;
}

bool enf_world_has_trail(const EnfWorld *world) {
    return world->trail;
}

/* Half the tick is kept: 2^32 ticks after its event an object is taken for one just set, for one tick, and is blended from where it
 * is: every box agrees. */
static bool has_last(const EnfWorld *world, uint32_t index) {
    return world->trail && world->objects[index].motion.set_tick != (uint32_t)world->tick;
}

bool enf_world_last_pose(EnfWorld *world, uint32_t index, EnfPose *pose) {
    if (!has_last(world, index)) {
        *pose = enf_world_pose(world, index);
        return false;
    }
    world->evaluations++;
    *pose = enf_motion_state(&world->objects[index].motion, world->tick - 1);
    return true;
}

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

/* The box of one pose is the bound of a motion that stands still there. */
static EnfBox3 pose_box(const EnfWorld *world, uint32_t index, EnfPose pose) {
    EnfMotion still;
    still.kind = ENF_MOTION_STILL;
    still.as.still = pose;
    return enf_motion_bound(&still, &world->objects[index].local, world->tick, world->tick);
}

static bool same_box(const EnfBox3 *a, const EnfBox3 *b) {
    return a->min.x == b->min.x && a->min.y == b->min.y && a->min.z == b->min.z && a->max.x == b->max.x &&
           a->max.y == b->max.y && a->max.z == b->max.z;
}

/* Does the new place lie within what the largest speed allows since the last push, a millionth less? Then, however many pushes
 * follow one another, volumes made since the first of them hold the last: what is left out is more than the rounding of boxes,
 * where a tick's way is not below a millionth of the coordinates. */
static bool within_speed(const EnfWorld *world, uint32_t index, EnfPose pose) {
    const EnfFreeMotion *free = &world->objects[index].motion.as.free;
    EnfBox3 before = pose_box(world, index, free->pose), now = pose_box(world, index, pose);
    if (same_box(&before, &now)) {
        return true;
    }
    int64_t elapsed = world->tick > free->push_tick ? world->tick - free->push_tick : 0;
    double way = free->max_speed * (double)elapsed / ENF_TICK_RATE * (1.0 - 0x1p-20);
    double size = enf_length(before.min) + enf_length(before.max);
    EnfVec3 reach = enf_v3(way, way, way);
    EnfBox3 allowed = {enf_sub(before.min, reach), enf_add(before.max, reach)};
    return way >= 0x1p-20 * size && enf_box3_contains(allowed, now.min) && enf_box3_contains(allowed, now.max);
}

bool enf_world_push(EnfWorld *world, EnfObjectId id, const EnfPose *pose) {
    if (!enf_world_alive(world, id) || world->objects[id.index].motion.kind != ENF_MOTION_FREE ||
        world->objects[id.index].motion.as.free.ask != NULL || !reserve_change(world)) {
        return false;
    }
    if (!within_speed(world, id.index, *pose)) {
        world->changes[world->change_count++] = id.index;
    }
    enf_free_push(&world->objects[id.index].motion, world->tick, *pose);
    world->pushes++;
    return true;
}

uint64_t enf_world_pushes(const EnfWorld *world) {
    return world->pushes;
}

/* Adds where the object was one tick ago. */
static EnfBox3 with_trail(EnfWorld *world, uint32_t index, EnfBox3 box) {
    EnfPose last;
    return has_last(world, index) && enf_world_last_pose(world, index, &last)
               ? enf_box3_union(box, pose_box(world, index, last))
               : box;
}

EnfBox3f enf_world_box(EnfWorld *world, uint32_t index) {
    return enf_box3f_outward(pose_box(world, index, enf_world_pose(world, index)));
}

EnfBox3f enf_world_seen_box(EnfWorld *world, uint32_t index) {
    EnfBox3 box = pose_box(world, index, enf_world_pose(world, index));
    return enf_box3f_outward(with_trail(world, index, box));
}

EnfBox3f enf_world_bound(EnfWorld *world, uint32_t index, int64_t until) {
    if (world->objects[index].motion.kind == ENF_MOTION_FREE) {
        refresh_free(world, index);
    }
    EnfBox3 box = enf_motion_bound(&world->objects[index].motion, &world->objects[index].local, world->tick, until);
    return enf_box3f_outward(with_trail(world, index, box));
}

bool enf_world_is_confined(const EnfWorld *world, uint32_t index) {
    return enf_world_is_free(world, index) && world->objects[index].motion.as.free.confined;
}

#if defined(__GNUC__)
#define PREFETCH(address) __builtin_prefetch(address)
#else
#define PREFETCH(address) ((void)(address))
#endif

void enf_world_prefetch(const EnfWorld *world, uint32_t index) {
    const char *object = (const char *)&world->objects[index];
    for (size_t at = 0; at < sizeof(Object); at += 64) {
        PREFETCH(object + at);
    }
    PREFETCH(object + sizeof(Object) - 1);
}

void enf_world_prefetch_named(const EnfWorld *world, uint32_t index) {
    const EnfMotion *motion = &world->objects[index].motion;
    switch (motion->kind) {
    case ENF_MOTION_PATH:
        PREFETCH(motion->as.path.translation.times);
        PREFETCH(motion->as.path.translation.values);
        PREFETCH(motion->as.path.rotation.times);
        PREFETCH(motion->as.path.rotation.values);
        break;
    case ENF_MOTION_FREE:
        PREFETCH(motion->as.free.user);
        break;
    case ENF_MOTION_CALLBACK:
        PREFETCH(motion->as.callback.user);
        break;
    case ENF_MOTION_HINGE:
    case ENF_MOTION_SLIDE:
    case ENF_MOTION_STILL:
        break;
    }
}

double enf_world_max_speed(const EnfWorld *world, uint32_t index) {
    return world->objects[index].max_speed;
}

bool enf_world_is_free(const EnfWorld *world, uint32_t index) {
    return world->objects[index].motion.kind == ENF_MOTION_FREE;
}

uint64_t enf_world_evaluations(const EnfWorld *world) {
    return world->evaluations;
}

EnfBox3f enf_world_box_in_cell(const EnfMap *map, uint32_t cell, EnfBox3f box) {
    const double *o = map->cells[cell].origin;
    EnfVec3 origin = enf_v3(o[0], o[1], o[2]);
    EnfBox3 local = {enf_sub(enf_v3_from_f(box.min), origin), enf_sub(enf_v3_from_f(box.max), origin)};
    return enf_box3f_outward(local);
}

bool enf_world_touches(const EnfMap *map, uint32_t cell, EnfBox3f box) {
    const EnfCell *c = &map->cells[cell];
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z};
    const double high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    for (int a = 0; a < 3; a++) {
        double cell_low = c->origin[a] + (double)c->min[a];
        double cell_high = c->origin[a] + (double)c->max[a];
        if (!(high[a] > cell_low + ENF_GRID_STEP && low[a] < cell_high - ENF_GRID_STEP)) {
            return false;
        }
    }
    return true;
}
