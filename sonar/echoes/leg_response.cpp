#include "sonar/echoes/leg_response.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.h"
#include "raytrace/ocean/boundary.h"
#include "raytrace/ocean/roughness.h"

namespace asdic::detail {
namespace {

/// Whether the reflection of a boundary depends on frequency.
bool changes_with_frequency(const Boundary& boundary) {
  const auto depends = [](const BoundaryMaterial& material) {
    return depends_on_frequency(material);
  };
  return !boundary.roughness.smooth() || depends(boundary.material) ||
         (boundary.shape && std::any_of(boundary.shape->materials().begin(),
                                        boundary.shape->materials().end(), depends));
}

/// Solver of the vertical plane through both ends of a leg.
std::shared_ptr<const EigenraySolver> solver_of(const PropagationPaths& paths, const MetLeg& leg) {
  const Separation way = separation(leg.from, leg.to);
  return paths.solver(paths.plane(leg.from, way.bearing, way.range));
}

/// Product of the reflection coefficients of a path's bounces at a frequency.
std::complex<double> reflected(const Environment& ocean, const Arrival& path, double frequency) {
  std::complex<double> product = 1.0;
  for (const Bounce& bounce : path.bounces) {
    const Boundary& boundary =
        bounce.boundary == BoundaryKind::surface ? ocean.surface : ocean.bottom;
    if (!changes_with_frequency(boundary)) continue;
    const double depth = boundary.depth_at(bounce.range);
    const double c = sound_speed(ocean, bounce.range, depth).c;
    product *=
        reflection_coefficient(
            boundary.material_at(bounce.range), bounce.grazing,
            {.speed = c, .density = ocean.water_density.at(depth), .frequency = frequency}) *
        coherent_reflection(boundary.roughness, std::sin(bounce.grazing), 2.0 * pi * frequency / c);
  }
  return product;
}

/// Shares the sum of paths that a band does not resolve in the same way as at the centre. Where
/// rays meet, the sound may jump from one path to another with frequency, while their sum is
/// smooth.
/// \param amplitudes  [leg.paths] at a frequency, with phases for the delays at the centre
void share_unresolved(const MetLeg& leg, double frequency, double half_width,
                      std::vector<std::complex<double>>& amplitudes) {
  const double resolved = 0.05 / half_width;  // difference of delays [s]
  const auto turned = [&](std::size_t i) {
    return std::polar(1.0, -2.0 * pi * std::fmod(frequency * leg.paths[i].delay, 1.0));
  };
  for (std::size_t first = 0, last = 0; first < leg.paths.size(); first = last) {
    std::complex<double> changed = 0.0;
    double energy = 0.0;
    for (last = first;
         last < leg.paths.size() &&
         (last == first || leg.paths[last].delay - leg.paths[last - 1].delay < resolved);
         ++last) {
      changed += (amplitudes[last] - leg.paths[last].amplitude) * turned(last);
      energy += std::norm(leg.paths[last].amplitude);
    }
    if (last - first < 2 || energy == 0.0) continue;
    for (std::size_t i = first; i < last; ++i) {
      const std::complex<double> here = leg.paths[i].amplitude;
      amplitudes[i] = here + std::norm(here) / energy * changed * std::conj(turned(i));
    }
  }
}

/// Path found at a frequency that continues a given path; null if there is none.
const Arrival* become(const Arrivals& found, const Arrival& path, bool layered) {
  // There is only one diffracted arrival, whatever its direction.
  if (path.kind == ArrivalKind::diffracted)
    for (const Arrival& one : found)
      if (one.kind == ArrivalKind::diffracted) return &one;
  return same_path(found, path, layered);
}

}  // namespace

std::vector<std::complex<double>> SampledResponse::at(double frequency) const {
  std::vector<std::complex<double>> sums(values.empty() ? 0 : values.front().size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double share = nodes.basis(k, frequency);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += share * values[k][i];
  }
  return sums;
}

double SampledResponse::energy() const {
  double greatest = 0.0;
  for (const auto& at_node : values) {
    double energy = 0.0;
    for (const std::complex<double>& value : at_node) energy += std::norm(value);
    greatest = std::max(greatest, energy);
  }
  return greatest;
}

/// Adds up the coefficients of its Chebyshev polynomials, the highest first.
std::size_t SampledResponse::degree(double loudest) const {
  const std::size_t cells = values.size() - 1, responses = values.front().size();
  const double greatest = std::max(energy(), loudest);
  const ResponseError tolerated;
  const double most = cells < 32 ? 0.5 * tolerated.few : tolerated.many;
  double left_out = 0.0;
  for (std::size_t j = cells; j > 0; --j) {
    std::vector<std::complex<double>> coefficient(responses);
    for (std::size_t k = 0; k <= cells; ++k) {
      const double ends = (k == 0 || k == cells ? 0.5 : 1.0) * (j == cells ? 1.0 : 2.0),
                   share = ends / static_cast<double>(cells) *
                           std::cos(pi * static_cast<double>(j * k) / static_cast<double>(cells));
      for (std::size_t i = 0; i < responses; ++i) coefficient[i] += share * values[k][i];
    }
    for (const std::complex<double>& c : coefficient) left_out += std::norm(c);
    if (left_out > most * most * greatest) return j;
  }
  return 0;
}

SampledResponse sampled_response(
    double centre, double half_width, const ResponseError& error, std::size_t most,
    const std::function<std::vector<std::complex<double>>(double)>& responses) {
  const auto place = [&](std::size_t k, std::size_t cells) {
    return centre - half_width * std::cos(pi * static_cast<double>(k) / static_cast<double>(cells));
  };
  const auto size = [](const std::vector<std::complex<double>>& values) {
    double sum = 0.0;
    for (const std::complex<double>& value : values) sum += std::norm(value);
    return std::sqrt(sum);
  };
  SampledResponse known{.nodes = {centre, half_width, {}}, .values = {}};
  for (std::size_t k = 0; k <= 2; ++k) {
    known.nodes.frequencies.push_back(place(k, 2));
    known.values.push_back(responses(known.nodes.frequencies.back()));
  }
  for (std::size_t cells = 4;; cells *= 2) {
    SampledResponse finer{.nodes = {centre, half_width, {}}, .values = {}};
    finer.values.resize(cells + 1);
    double greatest = 0.0;
    for (std::size_t k = 0; k <= cells; ++k) {
      finer.nodes.frequencies.push_back(place(k, cells));
      if (k % 2 == 0) finer.values[k] = known.values[k / 2];
      greatest = std::max(greatest, size(finer.values[k]));
    }
    /// Computes every `step`-th of the new values.   \return largest error of the prediction,
    /// relative
    const auto off = [&](std::size_t first, std::size_t step) {
      double worst = 0.0;
      for (std::size_t k = first; k <= cells; k += step) {
        if (!finer.values[k].empty()) continue;
        finer.values[k] = responses(finer.nodes.frequencies[k]);
        std::vector<std::complex<double>> foretold = known.at(finer.nodes.frequencies[k]);
        for (std::size_t i = 0; i < foretold.size(); ++i) foretold[i] -= finer.values[k][i];
        worst = std::max(worst, size(foretold));
        greatest = std::max(greatest, size(finer.values[k]));
      }
      return greatest > 0.0 ? worst / greatest : 0.0;
    };
    const std::size_t few = std::max<std::size_t>(1, cells / 8);  // for four new values, or all
    known.error = off(few | 1, 2 * few);
    if (known.error <= (cells < 64 ? error.few : error.many)) return known;
    finer.error = std::max(known.error, off(1, 2));
    known = std::move(finer);
    if (2 * cells + 1 > most) return known;
  }
}

bool MetLeg::by_waves() const noexcept {
  return std::any_of(paths.begin(), paths.end(),
                     [](const Arrival& path) { return path.kind != ArrivalKind::ray; });
}

PathOnLeg path_on_leg(const std::shared_ptr<const MetLeg>& known, std::size_t path,
                      const Vec3& from, const MetPath& met) {
  constexpr double periods = 2.0;  // over which waves keep their amplitude
  if (met.path.kind == ArrivalKind::ray ||
      std::abs(met.path.delay - known->paths[path].delay) * known->frequency < periods)
    return {known, path};
  return {std::make_shared<const MetLeg>(MetLeg{.from = from,
                                                .to = met.way.end.position,
                                                .paths = {met.path},
                                                .frequency = known->frequency,
                                                .limits = known->limits}),
          0};
}

bool changes_with_frequency(const PropagationPaths& paths, const MetLeg& leg) {
  if (leg.by_waves()) return true;
  if (paths.volume() != nullptr) return false;  // places of bounces are not known
  const auto solver = solver_of(paths, leg);
  const bool surface = changes_with_frequency(solver->environment().surface),
             bottom = changes_with_frequency(solver->environment().bottom);
  return std::any_of(leg.paths.begin(), leg.paths.end(), [&](const Arrival& path) {
    return (surface && path.surface_bounces > 0) || (bottom && path.bottom_bounces > 0);
  });
}

std::vector<std::complex<double>> amplitudes_at(const PropagationPaths& paths, const MetLeg& leg,
                                                double frequency) {
  constexpr double lowest = 0.1;  // of the centre: a band's edge may reach to 0 Hz and below
  const double f = std::max(lowest * leg.frequency, frequency);
  std::vector<std::complex<double>> amplitudes;
  if (!leg.by_waves()) {
    const auto solver = solver_of(paths, leg);
    for (const Arrival& path : leg.paths) {
      const std::complex<double> at_centre = reflected(solver->environment(), path, leg.frequency);
      amplitudes.push_back(at_centre == 0.0 ? path.amplitude
                                            : path.amplitude / at_centre *
                                                  reflected(solver->environment(), path, f));
    }
    return amplitudes;
  }
  const Arrivals found = paths.find(leg.from, leg.to, f, leg.limits);
  for (const Arrival& path : leg.paths) {
    Arrivals followed;
    if (path.kind == ArrivalKind::diffracted)  // even if rays reach the place at that frequency
      followed = paths.follow(std::span(&path, 1), leg.from, leg.to, f, leg.limits);
    const Arrival* same = become(followed.empty() ? found : followed, path, paths.layered());
    if (same == nullptr) {  // too faint at that frequency
      amplitudes.emplace_back(0.0);
      continue;
    }
    const double cycles = std::fmod(f * (same->delay - path.delay), 1.0);
    amplitudes.push_back(same->amplitude * std::polar(1.0, -2.0 * pi * cycles));
  }
  return amplitudes;
}

double response_half_band(const Pulse& pulse) noexcept {
  return std::min(0.5 * pulse.bandwidth_40db(), pulse.bandwidth_99());
}

SampledResponse leg_response(const PropagationPaths& paths, const MetLeg& leg, double centre,
                             double half_width) {
  return sampled_response(centre, half_width, ResponseError{},
                          leg.by_waves() ? most_wave_frequencies : most_ray_frequencies,
                          [&](double f) {
                            std::vector<std::complex<double>> there = amplitudes_at(paths, leg, f);
                            if (leg.by_waves()) share_unresolved(leg, f, half_width, there);
                            return there;
                          });
}

bool too_narrow_to_change(const MetLeg& leg, double half_width, double least) {
  // The amplitude of a single wave changes with frequency at most as its 10th power. Waves of one
  // term have the delays of its rays, whose numbers of turns and bounces differ by at most two.
  constexpr double steepest = 10.0;
  if (steepest * half_width > least * leg.frequency) return false;
  const auto vertices = [](const Arrival& path) {
    return path.surface_bounces + path.bottom_bounces + path.upper_turns + path.lower_turns;
  };
  for (const Arrival& path : leg.paths)
    for (const Arrival& other : leg.paths)
      if (path.kind != ArrivalKind::ray && std::abs(vertices(path) - vertices(other)) <= 2 &&
          2.0 * pi * half_width * std::abs(path.delay - other.delay) > least)
        return false;
  return true;
}

}  // namespace asdic::detail
