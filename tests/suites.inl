/* Every suite of tests, a line each: ENF_SUITE(name, folder, links). CMake reads this file, and so does C.
 *
 * name:   the executable test_<name>, made from tests/<folder>/test_<name>.c
 * folder: unit (one function at a time), property (random input against an oracle), golden (pictures), replay
 * links:  none, core, gl or compile: the library under test; several are joined by '+', e.g. gl+compile
 *
 * Write the file first, then its line: a line without a file stops CMake. */
ENF_SUITE(harness, unit, none)
ENF_SUITE(draw, unit, core)
ENF_SUITE(vis, property, core)
ENF_SUITE(base, unit, core)
ENF_SUITE(file, unit, core)
ENF_SUITE(world, unit, core)
ENF_SUITE(traversal, unit, core)
ENF_SUITE(kd, property, core)
ENF_SUITE(math, unit, core)
ENF_SUITE(gl, golden, gl)
ENF_SUITE(motion, property, core)
ENF_SUITE(screen_box, property, core)
ENF_SUITE(map, unit, core)
ENF_SUITE(locate, property, core)
ENF_SUITE(track, property, core)
ENF_SUITE(portal_eye, property, core)
ENF_SUITE(predicates, property, core)
ENF_SUITE(window_polygon, property, core)
ENF_SUITE(import, unit, compile)
ENF_SUITE(import_looks, unit, compile)
ENF_SUITE(import_models, property, compile)
ENF_SUITE(import_hostile, property, compile)
ENF_SUITE(pyramid, property, core)
ENF_SUITE(dbv, property, core)
ENF_SUITE(layout, unit, compile)
ENF_SUITE(enfinfo, unit, compile)
ENF_SUITE(level_json, unit, compile)
ENF_SUITE(soup, unit, compile)
ENF_SUITE(weld, unit, compile)
ENF_SUITE(walks, property, compile)
ENF_SUITE(regions, property, compile)
