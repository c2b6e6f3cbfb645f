#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>
#include <vector>

#include "core/level_namespace.h"
#include "raytrace/beams/beam.h"
#include "raytrace/beams/column_sum.h"
#include "raytrace/beams/layered_crossings.h"
#include "raytrace/beams/rays_between.h"
#include "raytrace/beams/tube_error.h"
#include "raytrace/runs/field_run.h"

// The partial sums of a field: each adds rays of one fan, and a field is the sum of a few.
namespace asdic::detail {

/// One source and one fan, ready to be summed.
struct FieldWork {
  const PropagationCase& run_case;
  const RayTracer& tracer;
  double source_depth;
  const BeamFan& fan;
  const Progress& progress;
  BeamSetting setting;
  TraceLimits limits;
  const FieldCheck& also;
  std::vector<double> level;        // [columns looked at] of TubeError
  std::vector<double>& tube_share;  // [beams − 1]
  double* end_share;                // [2] of the first and the last ray
  const BoundaryRows& boundary_rows;
  const BoundaryRows& boundary_rows_looked_at;  // of those columns alone

  [[nodiscard]] BeamLaunch launch(std::size_t i, double source_speed) const {
    const double elevation = fan.elevation[i];
    BeamLaunch launch{elevation, launch_amplitude(run_case, source_depth, source_speed, elevation)};
    if (fan.graded) {
      launch.higher = fan.to_next(i), launch.lower = fan.to_next(i > 0 ? i - 1 : 0);
      // but for rounding, within a tube that was divided evenly
      if (std::abs(launch.higher - launch.lower) < 1e-9 * launch.higher)
        launch.lower = launch.higher;
    }
    return launch;
  }
};

/// Nothing yet at the receivers of a case.
[[nodiscard]] inline FieldSum empty_field(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  return {.ranges = grid.ranges,
          .depths = grid.depths,
          .irregular = grid.irregular,
          .sum = std::vector<std::complex<double>>(grid.size())};
}

/// Every kind of beam, receiver by receiver.
class PlainPart {
 public:
  PlainPart(const FieldWork& work, std::span<float> /*memory*/)
      : work_(work),
        setting_{work.setting, work.setting},
        field_{empty_field(work.run_case), {}},
        pairs_(work.boundary_rows, field_[0]) {
    setting_[1].spacing *= 2.0;
    if (work.also.half) field_[1] = field_[0];
  }
  [[nodiscard]] static std::size_t room(const FieldWork& /*work*/) noexcept { return 0; }
  [[nodiscard]] static std::size_t packet(const FieldWork& /*work*/) noexcept { return 16; }
  void add(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) add(i);
  }
  void add(std::size_t i) {
    const double elevation = work_.fan.elevation[i];
    work_.tracer.trace(0.0, work_.source_depth, elevation, work_.limits, ray_);
    const BeamLaunch launch = work_.launch(i, ray_.source_speed);
    add_to(0, launch);
    if (work_.also.half && i % 2 == 0) add_to(1, launch);
  }
  /// Adds what another part has.
  void absorb(const PlainPart& other) {
    for (std::size_t h = 0; h < 2; ++h)
      for (std::size_t n = 0; n < field_[h].sum.size(); ++n)
        field_[h].sum[n] += other.field_[h].sum[n];
  }
  /// Of the whole sum.
  void silence() {
    const BeamKind kind = work_.setting.kind;
    if (kind == BeamKind::cerveny_cartesian || kind == BeamKind::cerveny_ray_centred) return;
    for (std::size_t h = 0; h < (work_.also.half ? 2 : 1); ++h) pairs_.silence(field_[h]);
  }
  [[nodiscard]] std::complex<double> at(std::size_t column, std::size_t row, bool half) const {
    const FieldSum& field = field_[half ? 1 : 0];
    return field.sum[column * field.rows() + row];
  }

 private:
  void add_to(std::size_t h, const BeamLaunch& launch) {
    add_beam(setting_[h], launch, ray_, field_[h]);
    if (work_.boundary_rows.any()) pairs_.add(setting_[h], launch, ray_, field_[h]);
  }

  const FieldWork& work_;
  BeamSetting setting_[2];
  RayTrajectory ray_;
  FieldSum field_[2];
  BeamPairs pairs_;
};

inline namespace ASDIC_LEVEL {

/// Hat and Gaussian beams in Cartesian coordinates on a rectilinear grid.
class FastPart {
 public:
  FastPart(const FieldWork& work, std::span<float> memory, const LayeredCrossings* layered)
      : work_(work),
        layered_(layered),
        walls_(work.boundary_rows.any() ? &work.boundary_rows : nullptr) {
    const ReceiverGrid& grid = work.run_case.receivers;
    BeamSetting setting = work.setting;
    const std::size_t one = ColumnSum::room(grid.depths.size(), grid.ranges.size());
    sum_.emplace_back(setting, grid.depths, memory.first(one));
    setting.spacing *= 2.0;
    if (work.also.half) sum_.emplace_back(setting, grid.depths, memory.subspan(one));
    if (work.also.bound)
      tubes_.emplace(work.setting, grid.depths, work.also.looked_at.count(grid.ranges.size()),
                     work.also.first_left_out, work.also.last_left_out,
                     &work.boundary_rows_looked_at);
    if (work.also.between && layered == nullptr) between_.emplace(work.run_case);
  }
  /// Neighbouring rays that a part takes at once.
  [[nodiscard]] static std::size_t packet(const FieldWork& work, const LayeredCrossings* layered) {
    return work.also.between && layered == nullptr ? 64 : 16;
  }
  /// Numbers of memory for the sums.
  [[nodiscard]] static std::size_t room(const FieldWork& work) noexcept {
    const ReceiverGrid& grid = work.run_case.receivers;
    return ColumnSum::room(grid.depths.size(), grid.ranges.size()) * (work.also.half ? 2 : 1);
  }
  /// Rays [first, last), and the tubes above each of them.
  void add(std::size_t first, std::size_t last) {
    if (between_) return add_between(first, last);
    for (std::size_t i = first; i < last; ++i) add(i);
  }
  void finish() { tubes_->finish(); }
  /// Of the whole sum.
  void silence() {
    for (ColumnSum& sum : sum_)
      if (walls_ != nullptr) sum.silence(*walls_);
  }
  /// Adds what another part has, but for the bound.
  void absorb(const FastPart& other) {
    for (std::size_t h = 0; h < sum_.size(); ++h) sum_[h].absorb(other.sum_[h]);
  }
  /// \param column  of those looked at
  [[nodiscard]] double bound_at(std::size_t column, std::size_t row) const {
    return tubes_->at(column, row);
  }
  [[nodiscard]] std::complex<double> at(std::size_t column, std::size_t row, bool half) const {
    return sum_[half ? 1 : 0].at(column, row);
  }

 private:
  void add(std::size_t i) {
    if (work_.also.bound && i > 0) {
      if (last_ + 1 != i)
        cross(i - 1, before_);  // the packet's first: another part has that ray
      else
        std::swap(here_, before_);
    }
    const BeamLaunch launch = cross(i, here_);
    for (std::size_t h = 0; h < sum_.size(); ++h) {
      if (h == 1 && i % 2 != 0) continue;
      sum_[h].add(launch, crossings_, walls_);
    }
    if (work_.also.bound && i > 0)
      work_.tube_share[i - 1] = tubes_->add(before_, here_, work_.fan.to_next(i - 1), work_.level);
    if (work_.also.bound && (i == 0 || i + 1 == work_.fan.elevation.size()))
      (i == 0 ? work_.end_share[0] : work_.end_share[1]) =
          tubes_->add_end(here_, work_.fan.to_next(i), work_.level);
    last_ = i;
  }

  using Traced = RaysBetween::Traced;

  void trace(std::size_t i, Traced& ray) {
    ray.elevation = work_.fan.elevation[i];
    MarchedCrossings marched(work_.setting, ray.crossings);
    ray.crossings.source_speed =
        work_.tracer.trace_past(work_.run_case.receivers.ranges, 0.0, work_.source_depth,
                                ray.elevation, work_.limits, marched);
  }

  /// The same as add(), where most rays come from those around them.
  void add_between(std::size_t first, std::size_t last) {
    const std::size_t end =
        work_.also.bound ? std::min(last, work_.fan.elevation.size() - 1) : last - 1;
    last_ = last, previous_ = end + 1;
    trace(first, traced_[0]);
    put(first, traced_[0].crossings);
    if (end == first) return;
    trace(end, traced_[1]);
    fill(first, traced_[0], end, traced_[1], 2);
    put(end, traced_[1].crossings);
  }

  /// All rays between two, from below.
  void fill(std::size_t low, const Traced& lowest, std::size_t high, const Traced& highest,
            std::size_t depth) {
    if (high - low < 2) return;
    const std::size_t middle = low + (high - low) / 2;
    Traced& halfway = traced_[depth];
    trace(middle, halfway);
    constexpr std::size_t worth_it = 4;
    const double spacing = (highest.elevation - lowest.elevation) / static_cast<double>(high - low);
    if (high - low >= worth_it && between_->fit(lowest, halfway, highest, spacing)) {
      for (std::size_t i = low + 1; i < high; ++i) {
        if (i == middle) {
          put(i, halfway.crossings);
          continue;
        }
        between_->at(work_.fan.elevation[i], crossings_);
        put(i, crossings_);
      }
      return;
    }
    fill(low, lowest, middle, halfway, depth + 1);
    put(middle, halfway.crossings);
    fill(middle, halfway, high, highest, depth + 1);
  }

  /// A ray of add_between(), in order; ray last_ for its tube alone.
  void put(std::size_t i, const Crossings& crossings) {
    const BeamLaunch launch = work_.launch(i, crossings.source_speed);
    const std::size_t beams = work_.fan.elevation.size();
    if (i < last_)
      for (std::size_t h = 0; h < sum_.size(); ++h)
        if (h == 0 || i % 2 == 0) sum_[h].add(launch, crossings, walls_);
    if (!work_.also.bound) return;
    std::swap(here_, before_);
    look_at(crossings, launch, here_);
    if (previous_ + 1 == i)
      work_.tube_share[i - 1] = tubes_->add(before_, here_, work_.fan.to_next(i - 1), work_.level);
    if (i < last_ && (i == 0 || i + 1 == beams))
      (i == 0 ? work_.end_share[0] : work_.end_share[1]) =
          tubes_->add_end(here_, work_.fan.to_next(i), work_.level);
    previous_ = i;
  }

  /// Follows ray i to the columns, and to those looked at too if the bound is asked for.
  BeamLaunch cross(std::size_t i, RayAtColumns& looked_at) {
    const double elevation = work_.fan.elevation[i];
    if (layered_ == nullptr || !layered_->find(elevation, workspace_, crossings_)) {
      MarchedCrossings marched(work_.setting, crossings_);
      crossings_.source_speed =
          work_.tracer.trace_past(work_.run_case.receivers.ranges, 0.0, work_.source_depth,
                                  elevation, work_.limits, marched);
    }
    const BeamLaunch launch = work_.launch(i, crossings_.source_speed);
    if (work_.also.bound) look_at(crossings_, launch, looked_at);
    return launch;
  }

  void look_at(const Crossings& crossings, const BeamLaunch& launch, RayAtColumns& looked_at) {
    const ColumnSample& sample = work_.also.looked_at;
    pick_columns(crossings, sample.first(), sample.every, looked_at.crossings);
    looked_at.foretell(work_.setting, launch);
  }

  const FieldWork& work_;
  const LayeredCrossings* layered_;
  const BoundaryRows* walls_;
  LayeredCrossings::Workspace workspace_;
  Crossings crossings_;                              // of the ray in hand
  RayAtColumns here_, before_;                       // at the columns looked at
  std::size_t last_ = static_cast<std::size_t>(-2);  // ray of here_
  std::optional<RaysBetween> between_;
  std::size_t previous_ = 0;  // ray of here_, in add_between()
  std::array<RaysBetween::Traced, 9> traced_;
  std::vector<ColumnSum> sum_;
  std::optional<TubeError> tubes_;
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
