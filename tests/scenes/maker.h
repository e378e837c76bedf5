/* Small maps made by code: polygons and portals in, a checked EnfMap out. For tests, benchmarks and pictures; the real thing is
 * tools/compile. Coordinates are world metres and should be multiples of 2^-12. */
#ifndef ENF_SCENES_MAKER_H
#define ENF_SCENES_MAKER_H

#include <enfilade/map.h>

typedef struct EnfMaker EnfMaker;

EnfMaker *enf_maker_create(void); /**< NULL without memory. Material 0, "plaster", is there already. */
void enf_maker_destroy(EnfMaker *maker);

/** Offset of `text`, added once. */
uint32_t enf_maker_string(EnfMaker *maker, const char *text);
/** Zeroed but for name, colour and an untransformed texture; the caller may fill in more until the next call. */
EnfMaterial *enf_maker_material(EnfMaker *maker, const char *name, float r, float g, float b);
/** Likewise; its origin is rounded to the grid of origins. Returns the index through `cell`. */
EnfCell *enf_maker_cell(EnfMaker *maker, const char *name, EnfVec3 origin_ws, uint32_t *cell);
/** A new group: polygons of one group, cell and material make one cluster (or several of 128 triangles). */
uint32_t enf_maker_group(EnfMaker *maker);
/** A new group of a node of this name. */
void enf_maker_node(EnfMaker *maker, const char *name);
/** A convex polygon, front by the right-hand rule, as a fan. */
void enf_maker_polygon(EnfMaker *maker, uint32_t cell, uint32_t material, const EnfVec3 *points, uint32_t count);
/** The six sides of a box; `inward`: a room, else a thing in it. */
void enf_maker_box(EnfMaker *maker, uint32_t cell, uint32_t material, EnfBox3 box, bool inward);
/** The current group, all of one cell and material, is also listed in the tree of `cell`. */
void enf_maker_reach(EnfMaker *maker, uint32_t cell);
/** A portal to be: `points` of `count` corners, front out of `source`; none for an overlap. */
typedef struct EnfMakerPortal {
    const char *name;
    uint32_t source, target;
    const EnfVec3 *points;
    uint32_t count, flags; /**< ENF_PORTAL_*; MIRROR is found by itself */
} EnfMakerPortal;
/** A pair of half-portals. Returns the number of the pair: enf_maker_half gives the map's indices. */
uint32_t enf_maker_add_portal(EnfMaker *maker, const EnfMakerPortal *portal);
#define enf_maker_portal(maker, name, source, target, points, count, flags)                                                    \
    enf_maker_add_portal((maker), &(EnfMakerPortal){(name), (source), (target), (points), (count), (flags)})
/** A half-portal alone, with a transform (`p_target = transform p_source`). A pair is two calls, and `twin` the number of the first,
 *  else ENF_NONE. Returns its number, of the same count as enf_maker_portal's. */
uint32_t enf_maker_add_teleport(EnfMaker *maker, const EnfMakerPortal *portal, const EnfAffine *transform, uint32_t twin);
#define enf_maker_teleport(maker, source, target, points, count, transform, twin)                                              \
    enf_maker_add_teleport((maker), &(EnfMakerPortal){"teleport", (source), (target), (points), (count), 0}, (transform),      \
                           (twin))
/** A point light that reaches its own cell alone. */
void enf_maker_light(EnfMaker *maker, uint32_t cell, EnfVec3 position_ws, EnfVec3f color, float range);
/** Limits the newest light in its cell to what lies inside `planes` (relative to the light). */
void enf_maker_light_window(EnfMaker *maker, const EnfPlane4f *planes, uint32_t count);
/** The half-space n·p <= n·point of the bound of the newest cell. */
void enf_maker_bound(EnfMaker *maker, EnfVec3 normal, EnfVec3 point_ws);
/** Raw records, for what no test needs more than once: entities, paths … go straight in. */
uint32_t enf_maker_entity(EnfMaker *maker, const EnfEntity *entity);
uint32_t enf_maker_path(EnfMaker *maker, const EnfPath *path, const float *floats, uint32_t float_count);
uint32_t enf_maker_image(EnfMaker *maker, uint32_t width, uint32_t height, const uint8_t *rgba);
uint32_t enf_maker_texture(EnfMaker *maker, uint32_t image);
uint32_t enf_maker_camera(EnfMaker *maker, const EnfMapCamera *camera);

/** A mesh that moves: a box of one material in its own space, fronts outward. Returns its index. */
uint32_t enf_maker_mesh(EnfMaker *maker, const char *name, uint32_t material, EnfBox3 box);
/** One more box of the newest mesh, of a material with a higher number. */
void enf_maker_mesh_part(EnfMaker *maker, uint32_t material, EnfBox3 box);
uint32_t enf_maker_mover(EnfMaker *maker, const EnfMover *mover);
/** A mover's fields that mean nothing: no entity's mesh, path or portal, a slide of no length along +Y at 1 m/s. */
EnfMover enf_maker_mover_default(void);

/** The map, owned by the maker; NULL with `error` if it does not pass enf_map_check. Nothing may be added after it. */
const EnfMap *enf_maker_finish(EnfMaker *maker, EnfError *error);
/** What enf_maker_finish gave. */
const EnfMap *enf_maker_map(const EnfMaker *maker);
/** The map's half-portal for a number that enf_maker_portal (`way` 0: as given, 1: its twin) or enf_maker_teleport gave. */
uint32_t enf_maker_half(const EnfMaker *maker, uint32_t number, uint32_t way);

#endif
