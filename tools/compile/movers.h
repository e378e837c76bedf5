/* What moves: which nodes, with which meshes, along which paths, through which doorways. EnfSource + EnfLayout → meshes, movers. */
#ifndef ENFILADE_COMPILE_MOVERS_H
#define ENFILADE_COMPILE_MOVERS_H

#include "compile/assemble.h"
#include "compile/layout_work.h"
#include "compile/mover_extras.h"

/** layout: marks the nodes that move (EnfLayout.node_movers) and takes their meshes out of static geometry (ENF_ROLE_MOVER). A node
 *  moves if it is animated itself, or its extras say so (a class of enf_mover_class, `dynamic`, `max_speed`). What hangs below it moves
 *  with it, as one rigid mesh, down to nodes that move by themselves; `-colonly` nodes, too. Rooms, portals and bounds do not move. A
 *  level of which nothing would be left standing keeps everything static. False if memory is out. */
bool enf_movers_mark(EnfLayoutWork *work);

/** assembly: meshes, movers and the paths they take, after entities. False if memory is out or a table has no room. */
bool enf_assemble_movers(EnfAssembly *assembly, const EnfAssemblyParts *parts);

/* ---- what the mover_*.c share ------------------------------------------------------------------------------------ */

/* Metres: what is larger, or goes farther, is a slip of the keyboard. */
#define ENF_MOVER_FAR 1e6

/** All movers in the making. */
typedef struct EnfMovers {
    EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    uint32_t *meshes;                   /**< a source mesh → the mesh that it became as it is, or ENF_NONE */
    uint32_t *first_path, *next_path;   /**< the animation curves of a node, in the file's order; ENF_NONE ends */
    uint32_t *first_piece, *next_piece; /**< the nodes that a node moves rigidly, itself first; ENF_NONE ends */
    uint32_t *driver;                   /**< a node → the animated node at or next above it, or ENF_NONE */
    ENF_ARRAY(uint32_t) nodes;          /**< a mover → its root */
    uint32_t clip;                      /**< the material of what collides and is not drawn, or ENF_NONE so far */
    uint64_t samples;                   /**< ticks that were sampled: a hostile level would have more than there is time for */
} EnfMovers;

/** A mover in the making. */
typedef struct EnfMoverWork {
    EnfMovers *movers;
    EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    uint32_t node; /**< the root */
    EnfMoverExtras extras;
    EnfAffine rest; /**< mesh space → world as the run time computes it: the entity's translation, rotation, scale */
    EnfMover mover;
} EnfMoverWork;

/** Mesh space → world of a mover at rest, from its entity's floats, as the run time will read them. */
EnfAffine enf_mover_rest(const EnfEntity *entity);
/** mover_mesh.c: the mesh of a mover, shared with earlier movers of the same source mesh. False if memory is out. */
bool enf_mover_mesh(EnfMoverWork *work);
/** mover_obstacle.c: what of a node that stands only collides, as movers that stand: a solid has few triangles (collide.h), so that
 *  large meshes become several. False if memory is out. */
bool enf_mover_obstacle(EnfMoverWork *work);
/** Does the node only collide (`-colonly`), or has it faces that do (material `clip`)? */
bool enf_mover_collides(const EnfSource *source, const EnfLayout *layout, uint32_t node);
/** mover_path.c: kind, wrap, seconds, phase and tracks of an animated node, in the world. False if memory is out. */
bool enf_mover_path(EnfMoverWork *work);
/** mover_door.c: hinges and slides: axis, pivot, range, rate. */
void enf_mover_swing(EnfMoverWork *work);
/** mover_speed.c: no point of the mover is faster, metres a second; 0 where nothing is known. */
float enf_mover_speed(const EnfMoverWork *work);
/** mover_cover.c: which portals the doors close; only those that all their doors together cover whole (PITFALLS 10). False if memory
 *  is out. */
bool enf_movers_close_portals(EnfMovers *movers);

/* ---- meshes from corners (mover_mesh.c) -------------------------------------------------------------------------- */

/** A corner before corners are shared. */
typedef struct EnfMoverCorner {
    EnfVertex vertex;
    uint32_t material, order;
} EnfMoverCorner;

typedef struct EnfMesher {
    EnfMovers *movers;
    bool obstacle;                     /**< only what collides and is not drawn */
    ENF_ARRAY(EnfMoverCorner) corners; /**< three a triangle */
} EnfMesher;

/** The triangles of a node. `to_mesh` leads from the node's mesh to the mover's; `flip`: the node turns windings around in the world. */
bool enf_mesher_add_node(EnfMesher *mesher, uint32_t node, const EnfAffine *to_mesh, bool flip);
/** `count` corners (reordered) become a mesh of its own: work->mover.mesh. Too far away: reported, no mesh. */
bool enf_mesher_add_mesh(EnfMoverWork *work, EnfMoverCorner *corners, uint32_t count);

/* ---- animations (mover_path.c) ----------------------------------------------------------------------------------- */

/** The curves of one node: of each target the first animation that drives it. */
typedef struct EnfMoverDrive {
    const EnfSourcePath *paths[3]; /**< by target; NULL: as at rest */
    double first, seconds;         /**< of all curves: when they begin, how long they take */
    EnfWrap wrap;
    double phase;
} EnfMoverDrive;

EnfMoverDrive enf_mover_drive(const EnfMovers *movers, uint32_t node, const EnfMoverExtras *extras);
/** `count` key times less `first`; times that floats cannot tell apart once shifted are pushed apart. */
void enf_mover_shift_times(const float *times, uint32_t count, double first, float *out);
/** Room for a path of the mover's entity; its floats are at the returned place, NULL if memory is out. */
float *enf_mover_new_path(EnfMoverWork *work, const char *name, EnfPath path, uint32_t *number);
/** mover_chain.c: the motion of what hangs below something that moves. False if memory is out. */
bool enf_mover_chain(EnfMoverWork *work);
/** Ticks of one pass of `seconds`. */
uint32_t enf_mover_ticks(double seconds);

#endif
