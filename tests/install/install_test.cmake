# Run by ctest: install, configure, build and run the outside project.
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} --install ${PLIANT_BUILD} --prefix ${WORK}/prefix --config ${CONFIGURATION})
must(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G ${GENERATOR}
  -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_BUILD_TYPE=${CONFIGURATION}
  -D CMAKE_CXX_COMPILER=${COMPILER} -D "CMAKE_CXX_FLAGS=${FLAGS}")
must(${CMAKE_COMMAND} --build ${WORK}/build --config ${CONFIGURATION})
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./hello_cloth)
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./save_and_load)
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./own_constraint)
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./run_time)
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./bodies)
must(${CMAKE_COMMAND} -E chdir ${WORK}/build ./game_loop)

file(READ ${WORK}/build/draped.ply draped)
if(NOT draped MATCHES "element vertex 1600")
  message(FATAL_ERROR "the outside project wrote no cloth of 1600 vertices")
endif()
# Nothing installed may point back to where it was built or written.
file(GLOB_RECURSE configuration ${WORK}/prefix/lib/*.cmake)
if(NOT configuration)
  message(FATAL_ERROR "no package configuration was installed")
endif()
foreach(file ${configuration})
  file(READ ${file} text)
  if(text MATCHES "${PLIANT_BUILD}/")
    message(FATAL_ERROR "${file} points into the build folder")
  endif()
endforeach()
if(COMMAND_BUILT)
  must(${WORK}/prefix/bin/pliant version)
endif()
# The second program is installed where it was built.
if(EXISTS ${PLIANT_BUILD}/bin/pliant-measure)
  must(${WORK}/prefix/bin/pliant bench --help)
endif()
