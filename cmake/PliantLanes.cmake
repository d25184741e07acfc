# The units in lanes: compiled once for each instruction set level that the build holds, all into one program, which picks one table of
# kernels at start (src/solver/kernels.h). src/math/levels.h declares all levels there are. A new level also needs
# its flags and its name below, a place in `known` and among the `names` and numbers of pliant_native_level, a test of
# the processor (src/math/runs_level.h) and the vectors that it has (src/math/isa.h).
set(PLIANT_LEVELS all CACHE STRING "Instruction set levels that the build holds: all, or a list of native (the best of this machine), v4, v3, \
v2 and generic; a program runs where one of them runs. The results have the same bits by any")
set(PLIANT_LEVEL_FLAGS_v4 -march=x86-64-v4 -mprefer-vector-width=512)
set(PLIANT_LEVEL_FLAGS_v3 -march=x86-64-v3)
set(PLIANT_LEVEL_FLAGS_v2 -march=x86-64-v2)
set(PLIANT_LEVEL_FLAGS_generic "")
set(PLIANT_LEVEL_NAME_v4 x86-64-v4)
set(PLIANT_LEVEL_NAME_v3 x86-64-v3)
set(PLIANT_LEVEL_NAME_v2 x86-64-v2)
set(PLIANT_LEVEL_NAME_generic generic)

# pliant_native_level(VARIABLE): the best level that this machine runs, asked of a program that is compiled and run.
function(pliant_native_level variable)
  if(NOT PLIANT_NATIVE_LEVEL)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/native_level.cpp)
    file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include "@PROJECT_SOURCE_DIR@/src/math/runs_level.h"
int main() { return pliant::runs_v4() ? 4 : pliant::runs_v3() ? 3 : pliant::runs_v2() ? 2 : 1; }
]])
    try_run(PLIANT_NATIVE_RUN PLIANT_NATIVE_COMPILED ${CMAKE_CURRENT_BINARY_DIR} ${source})
    if(NOT PLIANT_NATIVE_COMPILED OR NOT PLIANT_NATIVE_RUN MATCHES "^[1-4]$")
      message(FATAL_ERROR "the program that asks for this machine's level did not run; set PLIANT_LEVELS to v4, v3, v2 or generic")
    endif()
    set(names generic v2 v3 v4)
    math(EXPR place "${PLIANT_NATIVE_RUN} - 1")
    list(GET names ${place} name)
    set(PLIANT_NATIVE_LEVEL ${name} CACHE INTERNAL "the best instruction set level of this machine")
  endif()
  set(${variable} ${PLIANT_NATIVE_LEVEL} PARENT_SCOPE)
endfunction()

# pliant_choose_levels(VARIABLE): PLIANT_LEVELS as a list of levels, widest first.
function(pliant_choose_levels variable)
  set(known generic)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    set(known v4 v3 v2 generic)
  endif()
  set(wanted ${PLIANT_LEVELS})
  if(wanted STREQUAL "all" OR known STREQUAL "generic")
    set(wanted ${known})
  endif()
  set(chosen "")
  foreach(level ${wanted})
    if(level STREQUAL "native")
      pliant_native_level(level)
    endif()
    if(NOT level IN_LIST known)
      message(FATAL_ERROR "PLIANT_LEVELS holds '${level}'; use all, or a list of native, ${known}")
    endif()
    list(APPEND chosen ${level})
  endforeach()
  if(NOT chosen)
    message(FATAL_ERROR "PLIANT_LEVELS is empty; use all, or a list of native, ${known}")
  endif()
  set(in_order "")
  foreach(level ${known})
    if(level IN_LIST chosen)
      list(APPEND in_order ${level})
    endif()
  endforeach()
  set(${variable} ${in_order} PARENT_SCOPE)
endfunction()
pliant_choose_levels(PLIANT_COMPILED_LEVELS)
message(STATUS "Instruction set levels: ${PLIANT_COMPILED_LEVELS}")

# "levels/compiled.h": the levels for C++, in a folder of its own, because it alone differs between builds of different levels.
set(PLIANT_LEVEL_LINES "")
foreach(level ${PLIANT_COMPILED_LEVELS})
  string(APPEND PLIANT_LEVEL_LINES " \\\n  X(${level}, \"${PLIANT_LEVEL_NAME_${level}}\", __VA_ARGS__)")
endforeach()
list(GET PLIANT_COMPILED_LEVELS -1 PLIANT_BASE_LEVEL)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/roots/levels/levels/compiled.h @ONLY CONTENT [[
// Made by cmake/PliantLanes.cmake: the instruction set levels that this build holds, widest first, as PLIANT_FOR_EACH_LEVEL of
// math/levels.h names all there are.
#pragma once
#define PLIANT_FOR_EACH_COMPILED_LEVEL(X, ...)@PLIANT_LEVEL_LINES@
// The function of the narrowest of them, which runs wherever this build does: PLIANT_OF_BASE_LEVEL(name)().
#define PLIANT_OF_BASE_LEVEL(name) name##_@PLIANT_BASE_LEVEL@
]])

# Optimised in Debug too: else the inline functions that they call come out as code for AVX-512 under names that the whole
# program shares (tests/solver/lanes_symbols_test.cmake).
set(PLIANT_LANES_OPTIMISATION $<IF:$<CONFIG:Debug>,-O2,-O3>)
if(CMAKE_CXX_FLAGS MATCHES "sanitize")
  # Minutes instead of seconds to compile otherwise; the same formulas run under all checks in the sequential kernels.
  set(PLIANT_LANES_OPTIMISATION -O1 -g1 -fno-sanitize=undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    list(APPEND PLIANT_LANES_OPTIMISATION --param=asan-stack=0)  # all of its locals are arrays of fixed size
  endif()
endif()

# pliant_lanes(NAME SOURCES files... DEPENDS targets...): takes these sources out of pliant_NAME and compiles them once a level.
function(pliant_lanes name)
  cmake_parse_arguments(ARG "" "PREFIX" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_PREFIX)
    set(ARG_PREFIX ${name})
  endif()
  set(target pliant_${name})
  get_target_property(sources ${target} SOURCES)
  foreach(source ${ARG_SOURCES})
    list(REMOVE_ITEM sources ${source} ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  endforeach()
  set_property(TARGET ${target} PROPERTY SOURCES ${sources})
  foreach(level ${PLIANT_COMPILED_LEVELS})
    set(lanes ${target}_lanes_${level})
    add_library(${lanes} OBJECT ${ARG_SOURCES})
    target_link_libraries(${lanes} PRIVATE pliant_options ${ARG_DEPENDS})
    pliant_include_root(${lanes} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${ARG_PREFIX})
    target_compile_options(${lanes} PRIVATE ${PLIANT_LEVEL_FLAGS_${level}} ${PLIANT_LANES_OPTIMISATION})
    target_compile_definitions(${lanes} PRIVATE PLIANT_LEVEL=${level} PLIANT_LEVEL_IS_${level})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${lanes}>)
    set_property(GLOBAL APPEND PROPERTY PLIANT_LANES ${lanes})
  endforeach()
endfunction()
