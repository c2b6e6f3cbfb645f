#pragma once
#include <limits>
#include <span>
#include <vector>

#include "processing/array_shape.h"
#include "processing/detector.h"
#include "processing/matched_filter.h"

namespace asdic::detail {

/// A probe in the detector's own cells: the beam that receives it best, the nearest filter and
/// sample.
struct PlacedProbe {
  std::size_t beam = 0, filter = 0, sample = 0;
  bool inside = false;  ///< of what is searched
  float power = 0.0F, background = 0.0F;
  float threshold = std::numeric_limits<float>::infinity();  ///< |y|²
};

/// \param doppler_cell  beyond the bank's last filter that one still answers so far
/// \param wavenumber    at the pulse's centre [rad/m]
[[nodiscard]] std::vector<PlacedProbe> place_probes(std::span<const Probe> probes,
                                                    const MatchedFilterBank& bank,
                                                    double doppler_cell, const BeamGrid& grid,
                                                    std::span<const Vec3> phones,
                                                    std::span<const double> weights,
                                                    double wavenumber);

}  // namespace asdic::detail
