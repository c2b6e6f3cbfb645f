#include "raytrace/bellhop_emulation/results.h"

#include <cmath>

namespace asdic::detail::bellhop_emulation {
namespace {

/// What spreading by range multiplies: 1/√r of a point source, 4√π of a line.
double range_factor(SourceKind source, double range, double at_source) noexcept {
  if (source == SourceKind::line) return 4.0 * std::sqrt(pi);
  return range == 0.0 ? at_source : 1.0 / std::sqrt(std::abs(range));
}

template <class Real>
Arrival arrival_of(const StoredArrival<Real>& a, double range_factor, double omega) {
  const double tube = static_cast<double>(a.amplitude) * range_factor;
  const double absorption = std::exp(omega * static_cast<double>(a.tau.imag()));
  Arrival out;
  out.launch_elevation = -static_cast<double>(a.launch_declination);
  out.arrival_elevation = -static_cast<double>(a.arrival_declination);
  out.delay = static_cast<double>(a.tau.real());
  out.amplitude = std::polar(tube * absorption, static_cast<double>(a.phase));
  out.spreading = tube;  // the magnitudes of the reflections are in it
  out.reflection = std::polar(1.0, static_cast<double>(a.phase));
  out.absorption_db = -db_from_amplitude(absorption);
  out.surface_bounces = a.surface_bounces;
  out.bottom_bounces = a.bottom_bounces;
  return out;
}

}  // namespace

SourceResults::SourceResults(const PropagationCase& given, const BellhopEmulationOptions& options)
    : run_case(given), rows(given.receivers.rows()), columns(given.receivers.ranges.size()) {
  const std::size_t size = rows * columns;
  if (given.task == Task::field) {
    if (options.single_precision)
      field32 = std::make_unique<FieldSums<float>>(given.field, columns, size);
    else
      field64 = std::make_unique<FieldSums<double>>(given.field, columns, size);
  }
  if (given.task == Task::arrivals || given.task == Task::eigenrays_and_arrivals) {
    if (options.single_precision)
      arrivals32 = std::make_unique<ArrivalStore<float>>(size, options.merge);
    else
      arrivals64 = std::make_unique<ArrivalStore<double>>(size, options.merge);
  }
  eigenrays = given.task == Task::eigenrays || given.task == Task::eigenrays_and_arrivals;
}

template <class Real>
void SourceResults::append_field(const FieldSums<Real>& sums, PropagationResult& result,
                                 double beam_factor) const {
  for (std::size_t i = 0; i < sums.sums().size(); ++i) {
    const double scale = beam_factor * range_factor(run_case.beams.source,
                                                    run_case.receivers.ranges[i % columns], 0.0);
    const std::complex<double> sum(sums.sums()[i]);
    const std::complex<double> p = sums.kind() == FieldKind::coherent
                                       ? scale * sum
                                       : std::complex<double>(scale * std::sqrt(sum.real()));
    result.field.emplace_back(static_cast<float>(p.real()), static_cast<float>(p.imag()));
  }
}

template <class Real>
void SourceResults::append_arrivals(const ArrivalStore<Real>& store,
                                    PropagationResult& result) const {
  const double omega = 2.0 * pi * run_case.frequency;
  for (std::size_t i = 0; i < rows * columns; ++i) {
    const double factor =
        range_factor(run_case.beams.source, run_case.receivers.ranges[i % columns], 1e5);
    Arrivals list;
    for (const auto& a : store.at(i)) list.push_back(arrival_of(a, factor, omega));
    result.arrivals.push_back(std::move(list));
  }
}

void SourceResults::append_to(PropagationResult& result, double source_speed, double spacing) {
  const BeamKind kind = run_case.beams.kind;
  const bool cerveny = kind == BeamKind::cerveny_cartesian || kind == BeamKind::cerveny_ray_centred;
  const double beam_factor = cerveny ? spacing * std::sqrt(run_case.frequency) / source_speed : 1.0;
  if (field32) append_field(*field32, result, beam_factor);
  if (field64) append_field(*field64, result, beam_factor);
  if (arrivals32) append_arrivals(*arrivals32, result);
  if (arrivals64) append_arrivals(*arrivals64, result);
  if (eigenrays || run_case.task == Task::rays) result.rays.push_back(std::move(rays));
}

RayPath path_of(const LiteralRay& ray, std::size_t count) {
  RayPath path;
  path.launch_elevation = -ray.declination;
  path.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const LiteralPoint& y = ray.points[i];
    path.points.push_back({.range = y.x.x(), .depth = y.x.y(), .time = y.tau.real()});
    if (i == 0) continue;
    const LiteralPoint& before = ray.points[i - 1];
    path.path_length += (y.x - before.x).norm();
    const bool at_surface = y.surface_bounces > before.surface_bounces;
    const bool at_bottom = y.bottom_bounces > before.bottom_bounces;
    if (at_surface) path.surface_hits.push_back(y.x.x());
    if (!at_surface && !at_bottom && y.t.y() * before.t.y() < 0.0) ++path.turns;
  }
  const LiteralPoint& end = ray.points[count - 1];
  path.final_elevation = std::atan2(-end.t.y(), end.t.x());
  path.surface_bounces = end.surface_bounces;
  path.bottom_bounces = end.bottom_bounces;
  return path;
}

}  // namespace asdic::detail::bellhop_emulation
