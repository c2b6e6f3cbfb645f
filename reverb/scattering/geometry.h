#pragma once
#include <concepts>
#include <string_view>

namespace asdic {

/// How sound comes to a scattering surface and leaves it.
struct ScatterGeometry {
  double grazing_in = 0.0;   ///< [rad] above the surface plane
  double grazing_out = 0.0;  ///< [rad]
  double azimuth =
      3.14159265358979323846;  ///< change of horizontal direction [rad]: 0 forward, π backscatter
};

/// The limits of a model's parameter, for checking and for the manual.
struct Range {
  double low;
  double high;
};

/// A scattering model: parameters, name and σ, the scattering cross-section per unit area and
/// steradian [1/sr] (10·log₁₀σ is the scattering strength in dB). `describe(field)` calls
/// field("key", value, Range{…}) for every parameter, and so gives the scenario reader, the HDF5
/// provenance, the manual's table and the property tests what they need. cross_section must be
/// reciprocal (in ↔ out) and finite, and 0 (never log of 0) where the model says nothing scatters.
template <class Model>
concept ScatteringModel = requires(const Model& model, const ScatterGeometry& geometry,
                                   double frequency) {
  { Model::name } -> std::convertible_to<std::string_view>;
  { model.cross_section(geometry, frequency) } -> std::same_as<double>;
};

}  // namespace asdic
