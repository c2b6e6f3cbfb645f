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

constexpr double flattest_zones = 0.1;  // of the slope that a wave of one Fresnel zone notices
constexpr double behind_turn = 10.0;    // phase behind a turn beyond which there is nothing [rad]

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
  const double widest = std::sqrt(2.0 * column.largest_wavenumber() / furthest);
  least_slope_ = flattest_zones * widest * widest * widest;
  const double upper = (source_is_upper_ ? column.at_source() : column.at_receiver()).slope,
               lower = (source_is_upper_ ? column.at_receiver() : column.at_source()).slope;
  // Across the slowest depth a ray that is horizontal at one end turns before the other, whatever
  // the slopes: in a surface duct above a thermocline, say.
  turns_ = column.slowest_is_between()  ? Turns::between
           : upper > 0.0 && lower > 0.0 ? Turns::above
           : upper < 0.0 && lower < 0.0 ? Turns::below
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
  if (q.real() < 0.0 && std::abs(q * std::sqrt(q)) > 1.5 * behind_turn * std::abs(slope)) {
    const Complex all = -2.0 * uv / wronskian(u.u, u.du, v.u, v.du);
    return {all, 0.0, 0.0, all};
  }
  // Up and down are resolved where all rays are steepest.
  const TravellingWaves wave = travelling_waves(q, slope);
  const Complex both = wronskian(wave.up, wave.up_slope, wave.down, wave.down_slope);
  // u = a·(up + V_u·down), v = d·(down + V_v·up)
  const Complex a = wronskian(u.u, u.du, wave.down, wave.down_slope) / both,
                d = wronskian(wave.up, wave.up_slope, v.u, v.du) / both;
  const Complex above = wronskian(wave.up, wave.up_slope, u.u, u.du) / (both * a),
                below = wronskian(v.u, v.du, wave.down, wave.down_slope) / (both * d);
  const Complex cycle = above * below, scale = -2.0 / both;
  const Complex term = scale * uv / (a * d), all = term / (1.0 - cycle);
  if (turns_ == Turns::between) return {term, term * cycle, cycle, all};
  // What has turned at the one side before both ends, and after: a sum over the others' turns.
  const Complex turned = turns_ == Turns::above
                             ? below * product(over.above, under.above, 2.0 * u.growth) / (a * a)
                             : above * product(over.below, under.below, 2.0 * v.growth) / (d * d);
  const Complex next = scale * turned;
  return {(term - next) / (1.0 - cycle), next, cycle, all};
}

std::vector<Complex> CycleWaves::terms(std::size_t count, double range) const {
  std::vector<Complex> sums(count + 1, 0.0);
  for (std::size_t j = 0; j < kernels_.size(); ++j) {
    const Complex f = window_.factor(window_.at(j), range);
    const Kernel& k = kernels_[j];
    sums[0] += f * k.first;
    Complex term = f * k.next;
    for (std::size_t n = 1; n < count; ++n, term *= k.cycle) sums[n] += term;
    sums[count] += f * k.all;
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

/// Rays of one term.
struct TermRays {
  std::vector<std::size_t> rays;  // of all arrivals
  Complex lacking = 0.0;          // what the term has more than they
};

/// How far the amplitudes of rays may be off, and what share of their waves the window holds.
struct Judged {
  std::vector<RayError> errors;
  std::vector<double> weights;
};

/// The amplitudes of a term's rays so that their sum is the term: of each what is sure of its
/// amplitude, and of what is lacking then a share by how far it may be off. \return [term.rays]
std::vector<Complex> shared_amplitudes(const TermRays& term, const Arrivals& found,
                                       const Judged& judged, double frequency) {
  const auto unsure = [](double error) { return 1.0 - 1.0 / (1.0 + error * error); };
  Complex lacking = term.lacking;
  double all = 0.0;
  std::vector<double> left_out, doubt;
  for (const std::size_t i : term.rays) {
    const RayError& error = judged.errors[i];
    left_out.push_back(judged.weights[i] * unsure(error.focusing));
    lacking += left_out.back() * pressure(found[i], frequency);
    doubt.push_back(judged.weights[i] * std::norm(found[i].amplitude) *
                    unsure(std::max(least_error, error.focusing + error.turning)));
    all += doubt.back();
  }
  std::vector<Complex> amplitudes;
  for (std::size_t n = 0; n < term.rays.size(); ++n) {
    const Arrival& ray = found[term.rays[n]];
    const double share = doubt[n] / all;
    const double turns = std::fmod(frequency * ray.delay, 1.0);
    amplitudes.push_back((1.0 - left_out[n]) * ray.amplitude +
                         share * lacking * std::polar(1.0, 2.0 * pi * turns));
  }
  return amplitudes;
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
  Judged judged{.errors =
                    ray_errors(solver, source_depth, receiver_depth, frequency, limits, found)};
  double energy = 0.0, wrong = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::min(1.0, judged.errors[i].focusing + judged.errors[i].turning);
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
  int first = 0, last = -1;
  bool waterborne = false;
  for (const Arrival& ray : found) {
    waterborne = waterborne || ray.bottom_bounces == 0;
    judged.weights.push_back(plain->window().weight(omega * ray.horizontal_slowness));
    if (judged.weights.back() < least_weight) continue;
    const int term = term_of(ray);
    first = last < 0 ? term : std::min(first, term);
    last = std::max(last, term);
  }
  if (last < 0) return;
  first = std::max(0, first - 1);
  const std::size_t count = std::size_t(last) + 2;
  std::map<std::pair<bool, bool>, std::vector<Complex>> known;
  const auto term_without = [&](bool surface, bool bottom, int term) {
    std::vector<Complex>& there = known[{surface, bottom}];
    if (there.empty()) there = cycles(surface, bottom)->terms(count, range);
    return there[std::size_t(term)];
  };
  std::map<int, TermRays> terms;
  for (int term = first; term < int(count); ++term) {
    // A term has so many turns at either side, or one more.
    const bool surface = no_surface || term + 1 > limits.max_surface_bounces,
               bottom = no_bottom || term + 1 > limits.max_bottom_bounces;
    TermRays& here = terms[term];
    here.lacking = term_without(surface, bottom, term);
    if (!waterborne && !bottom) here.lacking -= term_without(surface, true, term);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Arrival& ray = found[i];
      if (judged.weights[i] < least_weight || !(std::norm(ray.amplitude) > 0.0) ||
          term_of(ray) != term || (surface && ray.surface_bounces > 0) ||
          (bottom && ray.bottom_bounces > 0))
        continue;
      here.rays.push_back(i);
      here.lacking -= judged.weights[i] * pressure(ray, frequency);
    }
  }
  // What there is of a term without rays goes to the next one that has some.
  for (const auto& [term, here] : terms)
    for (const int next : {term - 1, term + 1}) {
      const auto other = terms.find(next);
      if (!here.rays.empty() || other == terms.end() || other->second.rays.empty()) continue;
      other->second.lacking += here.lacking;
      break;
    }
  std::vector<std::pair<std::size_t, Complex>> changed;
  for (const auto& [term, here] : terms) {
    const std::vector<Complex> amplitudes = shared_amplitudes(here, found, judged, frequency);
    for (std::size_t n = 0; n < here.rays.size(); ++n)
      if (std::norm(amplitudes[n] - found[here.rays[n]].amplitude) >
          least_change * least_change * energy)
        changed.emplace_back(here.rays[n], amplitudes[n]);
  }
  for (const auto& [i, amplitude] : changed) make_wave(found[i], amplitude / found[i].amplitude);
}

}  // namespace asdic::detail
