/* EnfLayout. Input: an EnfSource; output: cells, half-portals and the cell of every node. The order of work: roles and cells, openings,
 * links, half-portals. Source: DESIGN §3, §6. */
#include "compile/movers.h"

EnfCompileSettings enf_compile_settings_default(void) {
    return (EnfCompileSettings){.leak_gap = 0.25,
                                .portal_snap = 0.05,
                                .crease_deg = 30.0,
                                .max_image = 2048,
                                .weld_tjunctions = true,
                                .detect_leaks = true};
}

/* ---- half-portals ---------------------------------------------------------------------------------------------------------- */

static bool push_half(EnfLayoutWork *work, const EnfOpening *opening, uint32_t piece, bool reversed) {
    const EnfPiece *polygon = &work->patches.pieces.data[piece];
    if (!ENF_ARRAY_ROOM(&work->portals, 1) || !ENF_ARRAY_ROOM(&work->points, polygon->point_count)) {
        return false;
    }
    EnfLayoutPortal half = {.name = enf_opening_name(work, opening), .node = opening->node, .source = opening->source};
    half.target = opening->target;
    half.twin = ENF_NONE;
    half.point_first = work->points.count;
    half.point_count = polygon->point_count;
    half.flags = (opening->patch.bent ? ENF_PORTAL_NONPLANAR : 0U) | (opening->closed ? ENF_PORTAL_CLOSED : 0U) |
                 (opening->mirror ? ENF_PORTAL_MIRROR : 0U);
    half.has_transform = opening->has_transform;
    half.transform = opening->transform;
    for (uint32_t i = 0; i < polygon->point_count; i++) {
        uint32_t from = reversed ? polygon->point_count - 1 - i : i;
        work->points.data[work->points.count++] = work->patches.points.data[polygon->point_first + from];
    }
    work->portals.data[work->portals.count++] = half;
    return true;
}

/* The half-portals of one opening, both ways unless it is one way; the way back is named after the portal given there, if any. */
static bool push_opening(EnfLayoutWork *work, uint32_t index) {
    EnfOpening *opening = &work->openings.data[index];
    EnfOpening back = opening->twin != ENF_NONE ? work->openings.data[opening->twin] : *opening;
    back.patch = opening->patch;
    back.source = opening->target;
    back.target = opening->source;
    back.closed = opening->closed = opening->closed || back.closed;
    bool both = !opening->has_transform && (opening->twin != ENF_NONE || !opening->one_way);
    for (uint32_t i = 0; i < opening->patch.piece_count; i++) {
        uint32_t piece = opening->patch.piece_first + i, first = work->portals.count;
        if (!push_half(work, opening, piece, opening->flipped)) {
            return false;
        }
        if (both) {
            if (!push_half(work, &back, piece, !opening->flipped)) {
                return false;
            }
            work->portals.data[first].twin = first + 1;
            work->portals.data[first + 1].twin = first;
        }
    }
    return true;
}

/* Two portals that teleport to each other are twins, if each is one polygon. */
static void pair_teleports(EnfLayoutWork *work, const uint32_t *half_of) {
    for (uint32_t i = 0; i < work->openings.count; i++) {
        const EnfOpening *a = &work->openings.data[i];
        if (a->exit == ENF_NONE || a->dropped) {
            continue;
        }
        const EnfOpening *b = &work->openings.data[a->exit];
        if (b->exit == i && !b->dropped && a->patch.piece_count == 1 && b->patch.piece_count == 1) {
            work->portals.data[half_of[i]].twin = half_of[a->exit];
        }
    }
}

static bool push_openings(EnfLayoutWork *work) {
    uint32_t count = work->openings.count;
    uint32_t *half_of = enf_alloc(NULL, count, sizeof *half_of);
    bool ok = half_of != NULL || count == 0;
    for (uint32_t i = 0; ok && i < count; i++) {
        const EnfOpening *opening = &work->openings.data[i];
        bool second = opening->twin != ENF_NONE && opening->twin < i; /* pushed with the first of the two */
        half_of[i] = work->portals.count;
        if (!opening->dropped && !second) {
            ok = push_opening(work, i);
        }
    }
    if (ok) {
        pair_teleports(work, half_of);
    }
    enf_free(NULL, half_of, count, sizeof *half_of);
    return ok;
}

bool enf_layout_sort_portals(EnfLayoutPortal *portals, uint32_t count, uint32_t cell_count) {
    uint32_t *place = enf_alloc(NULL, count, sizeof *place);
    uint32_t *next = enf_alloc(NULL, (size_t)cell_count + 1, sizeof *next);
    EnfLayoutPortal *sorted = enf_alloc(NULL, count, sizeof *sorted);
    bool ok = next != NULL && (count == 0 || (place != NULL && sorted != NULL));
    for (uint32_t i = 0; ok && i < count; i++) {
        next[portals[i].source + 1]++;
    }
    for (uint32_t c = 0; ok && c < cell_count; c++) {
        next[c + 1] += next[c];
    }
    for (uint32_t i = 0; ok && i < count; i++) {
        place[i] = next[portals[i].source]++;
    }
    for (uint32_t i = 0; ok && i < count; i++) {
        EnfLayoutPortal portal = portals[i];
        portal.twin = portal.twin != ENF_NONE ? place[portal.twin] : ENF_NONE;
        sorted[place[i]] = portal;
    }
    if (ok && count > 0) {
        memcpy(portals, sorted, count * sizeof *sorted);
    }
    enf_free(NULL, place, count, sizeof *place);
    enf_free(NULL, next, (size_t)cell_count + 1, sizeof *next);
    enf_free(NULL, sorted, count, sizeof *sorted);
    return ok;
}

/* ---- cells ----------------------------------------------------------------------------------------------------------------- */

static int64_t least(int64_t a, int64_t b) {
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b) {
    return a > b ? a : b;
}

static int64_t middle(int64_t a, int64_t b) {
    const int64_t step = 16; /* grid steps between origins */
    int64_t sum = a + b;
    return (sum >= 0 ? sum : sum - 2 * step + 1) / (2 * step) * step;
}

/* Bounds take in the portals, and the origin is put at the middle. */
static void place_cells(EnfLayoutWork *work) {
    for (uint32_t i = 0; i < work->portals.count; i++) {
        const EnfLayoutPortal *portal = &work->portals.data[i];
        EnfLayoutCell *cell = &work->cells.data[portal->source];
        for (uint32_t k = portal->point_first; k < portal->point_first + portal->point_count; k++) {
            EnfGrid3 p = work->points.data[k];
            cell->min = (EnfGrid3){least(cell->min.x, p.x), least(cell->min.y, p.y), least(cell->min.z, p.z)};
            cell->max = (EnfGrid3){most(cell->max.x, p.x), most(cell->max.y, p.y), most(cell->max.z, p.z)};
        }
    }
    for (uint32_t c = 0; c < work->cells.count; c++) {
        EnfLayoutCell *cell = &work->cells.data[c];
        cell->origin = (EnfGrid3){middle(cell->min.x, cell->max.x), middle(cell->min.y, cell->max.y),
                                  middle(cell->min.z, cell->max.z)};
    }
}

/* A level without rooms is one room. */
static bool make_only_cell(EnfLayoutWork *work) {
    EnfLayout *layout = work->layout;
    if (!ENF_ARRAY_ROOM(&work->cells, 1)) {
        return false;
    }
    work->cells.data[work->cells.count++] = (EnfLayoutCell){.name = "level", .node = ENF_NONE, .parent = ENF_NONE};
    enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_NO_ROOMS, "",
                 "no node's name ends in '-room': the whole level became one cell. Put the contents of each room under a node "
                 "named 'NAME-room', and a polygon named 'OTHER*-portal' into each opening to room OTHER");
    for (uint32_t n = 0; n < work->source->node_count; n++) {
        layout->node_cells[n] = 0;
        if (layout->roles[n] == ENF_ROLE_PORTAL) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, work->source->nodes[n].name,
                         "there are no rooms for it to join; it was left out");
        }
    }
    return true;
}

/* A room inside another that no portal joins to anything would never be seen. */
static bool link_nested(EnfLayoutWork *work) {
    bool *joined = enf_alloc(NULL, work->cells.count, sizeof *joined);
    if (joined == NULL) {
        return work->cells.count == 0;
    }
    for (uint32_t i = 0; i < work->openings.count; i++) {
        const EnfOpening *opening = &work->openings.data[i];
        if (!opening->dropped) {
            joined[opening->source] = true;
            joined[opening->target] = true;
        }
    }
    bool ok = true;
    for (uint32_t c = 0; ok && c < work->cells.count; c++) {
        uint32_t parent = work->cells.data[c].parent;
        if (parent == ENF_NONE || joined[c]) {
            continue;
        }
        ok = ENF_ARRAY_ROOM(&work->portals, 2);
        if (ok) {
            uint32_t first = work->portals.count;
            EnfLayoutPortal in = {.name = "", .node = ENF_NONE, .source = parent, .target = c, .twin = first + 1};
            in.flags = ENF_PORTAL_OVERLAP;
            EnfLayoutPortal out = in;
            out.source = c, out.target = parent, out.twin = first;
            work->portals.data[work->portals.count++] = in;
            work->portals.data[work->portals.count++] = out;
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_ROOM_OVERLAP, work->cells.data[c].name,
                         "the room lies inside '%s', but no portal leads into it: they are shown together",
                         work->cells.data[parent].name);
        }
    }
    enf_free(NULL, joined, work->cells.count, sizeof *joined);
    return ok;
}

/* ---- the whole ------------------------------------------------------------------------------------------------------------- */

/* Exporters leave these out unless a box is ticked (PITFALLS 30). */
static void remark_on_export(const EnfLayoutWork *work) {
    const EnfSource *source = work->source;
    bool blender = source->generator != NULL && strstr(source->generator, "Blender") != NULL;
    if (!source->has_extras) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_NO_EXTRAS, "", "the file has no extras%s: names alone say what a node is",
                     blender ? " (in Blender's glTF export tick Include > Data > Custom Properties)" : "");
    }
    if (!source->has_lights) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_NO_LIGHTS, "", "the file has no lights%s",
                     blender ? " (in Blender's glTF export tick Include > Data > Punctual Lights)" : "");
    }
}

/* The grid's integers hold cells of this half size (metres) exactly in every stage: 2^18, 262 km. */
static bool is_too_large(const EnfLayoutWork *work) {
    const int64_t limit = (int64_t)1 << 30;
    for (uint32_t c = 0; c < work->cells.count; c++) {
        const EnfLayoutCell *cell = &work->cells.data[c];
        int64_t size = most(cell->max.x - cell->min.x, most(cell->max.y - cell->min.y, cell->max.z - cell->min.z));
        if (size >= limit) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_TOO_LARGE, cell->name, "the cell is %.0f km across: more than 262",
                         (double)size / 4096.0 / 1000.0);
            return true;
        }
    }
    return false;
}

static bool has_geometry(const EnfLayoutWork *work) {
    for (uint32_t n = 0; n < work->source->node_count; n++) {
        EnfRole role = work->layout->roles[n];
        uint32_t mesh = work->source->nodes[n].mesh;
        if (mesh == ENF_NONE || (role != ENF_ROLE_GEOMETRY && role != ENF_ROLE_ROOM)) {
            continue;
        }
        for (uint32_t i = 0; i < work->source->meshes[mesh].primitive_count; i++) {
            if (work->source->primitives[work->source->meshes[mesh].primitive_first + i].index_count > 0) {
                return true;
            }
        }
    }
    return false;
}

static bool build(EnfLayoutWork *work) {
    if (work->cells.count == 0) {
        return make_only_cell(work) && enf_layout_bounds(work);
    }
    bool ok = enf_layout_index_rooms(work) && enf_layout_bounds(work) && enf_layout_openings(work) && enf_layout_shells(work);
    if (ok) {
        enf_layout_link(work);
        ok = push_openings(work) && link_nested(work) &&
             enf_layout_sort_portals(work->portals.data, work->portals.count, work->cells.count);
    }
    return ok;
}

/* The arrays become the layout's. */
static void hand_over(EnfLayoutWork *work) {
    EnfLayout *layout = work->layout;
    layout->cells = work->cells.data;
    layout->cell_count = work->cells.count;
    layout->portals = work->portals.data;
    layout->portal_count = work->portals.count;
    layout->points = work->points.data;
    layout->point_count = work->points.count;
    layout->bound_planes = work->planes.data;
    layout->bound_plane_count = work->planes.count;
}

static void work_free(EnfLayoutWork *work) {
    size_t keys = 3 * (size_t)work->cells.count;
    enf_free(NULL, work->rooms, keys, sizeof *work->rooms);
    enf_free(NULL, work->rooms_folded, keys, sizeof *work->rooms_folded);
    free(work->openings.data);
    free(work->extras.data);
    enf_patches_free(&work->patches);
    enf_shells_free(&work->shells);
    enf_kd_built_free(&work->cell_tree);
}

EnfResult enf_layout_build(EnfLayout *layout, const EnfSource *source, const EnfCompileSettings *settings,
                           EnfDiagnosis *diagnosis, EnfError *error) {
    ENF_ASSERT(layout && source && settings && diagnosis);
    EnfLayoutWork work = {.source = source, .settings = settings, .diagnosis = diagnosis, .layout = layout};
    *layout = (EnfLayout){.source = source};
    layout->roles = calloc((size_t)source->node_count + 1, sizeof *layout->roles);
    layout->node_cells = calloc((size_t)source->node_count + 1, sizeof *layout->node_cells);
    EnfResult result = ENF_OK;
    if (layout->roles == NULL || layout->node_cells == NULL || !enf_layout_roles(&work) || !enf_movers_mark(&work)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for %u nodes", source->node_count);
    } else if (!has_geometry(&work)) {
        enf_diagnose(diagnosis, ENF_DIAGNOSIS_NO_GEOMETRY, "", "the level has no triangles to draw");
        result = enf_error_set(error, ENF_ERROR_LEVEL, UINT64_MAX, "the level has no triangles to draw");
    } else if (!build(&work)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the cells and portals");
    }
    if (result == ENF_OK) {
        remark_on_export(&work);
        place_cells(&work);
        if (is_too_large(&work)) {
            result = enf_error_set(error, ENF_ERROR_LEVEL, UINT64_MAX, "a cell is larger than the compiler's grid can hold");
        }
    }
    hand_over(&work);
    work_free(&work);
    if (result != ENF_OK) {
        enf_layout_free(layout);
    }
    return result;
}

void enf_layout_free(EnfLayout *layout) {
    free(layout->cells);
    free(layout->portals);
    free(layout->points);
    free(layout->bound_planes);
    free(layout->roles);
    free(layout->node_cells);
    free(layout->node_movers);
    free(layout->guests);
    memset(layout, 0, sizeof *layout);
}
