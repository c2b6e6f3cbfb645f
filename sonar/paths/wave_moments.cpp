#include "sonar/paths/wave_moments.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr std::size_t moments_of_segment = 4;  // as in delay_curve.cpp
constexpr std::array<double, moments_of_segment> shares_of_segment{0.0, 0.25, 0.75,
                                                                   1.0};  // (1 − cos kπ/3)/2
constexpr int most_wave_halvings = 6;

using WaveSegment = std::array<PulseMoment, moments_of_segment>;

/// When the cubic through a segment says that a moment is received [s].
double foretold_arrival(const WaveSegment& segment, double sent) {
  double sum = 0.0;
  for (std::size_t k = 0; k < moments_of_segment; ++k) {
    double weight = 1.0;
    for (std::size_t other = 0; other < moments_of_segment; ++other)
      if (other != k)
        weight *= (sent - segment[other].sent) / (segment[k].sent - segment[other].sent);
    sum += weight * segment[k].received;
  }
  return sum;
}

/// \return false if the path is lost on the way
bool add_wave_segment(const MovingPath& path, const WaveSegment& segment, int halvings,
                      std::vector<PulseMoment>& moments) {
  const double begin = segment.front().sent, end = segment.back().sent,
               tolerance = negligible_phase / (2.0 * pi * path.frequency);
  const auto middle = path.moment(0.5 * (begin + end));
  if (!middle) return false;
  const double off = std::abs(middle->received - foretold_arrival(segment, middle->sent));
  if (off <= tolerance || halvings == 0) {
    moments.insert(moments.end(), segment.begin(), segment.end());
    return true;
  }
  const auto between = [&](const PulseMoment& first, const PulseMoment& last) {
    std::optional<WaveSegment> half = WaveSegment{first, first, last, last};
    for (const std::size_t k : {std::size_t(1), std::size_t(2)}) {
      const auto moment = path.moment(std::lerp(first.sent, last.sent, shares_of_segment[k]));
      if (!moment) return std::optional<WaveSegment>{};
      (*half)[k] = *moment;
    }
    return half;
  };
  const auto early = between(segment.front(), *middle), late = between(*middle, segment.back());
  return early && late && add_wave_segment(path, *early, halvings - 1, moments) &&
         add_wave_segment(path, *late, halvings - 1, moments);
}

}  // namespace

std::vector<PulseMoment> wave_moments(const MovingPath& path) {
  const std::vector<PulseMoment> known = pulse_moments(path);
  std::vector<PulseMoment> moments;
  for (std::size_t i = 0; i + moments_of_segment <= known.size(); i += moments_of_segment)
    if (!add_wave_segment(path, {known[i], known[i + 1], known[i + 2], known[i + 3]},
                          most_wave_halvings, moments))
      return {};
  return moments;
}

}  // namespace asdic::detail
