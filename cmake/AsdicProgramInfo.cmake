# What the program says about itself: its version, how it was built, the libraries it was built with, where what comes with it is.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}" flags)
set(build "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}, ")
string(APPEND build ""
  "$<JOIN:$<TARGET_PROPERTY:asdic_any_level_options,INTERFACE_COMPILE_OPTIONS>, > ${flags}")  # by name: options may hold commas
set(rasters "")
if(ASDIC_HAS_GDAL)
  set(rasters ", GDAL ${GDAL_VERSION}")
endif()
set_property(SOURCE io/ping/provenance.cpp APPEND PROPERTY COMPILE_DEFINITIONS
  ASDIC_VERSION="${PROJECT_VERSION}" ASDIC_BUILD="${build}"
  ASDIC_LIBRARIES="HDF5 ${hdf5_hdf5_VERSION}, FFTW ${fftw3_fftw3_fftw3_VERSION}, netCDF ${netcdf_netcdf_VERSION}${rasters}")
# A system's program knows nothing of the folder in which it was built.
set(source_dir "${PROJECT_SOURCE_DIR}")
if(ASDIC_SYSTEM_PACKAGE)
  set(source_dir "")
endif()
set_property(SOURCE app/shared_files.cpp APPEND PROPERTY COMPILE_DEFINITIONS ASDIC_SOURCE_DIR="${source_dir}")
