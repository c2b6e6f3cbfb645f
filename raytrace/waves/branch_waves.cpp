#include "raytrace/waves/branch_waves.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/waves/waterborne.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr std::array steepest_cosines = {0.9, 0.8, 0.65, 0.5};  // at the source, of windows
constexpr double branch_edge_radians = 100.0;  // that the window's edges hold at the furthest range
constexpr double noticed_radians = 1.0;        // at the furthest range, of a slope beside an end
constexpr double one_at_an_end = 2.0,
                 two_at_an_end = 6.0;      // Airy's argument at an end: up and down are two
constexpr double least_summed = 1e-8;      // of a wavenumber that is summed
constexpr double floor_layers = 10.0;      // as dear as a floor's reflection
constexpr double faintest_counted = 1e-3;  // of the loudest ray, whose angle waves have

double fade_in(double x) { return 0.5 * std::erfc(-4.0 * (2.0 * x - 1.0)); }

/// No wavenumbers where its edges do not fit.
WaterWindow branch_window(double steepest, double flattest, double range, double period) {
  WaterWindow w;
  w.spacing = 2.0 * pi / period;
  w.offset = suppressed_by_a_period / period;
  w.low_width = w.high_width = branch_edge_radians / range;
  w.begin = steepest - w.low_width;
  w.end = flattest + w.high_width;
  if (w.begin > 0.0) w.count = std::size_t((w.end - w.begin) / w.spacing);
  return w;
}

}  // namespace

double BranchWaves::End::resolved(double wavenumber) const noexcept {
  return noticed ? fade_in((airy(wavenumber) - one_at_an_end) / (two_at_an_end - one_at_an_end))
                 : 1.0;
}

bool BranchWaves::End::is_level(double wavenumber) const noexcept {
  return !noticed && slope != 0.0 && airy(wavenumber) < one_at_an_end;
}

double BranchWaves::End::airy(double wavenumber) const noexcept {
  return (k2 - wavenumber * wavenumber) / std::cbrt(slope * slope);
}

BranchWaves::BranchWaves(const Environment& ocean, const BranchNeed& need) {
  const WaveColumn column(ocean, need.frequency, need.upper, std::span(&need.lower, 1));
  window_ = branch_window(need.steepest, column.largest_wavenumber(), need.furthest,
                          column.ranges_of_a_period() * need.furthest);
  k2_ = {column.at_source(), column.at_receiver()};
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    // Phase that Airy's length adds over the whole way [rad].
    const double k2 = k2_[i].k2.real(), slope = k2_[i].slope;
    const double turned = std::cbrt(slope * slope) / std::sqrt(k2) * need.furthest;
    ends_[i] = {k2, slope, turned > noticed_radians};
  }
  const double layers = double(column.layers()) + floor_layers;
  if (layers * double(window_.count) > most_cycle_steps) return;
  kernels_.resize(window_.count);
  constexpr std::size_t piece = 16;
  in_parallel_chunks(window_.count, piece, [&](std::size_t begin, std::size_t end) {
    stop_point();
    for (std::size_t j = begin; j < end; j += DepthWaves::count) {
      const Wavenumbers xi(std::min(DepthWaves::count, end - j),
                           [&](std::size_t lane) { return window_.at(j + lane); });
      const auto solutions = column.solutions(xi);
      for (std::size_t l = 0; l < xi.used; ++l) {
        Kernel& k = kernels_[j + l] = kernel(solutions[l], xi.xi[l]);
        for (Complex& part : k.first) part *= window_.factor(xi.xi[l]);
      }
    }
  });
}

std::size_t BranchWaves::bytes() const noexcept {
  return sizeof *this + kernels_.size() * sizeof(Kernel);
}

double BranchWaves::share(double wavenumber) const noexcept {
  return window_.weight(wavenumber) * ends_[0].resolved(wavenumber) * ends_[1].resolved(wavenumber);
}

BranchWaves::Kernel BranchWaves::kernel(const WaveColumn::AtDepths& at, Complex xi) const noexcept {
  const double share = ends_[0].resolved(xi.real()) * ends_[1].resolved(xi.real());
  if (share < least_summed) return {};
  const DepthWave &u = at.source.above, &v = at.source.below, &v_lower = at.receiver.below;
  const auto travelling = [&](std::size_t end) {
    return travelling_waves(k2_[end].k2 - xi * xi, ends_[end].noticed ? ends_[end].slope : 0.0);
  };
  const TravellingWaves here = travelling(0), there = travelling(1);
  const auto both = [](const TravellingWaves& wave) {
    return wronskian(wave.up, wave.up_slope, wave.down, wave.down_slope);
  };
  const auto up_in = [](const TravellingWaves& wave, const DepthWave& w) {
    return wronskian(w.u, w.du, wave.down, wave.down_slope);
  };
  const auto down_in = [](const TravellingWaves& wave, const DepthWave& w) {
    return wronskian(wave.up, wave.up_slope, w.u, w.du);
  };
  const Complex above = down_in(here, u) / up_in(here, u),
                below = up_in(here, v) / down_in(here, v),
                below_lower = up_in(there, v_lower) / down_in(there, v_lower);
  const Complex passed = down_in(there, v_lower) / both(there) * both(here) / down_in(here, v) *
                         std::exp(std::min(v_lower.growth - v.growth, 100.0));
  const Complex scale = -2.0 * share * passed / both(here);
  const Complex left_up = above * here.down, arrives_up = below_lower * there.up;
  return {{scale * here.up * there.down, scale * left_up * there.down, scale * here.up * arrives_up,
           scale * left_up * arrives_up},
          above * below};
}

std::array<std::vector<Complex>, 4> BranchWaves::pressures(double range, int cycles) const {
  std::array<std::vector<Complex>, 4> sums;
  for (std::vector<Complex>& sum : sums) sum.resize(std::size_t(cycles) + 1);
  const std::vector<Complex> factors = window_.factors(range);
  for (std::size_t j = 0; j < kernels_.size(); ++j) {
    const Kernel& k = kernels_[j];
    const Complex f = factors[j];
    for (std::size_t kind = 0; kind < sums.size(); ++kind) {
      Complex term = f * k.first[kind];
      for (Complex& sum : sums[kind]) sum += term, term *= k.cycle;
    }
  }
  return sums;
}

BranchWaves::Place BranchWaves::place_of(Branch from_upper, double wavenumber, bool turns_above,
                                         bool turns_below) const noexcept {
  const auto turns_at_once = [&](const End& end, bool upward) {
    return from_upper.vertices > 0 && (upward ? turns_above : turns_below) &&
           end.is_level(wavenumber);
  };
  // Waves that do not notice the gradient go straight on.
  if (turns_at_once(ends_[0], from_upper.starts_up))
    from_upper = {.starts_up = !from_upper.starts_up, .vertices = from_upper.vertices - 1};
  if (turns_at_once(ends_[1], !from_upper.arrives_upward())) --from_upper.vertices;
  const int kind = (from_upper.starts_up ? 1 : 0) + (from_upper.arrives_upward() ? 2 : 0);
  const int vertices = kind == 0 ? 0 : kind == 3 ? 2 : 1;  // without a cycle
  return {kind, (from_upper.vertices - vertices) / 2};
}

BranchNeed branch_need(const Environment& ocean, double upper, double lower, double range,
                       double frequency, const Arrivals& rays) {
  double loudest = 0.0, steepest = infinity;  // a wavenumber
  for (const Arrival& ray : rays) loudest = std::max(loudest, std::norm(ray.amplitude));
  const double omega = 2.0 * pi * frequency;
  for (const Arrival& ray : rays)
    if (std::norm(ray.amplitude) > faintest_counted * faintest_counted * loudest)
      steepest = std::min(steepest, omega * ray.horizontal_slowness);
  const double k = omega / ocean.water.at(upper).c, zone = std::sqrt(2.0 * k / range);
  const auto chosen = std::find_if(steepest_cosines.begin(), steepest_cosines.end(),
                                   [&](double cosine) { return cosine * k < steepest - zone; });
  return {.upper = upper,
          .lower = lower,
          .frequency = frequency,
          .furthest = furthest_in_step(range),
          .steepest = k * (chosen == steepest_cosines.end() ? steepest_cosines.back() : *chosen)};
}

}  // namespace asdic::detail
