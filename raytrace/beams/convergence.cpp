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

/// Where errors are smaller than 100 dB below 1 m, or 60 dB below the strongest, they do not count.
double faintest_of(const std::vector<std::complex<double>>& field) {
  double strongest = 0.0;
  for (const auto& p : field) strongest = std::max(strongest, std::abs(p));
  return std::min(1e-5, 1e-3 * strongest);
}

/// The value that a share of them stays below.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Rows of receivers that have no limit, [first, last).
struct RowsLeftOut {
  std::size_t first = 0, last = 0, columns = 1;
  [[nodiscard]] bool hold(std::size_t receiver) const noexcept {
    const std::size_t row = receiver / columns;
    return row >= first && row < last;
  }
};

RowsLeftOut rows_without_limit(const ReceiverGrid& grid, const LevelRays& level,
                               double source_depth) {
  RowsLeftOut rows{.columns = std::max<std::size_t>(grid.ranges.size(), 1)};
  if (level.angle == 0.0 || grid.irregular) return rows;
  const auto row = [&](auto at) { return static_cast<std::size_t>(at - grid.depths.begin()); };
  rows.first =
      row(std::lower_bound(grid.depths.begin(), grid.depths.end(), source_depth - level.height));
  rows.last =
      row(std::upper_bound(grid.depths.begin(), grid.depths.end(), source_depth + level.height));
  if (rows.last - rows.first == grid.depths.size()) rows.last = rows.first;
  return rows;
}

/// |ΔTL| that a bound allows [dB], ∞ where it is as large as the field; of the cells where field or
/// bound is above the floor.
std::vector<double> unsure_db(const std::vector<std::complex<double>>& field,
                              const std::vector<double>& bound, bool coherent,
                              const RowsLeftOut& rows = {}) {
  const double faintest = faintest_of(field), factor = coherent ? 20.0 : 10.0;
  std::vector<double> unsure;
  unsure.reserve(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double p = std::abs(field[i]), x = coherent ? p : p * p;
    if (std::max(p, coherent ? bound[i] : std::sqrt(bound[i])) <= faintest || rows.hold(i))
      continue;
    unsure.push_back(bound[i] < x ? -factor * std::log10(1.0 - bound[i] / x) : infinity);
  }
  return unsure;
}

/// Root mean square over depth (mean intensity if not coherent) of each column.
std::vector<double> column_levels(const std::vector<std::complex<double>>& field,
                                  std::size_t columns, bool coherent) {
  std::vector<double> level(columns);
  for (std::size_t i = 0; i < field.size(); ++i) level[i % columns] += std::norm(field[i]);
  const double rows = static_cast<double>(field.size()) / static_cast<double>(columns);
  for (double& l : level) l = coherent ? std::sqrt(l / rows) : l / rows;
  return level;
}

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::floor(100.0 * share))) + " %";
}

std::string decimals(double value, std::size_t places = 2) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 1 + places);
}

/// What the user should know of a source on a kink of least sound speed; nothing of another.
std::string note_of(const LevelRays& level, double source_depth) {
  if (level.angle == 0.0) return {};
  return "the source at " + decimals(source_depth) +
         " m is on a kink where the sound speed is least: rays within " +
         decimals(degrees(level.angle), 3) + " deg of the horizontal stay within " +
         decimals(1e3 * level.height, 1) +
         " mm of that depth and are not told apart; only there the field has no ray limit, and "
         "receivers there do not count in the error unless there are no others";
}

/// No tube is narrower at the last receiver than this [m]: depths of rays are right to 1e-9 m, and
/// beams as narrow as that would no longer share a receiver among them, but all reach it or none.
constexpr double finest_tube = 1e-5;

/// Until the bound is what is wanted.
ConvergedField bounded_field(const PropagationCase& run_case, const FieldOfFan& field_of,
                             const LevelRays& level_rays, double source_depth, bool circle,
                             std::size_t first, std::size_t most) {
  const BeamSettings& beams = run_case.beams;
  const bool coherent = run_case.field == FieldKind::coherent;
  BeamFan fan = even_fan(beams.lowest, beams.highest, static_cast<int>(first));
  const ReceiverGrid& grid = run_case.receivers;
  const RowsLeftOut left_out = rows_without_limit(grid, level_rays, source_depth);
  const double reach = std::max({std::abs(grid.ranges.front()), std::abs(grid.ranges.back()), 1.0});
  const FinestTubes finest{.width = finest_tube / reach, .level = level_rays.angle};
  std::vector<double> level;
  while (true) {
    const std::size_t count = fan.elevation.size();
    FanField pass = field_of(fan, {.bound = true,
                                   .level = level,
                                   .first_left_out = left_out.first,
                                   .last_left_out = left_out.last});
    std::vector<double> unsure = unsure_db(pass.field, pass.bound, coherent, left_out);
    ConvergedField answer{.field = std::move(pass.field),
                          .beams = count,
                          .error_db = quantile(unsure, 0.95),
                          .bounded = true};
    if (answer.error_db <= wanted_bound_db) return answer;
    if (count >= most) {
      const auto sure = std::count_if(unsure.begin(), unsure.end(),
                                      [](double db) { return db <= wanted_bound_db; });
      answer.note = std::to_string(count) + " beams leave the field sure to " +
                    decimals(wanted_bound_db) + " dB at " +
                    percent(static_cast<double>(sure) / static_cast<double>(unsure.size())) +
                    " of the receivers" +
                    (std::isfinite(answer.error_db)
                         ? ", to " + decimals(answer.error_db) + " dB at 95 %"
                         : std::string(", and less than 95 % of them to any number"));
      return answer;
    }
    level = column_levels(answer.field, run_case.receivers.ranges.size(), coherent);
    // The bound falls with the number or a little faster.
    const double factor = std::clamp(1.05 * answer.error_db / wanted_bound_db, 1.25, 2.0);
    const auto next = std::min(static_cast<std::size_t>(factor * static_cast<double>(count)), most);
    if (beams.kind == BeamKind::hat && !circle)
      fan = graded_fan(fan, pass.tube_share, next, finest);
    if (fan.elevation.size() <= count)  // Gaussians, or no tube that stands out
      fan = even_fan(beams.lowest, beams.highest, static_cast<int>(std::max(next, count + 1)));
  }
}

}  // namespace

double bound_db(const std::vector<std::complex<double>>& field, const std::vector<double>& bound,
                bool coherent, double share) {
  std::vector<double> unsure = unsure_db(field, bound, coherent);
  return quantile(unsure, share);
}

double level_difference_db(const std::vector<std::complex<double>>& a,
                           const std::vector<std::complex<double>>& b, double share) {
  const double floor = faintest_of(b);
  std::vector<double> difference;
  difference.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = std::abs(a[i]), y = std::abs(b[i]);
    if (std::max(x, y) <= floor) continue;
    difference.push_back(20.0 *
                         std::abs(std::log10(std::max(x, 0.1 * floor) / std::max(y, 0.1 * floor))));
  }
  return quantile(difference, share);
}

ConvergedField converged_field(const PropagationCase& run_case, const FieldOfFan& field_of,
                               const LevelRays& level, double source_depth) {
  const BeamSettings& beams = run_case.beams;
  const bool circle = std::abs(beams.highest - beams.lowest - 2.0 * pi) < 1e-9;
  const int most = std::max(most_beams, beams.count | 1);
  int count = std::max(beams.count, first_count(run_case)) | 1;
  if (has_error_bound(run_case)) {
    ConvergedField answer =
        bounded_field(run_case, field_of, level, source_depth, circle,
                      static_cast<std::size_t>(count), static_cast<std::size_t>(most));
    const std::string note = note_of(level, source_depth);
    if (!note.empty()) answer.note = answer.note.empty() ? note : note + "; " + answer.note;
    return answer;
  }
  double last_change = 0.0;
  int last_count = 0;
  while (true) {
    // Every second of an odd number of beams has both ends; around a circle it takes an even
    // number.
    FanField fan =
        field_of(even_fan(beams.lowest, beams.highest, circle ? count + 1 : count), {.half = true});
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
      answer.note =
          "the field is not sure of its number of beams: " + std::to_string(answer.beams) +
          " leave an error of about " + decimals(answer.error_db) + " dB at 95 % of the receivers";
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
