# Run by ctest. Takes the header and the scene out of the page itself, so that the page can't go stale.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# extract(LANGUAGE FILE): writes the next code block of that language in the section to FILE, without its indentation.
function(extract language file)
  string(FIND "${section}" "```${language}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "the page has no further ${language} block")
  endif()
  string(SUBSTRING "${section}" ${begin} -1 rest)
  string(REGEX REPLACE "^```${language}\n" "" rest "${rest}")
  string(FIND "${rest}" "```" end)
  string(SUBSTRING "${rest}" 0 ${end} text)
  string(REGEX REPLACE "\n   " "\n" text "\n${text}")
  file(WRITE ${file} "${text}")
  string(SUBSTRING "${rest}" ${end} -1 rest)
  set(section "${rest}" PARENT_SCOPE)
endfunction()

file(READ ${SOURCE}/docs/internals/architecture.md page)
string(FIND "${page}" "### Adding a constraint" begin)
string(SUBSTRING "${page}" ${begin} -1 section)

set(tree ${WORK}/tree)
file(REMOVE_RECURSE ${WORK})
foreach(entry CMakeLists.txt cmake include src io apps scenes bench tests)
  file(COPY ${SOURCE}/${entry} DESTINATION ${tree})
endforeach()

# One header, one line (and its include), one scene.
extract(cpp ${tree}/src/constraints/triangle_area.h)
extract(json ${tree}/scenes/triangle_area.json)
extract(cpp ${tree}/src/constraints/bead.h)
extract(json ${tree}/scenes/bead.json)
# add_type FILE LIST TYPE HEADER: the line in a list of types, and the include.
function(add_type file list type header)
  file(READ ${tree}/src/constraints/${file} text)
  string(REPLACE "#pragma once\n" "#pragma once\n\n#include \"constraints/${header}\"\n" text "${text}")
  string(REGEX REPLACE "(using ${list} =[ \n]*TypeList<[^>]*)>" "\\1, ${type}>" text "${text}")
  if(NOT text MATCHES ", ${type}>")
    message(FATAL_ERROR "${file} no longer looks as the page says")
  endif()
  file(WRITE ${tree}/src/constraints/${file} "${text}")
endfunction()
add_type(in_lanes.h LaneConstraints TriangleArea triangle_area.h)
add_type(all.h StencilConstraints Bead bead.h)

# Warnings are errors as in the presets: what the new type does not touch then comes out of the compiler's cache.
must(${CMAKE_COMMAND} -S ${tree} -B ${tree}/build/newcomer -G ${GENERATOR} -D CMAKE_BUILD_TYPE=${CONFIGURATION}
  -D CMAKE_CXX_COMPILER=${COMPILER} -D PLIANT_CUDA=OFF -D PLIANT_WARNINGS_AS_ERRORS=ON -D PLIANT_LEVELS=native
  -D PLIANT_BUILD_C=OFF)
must(${CMAKE_COMMAND} --build ${tree}/build/newcomer --target pliant_command test_constraints test_stencils)

# The scene runs, and the area holds: the weight has not fallen.
must(${tree}/build/newcomer/bin/pliant run ${tree}/scenes/triangle_area.json --quiet --report ${WORK}/report.json)
file(READ ${WORK}/report.json report)
string(JSON count GET "${report}" constraints triangle_area)
string(JSON largest GET "${report}" residual triangle_area largest)
if(NOT count EQUAL 1 OR largest GREATER 0.001)
  message(FATAL_ERROR "the area does not hold: ${report}")
endif()

# The bead of the second type is on its rod, further down than it was.
must(${tree}/build/newcomer/bin/pliant run ${tree}/scenes/bead.json --quiet --report ${WORK}/report.json)
file(READ ${WORK}/report.json report)
string(JSON count GET "${report}" constraints bead)
string(JSON largest GET "${report}" residual bead largest)
if(NOT count EQUAL 1 OR largest GREATER 0.001)
  message(FATAL_ERROR "the bead is off its rod: ${report}")
endif()

# The typed tests took the type up and it passes them.
must(${tree}/build/newcomer/tests/test_constraints --gtest_list_tests)
if(NOT output MATCHES "triangle_area")
  message(FATAL_ERROR "no typed test runs over the new type:\n${output}")
endif()
must(${tree}/build/newcomer/tests/test_constraints)
must(${tree}/build/newcomer/tests/test_stencils --gtest_list_tests)
if(NOT output MATCHES "bead")
  message(FATAL_ERROR "no typed test runs over the type with a frame:\n${output}")
endif()
must(${tree}/build/newcomer/tests/test_stencils --gtest_filter=Stencil*)
