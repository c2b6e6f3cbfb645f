#include "raytrace/runs/field_run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/huge_pages.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/runs/checks.h"
#include "raytrace/runs/field_parts.h"
#include "raytrace/runs/image_field.h"
#include "raytrace/runs/path_field.h"
#include "raytrace/runs/rays_run.h"
#include "raytrace/runs/single_beam.h"
#include "raytrace/waves/wave_field.h"

namespace asdic::detail {

namespace {

/// Rays are dealt to this many partial sums, whatever the number of threads, and these are added in
/// order: so the same bits come out.
constexpr std::size_t most_parts = 16;
constexpr std::size_t most_partial_cells = 32'000'000;  // 0.5 GB

BeamSetting beam_setting(const PropagationCase& run_case, const BeamFan& fan) {
  return {.kind = run_case.beams.kind,
          .coherent = run_case.field == FieldKind::coherent,
          .point_source = run_case.beams.source == SourceKind::point,
          .spreading = spreading_across(run_case.environment),
          .frequency = run_case.frequency,
          .spacing = fan.spacing,
          .cerveny = run_case.beams.cerveny.value_or(CervenyBeams{}),
          .environment = &run_case.environment};
}

void check(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  if (grid.size() == 0) throw InputError({"receivers", "none", "at least one depth and one range"});
  if (grid.irregular && grid.depths.size() != grid.ranges.size())
    throw InputError({"receivers.depths", std::to_string(grid.depths.size()) + " depths",
                      "one for each of the " + std::to_string(grid.ranges.size()) + " ranges"});
  if (!(run_case.frequency > 0.0))
    throw InputError({"frequency", std::to_string(run_case.frequency) + " Hz", "above 0 Hz"});
  const BeamSettings& beams = run_case.beams;
  if (!beams.elevations.empty() && beams.elevations.size() < 2)
    throw InputError({"beams.elevations", "one elevation",
                      "two or more: a beam is as wide as the fan is dense"});
  if (beams.elevations.empty() && !(beams.highest > beams.lowest))
    throw InputError({"beams.highest", std::to_string(degrees(beams.highest)) + " deg",
                      "above the lowest, " + std::to_string(degrees(beams.lowest)) + " deg"});
  const Environment& ocean = run_case.environment;
  for (const double depth : run_case.source_depths)
    if (!(depth >= ocean.surface.depth_at(0.0) && depth <= ocean.bottom.depth_at(0.0)))
      throw InputError(
          {"source_depths", std::to_string(depth) + " m", "a depth between surface and bottom"});
}

}  // namespace

TraceLimits field_limits(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  const Environment& ocean = run_case.environment;
  const double nearest = grid.ranges.front(), farthest = grid.ranges.back();
  // Beams reach ahead of their ray and behind it: a ray goes on a little beyond the last receiver.
  const double margin = 1e-3 * std::abs(farthest) + 100.0 * 1500.0 / run_case.frequency;
  TraceLimits limits{.min_range = std::min(nearest, 0.0) - margin,
                     .max_range = std::max(farthest, 0.0) + margin,
                     .faintest = 1e-4};
  if (run_case.box_range > 0.0) {
    limits.max_range = std::min(limits.max_range, run_case.box_range);
    limits.min_range = std::max(limits.min_range, -run_case.box_range);
    // Where boundaries slope or the water changes with range, rays may come back.
    if (ocean.surface.shape || ocean.bottom.shape || ocean.section) {
      limits.max_range = run_case.box_range;
      limits.min_range = -run_case.box_range;
    }
  }
  limit_depth(run_case, limits);
  return limits;
}

namespace {

/// Memory without values for partial sums, all of which is written to: in huge pages where it fills
/// more than one. They are cut out of a little more, for what FftBuffer says of aligned_alloc.
class SumMemory {
 public:
  explicit SumMemory(std::size_t numbers) {
    constexpr std::size_t page = std::size_t{1} << 21U;
    const std::size_t pages = (numbers * sizeof(float) + page - 1) / page;
    std::size_t room = numbers * sizeof(float);
    if (pages > 1) room = (pages + 1) * page;
    memory_ = std::make_unique_for_overwrite<float[]>(room / sizeof(float));
    void* begin = memory_.get();
    if (pages > 1) prefer_huge_pages(std::align(page, pages * page, begin, room), pages * page);
    begin_ = static_cast<float*>(begin);
  }
  /// Numbers [first, first + count).
  [[nodiscard]] std::span<float> part(std::size_t first, std::size_t count) const noexcept {
    return {begin_ + first, count};
  }

 private:
  std::unique_ptr<float[]> memory_;
  float* begin_ = nullptr;
};

/// Sums the fan in `count` parts, which take turns at packets of neighbouring rays. Each is made
/// from `work`, room(work) numbers of memory and `more` by the thread that fills it, and has
/// add(first, last) for rays [first, last) and at(column, row, half).
template <class Part, class... More>
FanField sum_parts(const FieldWork& work, std::size_t count, const More&... more) {
  const std::size_t packet = Part::packet(work, more...);
  std::vector<std::optional<Part>> parts(count);
  // In one block: what a C library gives back to the system after each field, and gets again page
  // by page, goes by the largest block.
  const std::size_t room = Part::room(work);
  const SumMemory memory(count * room);
  const std::size_t beams = work.fan.elevation.size();
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel(parts.size(), [&](std::size_t p) {
    parts[p].emplace(work, memory.part(p * room, room), more...);
    for (std::size_t first = p * packet; first < beams && !stopped;
         first += parts.size() * packet) {
      const std::size_t last = std::min(first + packet, beams);
      parts[p]->add(first, last);
      const std::size_t n = done += last - first;
      if (work.progress && !work.progress(double(n) / double(beams))) stopped = true;
    }
  });
  if (stopped) throw Interrupted();
  const ReceiverGrid& grid = work.run_case.receivers;
  const std::size_t rows = grid.rows(), columns = grid.ranges.size();
  for (std::size_t p = 1; p < parts.size(); ++p) parts[0]->absorb(*parts[p]);
  parts[0]->silence();
  FanField result;
  const auto collect = [&](bool half, std::vector<std::complex<double>>& field) {
    field.resize(grid.size());
    // a few columns at a time, since the field has its ranges side by side
    constexpr std::size_t block = 8;
    in_parallel((columns + block - 1) / block, [&](std::size_t b) {
      const std::size_t from = b * block, to = std::min(from + block, columns);
      double scale[block];
      for (std::size_t j = from; j < to; ++j)
        scale[j - from] = field_scale(work.setting, grid.ranges[j]);
      for (std::size_t k = 0; k < rows; ++k)
        for (std::size_t j = from; j < to; ++j) {
          const std::complex<double> sum = parts[0]->at(j, k, half);
          field[k * columns + j] =
              scale[j - from] * (work.setting.coherent ? sum : std::sqrt(sum.real()));
        }
    });
  };
  collect(false, result.field);
  if (work.also.half) collect(true, result.half);
  if constexpr (requires(Part part) { part.bound_at(0, 0); }) {
    if (work.also.bound) {
      for (auto& part : parts) part->finish();
      const ColumnSample& sample = work.also.looked_at;
      const std::size_t looked_at = sample.count(columns);
      result.bound.resize(rows * looked_at);
      for (std::size_t j = 0; j < looked_at; ++j) {
        double scale = field_scale(work.setting, grid.ranges[sample.column(j)]);
        if (!work.setting.coherent) scale *= scale;
        for (std::size_t k = 0; k < rows; ++k) {
          double sum = 0.0;
          for (const auto& part : parts) sum += part->bound_at(j, k);
          result.bound[k * looked_at + j] = scale * sum;
        }
      }
    }
  }
  return result;
}

/// What the errors of tubes are held against: what is given, or the fan's power spread evenly over
/// the depths, Σ A²L/D with A² = 1/|q|, or 1/(r|q|) where field_scale leaves that to the crossings.
std::vector<double> tube_level(const PropagationCase& run_case, const BeamSetting& setting,
                               const FieldCheck& also) {
  const ReceiverGrid& grid = run_case.receivers;
  const bool by_crossings = setting.point_source && setting.spreading == Spreading::plane;
  const bool coherent = run_case.field == FieldKind::coherent;
  std::vector<double> level(also.bound ? also.looked_at.count(grid.ranges.size()) : 0);
  const double depth = std::max(1.0, grid.depths.back() - grid.depths.front());
  const double power = (run_case.beams.highest - run_case.beams.lowest) / depth;
  for (std::size_t j = 0; j < level.size(); ++j) {
    const std::size_t column = also.looked_at.column(j);
    const double here = by_crossings ? power / std::max(std::abs(grid.ranges[column]), 1.0) : power;
    level[j] = coherent ? std::sqrt(here) : here;
    if (also.level.empty()) continue;
    const double scale = field_scale(setting, grid.ranges[column]);
    if (scale > 0.0 && also.level[column] > 0.0)
      level[j] = also.level[column] / (coherent ? scale : scale * scale);
  }
  return level;
}

/// The columns that the bound is of, if these are not all of the grid.
std::optional<ReceiverGrid> grid_looked_at(const ReceiverGrid& grid, const FieldCheck& also) {
  if (!also.bound || also.looked_at.every == 1) return std::nullopt;
  ReceiverGrid fewer = grid;
  fewer.ranges.resize(also.looked_at.count(grid.ranges.size()));
  for (std::size_t j = 0; j < fewer.ranges.size(); ++j)
    fewer.ranges[j] = grid.ranges[also.looked_at.column(j)];
  return fewer;
}

}  // namespace

FanField field_of_fan(const PropagationCase& run_case, const RayTracer& tracer, double source_depth,
                      const BeamFan& fan, const Progress& progress, FieldMethod method,
                      const FieldCheck& also) {
  std::vector<double> tube_share(also.bound ? fan.elevation.size() - 1 : 0);
  double end_share[2] = {0.0, 0.0};
  const BoundaryRows boundary_rows(run_case.environment, run_case.frequency, run_case.receivers,
                                   run_case.field == FieldKind::coherent);
  const std::optional<ReceiverGrid> fewer = grid_looked_at(run_case.receivers, also);
  const std::optional<BoundaryRows> fewer_rows =
      fewer ? std::optional<BoundaryRows>(std::in_place, run_case.environment, run_case.frequency,
                                          *fewer, run_case.field == FieldKind::coherent)
            : std::nullopt;
  const BeamSetting setting = beam_setting(run_case, fan);
  const FieldWork work{run_case,
                       tracer,
                       source_depth,
                       fan,
                       progress,
                       setting,
                       field_limits(run_case),
                       also,
                       tube_level(run_case, setting, also),
                       tube_share,
                       end_share,
                       boundary_rows,
                       fewer_rows ? *fewer_rows : boundary_rows};
  const std::size_t cells = run_case.receivers.size();
  const bool fast = method == FieldMethod::fast && has_error_bound(run_case);
  // A packet of beams costs as much as a share of the grid: fewer parts for fewer beams.
  const std::size_t few =
      std::clamp<std::size_t>(fan.elevation.size() / (fast ? 1024 : 64), 1, most_parts);
  const std::size_t count = std::clamp<std::size_t>(most_partial_cells / cells, 1, few);
  if (!fast) return sum_parts<PlainPart>(work, count);
  std::optional<LayeredCrossings> layered;
  if (!run_case.beams.displacement)
    layered = LayeredCrossings::make(run_case.environment, run_case.frequency, source_depth,
                                     run_case.receivers.ranges, work.limits);
  FanField result = sum_parts<FastPart>(work, count, layered ? &*layered : nullptr);
  if (also.bound) tube_share.front() += end_share[0], tube_share.back() += end_share[1];
  result.tube_share = std::move(tube_share);
  return result;
}

namespace {

/// The field as a sum of images; none where the case's solver asks for waves, or images do not
/// apply. \param exact  with the automatic solver only if images are the wave equation's field
std::optional<ConvergedField> summed_images(const PropagationCase& run_case, double source_depth,
                                            const Progress& progress, bool exact) {
  if (run_case.solver == FieldSolver::waves) return std::nullopt;
  if (exact && run_case.solver == FieldSolver::automatic && !mirrors_exactly(run_case))
    return std::nullopt;
  return image_field(run_case, source_depth, progress);
}

}  // namespace

PropagationResult run_field(const PropagationCase& run_case, const Progress& progress) {
  check(run_case);
  const RayTracer tracer = tracer_of(run_case);
  const std::optional<SingleBeam> single = single_beam(run_case);
  PropagationResult result;
  result.field.reserve(run_case.source_depths.size() * run_case.receivers.size());
  const std::size_t sources = run_case.source_depths.size(), cells = run_case.receivers.size();
  constexpr float not_known = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < sources; ++i) {
    const double depth = run_case.source_depths[i];
    const Progress of_source = !progress ? Progress{} : [&](double share) {
      return progress((static_cast<double>(i) + share) / static_cast<double>(sources));
    };
    ConvergedField answer;
    std::string rays_alone;
    if (on_vacuum(run_case.environment, depth)) {
      answer = {.field = std::vector<std::complex<double>>(run_case.receivers.size()),
                .bounded = has_error_bound(run_case),
                .note = "the source at " + std::to_string(depth) +
                        " m is on a boundary with a vacuum, which reflects all it sends with the "
                        "opposite sign: there is no field, and no beam was traced"};
    } else if (single) {
      const BeamFan fan{.elevation = {single->elevation}, .spacing = single->spacing};
      answer = {.field = field_of_fan(run_case, tracer, depth, fan, of_source).field,
                .beams = 1,
                .note =
                    "one beam is wanted: the field is that beam's alone, as wide as its fan "
                    "makes it"};
    } else if (auto exact = summed_images(run_case, depth, of_source, true)) {
      answer = std::move(*exact);
    } else if (auto waves = wave_field(run_case, depth, of_source, rays_alone)) {
      answer = std::move(*waves);
    } else if (auto images = summed_images(run_case, depth, of_source, false)) {
      answer = std::move(*images);
      if (!why_no_waves(run_case).empty()) rays_alone.clear();  // waves would add nothing
    } else if (auto paths = path_field(run_case, depth, of_source)) {
      answer = std::move(*paths);
    } else if (run_case.beams.elevations.empty()) {
      FanProgress fans(of_source);
      answer = converged_field(
          run_case,
          [&](const BeamFan& fan, const FieldCheck& also) {
            return field_of_fan(run_case, tracer, depth, fan, fans.of_fan(), FieldMethod::fast,
                                also);
          },
          level_rays(run_case.environment, run_case.frequency, 0.0, depth), depth, &fans);
    } else {
      const BeamFan fan = given_fan(run_case.beams.elevations);
      answer = {.field = field_of_fan(run_case, tracer, depth, fan, of_source).field,
                .beams = fan.elevation.size()};
    }
    for (const std::complex<double>& p : answer.field) result.field.emplace_back(p);
    if (!answer.errors.empty()) {
      result.beam_errors.resize(i * cells, not_known);
      result.beam_errors.insert(result.beam_errors.end(), answer.errors.begin(),
                                answer.errors.end());
    }
    result.beams = std::max(result.beams, answer.beams);
    result.beam_error_db = std::max(result.beam_error_db, answer.error_db);
    result.beam_error_bounded = answer.bounded;
    result.waves = result.waves || answer.waves;
    for (const std::string& note : {answer.note, rays_alone})
      if (!note.empty()) result.notes.push_back(note);
  }
  if (!result.beam_errors.empty()) result.beam_errors.resize(sources * cells, not_known);
  return result;
}

}  // namespace asdic::detail
