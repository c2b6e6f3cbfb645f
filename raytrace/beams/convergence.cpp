#include "raytrace/beams/convergence.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace asdic::detail {

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

/// The share of a sample that has to stay below a value for 95 % of all to do so, but for a chance
/// of 2 in 100: two standard errors of a share above. \param whole  the sample is all there is
double share_of_sample(std::size_t size, bool whole) noexcept {
  constexpr double of_all = 0.95;
  if (whole || size == 0) return of_all;
  return std::min(1.0, of_all + 2.0 * std::sqrt(of_all * (1.0 - of_all) / double(size)));
}

constexpr double not_counted = std::numeric_limits<double>::quiet_NaN();

/// Rows of receivers that have no limit, [first, last).
struct RowsLeftOut {
  std::size_t first = 0, last = 0;
};

RowsLeftOut rows_without_limit(const ReceiverGrid& grid, const LevelRays& level,
                               double source_depth) {
  RowsLeftOut rows;
  if (level.angle == 0.0 || grid.irregular) return rows;
  const auto row = [&](auto at) { return static_cast<std::size_t>(at - grid.depths.begin()); };
  rows.first =
      row(std::lower_bound(grid.depths.begin(), grid.depths.end(), source_depth - level.height));
  rows.last =
      row(std::upper_bound(grid.depths.begin(), grid.depths.end(), source_depth + level.height));
  if (rows.last - rows.first == grid.depths.size()) rows.last = rows.first;
  return rows;
}

/// Which receivers there is a field at: those in the water, but for rows left out. [rows × ranges]
std::vector<bool> receivers_with_field(const PropagationCase& run_case,
                                       const RowsLeftOut& left_out = {}) {
  constexpr double on_boundary = 1e-3;  // [m]
  const Environment& ocean = run_case.environment;
  const ReceiverGrid& grid = run_case.receivers;
  const std::size_t columns = grid.ranges.size();
  std::vector<bool> with_field(grid.size());
  for (std::size_t j = 0; j < columns; ++j) {
    const double surface = ocean.surface.depth_at(grid.ranges[j]) - on_boundary;
    const double floor = ocean.bottom.depth_at(grid.ranges[j]) + on_boundary;
    for (std::size_t k = 0; k < grid.rows(); ++k) {
      const double depth = grid.depths[grid.irregular ? j : k];
      with_field[k * columns + j] =
          depth >= surface && depth <= floor && (k < left_out.first || k >= left_out.last);
    }
  }
  return with_field;
}

/// A bound over the pressure (intensity if not coherent) that it is of, ∞ where there is none; NaN
/// of cells that do not count: where field and bound are below the floor, or that are not in
/// `with_field`. Of the columns looked at, as the bound. \param with_field  empty: all
std::vector<double> shares_of_bound(const std::vector<std::complex<double>>& field,
                                    std::size_t columns, const std::vector<double>& bound,
                                    const ColumnSample& looked_at, bool coherent,
                                    const std::vector<bool>& with_field = {}) {
  const double faintest = faintest_of(field);
  const std::size_t count = looked_at.count(columns);
  std::vector<double> shares(bound.size(), not_counted);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    const std::size_t receiver = i / count * columns + looked_at.column(i % count);
    const double p = std::abs(field[receiver]), x = coherent ? p : p * p;
    if (std::max(p, coherent ? bound[i] : std::sqrt(bound[i])) <= faintest ||
        (!with_field.empty() && !with_field[receiver]))
      continue;
    shares[i] = x > 0.0 ? bound[i] / x : infinity;
  }
  return shares;
}

/// Those that count.
std::vector<double> counted(const std::vector<double>& values) {
  std::vector<double> those;
  those.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(those),
               [](double x) { return !std::isnan(x); });
  return those;
}

/// |ΔTL| of two fields [dB]; NaN where both are below the floor of level_difference_db.
std::vector<double> level_differences(const std::vector<std::complex<double>>& a,
                                      const std::vector<std::complex<double>>& b) {
  const double floor = faintest_of(b);
  std::vector<double> differences(a.size(), not_counted);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = std::abs(a[i]), y = std::abs(b[i]);
    if (std::max(x, y) <= floor) continue;
    differences[i] =
        20.0 * std::abs(std::log10(std::max(x, 0.1 * floor) / std::max(y, 0.1 * floor)));
  }
  return differences;
}

/// |ΔTL| that a bound of this share of the field allows [dB], ∞ where it is as large.
double db_of_share(double share, bool coherent) noexcept {
  return share < 1.0 ? -(coherent ? 20.0 : 10.0) * std::log10(1.0 - share) : infinity;
}

/// The share that allows so much.
double share_of_db(double db, bool coherent) noexcept {
  return 1.0 - std::pow(10.0, -db / (coherent ? 20.0 : 10.0));
}

/// What a receiver of each column looked at is sure to, as ConvergedField::errors.
std::vector<float> receiver_errors(const std::vector<double>& shares, std::size_t columns,
                                   const ColumnSample& looked_at, std::size_t receivers,
                                   bool coherent) {
  std::vector<float> errors(receivers, std::numeric_limits<float>::quiet_NaN());
  const std::size_t count = looked_at.count(columns);
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (!std::isnan(shares[i]))
      errors[i / count * columns + looked_at.column(i % count)] =
          static_cast<float>(db_of_share(shares[i], coherent));
  return errors;
}

/// The bound is looked at in no fewer columns than these.
constexpr std::size_t fewest_columns = 40;

/// All of them where the sea varies with range: tubes are torn in single columns there, a fan that
/// is divided by some would suit these alone, and to follow rays costs more than their bound.
ColumnSample columns_looked_at(const PropagationCase& run_case) noexcept {
  if (varies_with_range(run_case.environment)) return {};
  return {.every = std::max<std::size_t>(1, run_case.receivers.ranges.size() / fewest_columns)};
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
         " mm of that depth and are not resolved; only there the field has no ray limit, and "
         "receivers there do not count in the error unless there are no others";
}

/// No tube is narrower at the last receiver than this [m]: depths of rays are right to 1e-9 m, and
/// beams as narrow as that would no longer share a receiver among them, but all reach it or none.
constexpr double finest_tube = 1e-5;

/// How many times as many beams to take next where the bound is `excess` times what is wanted. It
/// falls with the number or a little faster, in a fan divided where the error is (`graded`) faster
/// the more often it is divided: 2 times at most. An even fan grows 4 times where it is far off,
/// and where even so `most` beams will be too few, these are taken at once.
double growth(double excess, bool graded, std::size_t count, std::size_t most) noexcept {
  constexpr std::size_t enough_to_tell = 1000;
  const double to_most = static_cast<double>(most) / static_cast<double>(count);
  if (!graded && count >= enough_to_tell && excess > 4.0 * to_most) return to_most;
  return std::clamp(1.05 * excess, 1.25, !graded && excess > 8.0 ? 4.0 : 2.0);
}

constexpr const char* in_vain_text =
    "; the last two doublings of their number made it no surer, and no more were traced";

std::string unsure_note(const ConvergedField& answer, bool in_vain) {
  const std::string count = std::to_string(answer.beams);
  const std::string why = in_vain ? in_vain_text : "";
  if (!answer.bounded)
    return "the field is not sure of its number of beams: " + count + " leave an error of about " +
           decimals(answer.error_db) + " dB at 95 % of the receivers" + why;
  return count + " beams leave the field sure " + certainty_text(share_sure(answer.errors)) +
         (std::isfinite(answer.error_db)
              ? ", to " + decimals(answer.error_db) + " dB at 95 %"
              : std::string(", and less than 95 % of them to any number")) +
         why;
}

/// Until the bound is what is wanted.
ConvergedField bounded_field(const PropagationCase& run_case, const FieldOfFan& field_of,
                             const LevelRays& level_rays, double source_depth, bool circle,
                             std::size_t first, std::size_t most, FanProgress* progress) {
  const BeamSettings& beams = run_case.beams;
  const bool coherent = run_case.field == FieldKind::coherent;
  BeamFan fan = even_fan(beams.lowest, beams.highest, static_cast<int>(first));
  const ReceiverGrid& grid = run_case.receivers;
  const RowsLeftOut left_out = rows_without_limit(grid, level_rays, source_depth);
  const double wanted_share = share_of_db(wanted_bound_db, coherent);
  const double reach = std::max({std::abs(grid.ranges.front()), std::abs(grid.ranges.back()), 1.0});
  const FinestTubes finest{.width = finest_tube / reach, .level = level_rays.angle};
  const ColumnSample looked_at = columns_looked_at(run_case);
  const std::vector<bool> with_field = receivers_with_field(run_case, left_out);
  std::vector<double> level;
  DoublingsInVain doublings;
  std::size_t enough = most;  // as far as the last fan tells
  while (true) {
    const std::size_t count = fan.elevation.size();
    if (progress != nullptr) progress->begin(count, enough);
    // Displaced rays have other slopes than their q tells.
    FanField pass = field_of(fan, {.bound = true,
                                   .between = !run_case.beams.displacement,
                                   .looked_at = looked_at,
                                   .level = level,
                                   .first_left_out = left_out.first,
                                   .last_left_out = left_out.last});
    const std::vector<double> shares = shares_of_bound(pass.field, grid.ranges.size(), pass.bound,
                                                       looked_at, coherent, with_field);
    std::vector<double> that_count = counted(shares);
    const double share =
        quantile(that_count, share_of_sample(that_count.size(), looked_at.every == 1));
    ConvergedField answer{.field = std::move(pass.field),
                          .beams = count,
                          .error_db = db_of_share(share, coherent),
                          .bounded = true};
    const bool in_vain = doublings.add(count, shares, wanted_share);
    if (answer.error_db <= wanted_bound_db || count >= most || in_vain) {
      answer.errors = receiver_errors(shares, grid.ranges.size(), looked_at, grid.size(), coherent);
      if (answer.error_db > wanted_bound_db) answer.note = unsure_note(answer, in_vain);
      return answer;
    }
    level = column_levels(answer.field, run_case.receivers.ranges.size(), coherent);
    const bool graded = beams.kind == BeamKind::hat && !circle;
    const double factor = growth(share / wanted_share, graded, count, most);
    enough = static_cast<std::size_t>(
        std::min(share / wanted_share * static_cast<double>(count), static_cast<double>(most)));
    auto next = static_cast<std::size_t>(factor * static_cast<double>(count));
    if (1.1 * static_cast<double>(next) > static_cast<double>(most)) next = most;
    if (graded) fan = graded_fan(fan, pass.tube_share, next, finest);
    if (fan.elevation.size() <= count)  // Gaussians, or no tube that stands out
      fan = even_fan(beams.lowest, beams.highest, static_cast<int>(std::max(next, count + 1)));
  }
}

/// How far a field is from that of infinitely many beams, by its changes from fan to fan.
class ChangeOfFans {
 public:
  /// Of two fields, one of twice as many beams as the other. They differ by count^−p; what is left
  /// is the sum of all further halvings. p is 2 between smooth neighbours, 1 or less where edges of
  /// ray families decide. \param count  beams of the denser fan
  void add(const std::vector<std::complex<double>>& coarse,
           const std::vector<std::complex<double>>& dense, std::size_t count) {
    differences_ = level_differences(coarse, dense);
    std::vector<double> that_count = counted(differences_);
    const double change = quantile(that_count, 0.95);
    if (count_ > 0 && change > 0.0)
      order_ = std::clamp(
          std::log(change_ / change) / std::log(double(count) / static_cast<double>(count_)), 0.5,
          2.0);
    change_ = change;
    count_ = count;
  }
  [[nodiscard]] double error_db() const noexcept { return change_ * left(); }
  [[nodiscard]] double order() const noexcept { return order_; }
  /// Of each receiver: ConvergedField::errors. \param with_field  [receivers]
  [[nodiscard]] std::vector<float> errors(const std::vector<bool>& with_field) const {
    std::vector<float> errors(differences_.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (with_field[i]) errors[i] = static_cast<float>(differences_[i] * left());
    return errors;
  }
  /// Whether more beams are in vain: the changes themselves shrink no more.
  [[nodiscard]] bool in_vain() { return doublings_.add(count_, differences_, wanted_error_db); }

 private:
  /// What all further halvings leave of the last change.
  [[nodiscard]] double left() const noexcept { return 1.0 / (std::exp2(order_) - 1.0); }

  std::vector<double> differences_;
  DoublingsInVain doublings_;
  double change_ = 0.0, order_ = 1.0;
  std::size_t count_ = 0;
};

/// Until a fan is as good as every second beam of it.
ConvergedField field_of_even_fans(const PropagationCase& run_case, const FieldOfFan& field_of,
                                  bool circle, int count, int most, FanProgress* progress) {
  const BeamSettings& beams = run_case.beams;
  ChangeOfFans change;
  double enough = most;
  while (true) {
    if (progress != nullptr)
      progress->begin(static_cast<std::size_t>(count), static_cast<std::size_t>(enough));
    // Every second of an odd number of beams has both ends; around a circle it takes an even
    // number.
    FanField fan =
        field_of(even_fan(beams.lowest, beams.highest, circle ? count + 1 : count), {.half = true});
    change.add(fan.half, fan.field, static_cast<std::size_t>(count));
    ConvergedField answer{.field = std::move(fan.field),
                          .beams = static_cast<std::size_t>(count),
                          .error_db = change.error_db()};
    const bool in_vain = change.in_vain();
    if (answer.error_db <= wanted_error_db || count >= most || in_vain) {
      answer.errors = change.errors(receivers_with_field(run_case));
      if (answer.error_db > wanted_error_db) answer.note = unsure_note(answer, in_vain);
      return answer;
    }
    const double factor = std::pow(answer.error_db / wanted_error_db, 1.0 / change.order());
    enough = std::min<double>(factor * count, most);
    count = std::min(static_cast<int>(std::clamp(factor, 2.0, 4.0) * count) | 1, most);
  }
}

/// Whether a beam is what it is whatever the others' number, but for the angle that it stands for:
/// the sum of a fan is then a part of the sum of one twice as dense.
bool nested(const PropagationCase& run_case) noexcept {
  const BeamSettings& beams = run_case.beams;
  return run_case.field == FieldKind::coherent &&
         (beams.kind == BeamKind::cerveny_cartesian ||
          beams.kind == BeamKind::cerveny_ray_centred) &&
         beams.cerveny.value_or(CervenyBeams{}).width != CervenyBeams::Width::space_filling;
}

/// The same of such beams: the angles between are added, and no ray is traced twice.
ConvergedField field_of_nested_fans(const PropagationCase& run_case, const FieldOfFan& field_of,
                                    int count, int most, FanProgress* progress) {
  const BeamSettings& beams = run_case.beams;
  BeamFan fan = even_fan(beams.lowest, beams.highest, count);
  const auto begin = [&](const BeamFan& next, double enough) {
    if (progress != nullptr)
      progress->begin(next.elevation.size(), static_cast<std::size_t>(enough));
  };
  begin(fan, 0.5 * most);  // the last beams traced are half of all
  ConvergedField answer{.field = field_of(fan, {}).field};
  ChangeOfFans change;
  double enough = most;
  while (true) {
    const BeamFan between = fan_between(fan);
    begin(between, 0.5 * enough);
    std::vector<std::complex<double>> denser = field_of(between, {}).field;
    for (std::size_t i = 0; i < denser.size(); ++i) denser[i] += 0.5 * answer.field[i];
    fan = even_fan(beams.lowest, beams.highest,
                   static_cast<int>(fan.elevation.size() + between.elevation.size()));
    answer.beams = fan.elevation.size();
    change.add(answer.field, denser, answer.beams);
    answer.field = std::move(denser);
    answer.error_db = change.error_db();
    const bool last = 2 * answer.beams > static_cast<std::size_t>(most) + 1;
    const bool in_vain = change.in_vain();
    if (answer.error_db <= wanted_error_db || last || in_vain) {
      answer.errors = change.errors(receivers_with_field(run_case));
      if (answer.error_db > wanted_error_db) answer.note = unsure_note(answer, in_vain);
      return answer;
    }
    enough = std::min<double>(std::pow(answer.error_db / wanted_error_db, 1.0 / change.order()) *
                                  static_cast<double>(answer.beams),
                              most);
  }
}

}  // namespace

double bound_db(const std::vector<std::complex<double>>& field, const std::vector<double>& bound,
                bool coherent, double share) {
  std::vector<double> shares = counted(shares_of_bound(field, field.size(), bound, {}, coherent));
  return db_of_share(quantile(shares, share), coherent);
}

double level_difference_db(const std::vector<std::complex<double>>& a,
                           const std::vector<std::complex<double>>& b, double share) {
  std::vector<double> differences = counted(level_differences(a, b));
  return quantile(differences, share);
}

bool DoublingsInVain::add(std::size_t beams, const std::vector<double>& errors, double sure) {
  if (beams < 2 * beams_) return false;
  std::vector<double> that_count = counted(errors);
  const auto share_of = [&](auto&& which) {
    return static_cast<double>(std::count_if(that_count.begin(), that_count.end(), which)) /
           std::max(1.0, static_cast<double>(that_count.size()));
  };
  const Certainty now{.sure = share_of([&](double error) { return error <= sure; }),
                      .unbounded = share_of([](double error) { return error >= 1.0; }),
                      .median = quantile(that_count, 0.5)};
  const bool helped = now.sure >= before_.sure + 0.005 ||
                      now.unbounded < 0.98 * before_.unbounded ||
                      now.median < 0.95 * before_.median;
  in_vain_ = helped || beams_ == 0 ? 0 : in_vain_ + 1;
  before_ = now;
  beams_ = beams;
  return in_vain_ >= 2;
}

bool has_error_bound(const PropagationCase& run_case) noexcept {
  const BeamKind kind = run_case.beams.kind;
  return !run_case.receivers.irregular && (kind == BeamKind::hat || kind == BeamKind::gaussian);
}

ConvergedField converged_field(const PropagationCase& run_case, const FieldOfFan& field_of,
                               const LevelRays& level, double source_depth, FanProgress* progress) {
  const BeamSettings& beams = run_case.beams;
  const bool circle = std::abs(beams.highest - beams.lowest - 2.0 * pi) < 1e-9;
  const int most = std::max(most_beams, beams.count | 1);
  int count = std::max(beams.count, first_count(run_case)) | 1;
  if (has_error_bound(run_case)) {
    ConvergedField answer =
        bounded_field(run_case, field_of, level, source_depth, circle,
                      static_cast<std::size_t>(count), static_cast<std::size_t>(most), progress);
    const std::string note = note_of(level, source_depth);
    if (!note.empty()) answer.note = answer.note.empty() ? note : note + "; " + answer.note;
    return answer;
  }
  return nested(run_case)
             ? field_of_nested_fans(run_case, field_of, circle ? count + 1 : count, most, progress)
             : field_of_even_fans(run_case, field_of, circle, count, most, progress);
}

}  // namespace asdic::detail
