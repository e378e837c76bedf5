/* All tolerances of the engine: unit, derivation, and the test that pins each (DESIGN §2). */
#ifndef ENFILADE_TOLERANCES_H
#define ENFILADE_TOLERANCES_H

/** Spacing of the grid that the compiler snaps source vertices to, metres: 2^-12 (0.24 mm). A float32 holds multiples of it
 *  exactly up to 4,096 m from a cell's origin, so a vertex shared by two cells is the same point in both. Pinned by
 *  tests/property/test_predicates. */
#define ENF_GRID_STEP (1.0 / 4096.0)

/** Spacing of cell origins, metres: 2^-8. A multiple of ENF_GRID_STEP. */
#define ENF_ORIGIN_STEP (1.0 / 256.0)

/** An eye at most this far (metres) from a portal *polygon* passes the parent's window unclipped. Must exceed every length
 *  at which the projection of a portal loses meaning: ENF_TOL_EYE_PLANE times the widest field of view's corner (16), and
 *  the grid step by which an opening may be misplaced (PITFALLS 2, 3, 4). Pinned by tests/property/test_portal_eye. */
#define ENF_TOL_PORTAL_EYE (1.0 / 128.0)

/** Portals are clipped to w >= this, metres in front of the eye plane, before the divide (PITFALLS 1). Pinned by
 *  tests/property/test_screen_box. */
#define ENF_TOL_EYE_PLANE (1.0 / 8192.0)

/** Outward padding of projected boxes, pixels: far above the rounding of the double pipeline (< 2^-20 px), far below a
 *  window's step (PITFALLS 27). Pinned by tests/property/test_screen_box. */
#define ENF_TOL_PAD_PX (1.0 / 256.0)

/** A portal whose vertices stray farther than this (metres) from their common plane has no facing test: 16 grid steps, far above
 *  what snapping does to a flat polygon (1 step), far below a bend that could be looked through from behind (PITFALLS 4).
 *  Pinned by tests/unit/test_world. */
#define ENF_TOL_PORTAL_FLAT (16.0 * ENF_GRID_STEP)

/** How far, entry by entry, a portal's transform may be from orthonormal (|mᵀm − 1|; no unit). Products of a dozen exact
 *  rotations in double stay below 2^-47; at 2^-40 a point 4,096 m from the centre is misplaced by less than 2^-28 m, far below a
 *  grid step. A matrix read in float32 must be orthonormalised first. Pinned by tests/unit/test_map. */
#define ENF_TOL_RIGID 0x1p-40

/** How far, in metres, rounding moves a point that was computed in double: 32 roundings of a coordinate of 2^20 m. Points this
 *  close to a portal are on both sides of it where a point is located, and within its border where a step crosses it; the side of a
 *  step's ends is decided without it. Pinned by tests/property/test_locate and test_track. */
#define ENF_TOL_ROUNDING 0x1p-28

/** What a moving capsule keeps from surfaces, metres: 2^-9 (2 mm, not seen). Far above the rounding of a sweep (2^-24 m), so that what
 *  slides along a surface does not meet it again, and the next triangle of a floor not at all: contact counts from half of it.
 *  Pinned by tests/property/test_collide. */
#define ENF_TOL_SKIN 0x1p-9

/** A sweep ends when the capsule is this near, metres, to contact; contact is half a skin away from the surface. Doubles of
 *  positions within 2^20 m round by 2^-32. Pinned by tests/property/test_collide. */
#define ENF_TOL_CONTACT 0x1p-24

/** Windows are fixed point with this many steps a pixel. */
#define ENF_WINDOW_STEPS 16

/** Sine of the angle by which the window of a light may be wider than the openings it comes through, and below which an edge of
 *  it has no plane of its own: far above the rounding of doubles (2^-50), far below what lighting shows (a millimetre at a
 *  kilometre). Lights only, never visibility; it errs towards more light. Pinned by tests/unit/test_lights. */
#define ENF_TOL_LIGHT 0x1p-20

#endif
