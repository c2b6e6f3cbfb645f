#pragma once
#include <concepts>
#include <string_view>

#include "core/fields.h"
#include "core/units.h"

namespace asdic {

/// How sound comes to a scattering surface and leaves it.
struct ScatterGeometry {
  double grazing_in = 0.0;   ///< above the plane of the surface [rad], 0..π/2
  double grazing_out = 0.0;  ///< [rad], 0..π/2
  double azimuth = pi;       ///< change of horizontal direction [rad]: 0 forward, π backscatter
};

/// The same, where sines and cosines are known already.
struct ScatterSines {
  double sin_in = 0.0, cos_in = 1.0;    ///< of grazing_in
  double sin_out = 0.0, cos_out = 1.0;  ///< of grazing_out
  double half_turn = 1.0;               ///< sin(azimuth/2)
};

/// A scattering model: parameters, name and σ, the scattering cross-section per unit area and
/// steradian [1/sr] (10·log₁₀σ is the scattering strength in dB). `describe` shows every member to
/// a walker, and so gives the scenario reader, the HDF5 provenance, the keys of what is remembered
/// and the property tests what they need. cross_section must be reciprocal (in ↔ out) and finite,
/// and 0 (never log of 0) where the model says nothing scatters.
template <class Model>
concept ScatteringModel = Described<Model> &&
    requires(const Model& constant, const ScatterGeometry& geometry, double frequency) {
  { Model::name } -> std::convertible_to<std::string_view>;
  { constant.cross_section(geometry, frequency) } -> std::same_as<double>;
};

/// A model of the sea surface also knows the sea above it, which `describe` shows as derived: the
/// environment gives it. cross_section is 0 without wind.
template <class Model>
concept SurfaceScatteringModel = ScatteringModel<Model> && requires(Model& model) {
  { model.wind_speed } -> std::same_as<double&>;   // at 10 m [m/s]
  { model.sound_speed } -> std::same_as<double&>;  // of the water at the surface [m/s]
};

}  // namespace asdic
