# Compiler flags, in one place. enf_flags(TARGET) gives a target of ours its language level and its warnings.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()

set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

set(ENF_WARNINGS_C -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wmissing-prototypes -Wstrict-prototypes -Wvla
                   -Wdouble-promotion -Wcast-qual)
set(ENF_WARNINGS_CXX -Wall -Wextra -Wpedantic -Wshadow)

# The same bits from every compiler and architecture: a fused multiply-add would round once where the source rounds
# twice. On gcc for aarch64, and on clang for newer x86-64, contraction is on by default.
set(ENF_EXACT_FLOAT -ffp-contract=off)

if(ENF_SANITIZE)
  add_compile_options(-fsanitize=${ENF_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ENF_SANITIZE})
endif()
if(ENF_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()
if(ENF_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

function(enf_flags target)
  target_compile_options(${target} PRIVATE ${ENF_EXACT_FLOAT} "$<$<COMPILE_LANGUAGE:C>:${ENF_WARNINGS_C}>"
                                           "$<$<COMPILE_LANGUAGE:CXX>:${ENF_WARNINGS_CXX}>")
  target_compile_definitions(${target} PRIVATE _POSIX_C_SOURCE=200809L ENF_VERSION="${PROJECT_VERSION}")
  if(ENF_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  foreach(switch ENF_ASSERTS ENF_VALIDATION ENF_NOSIMD)
    if(${switch})
      target_compile_definitions(${target} PRIVATE ${switch})
    endif()
  endforeach()
endfunction()

# Names the sources of a folder; every source file is relative to the project.
function(enf_glob result folder)
  set(patterns "")
  foreach(ending ${ARGN})
    list(APPEND patterns "${PROJECT_SOURCE_DIR}/${folder}/*.${ending}")
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(${result} ${sources} PARENT_SCOPE)
endfunction()
