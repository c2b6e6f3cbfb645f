#include "raytrace/waves/cycles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/simd.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/waves/diffraction.h"
#include "raytrace/waves/make_wave.h"
#include "raytrace/waves/ray_errors.h"
#include "raytrace/waves/waterborne.h"
#include "raytrace/waves/wave_integral.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double least_share = 1e-8;    // of a wavenumber in the terms
constexpr double flattest_zones = 0.1;  // of the slope that a wave of one Fresnel zone notices
constexpr double fade_radians = 100.0;  // over which flat waves fade, at the furthest range

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
  const double angle = angle_of_the_returned(column, angle_of_spreading(ocean, frequency));
  window_ = water_window(column, angle, furthest);
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
    for (std::size_t j = begin; j < end; j += DepthWaves::count) {
      stop_point();
      const Wavenumbers xi(std::min(DepthWaves::count, end - j),
                           [&](std::size_t lane) { return window_.at(j + lane); });
      const auto solutions = column.solutions(xi);
      for (std::size_t l = 0; l < xi.used; ++l) {
        const Complex factor = window_.factor(xi.xi[l]);
        Kernel& k = kernels_[j + l] = kernel(solutions[l], xi.xi[l]);
        for (Complex* part : {&k.first, &k.next, &k.flat}) *part *= factor;
      }
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

CycleWaves::Kernel CycleWaves::kernel(const WaveColumn::AtDepths& at, Complex xi) const noexcept {
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
  // Eight wavenumbers side by side, because the terms of one follow from each other.
  constexpr std::size_t lanes = 8;
  using Numbers = Lanes<double, lanes>;
  struct Values {
    Numbers re{}, im{};
    void set(std::size_t lane, Complex z) { re[lane] = z.real(), im[lane] = z.imag(); }
    void operator*=(const Values& z) { *this = {re * z.re - im * z.im, re * z.im + im * z.re}; }
    void operator+=(const Values& z) { re += z.re, im += z.im; }
  };
  std::vector<Values> sums(count + 1);
  const std::vector<Complex> factors = window_.factors(range);
  for (std::size_t begin = 0; begin < kernels_.size(); begin += lanes) {
    Values first, term, cycle, flat;
    for (std::size_t j = begin; j < std::min(begin + lanes, kernels_.size()); ++j) {
      const Kernel& k = kernels_[j];
      first.set(j - begin, factors[j] * k.first);
      term.set(j - begin, factors[j] * k.next);
      cycle.set(j - begin, k.cycle);
      flat.set(j - begin, factors[j] * k.flat);
    }
    sums[0] += first;
    for (std::size_t n = 1; n < count; ++n, term *= cycle) sums[n] += term;
    sums[count] += flat;
  }
  std::vector<Complex> found;
  for (const Values& sum : sums) {
    found.emplace_back(0.0);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      found.back() += Complex(sum.re[lane], sum.im[lane]);
  }
  return found;
}

namespace {

constexpr double least_error = 0.02;      // of an amplitude, that is reckoned with
constexpr double tolerable_error = 0.01;  // of the whole, below which rays are right
constexpr double least_change = 1e-3;     // of the whole, below which a ray stays one
constexpr double least_weight = 1e-3;     // of a ray in the window of wavenumbers
constexpr double held_alone = 0.25;  // share of a ray from which on its group's waves are all its
constexpr double resolved = 0.99;    // of a wavenumber that is summed history by history
constexpr double of_a_wave = 0.1;    // what its amplitude may be off by at most

/// Cubic from 0 to 1 between 0 and 1; 0 of what is no number.
double faded_in(double x) {
  const double share = x > 0.0 ? std::min(x, 1.0) : 0.0;
  return share * share * (3.0 - 2.0 * share);
}

/// Phase factor of a ray's delay.
Complex turned(const Arrival& ray, double frequency) {
  return std::polar(1.0, -2.0 * pi * std::fmod(frequency * ray.delay, 1.0));
}

/// Of a ray, at the receiver.
Complex pressure(const Arrival& ray, double frequency) {
  return ray.amplitude * turned(ray, frequency);
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
  double held = 0.0;              // of its waves by its rays, by the greatest share of any of them
  double shared = 0.0;            // of its rays with the flat waves' group, a sum of s(1 - s)

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
    amplitudes[i] += doubt[n] / all * lacking * std::conj(turned(found[i], frequency));
  }
}

/// A leg, its ocean and its rays.
struct FoundLeg {
  const Environment& ocean;
  double source_depth, receiver_depth, range, frequency;
  const PathLimits& limits;
  const Arrivals& found;

  [[nodiscard]] double omega() const { return 2.0 * pi * frequency; }
  [[nodiscard]] double upper() const { return std::min(source_depth, receiver_depth); }
  [[nodiscard]] double lower() const { return std::max(source_depth, receiver_depth); }
  /// The history of a ray from the upper end to the lower one.
  [[nodiscard]] Branch from_upper(const Arrival& ray) const {
    const Branch branch = branch_of(ray);
    return source_depth <= receiver_depth ? branch : reversed(branch);
  }
};

/// Rays that skim one wall where the range is too short for the window to hold such flat waves. The
/// water's gradient bends rays there, but not waves whose Airy length is far more than the ends are
/// off the wall, within the range that a ray would need to leave it by that length. They have the
/// field of water above or below that wall alone.   \param left_out  [found] by the window
WaveGroup skimming_group(const FoundLeg& leg, bool surface, const std::vector<double>& left_out) {
  const Boundary& wall = surface ? leg.ocean.surface : leg.ocean.bottom;
  const SoundSpeed there = leg.ocean.water.at(wall.depth);
  const double k = leg.omega() / there.c;
  const double length = std::cbrt(there.c / (2.0 * k * k * std::abs(there.dc_dz)));
  const double a = std::abs(leg.source_depth - wall.depth),
               b = std::abs(leg.receiver_depth - wall.depth);
  const double off = std::max(a, b) / length, along = leg.range / (2.0 * k * length * length);
  const double valid = faded_in(2.0 * (1.0 - std::max(off, along)));
  const int most = surface ? leg.limits.max_surface_bounces : leg.limits.max_bottom_bounces;
  WaveGroup group;
  if (!(valid > 0.0) || most == 0) return group;
  // The field is that of all rays beside the wall, so it counts as far as they are left out.
  const auto beside_it = [&](const Arrival& ray) {
    return (surface ? ray.bottom_bounces : ray.surface_bounces) == 0 &&
           ray.kind != ArrivalKind::diffracted && std::norm(ray.amplitude) > 0.0;
  };
  double energy = 0.0, outside = 0.0;
  for (std::size_t i = 0; i < leg.found.size(); ++i) {
    if (!beside_it(leg.found[i])) continue;
    energy += std::norm(leg.found[i].amplitude);
    if (left_out[i] > least_weight) outside += left_out[i] * std::norm(leg.found[i].amplitude);
  }
  const double share = outside > 0.0 ? valid * outside / energy : 0.0;
  if (!(share > least_weight)) return group;
  for (std::size_t i = 0; i < leg.found.size(); ++i)
    if (beside_it(leg.found[i])) group.add(i, share, pressure(leg.found[i], leg.frequency));
  if (group.rays.empty()) return group;
  const Environment beside = without(leg.ocean, !surface, surface);
  const WaveColumn column(beside, leg.frequency, leg.source_depth,
                          std::span(&leg.receiver_depth, 1));
  const WaveIntegral waves(column, 1, beside.bottom.depth - beside.surface.depth,
                           std::span(&leg.range, 1));
  if (waves.steps() > most_cycle_steps) return {};
  group.lacking += share * waves.field().front();
  return group;
}

/// Gives the waves that the rays of a group do not hold to others: to the group that has the other
/// shares of these rays, and to rays of groups near in cycles. The sum then stays that of the waves
/// whichever rays were found, and nothing jumps where a ray leaves a group.
/// \param groups  of terms 0, 1, …, and last that of the flat waves   \param flat  cycles of these
void hand_on(std::vector<WaveGroup>& groups, double flat) {
  constexpr double nearness = 8.0;  // a group one cycle off is given 4e-3 of what one beside it is
  constexpr double by_rays = 1000.0;  // what a ray in both counts against a group beside it
  const std::size_t last = groups.size() - 1;
  std::vector<std::size_t> holders;
  std::vector<Complex> kept;
  for (std::size_t i = 0; i <= last; ++i) {
    if (groups[i].held > 0.0) holders.push_back(i);
    kept.push_back(groups[i].held * groups[i].lacking);
  }
  const auto claim = [&](std::size_t i, std::size_t j) {
    const auto cycles = [&](std::size_t k) { return k < last ? double(k) : flat; };
    if (i == j) return 0.0;
    const double both = j == last ? groups[i].shared : i == last ? groups[j].shared : 0.0;
    return groups[j].held * std::pow(1.0 + std::abs(cycles(i) - cycles(j)), -nearness) +
           by_rays * both;
  };
  for (std::size_t i = 0; i <= last; ++i) {
    const Complex given = (1.0 - groups[i].held) * groups[i].lacking;
    if (given == 0.0) continue;
    double claims = 0.0;
    for (const std::size_t j : holders) claims += claim(i, j);
    for (const std::size_t j : holders)
      if (claims > 0.0) kept[j] += claim(i, j) / claims * given;
    if (!(claims > 0.0)) kept[i] += given;
  }
  for (std::size_t i = 0; i <= last; ++i) groups[i].lacking = kept[i];
}

/// Groups by cycles.   \param bottom_held  whether what no ray carries in the water alone is taken
/// from them, so that they hold all that the bottom does to it
std::vector<WaveGroup> cycle_groups(const FoundLeg& leg, const CyclesKeeper& keeper,
                                    bool& bottom_held) {
  const auto& [ocean, source_depth, receiver_depth, range, frequency, limits, found] = leg;
  // Of oceans whose boundaries return nothing where rays must not touch them so often; received at
  // the lower end, so that the way there and the way back have the same.
  const double furthest = furthest_in_step(range);
  const double upper = leg.upper(), lower = leg.lower();
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
  const double omega = leg.omega();
  const double steepest =
      omega * std::cos(limits.max_launch_angle) / ocean.water.at(source_depth).c;
  if (!plain->affordable() || steepest > plain->window().begin) return {};

  const auto term_of = [&](const Arrival& ray) { return plain->term_of(leg.from_upper(ray)); };
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
  std::vector<double> left_out;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool judged =
        found[i].kind != ArrivalKind::diffracted && std::norm(found[i].amplitude) > 0.0;
    left_out.push_back(judged ? 1.0 - weights[i] : 0.0);
  }
  std::vector<WaveGroup> all{skimming_group(leg, true, left_out),
                             skimming_group(leg, false, left_out)};
  if (last < 0) return all;
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
    if (!waterborne && !bottom) {
      here.lacking -= waves_without(surface, true, number);
      bottom_held = true;
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Arrival& ray = found[i];
      const double cycled = plain->cycled(omega * ray.horizontal_slowness);
      const double share = flat ? 1.0 - cycled : cycled, weight = weights[i] * share;
      if (weight < least_weight || (!flat && term_of(ray) != int(number)) ||
          (surface && ray.surface_bounces > 0) || (bottom && ray.bottom_bounces > 0))
        continue;
      here.add(i, weight, pressure(ray, frequency));
      here.held = std::max(here.held, std::min(1.0, share / held_alone));
      if (!flat) here.shared += share * (1.0 - share);
    }
    return here;
  };
  std::vector<WaveGroup> groups;
  // A term has as many turns at either side, or one more.
  for (int term = 0; term < int(count); ++term)
    groups.push_back(group_of(std::size_t(term), term + 1));
  groups.push_back(group_of(count, flat_cycles));
  hand_on(groups, flat_cycles);
  std::move(groups.begin(), groups.end(), std::back_inserter(all));
  return all;
}

/// Amplitudes of rays by the waves of their own histories, where those are resolved.
/// \param errors  of reflection: what a history lacks is shared by them, and they are mended
std::vector<Complex> branch_amplitudes(const FoundLeg& leg, const BranchWaves& waves,
                                       std::vector<RayError>& errors) {
  std::map<std::pair<int, int>, WaveGroup> groups;
  int cycles = 0;
  std::vector<Complex> amplitudes;
  const double k = leg.omega() / leg.ocean.water.at(leg.source_depth).c;
  for (std::size_t i = 0; i < leg.found.size(); ++i) {
    const Arrival& ray = leg.found[i];
    amplitudes.push_back(ray.amplitude);
    const double wavenumber = leg.omega() * ray.horizontal_slowness, zone = fresnel_zone(ray, k);
    if (ray.kind == ArrivalKind::diffracted || !(std::norm(ray.amplitude) > 0.0) ||
        !(waves.share(wavenumber - zone) > resolved && waves.share(wavenumber + zone) > resolved))
      continue;
    const auto [kind, n] =
        waves.place_of(leg.from_upper(ray), wavenumber, ray.upper_turns > 0, ray.lower_turns > 0);
    groups[{kind, n}].add(i, waves.share(wavenumber), pressure(ray, leg.frequency));
    cycles = std::max(cycles, n);
  }
  const auto pressures = waves.pressures(leg.range, cycles);
  for (const auto& [place, group] : groups) {
    const Complex lacking =
        group.lacking + pressures[std::size_t(place.first)][std::size_t(place.second)];
    double all = 0.0;
    for (const std::size_t i : group.rays)
      all += errors[i].reflecting * errors[i].reflecting * std::norm(leg.found[i].amplitude);
    for (const std::size_t i : group.rays) {
      if (!(errors[i].reflecting > 0.0)) continue;
      const double share =
          errors[i].reflecting * errors[i].reflecting * std::norm(leg.found[i].amplitude) / all;
      amplitudes[i] += share * lacking * std::conj(turned(leg.found[i], leg.frequency));
      errors[i].focusing = std::min(errors[i].focusing, of_a_wave);
    }
  }
  return amplitudes;
}

/// Gives rays other amplitudes, but for those that hardly change. \param energy  of all
void replace(const std::vector<Complex>& amplitudes, double energy, Arrivals& found) {
  for (std::size_t i = 0; i < found.size(); ++i)
    if (std::norm(amplitudes[i] - found[i].amplitude) > least_change * least_change * energy)
      make_wave(found[i], amplitudes[i] / found[i].amplitude);
}

}  // namespace

bool put_waves(const EigenraySolver& solver, double source_depth, double receiver_depth,
               double range, double frequency, const PathLimits& limits, Arrivals& found,
               const CyclesKeeper& keeper, const BranchKeeper& branches) {
  const Environment& ocean = solver.environment();
  if (!(range > 0.0)) return false;
  std::vector<RayError> errors =
      ray_errors(solver, source_depth, receiver_depth, frequency, limits, found);
  double energy = 0.0, wrong = 0.0, reflected = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::min(1.0, errors[i].focusing + errors[i].turning),
                 power = std::norm(found[i].amplitude);
    energy += power;
    wrong += power * error * error;
    reflected += power * errors[i].reflecting * errors[i].reflecting;
  }
  const bool by_cycles = wrong > tolerable_error * tolerable_error * energy;
  // Up to twice that error waves of each history fade in: nothing jumps where they begin to do.
  // A history that turns in the water holds rays off the boundaries as well, seconds apart, so that
  // what it lacks cannot be told from the others': then rays keep the reflection of plane waves.
  const bool turned = std::any_of(found.begin(), found.end(), [](const Arrival& ray) {
    return std::norm(ray.amplitude) > 0.0 && ray.upper_turns + ray.lower_turns > 0;
  });
  const double faded =
      turned ? 0.0 : faded_in(std::sqrt(reflected / energy) / tolerable_error - 1.0);
  if (!by_cycles && !(faded > 0.0)) return false;

  const FoundLeg leg{ocean, source_depth, receiver_depth, range, frequency, limits, found};
  if (faded > 0.0) {
    const BranchNeed need = branch_need(ocean, leg.upper(), leg.lower(), range, frequency, found);
    const auto make = [&] { return std::make_shared<BranchWaves>(ocean, need); };
    const std::shared_ptr<const BranchWaves> waves = branches ? branches(need, make) : make();
    if (waves->affordable()) {
      std::vector<Complex> amplitudes = branch_amplitudes(leg, *waves, errors);
      for (std::size_t i = 0; i < found.size(); ++i)
        amplitudes[i] = (1.0 - faded) * found[i].amplitude + faded * amplitudes[i];
      replace(amplitudes, energy, found);
    }
  }
  if (!by_cycles) return false;
  std::vector<Complex> amplitudes;
  for (const Arrival& ray : found) amplitudes.push_back(ray.amplitude);
  bool bottom_held = false;
  for (const WaveGroup& group : cycle_groups(leg, keeper, bottom_held))
    share(group, found, errors, frequency, amplitudes);
  replace(amplitudes, energy, found);
  return bottom_held;
}

}  // namespace asdic::detail
