#pragma once
#include "io/hdf5/hdf5_file.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Writes the group /environment of field, rays and arrivals files (docs/formats/field.md): the sea
/// as a picture needs it, sampled finely enough to be drawn. The scenario text has it exactly.
/// \param first_range, last_range  the segment that results cover [m]
void write_environment_group(Hdf5File& file, const Environment& ocean, double first_range,
                             double last_range);

}  // namespace asdic::detail
