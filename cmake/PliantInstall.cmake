# Install rules, and what find_package(pliant) finds: pliant::pliant, the core and the files, as static libraries; pliant::c. Only the
# public headers are installed; the folders' own libraries are there because a static library can't be merged portably.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The core and the files; what belongs to the programs of apps/ stays here.
get_property(folders GLOBAL PROPERTY PLIANT_LIBRARIES)
set(PLIANT_INSTALLED_LIBRARIES "")
foreach(library ${folders})
  get_target_property(folder ${library} SOURCE_DIR)
  if(folder MATCHES "^${PROJECT_SOURCE_DIR}/(src|io)")
    string(REGEX REPLACE "^pliant_" "" short_name ${library})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${short_name})
    list(APPEND PLIANT_INSTALLED_LIBRARIES ${library})
  endif()
endforeach()

# The one name that users link.
add_library(pliant_pliant INTERFACE)
target_link_libraries(pliant_pliant INTERFACE pliant_io pliant_api)
set_target_properties(pliant_pliant PROPERTIES EXPORT_NAME pliant)
add_library(pliant::pliant ALIAS pliant_pliant)

install(TARGETS ${PLIANT_INSTALLED_LIBRARIES} pliant_pliant EXPORT pliant-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(pliant_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
set(pliant_package ${PROJECT_BINARY_DIR}/pliant-config.cmake ${PROJECT_BINARY_DIR}/pliant-config-version.cmake)
# The C library, which needs none of the others: `cmake --install FOLDER --component c` installs it alone.
if(TARGET pliant_c)
  install(TARGETS pliant_c EXPORT pliant-c-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT c
          NAMELINK_COMPONENT c)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bindings/c/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT c)
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" up "${up}")
  configure_file(${PROJECT_SOURCE_DIR}/bindings/c/pliant_c.pc.in ${PROJECT_BINARY_DIR}/pliant_c.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pliant_c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT c)
  install(EXPORT pliant-c-targets NAMESPACE pliant:: DESTINATION ${pliant_package_folder} COMPONENT c)
  install(FILES ${pliant_package} DESTINATION ${pliant_package_folder} COMPONENT c)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/pliant DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET pliant_command)
  install(TARGETS pliant_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(TARGETS pliant_measure RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)  # where it was built
endif()

install(EXPORT pliant-targets NAMESPACE pliant:: DESTINATION ${pliant_package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/pliant-config.cmake.in
  ${PROJECT_BINARY_DIR}/pliant-config.cmake INSTALL_DESTINATION ${pliant_package_folder})
# Before 1.0 any minor version may break what was written for another.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pliant-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${pliant_package} DESTINATION ${pliant_package_folder})
