# bin/asdic-mpi, where there is an MPI (Debian: libopenmpi-dev): a study by many processes. Nothing else of the project knows of MPI.
option(ASDIC_MPI "Build asdic-mpi if an MPI is found" ON)
if(ASDIC_MPI)
  set(MPI_CXX_SKIP_MPICXX TRUE)  # the C interface is enough
  find_package(MPI COMPONENTS CXX)
endif()
if(ASDIC_MPI AND MPI_CXX_FOUND)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/study/mpi/*.cpp" "${PROJECT_SOURCE_DIR}/app/mpi/*.cpp")
  add_executable(asdic_mpi ${sources})
  set_target_properties(asdic_mpi PROPERTIES OUTPUT_NAME asdic-mpi RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(asdic_mpi PRIVATE asdic_commands MPI::MPI_CXX asdic_warnings asdic_build_options)
  asdic_allocator(asdic_mpi)
endif()
