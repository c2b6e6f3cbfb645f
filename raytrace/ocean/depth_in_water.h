#pragma once
#include <string>

#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// A depth that somebody asked for [m], if it lies in the water at that range [m].
/// \param what  the argument that has it \throws InputError naming it
double depth_in_water(const Environment& environment, const std::string& what, double depth,
                      double range = 0.0);

}  // namespace asdic::detail
