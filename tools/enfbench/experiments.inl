/* Every experiment, a line each: BENCH(name, function, what it shows, its knobs with defaults). */
BENCH(L1, bench_l1, "Luebke & Georges 1995: whole frames along a path, every traversal and window against the whole model",
      "scene=palace,freedoom,buildings path=CSV frames=500 width=640 height=480 fov=60 repeat=3 check=1 context=any")
BENCH(vis, bench_vis, "visibility of a frame alone (traversal and kd queries, one core), every traversal and window",
      "scene=palace,freedoom,buildings path=CSV frames=2000 width=640 height=480 fov=60 repeat=5 check=20 context=any")
BENCH(compile, bench_compile, "compile time against size: grids of rooms with doors and furniture",
      "rooms=100,500,2000,7000 tables=1 repeat=1")
BENCH(kd, bench_kd, "kd query with each SIMD variant against brute force over all boxes",
      "boxes=1000,10000,100000 frames=200 seed=1")
