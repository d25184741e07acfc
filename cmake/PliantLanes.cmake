# The units in lanes: compiled once for each instruction set that the target machine may have, all into one program, which picks
# one table of kernels at start (src/solver/kernels.h). src/math/levels.h has the same list for C++: a level is a line in each.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(PLIANT_LEVELS v4 v3 v2 generic)
else()
  set(PLIANT_LEVELS generic)
endif()
set(PLIANT_LEVEL_FLAGS_v4 -march=x86-64-v4 -mprefer-vector-width=512)
set(PLIANT_LEVEL_FLAGS_v3 -march=x86-64-v3)
set(PLIANT_LEVEL_FLAGS_v2 -march=x86-64-v2)
set(PLIANT_LEVEL_FLAGS_generic "")

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
  foreach(level ${PLIANT_LEVELS})
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
