#include "raytrace/waves/wave_integral.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/waves/range_sum.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double near_period = 6.0;      // of the largest range nearby: the sum's start is square
constexpr double near_share = 0.25;      // of the depth of the water
constexpr double near_argument = 640.0;  // or k·r: 60 over the steep launches' share of k
constexpr double steep_cosine[2] = {0.009, 0.105};  // 89.5 and 84 degrees
constexpr double beyond = 0.03;  // of the largest wavenumber, that waves without range are kept
constexpr int leg_nodes = 8;

/// From 0 to 1 between 0 and 1, as smooth as a bell.
double rise(double x) { return 0.5 * std::erfc(-4.0 * (2.0 * x - 1.0)); }

/// Nodes and weights on 0 … 1, Gauss–Legendre.
constexpr std::array<std::array<double, 2>, leg_nodes> leg = {
    {{0.0198550717512319, 0.0506142681451881},
     {0.1016667612931866, 0.1111905172266872},
     {0.2372337950418355, 0.1568533229389436},
     {0.4082826787521751, 0.1813418916891810},
     {0.5917173212478249, 0.1813418916891810},
     {0.7627662049581645, 0.1568533229389436},
     {0.8983332387068134, 0.1111905172266872},
     {0.9801449282487681, 0.0506142681451881}}};

}  // namespace

Complex bessel_j0(Complex z) noexcept {
  if (std::abs(z) < 12.0) {
    const Complex x = -0.25 * z * z;
    Complex term = 1.0, sum = 1.0;
    for (int k = 1; k < 60; ++k) {
      term *= x / double(k * k);
      sum += term;
      if (std::norm(term) < 1e-36 * std::norm(sum)) break;
    }
    return sum;
  }
  // √(2/πz)·(P·cos χ − Q·sin χ), χ = z − π/4
  const Complex y = 1.0 / (8.0 * z), y2 = y * y;
  const Complex p = 1.0 - y2 * (4.5 - y2 * (459.375 - y2 * 150077.8125));
  const Complex q = -y * (1.0 - y2 * (37.5 - y2 * (7441.875 - y2 * 3623307.1875)));
  const Complex chi = z - 0.25 * pi;
  return std::sqrt(2.0 / (pi * z)) * (p * std::cos(chi) - q * std::sin(chi));
}

Complex WaveIntegral::Contour::at(std::size_t j) const noexcept {
  return {(double(first + j) + 0.5) * spacing, offset};
}

double WaveIntegral::Contour::weight(std::size_t j) const noexcept {
  const double s = at(j).real();
  double w = rise((flattest + flat_width - s) / flat_width);
  if (steep_width > 0.0) w *= rise((s - steepest) / steep_width);
  return w;
}

WaveIntegral::WaveIntegral(const WaveColumn& column, std::size_t rows, double depth,
                           std::span<const double> ranges)
    : column_(column), rows_(rows), depth_(depth), ranges_(ranges.begin(), ranges.end()) {
  near_range_ = std::max(near_share * depth, near_argument / column.smallest_wavenumber());
  for (std::size_t i = 0; i < ranges_.size(); ++i)
    (ranges_[i] < near_range_ ? near_columns_ : far_columns_).push_back(i);
  if (!far_columns_.empty()) far_ = far_contour();
  if (!near_columns_.empty()) near_ = near_contour();
}

WaveIntegral::Contour WaveIntegral::far_contour() const {
  const double farthest = *std::max_element(ranges_.begin(), ranges_.end());
  const double k = column_.slowest_wavenumber(), steep = column_.smallest_wavenumber();
  Contour c;
  c.period = column_.ranges_of_a_period() * farthest;
  c.spacing = 2.0 * pi / c.period;
  c.offset = suppressed_by_a_period / c.period;
  c.steepest = steep_cosine[0] * steep;
  c.steep_width = (steep_cosine[1] - steep_cosine[0]) * steep;
  c.flattest = k * 1.0005;
  c.flat_width = std::max(beyond * k, 60.0 / near_range_);
  c.first = std::size_t(c.steepest / c.spacing);
  c.count = std::size_t((c.flattest + c.flat_width) / c.spacing) + 1 - c.first;
  return c;
}

WaveIntegral::Contour WaveIntegral::near_contour() const {
  double nearest = near_range_, farthest = 0.0;
  for (const std::size_t i : near_columns_) {
    nearest = std::min(nearest, ranges_[i]);
    farthest = std::max(farthest, ranges_[i]);
  }
  const double k = column_.slowest_wavenumber();
  Contour c;
  c.period = near_period * std::max(0.5 * depth_, farthest);
  c.spacing = 2.0 * pi / c.period;
  c.offset = suppressed_by_a_period / c.period;
  c.flattest = k;
  c.flat_width = std::clamp(60.0 / std::max(nearest, 1e-3), 0.1 * k, 2.0 * k);
  c.count = std::size_t((c.flattest + c.flat_width) / c.spacing) + 1;
  return c;
}

double WaveIntegral::steps() const noexcept {
  // A product of the direct sum costs a tenth of a layer.
  const double direct = 0.1 * double(near_columns_.size()) * double(rows_);
  return double(far_.count) * double(column_.layers() + rows_) +
         double(near_.count) * (double(column_.layers() + rows_) + direct);
}

double WaveIntegral::bytes() const noexcept {
  const double kernels = 3.0 * double(RangeSum::block) * double(rows_);
  return sizeof(Complex) * (kernels + 2.0 * double(rows_) * double(ranges_.size()));
}

void WaveIntegral::kernels(const Contour& contour, std::size_t first, std::size_t count,
                           std::vector<Complex>& g) const {
  constexpr std::size_t piece = 16;
  in_parallel_chunks(count, piece, [&](std::size_t begin, std::size_t end) {
    std::vector<double> growth(DepthWaves::count * rows_);
    for (std::size_t j = begin; j < end; j += DepthWaves::count) {
      stop_point();
      const Wavenumbers xi(std::min(DepthWaves::count, end - j),
                           [&](std::size_t lane) { return contour.at(first + j + lane); });
      column_.kernels(xi, growth, std::span(g).subspan(j * rows_, xi.used * rows_));
    }
  });
}

void WaveIntegral::add_far(std::vector<Complex>& field,
                           const std::function<void(double)>& done) const {
  constexpr std::size_t block = RangeSum::block;
  std::vector<double> far;
  for (const std::size_t i : far_columns_) far.push_back(ranges_[i]);
  const RangeSum ranges(far_.spacing, far);
  std::vector<Complex> g(block * rows_), phase(far.size());
  for (std::size_t first = 0; first < far_.count; first += block) {
    const std::size_t count = std::min(block, far_.count - first);
    kernels(far_, first, count, g);
    const double middle = far_.at(first + block / 2).real();
    for (std::size_t i = 0; i < far.size(); ++i)
      phase[i] = std::polar(
          0.5 * far_.spacing * std::sqrt(2.0 / (pi * far[i])) * std::exp(far_.offset * far[i]),
          0.25 * pi - std::fmod(middle * far[i], 2.0 * pi));
    in_parallel(rows_, [&](std::size_t row) {
      thread_local RangeSum::Memory memory;
      thread_local std::vector<Complex> a, sum;
      a.assign(block, 0.0);
      sum.resize(far.size());
      for (std::size_t j = 0; j < count; ++j)
        a[j] = far_.weight(first + j) * std::sqrt(far_.at(first + j)) * g[j * rows_ + row];
      ranges.sum(a, memory, sum);
      for (std::size_t i = 0; i < far.size(); ++i)
        field[row * ranges_.size() + far_columns_[i]] += phase[i] * sum[i];
    });
    done(double(count));
  }
}

void WaveIntegral::add_near(std::vector<Complex>& field,
                            const std::function<void(double)>& done) const {
  constexpr std::size_t block = RangeSum::block;
  std::vector<Complex> g(block * rows_);
  const auto add = [&](std::size_t count, const auto& xi_at, const auto& weight_at) {
    in_parallel(near_columns_.size(), [&](std::size_t i) {
      const std::size_t column = near_columns_[i];
      for (std::size_t j = 0; j < count; ++j) {
        const Complex xi = xi_at(j), f = weight_at(j) * xi * bessel_j0(xi * ranges_[column]);
        for (std::size_t row = 0; row < rows_; ++row)
          field[row * ranges_.size() + column] += f * g[j * rows_ + row];
      }
    });
  };
  // up from zero to where the contour begins
  std::vector<double> growth(DepthWaves::count * rows_);
  static_assert(leg.size() == DepthWaves::count);
  const auto leg_xi = [&](std::size_t j) { return Complex(0.0, near_.offset * leg[j][0]); };
  column_.kernels(Wavenumbers(leg.size(), leg_xi), growth, std::span(g).first(leg.size() * rows_));
  add(leg.size(), leg_xi, [&](std::size_t j) { return Complex(0.0, near_.offset * leg[j][1]); });
  for (std::size_t first = 0; first < near_.count; first += block) {
    const std::size_t count = std::min(block, near_.count - first);
    kernels(near_, first, count, g);
    add(
        count, [&](std::size_t j) { return near_.at(first + j); },
        [&](std::size_t j) { return near_.spacing * near_.weight(first + j); });
    done(double(count));
  }
}

std::vector<Complex> WaveIntegral::field(const std::function<bool(double)>& progress) const {
  std::vector<Complex> field(rows_ * ranges_.size());
  double made = 0.0;
  const auto done = [&](double count) {
    made += count;
    if (progress && !progress(made / double(wavenumbers()))) throw Interrupted();
  };
  if (far_.count > 0) add_far(field, done);
  if (near_.count > 0) add_near(field, done);
  return field;
}

}  // namespace asdic::detail
