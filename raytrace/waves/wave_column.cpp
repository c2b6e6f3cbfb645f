#include "raytrace/waves/wave_column.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/units.h"
#include "raytrace/ocean/layered_floor.h"
#include "raytrace/ocean/reflection_formulas.h"
#include "raytrace/waves/interface_wave.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double turn_phase = 0.002;  // that a layer may be off by where a wave turns in it [rad]
constexpr double thinnest = 0.01;     // layer of our own making [m]
constexpr double beyond_decay =
    40.0;  // there and back again 700 dB: what is beyond is nothing [Np]
constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// Of (ω/c)².
struct Derivatives {
  double first, second;
};
Derivatives derivatives(const SoundSpeed& at, double omega) {
  const double k2 = omega * omega / (at.c * at.c), g = at.dc_dz / at.c;
  return {-2.0 * k2 * g, k2 * (6.0 * g * g - 2.0 * at.d2c_dz2 / at.c)};
}

/// How thick a layer may be in which (ω/c)² bends as it does here: what the line leaves out,
/// k2″h²/12·P₂, turns the phase by it times h/(2w), w² = k2′h or, at an extremum, k2″h²/8.
double thickness_at(const SoundSpeed& at, double omega) {
  const Derivatives k2 = derivatives(at, omega);
  const double bend = std::abs(k2.second);
  if (!(bend > 0.0)) return std::numeric_limits<double>::infinity();
  const double sloping = std::pow(24.0 * turn_phase * std::sqrt(std::abs(k2.first)) / bend, 0.4);
  const double level = std::sqrt(8.5 * turn_phase / std::sqrt(bend));
  return std::max({sloping, level, thinnest});
}

struct ReflectionAt {
  const Boundary& boundary;
  const WaterAtBoundary& water;
  reflection::Grazing<Complex> grazing;

  Complex operator()(const Vacuum& /*vacuum*/) const { return -1.0; }
  Complex operator()(const Rigid& /*rigid*/) const { return 1.0; }
  Complex operator()(const FluidHalfSpace& fluid) const {
    return reflection::coefficient(fluid, grazing, water);
  }
  Complex operator()(const ElasticHalfSpace& solid) const {
    return reflection::coefficient(solid, grazing, water);
  }
  Complex operator()(const LayeredFloor& floor) const {
    return layered_reflection(floor, grazing.cosine, water);
  }
  Complex operator()(const ReflectionTable& /*table*/) const { return continued(); }
  Complex operator()(const ReflectionCurves& /*curves*/) const { return continued(); }

 private:
  /// A table's R = m·e^{iφ}, with lines m and φ of real angles θ, at complex ones:
  /// (m + m′·i·Im θ)·e^{iφ − φ′·Im θ}. Integrals above the real axis grow by up to e⁶ with
  /// range, and whatever is not analytic in R with them.
  Complex continued() const {
    constexpr double step = 1e-6;        // [rad]
    constexpr double most_growth = 1.0;  // of a wave along the boundary, whose angle is imaginary
    const Complex angle =
        Complex(0.0, -1.0) * std::log(grazing.cosine + Complex(0.0, 1.0) * grazing.sine);
    const double real = std::clamp(angle.real(), 0.0, 0.5 * pi - step), imaginary = angle.imag();
    const Complex here = reflection_coefficient(boundary.material, real, water),
                  next = reflection_coefficient(boundary.material, real + step, water);
    if (here == 0.0 || next == 0.0) return here;
    const double size = std::abs(here), slope = (std::abs(next) - size) / step,
                 turn = std::arg(next / here) / step;
    return here * Complex(1.0, slope / size * imaginary) *
           std::exp(std::min(-turn * imaginary, most_growth));
  }
};

/// The wave beside a boundary, its derivative away from it: one wave comes in and R goes back.
DepthWave wave_at(const Boundary& boundary, const WaterAtBoundary& water, double omega, Complex xi,
                  Complex q) {
  const Complex w = vertical_wavenumber(q);
  const Complex r = reflection_at(boundary, water, omega, xi, w);
  return {.u = 1.0 + r, .du = Complex(0.0, 1.0) * w * (1.0 - r)};
}

}  // namespace

Complex reflection_at(const Boundary& boundary, const WaterAtBoundary& water, double omega,
                      Complex xi, Complex w) noexcept {
  const double k = omega / water.speed;
  const ReflectionAt behind{boundary, water, {w / k, xi / k}};
  const Complex r = std::visit(behind, boundary.material);
  if (boundary.roughness.smooth()) return r;
  return r * coherent_reflection(boundary.roughness, std::abs((w / k).real()), k);
}

double WaveColumn::ranges_of_a_period() const noexcept {
  const auto tabulated = [](const Boundary& boundary) {
    const auto* table = std::get_if<ReflectionTable>(&boundary.material);
    return std::holds_alternative<ReflectionCurves>(boundary.material) ||
           (table &&
            (std::ranges::count(table->magnitude, table->magnitude.front()) !=
                 std::ssize(table->magnitude) ||
             std::ranges::count(table->phase, table->phase.front()) != std::ssize(table->phase)));
  };
  return tabulated(environment_.surface) || tabulated(environment_.bottom) ? 6.0 : 1.5;
}

double WaveColumn::slowest_wavenumber() const {
  double found = largest_;
  for (const Boundary* boundary : {&environment_.surface, &environment_.bottom}) {
    double nearest = infinity;
    for (const std::size_t receiver : edge_of_)
      if (receiver < edges_.size())
        nearest = std::min(nearest, std::abs(edges_[receiver] - boundary->depth));
    const double away = std::abs(edges_[source_edge_] - boundary->depth) + nearest;
    for (const InterfaceWave& wave : interface_waves(environment_, *boundary, frequency_, away))
      found = std::max(found, wave.wavenumber.real());
  }
  return found;
}

WaveColumn::WaveColumn(const Environment& environment, double frequency, double source_depth,
                       std::span<const double> receivers)
    : environment_(environment),
      frequency_(frequency),
      omega_(2.0 * pi * frequency),
      loss_(attenuation_np_per_m(environment, frequency)) {
  const double top = environment.surface.depth, bottom = environment.bottom.depth;
  std::vector<double> cuts = {top, bottom, source_depth};
  const auto inside = [&](double z) { return z >= top && z <= bottom; };
  for (const double z : environment.water.depths())
    if (inside(z)) cuts.push_back(z);
  for (const double z : receivers)
    if (inside(z)) cuts.push_back(z);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  edges_.push_back(top);
  for (std::size_t i = 1; i < cuts.size(); ++i) cut(cuts[i - 1], cuts[i], omega_);
  const auto edge = [&](double z) {
    return std::size_t(std::lower_bound(edges_.begin(), edges_.end(), z) - edges_.begin());
  };
  source_edge_ = edge(source_depth);
  for (const double z : receivers) edge_of_.push_back(inside(z) ? edge(z) : none);
  order_.resize(receivers.size());
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return edge_of_[a] < edge_of_[b]; });
  while (!order_.empty() && edge_of_[order_.back()] == none) order_.pop_back();
  if (!edge_of_.empty() && edge_of_.front() != none) slowest_edge_ = slowest_edge();
  find_wavenumbers();
}

WaveColumn::WaveColumn(const Environment& environment, double frequency, double cut_for)
    : environment_(environment),
      frequency_(frequency),
      omega_(2.0 * pi * frequency),
      loss_(attenuation_np_per_m(environment, frequency)) {
  const double top = environment.surface.depth, bottom = environment.bottom.depth;
  std::vector<double> cuts = {top, bottom};
  for (const double z : environment.water.depths())
    if (z > top && z < bottom) cuts.push_back(z);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  edges_.push_back(top);
  for (std::size_t i = 1; i < cuts.size(); ++i) cut(cuts[i - 1], cuts[i], 2.0 * pi * cut_for);
  find_wavenumbers();
}

void WaveColumn::find_wavenumbers() {
  largest_ = 0.0;
  smallest_ = std::numeric_limits<double>::infinity();
  for (const double z : edges_) {
    const double k = omega_ / environment_.water.at(z).c;
    largest_ = std::max(largest_, k);
    smallest_ = std::min(smallest_, k);
  }
}

void WaveColumn::cut(double from, double to, double omega) {
  double z = from;
  while (z < to) {
    // Just inside, where the law of this piece holds.
    const auto at = [&](double depth) {
      const double margin = 1e-9 * (to - from);
      return environment_.water.at(std::clamp(depth, from + margin, to - margin));
    };
    double h = thickness_at(at(z), omega);
    h = std::min({h, to - z, thickness_at(at(z + std::min(h, to - z)), omega)});
    const double next = z + 1.01 * h >= to ? to : z + h;
    layers_.push_back(layer(z, next));
    edges_.push_back(next);
    z = next;
  }
}

WaveLayer WaveColumn::layer(double from, double to) const noexcept {
  // The line that has the mean and the first moment, by Gauss and Legendre's three points.
  constexpr double node = 0.7745966692414834, weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  Complex mean = 0.0, slope = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double x = node * (i - 1), z = middle + half * x;
    const Complex k(omega_ / environment_.water.at(z).c, -loss_.at(z));
    mean += weight[i] * k * k;
    slope += 3.0 * weight[i] * x * k * k;
  }
  return {.thickness = to - from, .k2 = {mean - slope, mean + slope}};
}

DepthWave WaveColumn::beside(const Boundary& boundary, Complex xi, Complex k2) const noexcept {
  const WaterAtBoundary water{.speed = environment_.water.at(boundary.depth).c,
                              .density = environment_.water_density.at(boundary.depth),
                              .frequency = frequency_};
  return wave_at(boundary, water, omega_, xi, k2 - xi * xi);
}

WaveColumn::Squared WaveColumn::squared(std::size_t edge) const noexcept {
  const auto slope = [](const WaveLayer& l) { return (l.k2[1] - l.k2[0]).real() / l.thickness; };
  if (edge == 0) return {layers_.front().k2[0], slope(layers_.front())};
  if (edge == layers_.size()) return {layers_.back().k2[1], slope(layers_.back())};
  const WaveLayer &above = layers_[edge - 1], &below = layers_[edge];
  return {0.5 * (above.k2[1] + below.k2[0]), 0.5 * (slope(above) + slope(below))};
}

std::size_t WaveColumn::slowest_edge() const noexcept {
  // The water's own speeds: layers' lines are off by more than those of depths 0.1 mm apart differ.
  const auto slower = [&](std::size_t a, std::size_t than) {
    const auto speed = [&](std::size_t edge) { return environment_.water.at(edges_[edge]).c; };
    return speed(a) < speed(than) * (1.0 + 1e-12);
  };
  const auto [first, last] = std::minmax(source_edge_, edge_of_.front());
  std::size_t edge = first;
  for (std::size_t e = first + 1; e <= last; ++e)
    if (slower(e, edge)) edge = e;
  const std::size_t between = edge;
  while (edge + 1 < edges_.size() && slower(edge + 1, edge)) ++edge;
  if (edge != between) return edge;
  while (edge > 0 && slower(edge - 1, edge)) --edge;
  return edge;
}

namespace {

/// Waves of several wavenumbers, each with the edge from which it is followed.
class Starts {
 public:
  /// \param start  gives the wave of a wavenumber and moves the edge to where it starts
  template <class Start>
  Starts(const Wavenumbers& xi, std::size_t edge, const Start& start) {
    for (std::size_t l = 0; l < DepthWaves::count; ++l) {
      edges_[l] = l < xi.used ? edge : edges_[0];
      waves_[l] = l < xi.used ? start(xi.xi[l], edges_[l]) : waves_[0];
    }
  }
  [[nodiscard]] std::size_t uppermost() const { return std::ranges::min(edges_); }
  [[nodiscard]] std::size_t lowest() const { return std::ranges::max(edges_); }
  /// Puts in the waves that start at an edge.
  void put(std::size_t edge, DepthWaves& into) const {
    for (std::size_t l = 0; l < DepthWaves::count; ++l)
      if (edges_[l] == edge) into.set(l, waves_[l]);
  }

 private:
  std::array<std::size_t, DepthWaves::count> edges_;
  std::array<DepthWave, DepthWaves::count> waves_;
};

}  // namespace

template <class Keep>
void WaveColumn::follow_down(const Wavenumbers& xi, std::size_t first, std::size_t last,
                             Keep&& keep) const {
  const Starts starts(xi, first,
                      [&](Complex one, std::size_t& edge) { return upper_start(one, edge); });
  DepthWaves waves;
  for (std::size_t edge = starts.uppermost();; ++edge) {
    starts.put(edge, waves);
    if (edge >= first) keep(edge, waves);
    if (edge == last) return;
    follow(waves, xi, layers_[edge].k2[0], layers_[edge].k2[1], layers_[edge].thickness);
  }
}

template <class Keep>
void WaveColumn::follow_up(const Wavenumbers& xi, std::size_t first, std::size_t last,
                           Keep&& keep) const {
  const Starts starts(xi, first,
                      [&](Complex one, std::size_t& edge) { return lower_start(one, edge); });
  DepthWaves waves;
  for (std::size_t edge = starts.lowest();; --edge) {
    starts.put(edge, waves);
    if (edge <= first) keep(edge, waves);
    if (edge == last) return;
    const WaveLayer& layer = layers_[edge - 1];
    follow(waves, xi, layer.k2[1], layer.k2[0], layer.thickness);
  }
}

std::array<WaveColumn::AtDepths, DepthWaves::count> WaveColumn::solutions(
    const Wavenumbers& xi) const noexcept {
  const std::size_t receiver_edge = edge_of_.front();
  const auto [first, last] = std::minmax({source_edge_, receiver_edge, slowest_edge_});
  std::array<AtDepths, DepthWaves::count> at;
  const auto keep = [&](std::size_t edge, const DepthWaves& waves, DepthWave Solutions::*side,
                        double slope) {
    if (edge != source_edge_ && edge != receiver_edge && edge != slowest_edge_) return;
    for (std::size_t l = 0; l < DepthWaves::count; ++l) {
      DepthWave wave = waves.get(l);
      wave.du *= slope;
      if (edge == source_edge_) at[l].source.*side = wave;
      if (edge == receiver_edge) at[l].receiver.*side = wave;
      if (edge == slowest_edge_) at[l].slowest.*side = wave;
    }
  };
  follow_down(xi, first, last, [&](std::size_t edge, const DepthWaves& waves) {
    keep(edge, waves, &Solutions::above, 1.0);
  });
  follow_up(xi, last, first, [&](std::size_t edge, const DepthWaves& waves) {
    keep(edge, waves, &Solutions::below, -1.0);
  });
  return at;
}

double WaveColumn::returned_by_the_water(double xi) const noexcept {
  const auto waves_at = [&](Complex k2, const WaveLayer& layer) {
    return travelling_waves(k2 - xi * xi, ((layer.k2[1] - layer.k2[0]) / layer.thickness).real());
  };
  const TravellingWaves top = waves_at(layers_.front().k2[0], layers_.front());
  DepthWave wave{.u = top.up, .du = top.up_slope};
  for (const WaveLayer& l : layers_)
    follow(wave, l.k2[0] - xi * xi, l.k2[1] - xi * xi, l.thickness);
  const TravellingWaves out = waves_at(layers_.back().k2[1], layers_.back());
  // u = a·(up + R·down)
  return std::abs(wronskian(out.up, out.up_slope, wave.u, wave.du) /
                  wronskian(wave.u, wave.du, out.down, out.down_slope));
}

/// Whether a wave dies out in a layer. \param decay  is added to, a bound from below [Np]
bool WaveColumn::fades(std::size_t layer, double xi, double& decay) const noexcept {
  const WaveLayer& l = layers_[layer];
  const double least = xi * xi - std::max(l.k2[0].real(), l.k2[1].real());
  if (least > 0.0) decay += l.thickness * std::sqrt(least);
  return least > 0.0;
}

DepthWave WaveColumn::upper_start(Complex xi, std::size_t& edge) const noexcept {
  for (double decay = 0.0; edge > 0 && decay < beyond_decay; --edge)
    if (!fades(edge - 1, xi.real(), decay)) decay = 0.0;
  if (edge == 0) return beside(environment_.surface, xi, layers_.front().k2[0]);
  return {1.0, Complex(0.0, 1.0) * vertical_wavenumber(layers_[edge].k2[0] - xi * xi)};
}

DepthWave WaveColumn::lower_start(Complex xi, std::size_t& edge) const noexcept {
  for (double decay = 0.0; edge < layers_.size() && decay < beyond_decay; ++edge)
    if (!fades(edge, xi.real(), decay)) decay = 0.0;
  if (edge == layers_.size()) return beside(environment_.bottom, xi, layers_.back().k2[1]);
  return {1.0, Complex(0.0, 1.0) * vertical_wavenumber(layers_[edge].k2[0] - xi * xi)};
}

DepthWaves WaveColumn::above(const Wavenumbers& xi, std::size_t edge) const noexcept {
  DepthWaves found;
  follow_down(xi, edge, edge, [&](std::size_t, const DepthWaves& waves) { found = waves; });
  return found;
}

DepthWaves WaveColumn::below(const Wavenumbers& xi, std::size_t edge) const noexcept {
  DepthWaves found;
  follow_up(xi, edge, edge, [&](std::size_t, const DepthWaves& waves) { found = waves; });
  return found;
}

std::size_t WaveColumn::layer_at(double depth) const noexcept {
  const auto next = std::upper_bound(edges_.begin(), edges_.end(), depth);
  const auto edge = std::max<std::ptrdiff_t>(next - edges_.begin() - 1, 0);
  return std::min(std::size_t(edge), layers_.size() - 1);
}

void WaveColumn::descend(DepthWaves& waves, const Wavenumbers& xi, std::size_t edge,
                         double depth) const {
  for (; edge < layers_.size() && edges_[edge] < depth; ++edge) {
    const WaveLayer& layer = layers_[edge];
    const double down = std::min(depth - edges_[edge], layer.thickness);
    const Complex slope = (layer.k2[1] - layer.k2[0]) / layer.thickness;
    follow(waves, xi, layer.k2[0], layer.k2[0] + slope * down, down);
  }
}

void WaveColumn::ascend(DepthWaves& waves, const Wavenumbers& xi, std::size_t edge,
                        double depth) const {
  for (; edge > 0 && edges_[edge] > depth; --edge) {
    const WaveLayer& layer = layers_[edge - 1];
    const double up = std::min(edges_[edge] - depth, layer.thickness);
    const Complex slope = (layer.k2[1] - layer.k2[0]) / layer.thickness;
    follow(waves, xi, layer.k2[1], layer.k2[1] - slope * up, up);
  }
}

void WaveColumn::kernels(const Wavenumbers& xi, std::span<double> growth,
                         std::span<Complex> g) const noexcept {
  const std::size_t n = edge_of_.size();
  std::fill(g.begin(), g.end(), 0.0);
  const auto start = [&](const Boundary& boundary, Complex k2) {
    DepthWaves waves;
    for (std::size_t l = 0; l < DepthWaves::count; ++l)
      waves.set(l, l < xi.used ? beside(boundary, xi.xi[l], k2) : waves.get(0));
    return waves;
  };
  const auto put = [&](std::size_t receiver, const DepthWaves& waves) {
    for (std::size_t l = 0; l < xi.used; ++l) {
      g[l * n + receiver] = {waves.u_re[l], waves.u_im[l]};
      growth[l * n + receiver] = waves.growth[l];
    }
  };
  DepthWaves above = start(environment_.surface, layers_.front().k2[0]);
  auto next = order_.begin();
  for (std::size_t edge = 0;; ++edge) {
    for (; next != order_.end() && edge_of_[*next] == edge && edge < source_edge_; ++next)
      put(*next, above);
    if (edge == source_edge_) break;
    const WaveLayer& layer = layers_[edge];
    follow(above, xi, layer.k2[0], layer.k2[1], layer.thickness);
  }
  const auto first_below = next;
  DepthWaves below = start(environment_.bottom, layers_.back().k2[1]);
  auto last = order_.end();
  for (std::size_t edge = layers_.size();; --edge) {
    for (; last != first_below && edge_of_[*(last - 1)] == edge; --last) put(*(last - 1), below);
    if (edge == source_edge_) break;
    const WaveLayer& layer = layers_[edge - 1];
    follow(below, xi, layer.k2[1], layer.k2[0], layer.thickness);
  }
  for (std::size_t l = 0; l < xi.used; ++l) {
    const DepthWave u = above.get(l), v = below.get(l);
    // `below` was followed upwards: its derivative downwards has the other sign.
    const Complex source = -2.0 / (-u.u * v.du - u.du * v.u);
    for (auto it = order_.begin(); it != order_.end(); ++it) {
      const bool over = it < first_below;
      const double grown = growth[l * n + *it] - (over ? u.growth : v.growth);
      g[l * n + *it] *= source * std::exp(std::min(grown, 100.0)) * (over ? v.u : u.u);
    }
  }
}

}  // namespace asdic::detail
