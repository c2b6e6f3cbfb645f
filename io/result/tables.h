#pragma once
#include "io/bellhop/bellhop_files.h"
#include "io/hdf5/hdf5_file.h"

// Arrivals and rays as HDF5 (docs/formats/arrivals.md, rays.md), but for the root's attributes.
namespace asdic::detail::result_tables {

void write_arrivals(Hdf5File& file, const bellhop::ArrivalsFile& arrivals);
[[nodiscard]] bellhop::ArrivalsFile read_arrivals(const Hdf5File& file);

void write_rays(Hdf5File& file, const bellhop::RayFile& rays);
[[nodiscard]] bellhop::RayFile read_rays(const Hdf5File& file);

}  // namespace asdic::detail::result_tables
