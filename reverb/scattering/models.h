#pragma once
#include <variant>

#include "reverb/scattering/chapman_harris.h"
#include "reverb/scattering/nrl_surface.h"
#include "reverb/scattering/ogden_erskine.h"

namespace asdic {

/// Every law of surface scattering. A new one is one file and one name here.
using AnySurfaceScattering = std::variant<NrlSurface, ChapmanHarris, OgdenErskine>;

}  // namespace asdic
