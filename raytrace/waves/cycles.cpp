#include "raytrace/waves/cycles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/waves/diffraction.h"
#include "raytrace/waves/make_wave.h"
#include "raytrace/waves/ray_errors.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double least_share = 1e-8;    // of a wavenumber in the terms
constexpr double flattest_zones = 0.1;  // of the slope that a wave of one Fresnel zone notices
constexpr double fade_radians = 100.0;  // over which flat waves fade, at the furthest range

/// f·g′ − f′·g
Complex wronskian(Complex f, Complex f_slope, Complex g, Complex g_slope) {
  return f * g_slope - f_slope * g;
}

/// f·g, each with its exponent: alone one may be too small for a number and the other too great.
/// \param reference  of the exponents' sum
Complex product(const DepthWave& f, const DepthWave& g, double reference) {
  return f.u * g.u * std::exp(std::min(f.growth + g.growth - reference, 100.0));
}

}  // namespace

CycleWaves::CycleWaves(const Environment& ocean, double frequency, double source_depth,
                       double receiver_depth, double furthest)
    : source_is_upper_(source_depth <= receiver_depth) {
  const WaveColumn column(ocean, frequency, source_depth, std::span(&receiver_depth, 1));
  window_ = water_window(ocean, column, frequency, furthest);
  slowest_ = column.at_slowest();
  flattest_ = std::sqrt(slowest_.k2).real();
  fade_ = fade_radians / furthest;
  const double widest = std::sqrt(2.0 * column.largest_wavenumber() / furthest);
  least_slope_ = flattest_zones * widest * widest * widest;
  // A ray that is horizontal at an end turns on that side of the slowest depth. Slopes cannot
  // decide this, because they are 0 where the speed is greatest.
  turns_ = column.ends_are_above()   ? Turns::above
           : column.ends_are_below() ? Turns::below
                                     : Turns::between;
  affordable_ = double(column.layers()) * double(window_.count) <= most_cycle_steps;
  if (!affordable_) return;
  constexpr std::size_t piece = 16;
  kernels_.resize(window_.count);
  in_parallel_chunks(window_.count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      stop_point();
      kernels_[j] = kernel(column, window_.at(j));
    }
  });
}

double CycleWaves::cycled(double wavenumber) const noexcept {
  return 0.5 * std::erfc(-4.0 * (2.0 * (flattest_ - wavenumber) / fade_ - 1.0));
}

int CycleWaves::flat_cycles(double range) const noexcept {
  const double at = (flattest_ - 0.5 * fade_ - window_.begin) / window_.spacing;
  if (!(at >= 1.0)) return 0;
  const std::size_t j = std::min(std::size_t(at), kernels_.size() - 1);
  const double length = std::arg(kernels_[j].cycle / kernels_[j - 1].cycle) / window_.spacing;
  return length > 0.0 ? int(range / length) + 1 : 0;
}

std::size_t CycleWaves::bytes() const noexcept {
  return sizeof *this + kernels_.size() * sizeof(Kernel);
}

int CycleWaves::term_of(const Branch& branch) const noexcept {
  if (turns_ == Turns::above) return branch.bottom_vertices();
  if (turns_ == Turns::below) return branch.top_vertices();
  return source_is_upper_ ? branch.top_vertices() - int(branch.starts_up)
                          : branch.bottom_vertices() - int(!branch.starts_up);
}

CycleWaves::Kernel CycleWaves::kernel(const WaveColumn& column, Complex xi) const noexcept {
  const WaveColumn::AtDepths at = column.solutions(xi);
  const WaveColumn::Solutions &over = source_is_upper_ ? at.source : at.receiver,
                              &under = source_is_upper_ ? at.receiver : at.source;
  const DepthWave &u = at.slowest.above, &v = at.slowest.below;
  const Complex q = slowest_.k2 - xi * xi;
  const double slope =
      std::copysign(std::max(std::abs(slowest_.slope), least_slope_), slowest_.slope);
  const Complex uv = product(over.above, under.below, u.growth + v.growth);
  const double share = cycled(xi.real());
  const Complex flat = -2.0 * (1.0 - share) * uv / wronskian(u.u, u.du, v.u, v.du);
  if (share < least_share) return {0.0, 0.0, 0.0, flat};
  // Up and down are resolved where all rays are steepest.
  const TravellingWaves wave = travelling_waves(q, slope);
  const Complex both = wronskian(wave.up, wave.up_slope, wave.down, wave.down_slope);
  // u = a·(up + V_u·down), v = d·(down + V_v·up)
  const Complex a = wronskian(u.u, u.du, wave.down, wave.down_slope) / both,
                d = wronskian(wave.up, wave.up_slope, v.u, v.du) / both;
  const Complex above = wronskian(wave.up, wave.up_slope, u.u, u.du) / (both * a),
                below = wronskian(v.u, v.du, wave.down, wave.down_slope) / (both * d);
  const Complex cycle = above * below, scale = -2.0 * share / both;
  const Complex term = scale * uv / (a * d);
  if (turns_ == Turns::between) return {term, term * cycle, cycle, flat};
  // What has turned at the one side before both ends, and after: a sum over the others' turns.
  const Complex turned = turns_ == Turns::above
                             ? below * product(over.above, under.above, 2.0 * u.growth) / (a * a)
                             : above * product(over.below, under.below, 2.0 * v.growth) / (d * d);
  const Complex next = scale * turned;
  return {(term - next) / (1.0 - cycle), next, cycle, flat};
}

std::vector<Complex> CycleWaves::terms(std::size_t count, double range) const {
  std::vector<Complex> sums(count + 1, 0.0);
  for (std::size_t j = 0; j < kernels_.size(); ++j) {
    const Complex f = window_.factor(window_.at(j), range);
    const Kernel& k = kernels_[j];
    sums[0] += f * k.first;
    Complex term = f * k.next;
    for (std::size_t n = 1; n < count; ++n, term *= k.cycle) sums[n] += term;
    sums[count] += f * k.flat;
  }
  return sums;
}

namespace {

constexpr double least_error = 0.02;      // of an amplitude, that is reckoned with
constexpr double tolerable_error = 0.01;  // of the whole, below which rays are right
constexpr double least_change = 1e-3;     // of the whole, below which a ray stays one
constexpr double least_weight = 1e-3;     // of a ray in the window of wavenumbers

Branch branch_of(const Arrival& ray) {
  return {.starts_up = ray.launch_elevation > 0.0,
          .vertices = ray.surface_bounces + ray.bottom_bounces + ray.upper_turns + ray.lower_turns};
}

/// The history of the same ray from its other end.
Branch reversed(const Branch& branch) {
  return {.starts_up = !branch.arrives_upward(), .vertices = branch.vertices};
}

/// Of a ray, at the receiver.
Complex pressure(const Arrival& ray, double frequency) {
  return ray.amplitude * std::polar(1.0, -2.0 * pi * std::fmod(frequency * ray.delay, 1.0));
}

/// The same ocean whose boundaries return nothing.
Environment without(Environment ocean, bool surface, bool bottom) {
  const ReflectionTable nothing{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
  for (auto [boundary, left_out] : {std::pair{&ocean.surface, surface}, {&ocean.bottom, bottom}})
    if (left_out) boundary->material = nothing, boundary->roughness = {};
  return ocean;
}

/// Rays that go into each other, and the waves of these rays: those of one term, or the flat ones.
struct WaveGroup {
  std::vector<std::size_t> rays;  // their indices in all arrivals
  std::vector<double> weights;    // [rays] shares of the rays in this group
  Complex lacking = 0.0;          // pressure of the waves less that of the rays

  void add(std::size_t ray, double weight, Complex pressure) {
    rays.push_back(ray);
    weights.push_back(weight);
    lacking -= weight * pressure;
  }
};

/// Changes amplitudes so that the sum of a group's rays is its waves. The unsure part of each
/// amplitude is taken away, and the rays share what is then lacking in proportion to their possible
/// errors.   \param amplitudes  [found]
void share(const WaveGroup& group, const Arrivals& found, const std::vector<RayError>& errors,
           double frequency, std::vector<Complex>& amplitudes) {
  const auto unsure = [](double error) { return 1.0 - 1.0 / (1.0 + error * error); };
  Complex lacking = group.lacking;
  double all = 0.0;
  std::vector<double> doubt;
  for (std::size_t n = 0; n < group.rays.size(); ++n) {
    const std::size_t i = group.rays[n];
    const Arrival& ray = found[i];
    const double left_out = group.weights[n] * unsure(errors[i].focusing);
    lacking += left_out * pressure(ray, frequency);
    amplitudes[i] -= left_out * ray.amplitude;
    doubt.push_back(group.weights[n] * std::norm(ray.amplitude) *
                    unsure(std::max(least_error, errors[i].focusing + errors[i].turning)));
    all += doubt.back();
  }
  for (std::size_t n = 0; n < group.rays.size(); ++n) {
    const std::size_t i = group.rays[n];
    const double turns = std::fmod(frequency * found[i].delay, 1.0);
    amplitudes[i] += doubt[n] / all * lacking * std::polar(1.0, 2.0 * pi * turns);
  }
}

/// A range that many have in common, up to a fifth further.
double furthest_of(double range) { return std::exp2(std::ceil(4.0 * std::log2(range)) / 4.0); }

bool of_one_speed(const Environment& ocean) {
  const auto& water = ocean.water;
  const double c = water.at(ocean.surface.depth).c;
  bool same = water.at(ocean.bottom.depth).c == c;
  for (std::size_t i = 0; i < water.intervals(); ++i)
    same = same && water.at(water.law(i).z0).c == c;
  return same;
}

}  // namespace

void put_waves(const EigenraySolver& solver, double source_depth, double receiver_depth,
               double range, double frequency, const PathLimits& limits, Arrivals& found,
               const CyclesKeeper& keeper) {
  const Environment& ocean = solver.environment();
  if (!(range > 0.0) || of_one_speed(ocean)) return;
  const std::vector<RayError> errors =
      ray_errors(solver, source_depth, receiver_depth, frequency, limits, found);
  double energy = 0.0, wrong = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::min(1.0, errors[i].focusing + errors[i].turning);
    energy += std::norm(found[i].amplitude);
    wrong += std::norm(found[i].amplitude) * error * error;
  }
  if (!(wrong > tolerable_error * tolerable_error * energy)) return;

  // Of oceans whose boundaries return nothing where rays must not touch them so often; received at
  // the lower end, so that the way there and the way back have the same.
  const double furthest = furthest_of(range);
  const double upper = std::min(source_depth, receiver_depth),
               lower = std::max(source_depth, receiver_depth);
  const auto cycles = [&](bool surface, bool bottom) -> std::shared_ptr<const CycleWaves> {
    const auto make = [&] {
      return std::make_shared<CycleWaves>(without(ocean, surface, bottom), frequency, upper, lower,
                                          furthest);
    };
    return keeper ? keeper({upper, lower, frequency, furthest, surface, bottom}, make) : make();
  };
  const bool no_surface = limits.max_surface_bounces == 0,
             no_bottom = limits.max_bottom_bounces == 0;
  const auto plain = cycles(no_surface, no_bottom);
  const double omega = 2.0 * pi * frequency;
  const double steepest =
      omega * std::cos(limits.max_launch_angle) / ocean.water.at(source_depth).c;
  if (!plain->affordable() || steepest > plain->window().begin) return;

  const auto term_of = [&](const Arrival& ray) {
    const Branch branch = branch_of(ray);
    return plain->term_of(source_depth <= receiver_depth ? branch : reversed(branch));
  };
  int last = -1;
  bool waterborne = false;
  std::vector<double> weights;  // [found] of their wavenumbers in the window
  for (const Arrival& ray : found) {
    waterborne = waterborne || ray.bottom_bounces == 0;
    weights.push_back(plain->window().weight(omega * ray.horizontal_slowness));
    if (weights.back() < least_weight || !(std::norm(ray.amplitude) > 0.0)) weights.back() = 0.0;
    if (weights.back() == 0.0) continue;
    last = std::max(last, term_of(ray));
  }
  if (last < 0) return;
  const int flat_cycles = plain->flat_cycles(range);
  const std::size_t count = std::size_t(std::max(last, flat_cycles)) + 2;
  std::map<std::pair<bool, bool>, std::vector<Complex>> known;
  const auto waves_without = [&](bool surface, bool bottom, std::size_t number) {
    std::vector<Complex>& there = known[{surface, bottom}];
    if (there.empty()) there = cycles(surface, bottom)->terms(count, range);
    return there[number];
  };
  // Group of a term, or of flat waves (number = count), with at most so many bounces off either
  // boundary.
  const auto group_of = [&](std::size_t number, int bounces) {
    const bool flat = number == count;  // has all cycles, so bounces cannot be left out
    const bool surface = no_surface || (!flat && bounces > limits.max_surface_bounces),
               bottom = no_bottom || (!flat && bounces > limits.max_bottom_bounces);
    WaveGroup here{.lacking = waves_without(surface, bottom, number)};
    if (!waterborne && !bottom) here.lacking -= waves_without(surface, true, number);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Arrival& ray = found[i];
      const double cycled = plain->cycled(omega * ray.horizontal_slowness);
      const double weight = weights[i] * (flat ? 1.0 - cycled : cycled);
      if (weight < least_weight || (!flat && term_of(ray) != int(number)) ||
          (surface && ray.surface_bounces > 0) || (bottom && ray.bottom_bounces > 0))
        continue;
      here.add(i, weight, pressure(ray, frequency));
    }
    return here;
  };
  std::map<int, WaveGroup> groups;
  // A term has as many turns at either side, or one more.
  for (int term = 0; term < int(count); ++term)
    groups.emplace(term, group_of(std::size_t(term), term + 1));
  // Waves of groups without rays go to the nearest group with rays, so that the sum stays that of
  // the waves whichever rays were found.
  const auto hand_over = [&](const WaveGroup& from, int term) {
    const auto nearest =
        std::min_element(groups.begin(), groups.end(), [&](const auto& a, const auto& b) {
          const auto off = [&](const auto& group) {
            return std::pair(group.second.rays.empty(), std::abs(group.first - term));
          };
          return off(a) < off(b);
        });
    if (from.rays.empty() && !nearest->second.rays.empty()) nearest->second.lacking += from.lacking;
  };
  const WaveGroup flat = group_of(count, flat_cycles);
  hand_over(flat, flat_cycles);
  for (const auto& [term, here] : groups) hand_over(here, term);
  std::vector<Complex> amplitudes;
  for (const Arrival& ray : found) amplitudes.push_back(ray.amplitude);
  share(flat, found, errors, frequency, amplitudes);
  for (const auto& [term, here] : groups) share(here, found, errors, frequency, amplitudes);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (std::norm(amplitudes[i] - found[i].amplitude) > least_change * least_change * energy)
      make_wave(found[i], amplitudes[i] / found[i].amplitude);
}

}  // namespace asdic::detail
