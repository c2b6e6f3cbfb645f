# `cmake --install` and find_package(asdic): targets, headers under include/asdic, the dependencies' look-up, the pictures' script.
include(CMakePackageConfigHelpers)
get_property(folders GLOBAL PROPERTY ASDIC_LIBRARIES)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/asdic)
foreach(folder IN LISTS folders)
  install(TARGETS asdic_${folder} EXPORT asdicTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/asdic FILES_MATCHING PATTERN "*.h")
endforeach()
install(TARGETS asdic_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET asdic_mpi)
  install(TARGETS asdic_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS asdic_full RUNTIME DESTINATION libexec/asdic)  # found from bin/asdic as ../libexec/asdic
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/ DESTINATION ${CMAKE_INSTALL_DATADIR}/asdic/python FILES_MATCHING PATTERN "*.py")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenarios/ DESTINATION ${CMAKE_INSTALL_DATADIR}/asdic/scenarios)
install(EXPORT asdicTargets NAMESPACE asdic:: DESTINATION ${config_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/asdicConfig.cmake.in ${PROJECT_BINARY_DIR}/asdicConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/asdicConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/asdicConfig.cmake ${PROJECT_BINARY_DIR}/asdicConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/AsdicDependencies.cmake DESTINATION ${config_dir})
