# The suites of tests/suites.inl: one executable, and two CTest entries (label fast; label long), a line.

if(ENF_CMOCKA_STANDIN)
  set(CMOCKA_INCLUDE_DIR ${PROJECT_SOURCE_DIR}/tests/harness/standin)
  set(CMOCKA_LIBRARY "")
else()
  find_path(CMOCKA_INCLUDE_DIR cmocka.h)
  find_library(CMOCKA_LIBRARY cmocka)
  if(NOT CMOCKA_INCLUDE_DIR OR NOT CMOCKA_LIBRARY)
    message(FATAL_ERROR "cmocka is missing (Debian: libcmocka-dev); -DENF_TESTS=OFF builds without the tests")
  endif()
endif()

add_custom_target(enf_tests)
add_library(enf_harness STATIC ${PROJECT_SOURCE_DIR}/tests/harness/harness.c)
if(ENF_CMOCKA_STANDIN)
  target_sources(enf_harness PRIVATE ${PROJECT_SOURCE_DIR}/tests/harness/standin/cmocka.c)
endif()
enf_flags(enf_harness)
target_include_directories(enf_harness PUBLIC ${PROJECT_SOURCE_DIR}/tests)
target_include_directories(enf_harness SYSTEM PUBLIC ${CMOCKA_INCLUDE_DIR})
target_compile_definitions(enf_harness PUBLIC ENF_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                              ENF_SHARED_DATA="${ENF_SHARED_DATA}")
target_link_libraries(enf_harness PUBLIC ${CMOCKA_LIBRARY})
# Instrumented or emulated: what does not depend on that is left to the others.
if(ENF_SANITIZE OR CMAKE_CROSSCOMPILING)
  target_compile_definitions(enf_harness PUBLIC ENF_TEST_SLOW=1)
else()
  target_compile_definitions(enf_harness PUBLIC ENF_TEST_SLOW=0)
endif()

# Seconds after which CTest stops a test. A suite takes some ten seconds on an idle machine, many times that where it is
# instrumented or emulated.
set(ENF_TIMEOUT_FAST 900) # a hang is to be told from one slow, loaded core
set(ENF_TIMEOUT_LONG 1800)
if(ENF_SANITIZE OR CMAKE_CROSSCOMPILING)
  set(ENF_TIMEOUT_FAST 1200)
endif()

# enf_suite(NAME FOLDER LINKS): links is none, or libraries without their enf_, joined by "+", e.g. gl+compile.
function(enf_suite name folder links)
  set(source ${PROJECT_SOURCE_DIR}/tests/${folder}/test_${name}.c)
  if(NOT EXISTS ${source})
    message(FATAL_ERROR "tests/suites.inl lists the suite '${name}', but tests/${folder}/test_${name}.c is not there")
  endif()
  string(REPLACE "+" ";" libraries ${links})
  list(REMOVE_ITEM libraries none)
  list(TRANSFORM libraries PREPEND enf_)
  foreach(library ${libraries})
    if(NOT TARGET ${library})
      message(STATUS "test ${name} is left out: ${library} is not there")
      return()
    endif()
  endforeach()
  add_executable(test_${name} ${source})
  enf_flags(test_${name})
  target_compile_definitions(test_${name} PRIVATE ENF_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/engine ${PROJECT_SOURCE_DIR}/tools)
  target_link_libraries(test_${name} PRIVATE enf_harness)
  if(libraries AND TARGET enf_scenes)
    target_link_libraries(test_${name} PRIVATE enf_scenes)
  endif()
  target_link_libraries(test_${name} PRIVATE ${libraries} m)
  foreach(program enfc enfinfo enfview enfbench enfreplay)
    if(TARGET ${program} AND NOT links MATCHES "^(none|core)$")
      add_dependencies(test_${name} ${program})
    endif()
  endforeach()
  add_dependencies(enf_tests test_${name})
  foreach(length fast long)
    set(test ${name})
    string(TOUPPER ${length} upper)
    if(length STREQUAL "long")
      set(test ${name}.long)
    endif()
    add_test(NAME ${test} COMMAND test_${name})
    set_tests_properties(${test} PROPERTIES LABELS "${length};${folder};${links}" TIMEOUT ${ENF_TIMEOUT_${upper}}
                                            SKIP_RETURN_CODE 77)
  endforeach()
  set_tests_properties(${name}.long PROPERTIES ENVIRONMENT ENF_TEST_LONG=1)
endfunction()

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/suites.inl)
file(STRINGS ${PROJECT_SOURCE_DIR}/tests/suites.inl suite_lines REGEX "^ENF_SUITE\\(")
foreach(line ${suite_lines})
  if(NOT line MATCHES "^ENF_SUITE\\(([a-z0-9_]+), *([a-z]+), *([a-z+]+)\\)$")
    message(FATAL_ERROR "tests/suites.inl: not 'ENF_SUITE(name, folder, links)': ${line}")
  endif()
  enf_suite(${CMAKE_MATCH_1} ${CMAKE_MATCH_2} ${CMAKE_MATCH_3})
endforeach()

# The longest first: a test of a minute that is begun last leaves the other processors with nothing to do.
foreach(name collide levels front replay chase mover_levels)
  foreach(test ${name} ${name}.long)
    if(TEST ${test})
      set_tests_properties(${test} PROPERTIES COST 100)
    endif()
  endforeach()
endforeach()

# The maps of the recordings are compiled once, before the suites that walk them.
if(TARGET enfc)
  add_test(NAME replay_maps COMMAND bash ${PROJECT_SOURCE_DIR}/tests/replay/maps.sh $<TARGET_FILE:enfc> ${CMAKE_BINARY_DIR}/replay_maps)
  set_tests_properties(replay_maps PROPERTIES LABELS "fast;long;replay" FIXTURES_SETUP replay_maps TIMEOUT ${ENF_TIMEOUT_FAST})
  foreach(name replay mash replay_drawn)
    foreach(test ${name} ${name}.long)
      if(TEST ${test})
        set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED replay_maps)
      endif()
    endforeach()
  endforeach()
endif()

# enf_core as somebody else uses it: installed, found, linked, and given a level.
if(TARGET enf_core AND TARGET enfc AND NOT ENF_SANITIZE AND NOT ENF_COVERAGE)
  add_test(NAME install COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DWORK=${CMAKE_BINARY_DIR}/install_test
                                -DCOMPILER=${CMAKE_C_COMPILER} -DENFC=$<TARGET_FILE:enfc>
                                -DLEVEL=${PROJECT_SOURCE_DIR}/assets/palace/palace.glb "-DEYE=0;1.7;15;0"
                                -P ${PROJECT_SOURCE_DIR}/tests/install/install.cmake)
  set_tests_properties(install PROPERTIES LABELS fast TIMEOUT ${ENF_TIMEOUT_FAST})
endif()

# The game, as a person plays it: on a screen of Xvfb, with keys and a mouse by xdotool.
if(TARGET enfilade AND TARGET enfc AND TARGET enfreplay AND NOT CMAKE_CROSSCOMPILING)
  set(sanitized no)
  if(ENF_SANITIZE)
    set(sanitized sanitized)
  endif()
  # play: a whole evening. starts: how it begins and ends.
  foreach(test play starts)
    add_test(NAME ${test} COMMAND ${PROJECT_SOURCE_DIR}/tests/game/${test}.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                                  ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/game_test/${test} ${sanitized})
    set_tests_properties(${test} PROPERTIES LABELS "fast;game;gl" TIMEOUT ${ENF_TIMEOUT_FAST} SKIP_RETURN_CODE 77 RUN_SERIAL ON)
  endforeach()
endif()

include(EnfStyle)
include(EnfFuzz)
