# Debian packages, a component each: scripts/packages.sh. What they depend on is found when they are made (packages/depends.cmake).
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME asdic)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 0asdic1)  # a package of Debian itself goes first
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(ASDIC_MAINTAINER "the asdic developers <asdic@example.org>" CACHE STRING "Whom packages name: who distributes them")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${ASDIC_MAINTAINER}")
set(CPACK_PACKAGE_CONTACT "${ASDIC_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_COMPONENTS_ALL program library development)
set(library_package libasdic${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(this_version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")

# asdic_package(<component> <package> <what it is, below 80 letters> <more>): its name and description, its copyright and changelogs.
function(asdic_package component package brief more)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${brief}\n${more}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${brief}\n${more}" PARENT_SCOPE)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/packages/copyright DESTINATION ${doc} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(CODE "set(asdic_doc \"${doc}\")\nset(asdic_source \"${PROJECT_SOURCE_DIR}\")\nset(asdic_version ${this_version})\nset(asdic_maintainer \"${ASDIC_MAINTAINER}\")"
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/packages/changelogs.cmake COMPONENT ${component} EXCLUDE_FROM_ALL)
  # notices of the headers that are compiled in: Debian's, of the machine that compiles
  foreach(compiled IN ITEMS libeigen3-dev libcli11-dev librandom123-dev libasio-dev nlohmann-json3-dev pybind11-dev)
    if(EXISTS /usr/share/doc/${compiled}/copyright AND NOT component STREQUAL development
       AND (NOT compiled STREQUAL pybind11-dev OR component STREQUAL python))
      install(FILES /usr/share/doc/${compiled}/copyright DESTINATION ${doc}/compiled-in RENAME ${compiled}.txt
              COMPONENT ${component} EXCLUDE_FROM_ALL)
    endif()
  endforeach()
endfunction()

asdic_package(program asdic "simulator of active sonars in a real ocean"
"A ping goes out, sound refracts, strikes surface, bottom and targets, and
comes back to every phone: asdic makes the calibrated pressure of each, with
the truth behind it, as HDF5. It traces its own rays, computes fields and
eigenrays, reads BELLHOP's cases, processes pings, and runs Monte Carlo
studies. One program serves every x86-64 processor from 2008 on.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3, python3-numpy, python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packages/program/postinst;${PROJECT_SOURCE_DIR}/cmake/packages/program/prerm")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "asdic-mpi, python3-asdic, ferret-datasets")
if(ASDIC_HAS_GDAL)
  string(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ", ${ASDIC_GDAL_PACKAGE}")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "${ASDIC_GDAL_PACKAGE}")
endif()

asdic_package(library ${library_package} "simulator of active sonars - shared library"
"What the program asdic does, for programs in C++: scenarios, eigenrays,
fields, pings, processing and studies.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packages/triggers;${PROJECT_BINARY_DIR}/shlibs")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/shlibs
     CONTENT "libasdic ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library_package} (>= ${PROJECT_VERSION})\n")

asdic_package(development libasdic-dev "simulator of active sonars - headers and CMake package"
"For programs in C++ that include <asdic/asdic.h> and find asdic by CMake's
find_package(asdic).")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} (= ${this_version})")

if(TARGET asdic_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  asdic_package(mpi asdic-mpi "simulator of active sonars - studies by MPI"
"One Monte Carlo study by all ranks of an MPI job. Its file is that of the
program asdic, bit for bit.")
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS "openmpi-bin")
  set(CPACK_DEBIAN_MPI_PACKAGE_SUGGESTS "asdic")
endif()

if(TARGET asdic_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  asdic_package(python python3-asdic "simulator of active sonars - Python package"
"For notebooks and programs in Python: import asdic does what the program
does, in the types of NumPy, pandas and xarray.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  string(JOIN ", " CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${library_package} (= ${this_version})"
         "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})" "python3 (<< ${Python_VERSION_MAJOR}.${next_minor})"
         python3-numpy python3-pandas python3-xarray)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-h5py, python3-h5netcdf, python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "asdic, jupyter-notebook")
  # its byte code, as Debian's packages of Python have it
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packages/python/postinst;${PROJECT_SOURCE_DIR}/cmake/packages/python/prerm")
endif()

# What each file needs of the system; the program's lazily loaded libraries are those of libasdic.so.
foreach(component program library mpi python)
  set(target_of_program asdic_app asdic)
  set(target_of_library asdic)
  set(target_of_mpi asdic_mpi)
  set(target_of_python asdic_python)
  foreach(target IN LISTS target_of_${component})
    if(TARGET ${target})
      string(APPEND elf_files "list(APPEND elf_${component} \"$<TARGET_FILE:${target}>\")\n")
    endif()
  endforeach()
endforeach()
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/package_depends.cmake
     CONTENT "${elf_files}include(\"${PROJECT_SOURCE_DIR}/cmake/packages/depends.cmake\")\n")
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/package_depends.cmake)
include(CPack)
