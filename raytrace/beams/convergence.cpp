#include "raytrace/beams/convergence.h"

#include <algorithm>
#include <cmath>

namespace asdic {

namespace {

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

ConvergedField converged_field(const PropagationCase& run_case, const FieldOfFan& field_of) {
  const BeamSettings& beams = run_case.beams;
  const bool circle = std::abs(beams.highest - beams.lowest - 2.0 * pi) < 1e-9;
  const int most = std::max(most_beams, beams.count | 1);
  int count = std::max(beams.count, first_count(run_case)) | 1;
  double last_change = 0.0;
  int last_count = 0;
  while (true) {
    // Every second of an odd number of beams has both ends; around a circle it takes an even number.
    FanField fan = field_of(even_fan(beams.lowest, beams.highest, circle ? count + 1 : count));
    const double change = level_difference_db(fan.half, fan.field, 0.95);
    // change ~ count^−p; what is left is the sum of all further halvings. p is 2 between smooth
    // neighbours, 1 or less where edges of ray families decide.
    double p = 1.0;
    if (last_count > 0 && change > 0.0)
      p = std::clamp(std::log(last_change / change) / std::log(double(count) / last_count), 0.5,
                     2.0);
    ConvergedField answer{.field = std::move(fan.field),
                          .beams = static_cast<std::size_t>(count),
                          .error_db = change / (std::exp2(p) - 1.0)};
    if (answer.error_db <= wanted_error_db) return answer;
    if (count >= most) {
      answer.note = "the field is not sure of its number of beams: " + std::to_string(count) +
                    " leave an error of about " + std::to_string(answer.error_db) +
                    " dB at 95 % of the receivers";
      return answer;
    }
    last_change = change;
    last_count = count;
    const double factor =
        std::clamp(std::pow(answer.error_db / wanted_error_db, 1.0 / p), 2.0, 4.0);
    count = std::min(static_cast<int>(factor * count) | 1, most);
  }
}

}  // namespace asdic
