#pragma once
#include <complex>

#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// Plane-wave reflection coefficient of any number of fluid and elastic layers, e^{+iωt}.
///
/// From the half space up: in every layer the amplitudes of the waves that go up are ℛ times those
/// that go down (a number in a fluid, 2 × 2 of compressional and shear waves in a solid). Through a
/// layer ℛ → PℛP with P = diag(e^{−iωqh}), q the vertical slowness, |P| ≤ 1: nothing grows,
/// however thick the layer or evanescent the wave, and without thickness nothing changes. At an
/// interface the vertical displacement and the normal stress are continuous, the shear stress too,
/// which is zero in a fluid, and between solids the horizontal displacement: a system of two to
/// four equations. Kennett, Seismic Wave Propagation in Stratified Media (1983), ch. 6.
/// \param grazing  0..π/2 [rad]
[[nodiscard]] std::complex<double> layered_reflection(const LayeredFloor& floor, double grazing,
                                                      const WaterAtBoundary& water) noexcept;
/// The same of a wave whose angle is complex. \param cosine  of it
[[nodiscard]] std::complex<double> layered_reflection(const LayeredFloor& floor,
                                                      const std::complex<double>& cosine,
                                                      const WaterAtBoundary& water) noexcept;

}  // namespace asdic::detail
