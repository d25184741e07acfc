# What every target has in common: the language, the floating-point rules that keep the same bits everywhere, warnings.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# Not for WebAssembly, where it costs speed and nothing is loaded at run time.
if(NOT EMSCRIPTEN)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths relative to the tree, so that a clone elsewhere finds what this one compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()

add_library(pliant_options INTERFACE)
# A fused multiply-add rounds once where two operations round twice, so contraction would give other bits on other machines.
target_compile_options(pliant_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off;-fno-math-errno>)
target_compile_options(pliant_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Wno-sign-conversion;-Wno-psabi>)
# g++ 12 sees overlapping copies in "text" + std::string where there are none (its bug 105651).
target_compile_options(pliant_options INTERFACE
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-restrict>)
# Where pointers have 32 bits, clang warns of every 64-bit index into an array; an array that exists has no larger one.
target_compile_options(pliant_options INTERFACE
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:Clang>>:-Wno-shorten-64-to-32>)
if(PLIANT_WARNINGS_AS_ERRORS)
  target_compile_options(pliant_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()

# Several sources are compiled as one unit, so that the headers that they share are parsed and the templates instantiated once: a third of the
# time. File-local names have to differ within a folder. Without it (OFF) each source is a unit, as an editor's tools like it.
option(PLIANT_UNITY "Compile several sources of a folder as one unit" ON)

# pliant_unity(TARGET SIZE): compiles the sources of a target in units of so many.
function(pliant_unity target size)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${PLIANT_UNITY} UNITY_BUILD_BATCH_SIZE ${size})
endfunction()

# pliant_compile_fast(TARGET): for code that no step of a World runs: programs, readers and writers, tests. With less
# optimisation it compiles in two thirds of the time; reading and writing take as long as before
# (docs/internals/performance.md).
function(pliant_compile_fast target)
  target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)
endfunction()

# pliant_include_root(TARGET SCOPE FOLDER PREFIX): files that link TARGET may include FOLDER's headers as "PREFIX/name.h", and
# no other folder's: PREFIX is the only entry of a folder in the build tree that links to FOLDER. Linking a target is what makes
# its headers visible, so an include that skips the layers does not compile.
function(pliant_include_root target scope folder prefix)
  string(REPLACE "/" "_" name ${prefix})
  set(link ${PROJECT_BINARY_DIR}/roots/${name}/${prefix})
  get_filename_component(parent ${link} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${folder} ${link} SYMBOLIC)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/roots/${name}>)
endfunction()

# pliant_folder(NAME [DEPENDS targets...] [PREFIX path] [NOT_INSTALLED]): the .cpp files of this folder as the library pliant_NAME. It sees
# the public headers, its own, and those of the targets that it names. A folder without .cpp files becomes an interface library.
# PREFIX is what its headers are included by, NAME unless said.
function(pliant_folder name)
  cmake_parse_arguments(ARG "NOT_INSTALLED" "PREFIX" "DEPENDS;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(target pliant_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:pliant_options> ${ARG_PRIVATE})
    pliant_unity(${target} 8)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(pliant::${name} ALIAS ${target})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:include>)
  if(NOT ARG_PREFIX)
    set(ARG_PREFIX ${name})
  endif()
  pliant_include_root(${target} ${scope} ${CMAKE_CURRENT_SOURCE_DIR} ${ARG_PREFIX})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_link_libraries(${target} ${scope} ${ARG_DEPENDS})
  if(NOT ARG_NOT_INSTALLED)
    set_property(GLOBAL APPEND PROPERTY PLIANT_LIBRARIES ${target})
  endif()
endfunction()
