#include "raytrace/bellhop_emulation/fan.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::bellhop_emulation {
namespace {

/// The number of degrees that somebody wrote: that of few digits beside an angle [rad], if there is
/// one.
double written_degrees(double angle) {
  const double exact = degrees(angle), few = std::round(exact * 1e9) / 1e9;
  return std::abs(exact - few) < 1e-12 ? few : exact;
}

}  // namespace
int automatic_beams(const PropagationCase& run_case, double depth) {
  if (run_case.task == Task::rays) return 50;
  const double range = run_case.receivers.ranges.back();
  const int by_wavelength = static_cast<int>(0.3 * range * run_case.frequency / 1500.0);
  const int by_shape = static_cast<int>(pi / std::atan(depth / (10.0 * range)));
  return std::max({by_wavelength, 300, by_shape});
}

double least_beams(const PropagationCase& run_case, double source_speed, double fan_width) {
  const double range = run_case.receivers.ranges.back();
  return 2.0 + fan_width / std::sqrt(source_speed / (6.0 * run_case.frequency * range));
}

LiteralFan make_fan(const PropagationCase& run_case, const BellhopEmulationOptions& options,
                    double depth) {
  const BeamSettings& beams = run_case.beams;
  LiteralFan fan;
  if (!beams.elevations.empty() && !options.beams) {
    for (const double up : beams.elevations) fan.declinations.push_back(-up);
    std::sort(fan.declinations.begin(), fan.declinations.end());
  } else {
    int n = options.beams.value_or(run_case.literal.beams);
    if (n <= 0) n = automatic_beams(run_case, depth);
    // In degrees and with one rounding, as the reference outputs were computed: on a node of the
    // water it is the last bit that tells whether a horizontal ray goes up or down.
    const double first = written_degrees(-beams.highest), last = written_degrees(-beams.lowest);
    const double spacing = n > 1 ? (last - first) / (n - 1) : 0.0;
    for (int i = 0; i < n; ++i) fan.declinations.push_back(radians(std::fma(i, spacing, first)));
  }
  const std::vector<double>& a = fan.declinations;
  fan.spacing = a.size() > 1 ? (a.back() - a.front()) / static_cast<double>(a.size() - 1) : 0.0;
  fan.last = a.size();
  if (run_case.literal.single_beam && *run_case.literal.single_beam >= 1) {
    fan.first = std::min(static_cast<std::size_t>(*run_case.literal.single_beam - 1), a.size());
    fan.last = std::min(fan.first + 1, a.size());
  }
  return fan;
}

double launch_amplitude(const PropagationCase& run_case, double source_depth, double source_speed,
                        double declination) {
  double amplitude = run_case.beams.pattern ? run_case.beams.pattern->at(-declination) : 1.0;
  if (run_case.task == Task::field && run_case.field == FieldKind::semi_coherent) {
    const double omega = 2.0 * pi * run_case.frequency;
    amplitude *= std::sqrt(2.0) *
                 std::abs(std::sin(omega / source_speed * source_depth * std::sin(declination)));
  }
  return amplitude;
}

}  // namespace asdic::detail::bellhop_emulation
