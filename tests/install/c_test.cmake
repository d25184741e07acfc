# Part of install_test.cmake: a program in C by one line with pkg-config, as docs/guide/c.md says it, and by CMake.
file(GLOB_RECURSE pkg_config ${WORK}/prefix/*/pliant_c.pc)
get_filename_component(pkg_config "${pkg_config}" DIRECTORY)
get_filename_component(libraries "${pkg_config}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pkg_config})
set(ENV{LD_LIBRARY_PATH} ${libraries}:$ENV{LD_LIBRARY_PATH})
must(sh -c "cc -std=c99 -pedantic -Wall -Wextra -Werror -O2 ${FLAGS} drape.c $(pkg-config --cflags --libs pliant_c) -o ${WORK}/build/drape"
  WORKING_DIRECTORY ${CONSUMER})
must(./drape WORKING_DIRECTORY ${WORK}/build)
# The ball's lowest place is at 0.2 m, and the sheet, 0.4 m from its middle to its edge, hangs down beside it.
if(NOT output MATCHES "hangs down to 0.[345]")
  message(FATAL_ERROR "the program in C printed: ${output}")
endif()
if(NOT EXISTS ${WORK}/build/draped.glb)
  message(FATAL_ERROR "the program in C wrote no draped.glb")
endif()

must(${CMAKE_COMMAND} -S ${CONSUMER}/c -B ${WORK}/build_c -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${WORK}/prefix "-DCMAKE_C_FLAGS=${FLAGS}")
must(${CMAKE_COMMAND} --build ${WORK}/build_c)
must(./drape WORKING_DIRECTORY ${WORK}/build_c)

# The C library alone: a project in C finds it, one in C++ is told what else to install.
must(${CMAKE_COMMAND} --install ${PLIANT_BUILD} --component c --prefix ${WORK}/prefix_c --config ${CONFIGURATION})
must(${CMAKE_COMMAND} -S ${CONSUMER}/c -B ${WORK}/build_c_alone -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${WORK}/prefix_c
     "-DCMAKE_C_FLAGS=${FLAGS}")
must(${CMAKE_COMMAND} --build ${WORK}/build_c_alone)
must(./drape WORKING_DIRECTORY ${WORK}/build_c_alone)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build_alone -G ${GENERATOR}
                        -D CMAKE_PREFIX_PATH=${WORK}/prefix_c
  RESULT_VARIABLE status ERROR_VARIABLE errors OUTPUT_QUIET)
if(status EQUAL 0 OR NOT errors MATCHES "The C library alone was installed")
  message(FATAL_ERROR "a project in C++ was told where the C library alone is: ${errors}")
endif()
