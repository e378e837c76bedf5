/* EnfMap: a compiled level. The hinge of the house: the compiler writes it, the run time reads it (DESIGN §1, §8).
 *
 * Immutable once checked. Every record below is the exact file layout: little-endian, no padding, 4-byte fields (8-byte fields
 * first), so a chunk is an array of records. Geometry is float32 relative to the origin of its cell; origins are doubles on a
 * 2^-8 m grid; vertices lie on the 2^-12 m grid of the world, so one point shared by two cells is bit-equal after eye-relative
 * subtraction. Strings are offsets into `strings` (zero-terminated UTF-8; offset 0 is ""). Indices are into the map's arrays;
 * ENF_NONE is null. Nothing in a map is trusted before enf_map_check saw it. */
#ifndef ENFILADE_MAP_H
#define ENFILADE_MAP_H

#include <enfilade/kd.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ENF_MAP_VERSION 2

/** Cell flags. OUTSIDE: the synthetic cell that holds what lies in no room (never in `cells` of statistics). OPEN: its shell
 *  leaks; whoever sees into it is shown everything in that window (PITFALLS 12, 17: draw, never hide). */
enum { ENF_CELL_OUTSIDE = 1, ENF_CELL_OPEN = 2 };

typedef struct EnfCell {
    double origin[3];     /**< world, on the 2^-8 m grid */
    float min[3], max[3]; /**< bounds of contents, shell and portals, relative to origin, outward */
    uint32_t name;        /**< string: the glTF node's name */
    uint32_t flags;
    int32_t priority;                      /**< the higher wins where cells overlap */
    uint32_t portal_first, portal_count;   /**< half-portals leaving this cell, contiguous */
    uint32_t node_first, node_count;       /**< kd nodes */
    uint32_t block_first, block_count;     /**< kd leaf blocks */
    uint32_t cluster_first, cluster_count; /**< clusters whose home is this cell, contiguous */
    uint32_t light_first, light_count;     /**< in light_refs: lights that reach it */
    uint32_t bound_first, bound_count;     /**< in bound_planes, normals outward, relative to origin:
                                               inside n·p + d <= 0 for all; or none */
    uint32_t reserved;
} EnfCell; /* 24 + 24 + 64 = 112 bytes */

/** Half-portal flags. OVERLAP: no polygon (vertex_count 0): the two cells share space and the parent's window is passed on
 *  whole. NONPLANAR: no facing test. CLOSED: closed at start. MIRROR: its transform reflects. */
enum { ENF_PORTAL_OVERLAP = 1, ENF_PORTAL_NONPLANAR = 2, ENF_PORTAL_CLOSED = 4, ENF_PORTAL_MIRROR = 8 };

typedef struct EnfPortal {
    uint32_t source, target;             /**< cells */
    uint32_t twin;                       /**< the half-portal that leads back, or ENF_NONE (one way) */
    uint32_t vertex_first, vertex_count; /**< in portal_vertices, relative to the SOURCE cell's origin; front (right-hand
                                               normal) points out of the source, into the target */
    uint32_t transform;                  /**< in transforms: source space → target space, or ENF_NONE for identity */
    uint32_t flags;
    uint32_t name; /**< string: the glTF node's name */
} EnfPortal;       /* 32 bytes */

/** p_target = m p_source + t, world coordinates, m column-major, rigid or a reflection. */
typedef struct EnfTransform {
    double m[9], t[3];
} EnfTransform; /* 96 bytes */

typedef struct EnfCluster {
    float min[3], max[3]; /**< relative to the home cell's origin, tight */
    uint32_t cell;        /**< home: owner of the origin and lights */
    uint32_t material;
    uint32_t index_first, index_count;   /**< in indices; 3 × triangles, ≤ 3 × 128 */
    uint32_t vertex_first, vertex_count; /**< in vertices: all its indices lie in this range */
    uint32_t node;                       /**< string: the glTF node it came from (for messages) */
    uint32_t reserved;
} EnfCluster; /* 56 bytes */

typedef struct EnfVertex {
    float position[3]; /**< relative to the home cell's origin */
    uint32_t normal;   /**< three signed 10-bit fields x, y, z (bits 0, 10, 20), as GL_INT_2_10_10_10_REV */
    float uv[2];
    uint32_t color; /**< linear RGBA8, R in the low byte; white where absent */
    uint32_t cell;  /**< home cell (the shader fetches its eye-relative offset); ENF_NONE: of a mesh that moves, positions in
                         its own space */
} EnfVertex;        /* 32 bytes */

typedef enum EnfAlphaMode { ENF_ALPHA_OPAQUE, ENF_ALPHA_MASK, ENF_ALPHA_BLEND } EnfAlphaMode;
/** CLIP: collides although it is not drawn (NODRAW). NOCOLLIDE: drawn, and no obstacle. */
enum {
    ENF_MATERIAL_DOUBLE_SIDED = 1,
    ENF_MATERIAL_UNLIT = 2,
    ENF_MATERIAL_MIRROR = 4,
    ENF_MATERIAL_NODRAW = 8,
    ENF_MATERIAL_CLIP = 16,
    ENF_MATERIAL_NOCOLLIDE = 32
};

typedef struct EnfMaterial {
    uint32_t name;
    uint32_t texture;          /**< base colour, or ENF_NONE */
    uint32_t emissive_texture; /**< or ENF_NONE */
    uint32_t alpha_mode;       /**< EnfAlphaMode */
    uint32_t flags;
    float base_color[4]; /**< linear */
    float emissive[3];   /**< linear, strength applied */
    float alpha_cutoff;
    float roughness, metallic;
    float uv_transform[6]; /**< base colour KHR_texture_transform: u' = a u + b v + c; v' = d u + e v + f */
    float reserved;
} EnfMaterial; /* 88 bytes */

/** Samplers use the glTF (OpenGL) enumerants. */
typedef struct EnfTexture {
    uint32_t image;
    uint32_t mag_filter, min_filter, wrap_s, wrap_t;
} EnfTexture; /* 20 bytes */

/** RGBA8, sRGB colour with straight alpha, rows top to bottom as in the glTF image. */
typedef struct EnfImage {
    uint32_t width, height;
    uint32_t byte_first; /**< in pixels (bytes) */
    uint32_t name;
} EnfImage; /* 16 bytes */

typedef enum EnfLightKind { ENF_LIGHT_POINT, ENF_LIGHT_SPOT, ENF_LIGHT_DIRECTIONAL } EnfLightKind;
typedef struct EnfLight {
    double position[3]; /**< world */
    float direction[3]; /**< world, unit */
    float color[3];     /**< linear, times intensity (candela; lux for directional) */
    float range;        /**< metres; derived where the file gives none */
    float inner_cos, outer_cos;
    uint32_t kind; /**< EnfLightKind */
    uint32_t cell; /**< where it stands, or ENF_NONE (directional) */
    uint32_t name;
} EnfLight; /* 24 + 48 = 72 bytes */

/** A light that reaches a cell, through windows: lit is what lies inside all its planes (relative to the light's position:
 *  n·(p − light) >= 0), none for the light's own cell. A cell has one ref for each opening the light comes through. */
typedef struct EnfLightRef {
    uint32_t light, plane_first, plane_count;
} EnfLightRef; /* 12 bytes */
typedef struct EnfPlane4f {
    float n[3], d;
} EnfPlane4f; /* 16 bytes */

/** A node that is not geometry (or carries extras, or is animated): spawn points, cameras, markers, props' metadata. */
typedef struct EnfEntity {
    double translation[3]; /**< world */
    float rotation[4];     /**< world quaternion x, y, z, w */
    float scale[3];
    uint32_t name, classname, extras; /**< strings; extras is the node's JSON object as text, or "" */
    uint32_t parent;                  /**< entity or ENF_NONE */
    uint32_t cell;                    /**< where it lies, or ENF_NONE */
    uint32_t camera;                  /**< in cameras, or ENF_NONE */
    uint32_t light;                   /**< in lights, or ENF_NONE */
} EnfEntity;                          /* 24 + 56 = 80 bytes */

typedef struct EnfMapCamera {
    float fov_y, aspect, near_plane, far_plane;
} EnfMapCamera; /* radians; 16 bytes */

/** An animation channel of an entity: key times (seconds) and values in path_floats: key_count times, then the values
 *  (× 3 for cubic: in-tangent, value, out-tangent). */
typedef enum EnfPathTarget { ENF_PATH_TRANSLATION, ENF_PATH_ROTATION, ENF_PATH_SCALE } EnfPathTarget;
typedef enum EnfPathKind { ENF_PATH_STEP, ENF_PATH_LINEAR, ENF_PATH_CUBIC } EnfPathKind;
typedef struct EnfPath {
    uint32_t name; /**< the animation's name */
    uint32_t entity;
    uint32_t target; /**< EnfPathTarget */
    uint32_t kind;   /**< EnfPathKind */
    uint32_t key_count;
    uint32_t float_first;
} EnfPath; /* 24 bytes */

/** Geometry that moves: rigid, in its own space (metres), shared by any number of movers. Its vertices and indices stand behind those
 *  of all clusters. */
typedef struct EnfMesh {
    float min[3], max[3];            /**< of its vertices, tight */
    uint32_t part_first, part_count; /**< in mesh_parts, contiguous */
    uint32_t name;
    uint32_t reserved;
} EnfMesh; /* 40 bytes */

/** The triangles of a mesh that have one material; ordered by (mesh, material). */
typedef struct EnfMeshPart {
    uint32_t mesh, material;
    uint32_t index_first, index_count;   /**< in indices; 3 × triangles */
    uint32_t vertex_first, vertex_count; /**< in vertices: all its indices lie in this range */
} EnfMeshPart;                           /* 24 bytes */

/** How a mover moves: see EnfMotion (world.h). STILL things can be carried away, FREE ones are somebody's to steer. */
typedef enum EnfMoverKind { ENF_MOVER_STILL, ENF_MOVER_PATH, ENF_MOVER_HINGE, ENF_MOVER_SLIDE, ENF_MOVER_FREE } EnfMoverKind;
/** What a path does at its ends. */
typedef enum EnfWrap { ENF_WRAP_ONCE, ENF_WRAP_LOOP, ENF_WRAP_PING_PONG } EnfWrap;
/** SOLID: an obstacle. LOCKED: a door that does not open by itself. CARRY: can be carried away. */
enum { ENF_MOVER_SOLID = 1, ENF_MOVER_LOCKED = 2, ENF_MOVER_CARRY = 4 };

/** Something that moves. Its rest pose, name, class and extras are its entity's. */
typedef struct EnfMover {
    double pivot[3]; /**< world; of HINGE */
    uint32_t entity;
    uint32_t mesh;                         /**< or ENF_NONE: nothing to draw */
    uint32_t kind, wrap;                   /**< EnfMoverKind; EnfWrap (of PATH) */
    uint32_t translation, rotation, scale; /**< PATH: in paths, relative to the world; or ENF_NONE: as at rest */
    uint32_t portal;                       /**< half-portal that it closes while at rest, or ENF_NONE */
    uint32_t flags;                        /**< ENF_MOVER_* */
    uint32_t validity_ticks;               /**< the author's hint for its volumes; 0: none */
    float axis[3];                         /**< HINGE, SLIDE: unit, world */
    float low, high, rate;                 /**< HINGE, SLIDE: radians or metres, low <= 0 <= high; a second, > 0 */
    float seconds, phase;                  /**< PATH: of one pass, > 0; seconds into it at tick 0 */
    float max_speed;                       /**< metres a second, of any point; > 0 for FREE; 0: derived from the motion */
    uint32_t reserved;
} EnfMover; /* 24 + 80 = 104 bytes */

/** The chunks of a map in dependency order: X(TYPE, array, FOURCC). One table drives reader, checker, writer and tests. */
#define ENF_MAP_CHUNKS(X)                                                                                                      \
    X(char, strings, "STRS")                                                                                                   \
    X(EnfImage, images, "IMGS")                                                                                                \
    X(uint8_t, pixels, "PIXL")                                                                                                 \
    X(EnfTexture, textures, "TEXS")                                                                                            \
    X(EnfMaterial, materials, "MATS")                                                                                          \
    X(EnfCell, cells, "CELL")                                                                                                  \
    X(EnfTransform, transforms, "XFRM")                                                                                        \
    X(EnfPortal, portals, "PORT")                                                                                              \
    X(EnfVec3f, portal_vertices, "PVTX")                                                                                       \
    X(EnfPlane4f, bound_planes, "BPLN")                                                                                        \
    X(EnfVertex, vertices, "VERT")                                                                                             \
    X(uint32_t, indices, "INDX")                                                                                               \
    X(EnfCluster, clusters, "CLUS")                                                                                            \
    X(EnfKdNode, kd_nodes, "KDND")                                                                                             \
    X(EnfKdBlock, kd_blocks, "KDBL")                                                                                           \
    X(EnfLight, lights, "LGHT")                                                                                                \
    X(EnfLightRef, light_refs, "LREF")                                                                                         \
    X(EnfPlane4f, light_planes, "LPLN")                                                                                        \
    X(EnfMapCamera, cameras, "CAMS")                                                                                           \
    X(EnfEntity, entities, "ENTS")                                                                                             \
    X(EnfPath, paths, "PATH")                                                                                                  \
    X(float, path_floats, "PFLT")                                                                                              \
    X(EnfMesh, meshes, "MESH")                                                                                                 \
    X(EnfMeshPart, mesh_parts, "MPRT")                                                                                         \
    X(EnfMover, movers, "MOVR")                                                                                                \
    X(EnfKdNode, cell_nodes, "CKDN")                                                                                           \
    X(EnfKdBlock, cell_blocks, "CKDB")

/** Indices are absolute vertex numbers, so neighbouring clusters of one material merge into one draw range; clusters are
 *  ordered by (cell, material). cell_nodes/cell_blocks: one kd-tree over the world boxes of all cells but OUTSIDE (items are cells), relative to `tree_origin`. */
typedef struct EnfMap {
#define ENF_MAP_FIELD(type, array, fourcc)                                                                                     \
    const type *array;                                                                                                         \
    uint32_t array##_count;
    ENF_MAP_CHUNKS(ENF_MAP_FIELD)
#undef ENF_MAP_FIELD
    double tree_origin[3]; /**< world; in the file a chunk of its own, "ORIG" */
    uint64_t hash;         /**< of the content: identifies the map in recordings */
    uint64_t source_hash;  /**< of the glTF and project that it was compiled from */
    EnfFile file;          /**< the memory behind the arrays (empty where the caller owns them) */
} EnfMap;

/** Reads and checks: the map either is sound or is refused with file, byte offset and field. Free with enf_map_free. */
EnfResult enf_map_read(EnfMap *map, const char *path, const EnfAllocator *allocator, EnfError *error);
/** The same over the caller's bytes (16-byte aligned, kept alive by the caller). */
EnfResult enf_map_view(EnfMap *map, const void *data, size_t size, EnfError *error);
void enf_map_free(EnfMap *map);

/** Every index, range, enumerant, number (finite) and tree of the map. enf_map_read has called it; the compiler calls it on
 *  what it is about to write. */
EnfResult enf_map_check(const EnfMap *map, EnfError *error);

/** Writes atomically; byte-identical for equal content. Fills nothing in `map`. */
EnfResult enf_map_write(const EnfMap *map, const char *path, EnfError *error);
/** The content hash that enf_map_read would report for what enf_map_write writes. */
uint64_t enf_map_content_hash(const EnfMap *map);

/** A string of the map; "" for offset 0. */
static inline const char *enf_map_string(const EnfMap *map, uint32_t offset) {
    return map->strings + offset;
}

/** The kd-tree of a cell: items are clusters (its own and those of other cells that reach into it). */
EnfKdTree enf_map_cell_tree(const EnfMap *map, uint32_t cell);

/** The cell named `name`: the node's exact name, or that name without its `-room` suffix. ENF_NONE if absent. */
uint32_t enf_map_find_cell(const EnfMap *map, const char *name);

/** The cell that `p_ws` lies in: by `-bound` planes, else by what a few fixed rays meet first among the cell's opaque surfaces and
 *  its portals (a front, or a portal from within: inside; a back: outside); highest priority, then smallest volume wins. A point
 *  within a thing in the room (a barrel) is in the room. Double-sided surfaces count only where most of the cell is. ENF_NONE
 *  outside every cell. For spawn and teleport; a walking eye is tracked with enf_map_track. @cost tens of µs, hundreds in rooms of 10^4 triangles; no
 *  memory.
 *  @guarantee tests/property/test_locate, test_walks */
uint32_t enf_map_locate(const EnfMap *map, EnfVec3 p_ws);

/** Is `p_ws` inside this cell (as enf_map_locate decides it)? */
bool enf_map_cell_contains(const EnfMap *map, uint32_t cell, EnfVec3 p_ws);

/** The cell after moving from `from_ws` in `cell` to `to_ws`: follows the portals that the segment crosses, in order, closed ones
 *  too. Every point is on one side of a doorway, the same for both its half-portals, so no step along it loses the eye. Behind a
 *  portal with a transform the rest of the segment is followed there, but the caller moves the eye. Mirrors are not walked through.
 *  Exact for segments through portal interiors; ENF_NONE stays ENF_NONE. @cost some 0.1 µs a portal of the cells passed; no memory.
 *  @guarantee tests/property/test_track, test_walks */
uint32_t enf_map_track(const EnfMap *map, uint32_t cell, EnfVec3 from_ws, EnfVec3 to_ws);

/** The nearest triangle of a cell's clusters hit by a ray, front or back. */
typedef struct EnfRayHit {
    double t;
    uint32_t cluster, triangle;
    bool front;
} EnfRayHit;
bool enf_map_ray(const EnfMap *map, uint32_t cell, EnfVec3 from_ws, EnfVec3 direction, double t_max, EnfRayHit *hit);

#ifdef __cplusplus
}
#endif
#endif
