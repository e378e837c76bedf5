# The lints of tests/style as tests. Each has a second entry, <name>.self, that shows it a bad snippet.

find_package(Python3 COMPONENTS Interpreter)
if(NOT Python3_Interpreter_FOUND OR CMAKE_CROSSCOMPILING)
  return()
endif()

# enf_lint(NAME LABEL ARGUMENT...)
function(enf_lint name label)
  set(script ${PROJECT_SOURCE_DIR}/tests/style/lint_${name}.py)
  add_test(NAME style_${name} COMMAND ${Python3_EXECUTABLE} -B ${script} ${ARGN})
  add_test(NAME style_${name}.self COMMAND ${Python3_EXECUTABLE} -B ${script} --self-test)
  set_tests_properties(style_${name} PROPERTIES LABELS "${label};style" TIMEOUT 900 SKIP_RETURN_CODE 77)
  set_tests_properties(style_${name}.self PROPERTIES LABELS "${label};style" TIMEOUT 60 SKIP_RETURN_CODE 77)
endfunction()

enf_lint(layers fast)
enf_lint(sizes fast)
enf_lint(house fast)
enf_lint(format fast)
enf_lint(sounds fast)
enf_lint(tidy long ${CMAKE_BINARY_DIR})
set_tests_properties(style_tidy PROPERTIES TIMEOUT 3600) # every file, and most of the headers anew for each
# Instrumented and link-time-optimised objects name helpers of their own, so only a plain build is looked at.
if(TARGET enf_core AND NOT ENF_SANITIZE AND NOT ENF_COVERAGE AND NOT ENF_FUZZ AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  enf_lint(symbols fast ${CMAKE_NM} $<TARGET_FILE:enf_core>)
endif()

add_test(NAME tally.self COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tests/tally.py --self-test)
set_tests_properties(tally.self PROPERTIES LABELS "fast;style" TIMEOUT 60)

# What scripts make is what is committed: the sounds, and the palace by its own rules.
add_test(NAME assets.sounds COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/assets/sounds/synth.py --check)
add_test(NAME assets.palace COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/assets/palace/check.py)
set_tests_properties(assets.sounds assets.palace PROPERTIES LABELS "fast;style" TIMEOUT 600)
