#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "sonar/noise/interference.h"

// Private to Interference.
namespace asdic::detail {

/// Samples are numbered from the scenario's start in a stream, else from the record's.
struct Interference::Clock {
  std::int64_t first = 0, samples = 0, node = 64;  // node spacing
  double zero = 0.0;                               // time of sample 0 [s]
  double carrier_zero = 0.0;                       // on the carrier's clock [s]
  double rate = 1.0;

  [[nodiscard]] double time(std::int64_t sample) const {
    return zero + static_cast<double>(sample) / rate;
  }
};

/// One path between two nodes: everything straight in time.
struct Interference::Segment {
  std::int64_t begin = 0;  // sample of its first node
  std::array<double, 2> delay{}, length{};
  std::array<std::complex<double>, 2> amplitude{};
  std::array<std::vector<std::complex<double>>, 2> band;  // across it
  std::array<Vec3, 2> moveout{};
  double shift = 0.0;  // of its frequencies, by the sea's motion [Hz]
};

/// Of a grid: to the lower.
[[nodiscard]] inline std::int64_t floor_div(std::int64_t a, std::int64_t b) noexcept {
  return (a >= 0 ? a : a - b + 1) / b;
}

/// Samples over which phases are stepped.
inline constexpr std::int64_t interference_chunk = 64;

}  // namespace asdic::detail
