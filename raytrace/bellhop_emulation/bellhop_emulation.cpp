#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "raytrace/bellhop_emulation/fan.h"
#include "raytrace/bellhop_emulation/results.h"
#include "raytrace/bellhop_emulation/sinks.h"
#include "raytrace/bellhop_emulation/trace.h"
#include "raytrace/cases/memory.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace bellhop_emulation {
namespace {

constexpr std::size_t rays_at_once = 64;  // traced together, then added in order
constexpr std::size_t most_blocks = 16;   // of receivers, each added by one task

LiteralOcean make_ocean(const PropagationCase& run_case, const BellhopEmulationOptions& options) {
  const Environment& e = run_case.environment;
  LiteralOcean ocean{
      .water = LiteralWater(e, run_case.frequency),
      .surface = BoundaryLine(e.surface, BoundaryKind::surface, options.unit_normals),
      .bottom = BoundaryLine(e.bottom, BoundaryKind::bottom, options.unit_normals),
      .frequency = run_case.frequency,
      .step = options.step.value_or(run_case.literal.step),
      .box_range = run_case.box_range,
      .box_depth = run_case.box_depth,
      .displacement = run_case.beams.displacement};
  if (!(ocean.step > 0.0))
    ocean.step = 0.1 * (ocean.water.last_depth() - ocean.water.first_depth());
  return ocean;
}

void check(const PropagationCase& run_case) {
  if (run_case.source_depths.empty())
    throw InputError({.where = "source depths", .got = "none", .expected = "at least one"});
  if (run_case.task != Task::rays &&
      (run_case.receivers.depths.empty() || run_case.receivers.ranges.empty()))
    throw InputError({.where = "receivers", .got = "none", .expected = "depths and ranges"});
  if (run_case.dimension != 2)
    throw InputError({.where = "run.dimension",
                      .got = "3",
                      .expected = "2: BELLHOP's rays keep to the vertical plane"});
  if (run_case.off_transect != 0.0)
    throw InputError({.where = "run.off_transect",
                      .got = "an angle",
                      .expected = "0: BELLHOP's receivers lie along the transect"});
  if (!(run_case.box_range > 0.0) || !(run_case.box_depth > 0.0))
    throw InputError(
        {.where = "box", .got = "nothing", .expected = "a range and a depth where rays end"});
}

/// Puts every contribution where the task wants it.
class TaskSink final : public BeamSink {
 public:
  TaskSink(SourceResults& results, double omega) : results_(results), omega_(omega) {}

  void begin(std::size_t beam, double declination) {
    beam_ = beam;
    declination_ = declination;
  }
  void take(const Contribution& c) override {
    if (results_.field32) results_.field32->add(c, omega_);
    if (results_.field64) results_.field64->add(c, omega_);
    const std::size_t receiver = c.row * results_.columns + c.column;
    if (results_.arrivals32) results_.arrivals32->add(receiver, c, declination_, omega_);
    if (results_.arrivals64) results_.arrivals64->add(receiver, c, declination_, omega_);
    if (results_.eigenrays) hits.push_back({beam_, c.segment, c.column, c.row});
  }
  void take_pressure(std::size_t row, std::size_t column, std::complex<double> p,
                     double weight) override {
    if (results_.field32) results_.field32->add(row, column, p, weight);
    if (results_.field64) results_.field64->add(row, column, p, weight);
  }

  std::vector<EigenrayHit> hits;

 private:
  SourceResults& results_;
  double omega_, declination_ = 0.0;
  std::size_t beam_ = 0;
};

void add_beam(const BeamSettings& beams, const Beam& beam, const ReceiverBlock& block,
              BeamSink& sink) {
  switch (beams.kind) {
    case BeamKind::hat:
      return add_cartesian_hat(beam, block, sink);
    case BeamKind::gaussian:
      return add_cartesian_gaussian(beam, block, sink);
    case BeamKind::ray_centred_hat:
      return add_ray_centred_hat(beam, block, sink);
    case BeamKind::ray_centred_gaussian:
      return add_ray_centred_gaussian(beam, block, sink);
    case BeamKind::simple_gaussian:
      return add_simple_gaussian(beam, block, sink);
    case BeamKind::cerveny_cartesian:
      return add_cerveny_cartesian(beam, beams.cerveny.value_or(CervenyBeams{}), block, sink);
    case BeamKind::cerveny_ray_centred:
      return add_cerveny_ray_centred(beam, beams.cerveny.value_or(CervenyBeams{}), block, sink);
  }
}

/// Blocks of columns, or of rows for beams that follow each depth line. Every receiver belongs to
/// one block, so its sum does not depend on who computes it.
std::vector<ReceiverBlock> make_blocks(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  const BeamKind kind = run_case.beams.kind;
  const bool by_rows = kind == BeamKind::ray_centred_hat ||
                       kind == BeamKind::ray_centred_gaussian ||
                       kind == BeamKind::cerveny_ray_centred;
  const std::size_t n = by_rows ? grid.rows() : grid.ranges.size();
  const std::size_t count = std::min(n, most_blocks);
  std::vector<ReceiverBlock> blocks;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * n / count, end = (i + 1) * n / count;
    if (by_rows)
      blocks.push_back({grid, 0, grid.ranges.size(), begin, end});
    else
      blocks.push_back({grid, begin, end, 0, grid.rows()});
  }
  return blocks;
}

class Run {
 public:
  Run(const PropagationCase& run_case, const BellhopEmulationOptions& options,
      const Progress& progress)
      : case_(run_case),
        options_(options),
        progress_(progress),
        ocean_(make_ocean(run_case, options)),
        fan_(make_fan(run_case, options, ocean_.water.last_depth() - ocean_.water.first_depth())) {}

  PropagationResult operator()() {
    PropagationResult result;
    result.beams = fan_.last - fan_.first;
    for (std::size_t i = 0; i < case_.source_depths.size(); ++i) from_source(i, result);
    note(result);
    return result;
  }

 private:
  void from_source(std::size_t index, PropagationResult& result) {
    const double depth = case_.source_depths[index];
    WaterCell cell;
    const Vec2 source(0.0, depth);
    ocean_.water.locate(source, {1.0, 0.0}, cell);
    source_speed_ = ocean_.water.at(source, cell).c;
    SourceResults results(case_, options_);
    const std::vector<ReceiverBlock> blocks =
        case_.task == Task::rays ? std::vector<ReceiverBlock>{} : make_blocks(case_);
    std::vector<TaskSink> sinks(blocks.size(), TaskSink(results, 2.0 * pi * case_.frequency));
    rays_.resize(rays_at_once);
    for (std::size_t first = fan_.first; first < fan_.last; first += rays_at_once) {
      const std::size_t count = std::min(rays_at_once, fan_.last - first);
      trace_rays(depth, first, count);
      in_parallel(blocks.size(), [&](std::size_t b) {
        for (std::size_t i = 0; i < count; ++i) {
          sinks[b].begin(first + i, rays_[i].declination);
          add_beam(case_.beams, beam(rays_[i]), blocks[b], sinks[b]);
        }
      });
      take_paths(first, count, sinks, results);
      const double sources = static_cast<double>(case_.source_depths.size());
      const double share = static_cast<double>(first + count - fan_.first) /
                           static_cast<double>(fan_.last - fan_.first);
      if (progress_ && !progress_((static_cast<double>(index) + share) / sources))
        throw Interrupted("the run was stopped");
    }
    results.append_to(result, source_speed_, fan_.spacing);
  }

  void trace_rays(double depth, std::size_t first, std::size_t count) {
    const auto curvature =
        case_.beams.cerveny ? case_.beams.cerveny->curvature : CervenyBeams::Curvature::standard;
    in_parallel(count, [&](std::size_t i) {
      const double angle = fan_.declinations[first + i];
      trace(ocean_, depth, angle,
            bellhop_emulation::launch_amplitude(case_, depth, source_speed_, angle), curvature,
            rays_[i]);
    });
  }

  [[nodiscard]] Beam beam(const LiteralRay& ray) const noexcept {
    return {.ray = ray,
            .frequency = case_.frequency,
            .source_speed = source_speed_,
            .spacing = fan_.spacing,
            .step = ocean_.step,
            .surface_depth = ocean_.water.first_depth(),
            .bottom_depth = ocean_.water.last_depth(),
            .source = case_.beams.source,
            .apart = case_.task != Task::field};
  }

  /// Rays or eigenrays of the rays just traced, in the order of the beams and, in a beam, of its
  /// segments, ranges and depths.
  void take_paths(std::size_t first, std::size_t count, std::vector<TaskSink>& sinks,
                  SourceResults& results) {
    if (case_.task == Task::rays)
      for (std::size_t i = 0; i < count; ++i)
        results.rays.push_back(path_of(rays_[i], rays_[i].points.size()));
    std::vector<EigenrayHit> hits;
    for (TaskSink& sink : sinks) {
      hits.insert(hits.end(), sink.hits.begin(), sink.hits.end());
      sink.hits.clear();
    }
    std::sort(hits.begin(), hits.end());
    for (const EigenrayHit& hit : hits)
      results.rays.push_back(path_of(rays_[hit.beam - first], hit.segment + 1));
  }

  void note(PropagationResult& result) const {
    const bool coherent = case_.task == Task::field && case_.field == FieldKind::coherent;
    if (!coherent || fan_.declinations.size() < 2) return;
    const double least =
        least_beams(case_, source_speed_, fan_.declinations.back() - fan_.declinations.front());
    if (static_cast<double>(fan_.declinations.size()) < least)
      result.notes.push_back(
          "fewer beams than BELLHOP advises: " + std::to_string(fan_.declinations.size()) + " of " +
          std::to_string(static_cast<long>(std::ceil(least))));
  }

  const PropagationCase& case_;
  BellhopEmulationOptions options_;
  const Progress& progress_;
  LiteralOcean ocean_;
  LiteralFan fan_;
  double source_speed_ = 1500.0;
  std::vector<LiteralRay> rays_;  // [rays_at_once]
};

}  // namespace
}  // namespace bellhop_emulation

PropagationResult run_bellhop_emulation(const PropagationCase& run_case,
                                        const BellhopEmulationOptions& options,
                                        const Progress& progress) {
  bellhop_emulation::check(run_case);
  return bellhop_emulation::Run(run_case, options, progress)();
}

PropagationResult run_bellhop_emulation(const PropagationCase& run_case, const Progress& progress,
                                        const MemoryBudget& budget) {
  bellhop_emulation::check(run_case);
  static_cast<void>(run_memory(run_case, budget));
  return run_bellhop_emulation(run_case, BellhopEmulationOptions{}, progress);
}

}  // namespace asdic::detail
