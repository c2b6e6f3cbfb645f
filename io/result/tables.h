#pragma once
#include "io/bellhop/bellhop_files.h"
#include "io/hdf5/hdf5_file.h"
#include "raytrace/cases/earth_line.h"

// Arrivals and rays as HDF5 (docs/formats/arrivals.md, rays.md), but for the root's attributes.
namespace asdic::detail::result_tables {

/// \param earth  where their plane is
void write_arrivals(Hdf5File& file, const bellhop::ArrivalsFile& arrivals, const EarthLine& earth);
[[nodiscard]] bellhop::ArrivalsFile read_arrivals(const Hdf5File& file);

void write_rays(Hdf5File& file, const bellhop::RayFile& rays, const EarthLine& earth);
[[nodiscard]] bellhop::RayFile read_rays(const Hdf5File& file);

}  // namespace asdic::detail::result_tables
