/* What moves: which nodes, with which meshes, along which paths, through which doorways. EnfSource + EnfLayout → meshes, movers. */
#ifndef ENFILADE_COMPILE_MOVERS_H
#define ENFILADE_COMPILE_MOVERS_H

#include "compile/assemble.h"
#include "compile/layout_work.h"
#include "compile/mover_extras.h"

/** layout: marks the nodes that move (EnfLayout.node_movers) and takes their meshes out of static geometry (ENF_ROLE_MOVER). A node
 *  moves if it is animated itself, or its extras say so (a class of enf_mover_class, `dynamic`, `max_speed`). What hangs below it moves
 *  with it, as one rigid mesh, down to nodes that move by themselves. Rooms, portals and bounds do not move. A level of which nothing
 *  would be left standing keeps everything static. False if memory is out. */
bool enf_movers_mark(EnfLayoutWork *work);

/** assembly: meshes, movers and the paths they take, after entities. False if memory is out or a table has no room. */
bool enf_assemble_movers(EnfAssembly *assembly, const EnfAssemblyParts *parts);

/* ---- what the mover_*.c share ------------------------------------------------------------------------------------ */

/** A mover in the making. */
typedef struct EnfMoverWork {
    EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    uint32_t node; /**< the root */
    EnfMoverExtras extras;
    EnfAffine rest; /**< mesh space → world as the run time computes it: the entity's translation, rotation, scale */
    EnfMover mover;
    uint32_t clip; /**< what only collides: the material that all of its mesh takes; else ENF_NONE */
} EnfMoverWork;

/** mover_mesh.c: the mesh of a mover, shared with earlier movers of the same source mesh. `shared` maps a source mesh to its mesh, or
 *  ENF_NONE. False if memory is out. */
bool enf_mover_mesh(EnfMoverWork *work, uint32_t *shared);
/** Does the node only collide (`-colonly`), or has it faces that do (material `clip`)? */
bool enf_mover_collides(const EnfSource *source, const EnfLayout *layout, uint32_t node);
/** mover_path.c: kind, wrap, seconds, phase and tracks of an animated node, in the world. False if memory is out. */
bool enf_mover_path(EnfMoverWork *work);
/** mover_door.c: hinges and slides: axis, pivot, range, rate. */
void enf_mover_swing(EnfMoverWork *work);
/** mover_door.c: which portals the doors close; only those that all their doors together cover whole (PITFALLS 10). `nodes` are the
 *  roots, by mover. False if memory is out. */
bool enf_movers_close_portals(EnfAssembly *assembly, const EnfAssemblyParts *parts, const uint32_t *nodes);

/** Ticks of one pass of `seconds`. */
uint32_t enf_mover_ticks(double seconds);

#endif
