/* Every experiment, a line each: BENCH(name, function, what it shows, its knobs with defaults). */
BENCH(L1, bench_l1, "Luebke & Georges 1995: whole frames along a path, every traversal and window against the whole model",
      "scene=palace,freedoom,buildings path=CSV frames=500 width=640 height=480 fov=60 repeat=3 check=1 context=any")
BENCH(vis, bench_vis, "visibility of a frame alone (traversal and kd queries, one core), every traversal and window",
      "scene=palace,freedoom,buildings path=CSV frames=2000 width=640 height=480 fov=60 repeat=5 check=20 context=any")
BENCH(compile, bench_compile, "compile time against size: grids of rooms with doors and furniture",
      "rooms=100,500,2000,7000 tables=1 repeat=1")
BENCH(kd, bench_kd, "kd query with each SIMD variant against brute force over all boxes",
      "boxes=1000,10000,100000 frames=200 seed=1")
BENCH(collide, bench_collide, "swept capsules and walking bodies against brute force over every triangle",
      "scene=palace,freedoom,buildings path=CSV frames=500 moves=100000 brute=1000")
BENCH(S1, bench_s1, "Sudarsky & Gotsman 1996, test scene 1: a small cube in a large one, update from the root or the common ancestor",
      "rooms=4096 frames=108000 seed=1 policy=all")
BENCH(S2, bench_s2, "the same, test scene 2: a small cube around a thing on a table",
      "rooms=64 boxes=5745 frames=108000 seed=1 policy=all")
#define MOVERS_KNOBS \
    "rooms=1024 movers=10000 visible=0 speed=1.4 motion=free policy=all eye=walk doors=75 " \
    "door_width=1.25 polygons=0 period=64 leaf=4 occluders=all frames=600 seed=1 check=50 rounds=1 budget=20"
BENCH(movers, bench_movers, "moving objects: finding what is seen, every policy against plain ways, at the sizes of other engines", MOVERS_KNOBS)
BENCH(million, bench_million, "the same, a million in 10,000 rooms: every motion; and 1,000 visible with few and many hidden", MOVERS_KNOBS)
BENCH(losing, bench_losing, "the same, where volumes have little to win: fast movers, open plan, nothing hidden", MOVERS_KNOBS)
BENCH(S3, bench_s3, "Sudarsky & Gotsman 1996, figure 6a: 92 movers, static polygons vary", MOVERS_KNOBS)
BENCH(S4, bench_s4, "the same, figure 6b: four movers a room, size varies", MOVERS_KNOBS)
BENCH(S5, bench_s5, "the same, figure 6c: 125 rooms, movers vary", MOVERS_KNOBS)
BENCH(S6, bench_s6, "the same, section 3.2: how long volumes are valid, still and walking eye", MOVERS_KNOBS)
BENCH(B1, bench_b1, "Paunoo 2006, scene 1: one visible mover; polygons, speed", MOVERS_KNOBS)
BENCH(B2, bench_b2, "the same, scene 2: one visible, several hidden; polygons, number, speed", MOVERS_KNOBS)
BENCH(B3, bench_b3, "the same, scene 3: visible and hidden; polygons, number, speed", MOVERS_KNOBS)
BENCH(B4, bench_b4, "the same, scene 4: with static objects too; polygons, number, speed", MOVERS_KNOBS)
#undef MOVERS_KNOBS
