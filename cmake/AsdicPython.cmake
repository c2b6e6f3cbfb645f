# The Python package asdic: python/asdic and its extension _core, which is made of the public library alone (python/binding).
# In the build tree it lies in python/ (PYTHONPATH=build/release/python); `pip install --no-build-isolation .` installs it.
option(ASDIC_PYTHON_PACKAGE "Build the Python package if pybind11 is found" ON)
set(ASDIC_PACKAGE_PYTHON /usr/bin/python3 CACHE FILEPATH "The Python that the package is built for")
if(ASDIC_PYTHON_PACKAGE AND NOT ASDIC_SANITIZE)
  set(Python_EXECUTABLE ${ASDIC_PACKAGE_PYTHON})
  find_package(Python 3.11 COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 CONFIG)
endif()
if(NOT (ASDIC_PYTHON_PACKAGE AND Python_Development.Module_FOUND AND pybind11_FOUND))
  message(STATUS "No Python package: ${ASDIC_PACKAGE_PYTHON} or pybind11 (Debian: pybind11-dev python3-dev) was not found")
  return()
endif()

file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/binding/*.cpp")
pybind11_add_module(asdic_python MODULE ${sources})
set_target_properties(asdic_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/asdic
                      UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
target_link_libraries(asdic_python PRIVATE asdic::asdic asdic_warnings asdic_build_options)
target_compile_options(asdic_python PRIVATE -Wno-shadow)  # pybind11 2.10's own headers
set(ASDIC_PYTHON_HERE ${PROJECT_BINARY_DIR}/python)

file(MAKE_DIRECTORY ${ASDIC_PYTHON_HERE}/asdic)
# The sources beside the extension, as links: what is edited is what is run.
file(GLOB modules CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/asdic/*.py" "${PROJECT_SOURCE_DIR}/python/asdic/*.pyi"
     "${PROJECT_SOURCE_DIR}/python/asdic/py.typed")
foreach(module IN LISTS modules)
  get_filename_component(name ${module} NAME)
  file(CREATE_LINK ${module} ${ASDIC_PYTHON_HERE}/asdic/${name} SYMBOLIC)
endforeach()
foreach(package asdic_pictures asdic_page)
  if(EXISTS ${PROJECT_SOURCE_DIR}/python/${package})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/${package} ${ASDIC_PYTHON_HERE}/${package} SYMBOLIC)
  endif()
endforeach()

# pip needs the library alone.
if(SKBUILD)
  set_target_properties(asdic_app asdic_commands asdic_serve PROPERTIES EXCLUDE_FROM_ALL ON)
endif()

# A system's package (component `python`): beside libasdic.so of the system.
set(ASDIC_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the system's Python looks for packages, below the prefix")
install(TARGETS asdic_python LIBRARY DESTINATION ${ASDIC_PYTHON_DIR}/asdic COMPONENT python EXCLUDE_FROM_ALL)
install(FILES ${modules} DESTINATION ${ASDIC_PYTHON_DIR}/asdic COMPONENT python EXCLUDE_FROM_ALL)

foreach(package asdic_pictures asdic_page)
  if(EXISTS ${PROJECT_SOURCE_DIR}/python/${package})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/${package} DESTINATION ${ASDIC_PYTHON_DIR} COMPONENT python EXCLUDE_FROM_ALL
            FILES_MATCHING PATTERN "*.py" PATTERN "*.js" PATTERN "*.css" PATTERN "*.html" PATTERN "__pycache__" EXCLUDE)
  endif()
endforeach()

# pip's: with the library beside the extension. (In the build tree it lies in lib/.)
set_target_properties(asdic_python PROPERTIES INSTALL_RPATH "$ORIGIN;$ORIGIN/../../lib")
install(TARGETS asdic asdic_python LIBRARY DESTINATION python/asdic NAMELINK_SKIP COMPONENT wheel EXCLUDE_FROM_ALL)
add_custom_target(install_wheel COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --component wheel
                  DEPENDS asdic asdic_python VERBATIM)
