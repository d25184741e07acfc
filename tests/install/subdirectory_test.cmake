# Run by ctest: configures a project with Pliant as its subdirectory, and builds of it what takes seconds.
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK} -G ${GENERATOR} -D PLIANT_SOURCE=${PLIANT_SOURCE}
  -D CMAKE_BUILD_TYPE=${CONFIGURATION} -D CMAKE_CXX_COMPILER=${COMPILER} -D "CMAKE_CXX_FLAGS=${FLAGS}")
must(${CMAKE_COMMAND} --build ${WORK} --config ${CONFIGURATION} --target hello_objects pliant_core)
