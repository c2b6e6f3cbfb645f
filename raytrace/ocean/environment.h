#pragma once
#include <optional>
#include <vector>

#include "raytrace/ocean/absorption.h"
#include "raytrace/ocean/boundary.h"
#include "raytrace/ocean/boundary_shape.h"
#include "raytrace/ocean/depth_function.h"
#include "raytrace/ocean/roughness.h"
#include "raytrace/ocean/sound_speed.h"
#include "raytrace/ocean/sound_speed_section.h"

namespace asdic::detail {

/// A boundary of the water: where it is and what is behind it.
struct Boundary {
  double depth =
      0.0;  ///< of a flat boundary [m], positive down; with a shape: its depth at range 0
  BoundaryMaterial material = Vacuum{};
  std::optional<BoundaryShape> shape;  ///< where the boundary is not flat
  Roughness roughness = {};            ///< of all of it

  [[nodiscard]] double depth_at(double range) const noexcept {
    return shape ? shape->depth_at(range) : depth;
  }
  /// What lies behind the boundary at a range.
  [[nodiscard]] const BoundaryMaterial& material_at(double range) const noexcept;

  [[nodiscard]] bool operator==(const Boundary&) const = default;
};

/// What the sea is beside the plane, which decides how far apart the rays of a point source are
/// across it (raytrace/ocean/tube_amplitude.h). Where nothing varies with range both are the
/// same.
enum class Spreading {
  plane,        ///< the same across the transect: contours of depth and speed are straight lines
  cylindrical,  ///< the same all around the source, as BELLHOP has it
};

/// The vertical plane that sound crosses, as sound sees it: speed, boundaries and losses as
/// functions of range and depth. Immutable while anything is traced through it. Range 0 is where
/// the transect begins (the source, unless a run says otherwise); ranges below zero are the water
/// behind it.
struct Environment {
  SoundSpeedProfile water = SoundSpeedProfile::isovelocity(1500.0);
  std::optional<SoundSpeedSection> section;  ///< range-dependent water: rules instead of `water`,
                                             ///< which is then its profile at range 0
  DepthFunction water_density = 1027.0;      ///< [kg/m³]
  Boundary surface = {.depth = 0.0, .material = Vacuum{}};
  Boundary bottom = {.depth = 5000.0, .material = Rigid{}};
  Absorption absorption = NoAbsorption{};  ///< a law of frequency, the same at every depth
  std::vector<BiologicalLayer> biology;    ///< resonant absorption of layers of fish, added to it
  DepthFunction attenuation_db_per_km = 0.0;  ///< added to both: at the one frequency of interest
  Spreading spreading = Spreading::plane;     ///< of sea that varies with range

  [[nodiscard]] bool operator==(const Environment&) const = default;
};

/// Speed and its derivatives anywhere.
[[nodiscard]] SoundSpeed2D sound_speed(const Environment& environment, double range,
                                       double depth) noexcept;

/// All that the water takes out of a wave: absorption, biology and attenuation [Np/m] over depth.
[[nodiscard]] DepthFunction attenuation_np_per_m(const Environment& environment, double frequency);

/// Whether water or boundaries vary along the transect.
[[nodiscard]] bool varies_with_range(const Environment& environment) noexcept;

/// By which formula sound spreads across the plane: the cylinder's wherever it is right.
[[nodiscard]] Spreading spreading_across(const Environment& environment) noexcept;

/// Whether the layered solver applies: speed a function of depth, flat boundaries, losses the same
/// at every depth. Otherwise rays are marched.
[[nodiscard]] bool is_layered(const Environment& environment) noexcept;

}  // namespace asdic::detail
