# The game: its simulation, a library that links enf_core alone (game/sim), and the program on a window (game/front).

enf_glob(sim_sources game/sim c)
if(sim_sources AND TARGET enf_core)
  add_library(enf_game STATIC ${sim_sources})
  enf_flags(enf_game)
  target_include_directories(enf_game PUBLIC ${PROJECT_SOURCE_DIR}/game)
  target_link_libraries(enf_game PUBLIC enf_core)
endif()
