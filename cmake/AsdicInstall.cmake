# `cmake --install`, find_package(asdic) and the packages of a system (AsdicPackages.cmake). Components:
#   program      bin/asdic, the pictures' scripts, the scenarios, manual pages, completions, the guide
#   mpi          bin/asdic-mpi
#   library      libasdic.so.0.1
#   development  headers, libasdic.so, find_package(asdic)
#   python       `import asdic` (AsdicPython.cmake), not part of a plain `cmake --install`
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/asdic)
install(TARGETS asdic EXPORT asdicTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/asdic DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")
install(EXPORT asdicTargets NAMESPACE asdic:: DESTINATION ${config_dir} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/asdicConfig.cmake.in ${PROJECT_BINARY_DIR}/asdicConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/asdicConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/asdicConfig.cmake ${PROJECT_BINARY_DIR}/asdicConfigVersion.cmake
        DESTINATION ${config_dir} COMPONENT development)

# asdic_install_program(<target> <component>): the program, and what it writes about itself: manual pages and completions.
function(asdic_install_program target component)
  install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
  install(CODE "set(asdic_program \"$<TARGET_FILE:${target}>\")\nset(asdic_datadir \"${CMAKE_INSTALL_DATADIR}\")" COMPONENT ${component})
  install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/install_pages.cmake COMPONENT ${component})
endfunction()
asdic_install_program(asdic_app program)
if(TARGET asdic_mpi)
  asdic_install_program(asdic_mpi mpi)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/ DESTINATION ${CMAKE_INSTALL_DATADIR}/asdic/python COMPONENT program
        FILES_MATCHING PATTERN "*.py" PATTERN "*.js" PATTERN "*.css" PATTERN "*.html" PATTERN "binding" EXCLUDE PATTERN "asdic" EXCLUDE
        PATTERN "__pycache__" EXCLUDE)
# asdic-moos: a script beside the program, in the build tree as a link
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/asdic-moos ${PROJECT_BINARY_DIR}/bin/asdic-moos SYMBOLIC)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/python/asdic-moos DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
set(manual ${PROJECT_BINARY_DIR}/asdic-moos.1.gz)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/cmake/packages/asdic-moos.1 OUTPUT_FILE ${manual} COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_DATADIR}/man/man1 COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/ros DESTINATION ${CMAKE_INSTALL_DATADIR}/asdic COMPONENT program
        PATTERN "__pycache__" EXCLUDE
        PATTERN "scripts/*" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenarios/ DESTINATION ${CMAKE_INSTALL_DATADIR}/asdic/scenarios COMPONENT program)
# The pages, so that their links lead somewhere.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/asdic COMPONENT program
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/asdic COMPONENT program)
