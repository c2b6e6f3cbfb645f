#include "raytrace/beams/convergence.h"

#include <algorithm>
#include <cmath>

namespace asdic {

namespace {

constexpr double wanted_error_db = 0.1;
constexpr int most_beams = 400'000;

/// Where doubling starts: neighbouring rays at the last receiver no further apart than keeps a
/// straight front between them within a sixteenth of a wavelength of a spherical one.
int first_count(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  const double reach = std::max({std::abs(grid.ranges.front()), std::abs(grid.ranges.back()), 1.0});
  const double wavelength = 1500.0 / run_case.frequency;
  const double spacing = std::sqrt(wavelength / (2.0 * reach));  // (RΔα)²/(8R) = λ/16
  const double count = (run_case.beams.highest - run_case.beams.lowest) / spacing;
  return std::clamp(static_cast<int>(count) + 1, 128, 20'000);
}

}  // namespace

double level_difference_db(const std::vector<std::complex<double>>& a,
                           const std::vector<std::complex<double>>& b, double share) {
  double strongest = 0.0;
  for (const auto& p : b) strongest = std::max(strongest, std::abs(p));
  const double floor = std::min(1e-5, 1e-3 * strongest);
  std::vector<double> difference;
  difference.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = std::abs(a[i]), y = std::abs(b[i]);
    if (std::max(x, y) <= floor) continue;
    difference.push_back(20.0 *
                         std::abs(std::log10(std::max(x, 0.1 * floor) / std::max(y, 0.1 * floor))));
  }
  if (difference.empty()) return 0.0;
  const auto at = difference.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(difference.size() - 1));
  std::nth_element(difference.begin(), at, difference.end());
  return *at;
}

ConvergedField fixed_field(const BeamFan& fan, const FieldOfFan& field_of) {
  return {.field = field_of(fan), .beams = fan.elevation.size()};
}

ConvergedField converged_field(const PropagationCase& run_case, double /*source_depth*/,
                               const FieldOfFan& field_of) {
  const BeamSettings& beams = run_case.beams;
  int count = std::max({beams.count, first_count(run_case), 2});
  ConvergedField answer{.field = field_of(even_fan(beams.lowest, beams.highest, count)),
                        .beams = static_cast<std::size_t>(count)};
  double last_change = 0.0;
  while (true) {
    count = 2 * count - 1;
    std::vector<std::complex<double>> finer =
        field_of(even_fan(beams.lowest, beams.highest, count));
    const double change = level_difference_db(answer.field, finer, 0.95);
    // Changes shrink by 2 (edges of ray families) to 4 (between smooth neighbours) per doubling;
    // what is left is their geometric sum.
    const double ratio =
        last_change > 0.0 ? std::clamp(last_change / std::max(change, 1e-12), 1.5, 4.0) : 2.0;
    last_change = change;
    answer = {.field = std::move(finer),
              .beams = static_cast<std::size_t>(count),
              .error_db = change / (ratio - 1.0)};
    if (answer.error_db <= wanted_error_db) return answer;
    if (2 * count > most_beams) break;
  }
  answer.note = "the field still changes with the number of beams";
  return answer;
}

}  // namespace asdic
