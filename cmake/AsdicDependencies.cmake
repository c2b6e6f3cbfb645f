# What is borrowed. All are Debian 12 packages (scripts/packages/). Those without a CMake package come by pkg-config or as headers.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(SQLite3 3.35 REQUIRED)

# asdic_pkg_config(<target> <module>...): an imported interface target out of pkg-config modules.
function(asdic_pkg_config target)
  string(REPLACE "::" "_" name ${target})
  pkg_check_modules(${name} REQUIRED IMPORTED_TARGET GLOBAL ${ARGN})
  add_library(${target} ALIAS PkgConfig::${name})
endfunction()

asdic_pkg_config(fftw3::fftw3 fftw3 fftw3f)
asdic_pkg_config(hdf5::hdf5 hdf5)
find_library(HDF5_HL_LIBRARY NAMES hdf5_hl hdf5_serial_hl HINTS ${hdf5_hdf5_LIBRARY_DIRS} REQUIRED)  # dimension scales
target_link_libraries(PkgConfig::hdf5_hdf5 INTERFACE ${HDF5_HL_LIBRARY})
asdic_pkg_config(netcdf::netcdf netcdf)
asdic_pkg_config(sndfile::sndfile sndfile)
asdic_pkg_config(muparser::muparser muparser)

find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
add_library(random123::random123 INTERFACE IMPORTED GLOBAL)
set_target_properties(random123::random123 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${RANDOM123_INCLUDE_DIR}")

find_path(ASIO_INCLUDE_DIR asio.hpp REQUIRED)
add_library(asio::asio INTERFACE IMPORTED GLOBAL)  # standalone: no Boost
# Whether Asio sees std::aligned_alloc depends on what was included before it: a block of malloc's came to operator delete.
set_target_properties(asio::asio PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${ASIO_INCLUDE_DIR}" INTERFACE_COMPILE_DEFINITIONS "ASIO_STANDALONE;ASIO_SEPARATE_COMPILATION;ASIO_DISABLE_STD_ALIGNED_ALLOC")
