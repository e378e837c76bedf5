# The rooms of engine/: one object library each, gathered into enf_core; engine/gl becomes enf_gl.

set(ENF_CORE_ROOMS base math geom simd kd map world dbv vis draw replay)

set(core_objects "")
foreach(room ${ENF_CORE_ROOMS})
  enf_glob(sources engine/${room} c)
  if(NOT sources)
    continue()
  endif()
  add_library(enf_room_${room} OBJECT ${sources})
  enf_flags(enf_room_${room})
  target_include_directories(enf_room_${room} PRIVATE ${PROJECT_SOURCE_DIR}/engine/include ${PROJECT_SOURCE_DIR}/engine)
  list(APPEND core_objects $<TARGET_OBJECTS:enf_room_${room}>)
endforeach()

# The files with AVX2 intrinsics are compiled for AVX2 and called only after the processor was asked. No -mfma: a
# fused multiply-add would change the bits.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND NOT ENF_NOSIMD)
  enf_glob(avx2_sources engine/simd c)
  list(FILTER avx2_sources INCLUDE REGEX "_avx2\\.c$")
  set_source_files_properties(${avx2_sources} PROPERTIES COMPILE_OPTIONS -mavx2)
endif()

if(core_objects)
  add_library(enf_core STATIC ${core_objects})
  add_library(enfilade::core ALIAS enf_core)
  set_target_properties(enf_core PROPERTIES EXPORT_NAME core LINKER_LANGUAGE C)
  target_include_directories(enf_core PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/engine/include>
                                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  # Public: the contracts of the inline functions in the headers hold only where the consumer does not fuse either.
  target_compile_options(enf_core PUBLIC ${ENF_EXACT_FLOAT})
  target_link_libraries(enf_core PUBLIC m)
endif()

enf_glob(gl_sources engine/gl c)
if(gl_sources AND TARGET enf_core AND NOT ENF_CORE_ONLY)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(EGL egl)
  pkg_check_modules(OSMESA osmesa)
  pkg_check_modules(GL gl)
  find_library(OSMESA_LIBRARY OSMesa)
  if(NOT GL_FOUND OR NOT (EGL_FOUND OR OSMESA_FOUND OR OSMESA_LIBRARY))
    message(FATAL_ERROR "engine/gl needs the headers of OpenGL and of EGL or OSMesa; tools/packages.txt names the "
                        "packages, -DENF_CORE_ONLY=ON builds without")
  endif()
  add_library(enf_gl STATIC ${gl_sources})
  add_library(enfilade::gl ALIAS enf_gl)
  enf_flags(enf_gl)
  target_include_directories(enf_gl PRIVATE ${PROJECT_SOURCE_DIR}/engine)
  target_include_directories(enf_gl SYSTEM PRIVATE ${EGL_INCLUDE_DIRS} ${OSMESA_INCLUDE_DIRS} ${GL_INCLUDE_DIRS})
  # The context libraries are opened at run time (EGL may be missing where OSMesa is there, and both define the gl
  # functions), so --as-needed drops those that nothing names.
  target_link_libraries(enf_gl PUBLIC enf_core PRIVATE ${CMAKE_DL_LIBS})
  target_compile_definitions(enf_gl PRIVATE $<$<BOOL:${EGL_FOUND}>:ENF_HAVE_EGL>
                                            $<$<OR:$<BOOL:${OSMESA_FOUND}>,$<BOOL:${OSMESA_LIBRARY}>>:ENF_HAVE_OSMESA>)
endif()
