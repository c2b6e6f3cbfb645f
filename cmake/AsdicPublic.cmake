# libasdic.so, asdic::asdic: the library for other people's programs. include/asdic declares what it shows; all else of it is hidden,
# so that a program that has its own HDF5, or another asdic, does not meet ours. It needs nothing of ours that is not installed.
file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/library/*.cpp")
add_library(asdic SHARED ${sources})
add_library(asdic::asdic ALIAS asdic)
set_target_properties(asdic PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
target_compile_features(asdic PUBLIC cxx_std_20)
target_include_directories(asdic PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                           PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(asdic PRIVATE asdic::study asdic_warnings asdic_build_options)
target_link_options(asdic PRIVATE LINKER:--exclude-libs,ALL)
