#pragma once
#include "raytrace/ocean/absorption.h"
#include "raytrace/ocean/boundary.h"
#include "raytrace/ocean/sound_speed.h"

namespace asdic {

/// A boundary of the water: where it is and what is behind it. Flat for now; a slope will be a
/// shape beside `depth`.
struct Boundary {
  double depth = 0.0;  ///< [m], positive down
  BoundaryMaterial material = Vacuum{};
};

/// The ocean as sound sees it. Immutable while anything is traced through it.
struct Environment {
  SoundSpeedProfile water = SoundSpeedProfile::isovelocity(1500.0);
  double water_density = 1027.0;  ///< [kg/m³]
  Boundary surface = {.depth = 0.0, .material = Vacuum{}};
  Boundary bottom = {.depth = 5000.0, .material = Rigid{}};
  Absorption absorption = NoAbsorption{};
};

}  // namespace asdic
