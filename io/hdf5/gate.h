#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

// What a file of HDF5 must not have if it is to be read.
namespace asdic::detail::hdf5 {

/// Looks at every link and dataset of an open file. None may lead to another file: no external or
/// user-defined link, no data in other files, no virtual dataset but in a catalogue of a study; and
/// no dataset may claim more bytes than a file of this size can hold, compressed or not.
/// \throws InputError naming the object
void check_contents(std::int64_t file, const std::filesystem::path& path);

/// The same for a file that is not open, if it is HDF5 at all.
void check_contents(const std::filesystem::path& path);

/// Of a virtual dataset (of others there is nothing to say): each of its sources must be an HDF5
/// file of a study, with data of its own, and together they must be able to hold what it claims.
/// Those that are not there are passed over. \throws InputError naming the source
void check_sources(std::int64_t dataset, const std::filesystem::path& path);

/// The files of whose rows a dataset with these properties is made, each once, in their order, as
/// they are named there; {} for one that holds its own.
[[nodiscard]] std::vector<std::filesystem::path> virtual_sources(std::int64_t properties,
                                                                 const std::filesystem::path& path);

}  // namespace asdic::detail::hdf5
