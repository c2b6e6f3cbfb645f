#pragma once
#include <cmath>
#include <concepts>
#include <string_view>

#include "core/fields.h"
#include "core/units.h"
#include "core/validity.h"

namespace asdic::detail {

/// How sound comes to a scattering surface and leaves it.
struct ScatterGeometry {
  double grazing_in = 0.0;   ///< above the plane of the surface [rad], 0..π/2
  double grazing_out = 0.0;  ///< [rad], 0..π/2
  double azimuth = pi;       ///< change of horizontal direction [rad]: 0 forward, π backscatter
};

/// The same with sines and cosines, which paths have without asking for them.
struct ScatterSines {
  ScatterGeometry angles;
  double sin_in = 0.0, cos_in = 1.0;    ///< of grazing_in
  double sin_out = 0.0, cos_out = 1.0;  ///< of grazing_out
  double half_turn = 1.0;               ///< sin(azimuth/2)

  /// Q²/k² = cos²θᵢ + cos²θₛ − 2 cos θᵢ cos θₛ cos φ, by how much the horizontal part of the
  /// direction changes, squared. As (cos θᵢ − cos θₛ)² + 4 cos θᵢ cos θₛ sin²(φ/2) nothing cancels
  /// forward, nor near the horizon: cos θᵢ − cos θₛ = (sin²θₛ − sin²θᵢ)/(cos θᵢ + cos θₛ).
  [[nodiscard]] double across2() const noexcept {
    const double cosines = cos_in + cos_out;
    const double difference =
        cosines > 0.5 ? (sin_out - sin_in) * (sin_out + sin_in) / cosines : cos_in - cos_out;
    return difference * difference + 4.0 * cos_in * cos_out * half_turn * half_turn;
  }
};

[[nodiscard]] inline ScatterSines sines_of(const ScatterGeometry& g) noexcept {
  return {.angles = g,
          .sin_in = std::sin(g.grazing_in),
          .cos_in = std::cos(g.grazing_in),
          .sin_out = std::sin(g.grazing_out),
          .cos_out = std::cos(g.grazing_out),
          .half_turn = std::sin(0.5 * g.azimuth)};
}

/// The `at` of a law that is told by angles and has nothing to find once a frequency.
template <class Law>
struct LawByAngles {
  Law law;
  double frequency = 0.0;  ///< [Hz]
  [[nodiscard]] double operator()(const ScatterSines& g) const noexcept {
    return law.cross_section(g.angles, frequency);
  }
};

/// A scattering model: parameters, name and σ, the scattering cross-section per unit area and
/// steradian [1/sr] (10·log₁₀σ is the scattering strength in dB). `describe` shows every member to
/// a walker, and so gives the scenario reader, the HDF5 provenance, the keys of what is remembered
/// and the property tests what they need. cross_section must be reciprocal (in ↔ out) and finite,
/// and 0 (never log of 0) where the model says nothing scatters. `at(frequency)` is the same law
/// for many directions: what depends on the frequency alone is found once. One of the two is
/// written with the other. An empirical law also says where it holds: `static const Validity&
/// validity() noexcept`.
template <class Model>
concept ScatteringModel = Described<Model> &&
    requires(const Model& constant, const ScatterGeometry& geometry, const ScatterSines& sines,
             double frequency) {
  { Model::name } -> std::convertible_to<std::string_view>;
  { constant.cross_section(geometry, frequency) } -> std::same_as<double>;
  { constant.at(frequency)(sines) } -> std::same_as<double>;
};

/// A model of the sea surface also knows the sea above it, which `describe` shows as derived: the
/// environment gives it. cross_section is 0 without wind.
template <class Model>
concept SurfaceScatteringModel = ScatteringModel<Model> && requires(Model& model) {
  { model.wind_speed } -> std::same_as<double&>;   // at 10 m [m/s]
  { model.sound_speed } -> std::same_as<double&>;  // of the water at the surface [m/s]
};

}  // namespace asdic::detail
