# Installs Enfilade into an empty folder, builds the project beside this file against it, twice (find_package and
# pkg-config), and lets it draw a level. Run by CTest: cmake -DBUILD=... -DWORK=... -DCOMPILER=... -DENFC=... -DLEVEL=... -DEYE=x;y;z;yaw -P install.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGV}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --component core --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_C_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/build)

file(GLOB_RECURSE description ${WORK}/prefix/*/enfilade.pc)
get_filename_component(folder ${description} DIRECTORY)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder} pkg-config
                        --define-variable=prefix=${WORK}/prefix --cflags --libs enfilade
                OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags)
run(${COMPILER} -std=c11 ${CMAKE_CURRENT_LIST_DIR}/own_renderer.c ${flags} -o ${WORK}/own_renderer)

run(${ENFC} --quiet ${LEVEL} -o ${WORK}/level.enfmap)
foreach(program build/own_renderer own_renderer)
  execute_process(COMMAND ${WORK}/${program} ${WORK}/level.enfmap ${EYE} OUTPUT_FILE ${WORK}/picture.pgm
                  ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  file(SIZE ${WORK}/picture.pgm size)
  if(NOT said MATCHES "^([0-9]+) of ([0-9]+) cells" OR NOT size EQUAL 307215)
    message(FATAL_ERROR "no picture: ${said} (${size} bytes)")
  endif()
  if(CMAKE_MATCH_1 LESS 1 OR NOT CMAKE_MATCH_1 LESS CMAKE_MATCH_2)
    message(FATAL_ERROR "${CMAKE_MATCH_1} of ${CMAKE_MATCH_2} cells seen: nothing, or nothing culled")
  endif()
  message(STATUS "${program}: ${said}")
endforeach()
