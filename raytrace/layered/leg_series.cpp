#include "raytrace/layered/leg_series.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic {
namespace {

constexpr double range_error = 1e-7, time_error = 1e-13, slope_error = 1e-8;

}  // namespace

LegSeries::LegSeries(const Column& column, double c_ref, double low, double high)
    : middle_(0.5 * (low + high)), per_half_(2.0 / (high - low)) {
  static const auto cosines = [] {  // cos(πk(j + ½)/n)
    std::array<std::array<double, terms>, terms> t{};
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t j = 0; j < terms; ++j)
        t[k][j] = std::cos(pi * double(k) * (double(j) + 0.5) / double(terms));
    return t;
  }();
  for (std::size_t j = 0; j < terms; j += rays_at_once) {
    const RayLanes rays(c_ref, middle_ + load(&cosines[1][j]) / per_half_);
    const ColumnLanes sums = walk_all(column, rays);
    turns_above_ = sums.turns_above;
    turns_below_ = sums.turns_below;
    const LegLanes* legs[3] = {&sums.up, &sums.middle, &sums.down};
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const Rays values[quantities] = {legs[leg]->per_slowness, rays.sigma * legs[leg]->d_range,
                                       legs[leg]->intercept, legs[leg]->length};
      for (std::size_t k = 0; k < terms; ++k) {
        const Rays weight = (k == 0 ? 1.0 : 2.0) / double(terms) * load(&cosines[k][j]);
        for (std::size_t q = 0; q < quantities; ++q)
          series_[q][k][leg] += reduce(weight * values[q]);
      }
    }
  }
  good_ = holds(per_slowness, 1e-15, range_error * c_ref) && holds(d_range, slope_error, 0.0) &&
          holds(intercept, 1e-15, time_error) && holds(length, 1e-15, range_error);
  if (good_) to_polynomials();
}

/// Σ c_k·T_k(x) as Σ a_j·xʲ, with T_{k+1} = 2x·T_k − T_{k−1}.
void LegSeries::to_polynomials() noexcept {
  static const auto chebyshev = [] {  // [k][j]
    std::array<std::array<double, terms>, terms> t{};
    t[0][0] = t[1][1] = 1.0;
    for (std::size_t k = 2; k < terms; ++k)
      for (std::size_t j = 0; j <= k; ++j)
        t[k][j] = (j > 0 ? 2.0 * t[k - 1][j - 1] : 0.0) - t[k - 2][j];
    return t;
  }();
  for (Series& series : series_) {
    Series a{};
    for (std::size_t k = terms; k-- > 0;)  // small terms first
      for (std::size_t j = k % 2; j <= k; j += 2)
        for (std::size_t leg = 0; leg < 3; ++leg) a[j][leg] += chebyshev[k][j] * series[k][leg];
    series = a;
  }
}

bool LegSeries::holds(Quantity of, double relative, double absolute) const noexcept {
  const Series& s = series_[of];
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double tail = std::abs(s[terms - 1][leg]) + std::abs(s[terms - 2][leg]);
    if (!(tail <= absolute + relative * std::abs(s[0][leg]))) return false;  // or is not finite
  }
  return true;
}

/// Horner's rule.
std::array<std::array<Rays, 3>, 2> LegSeries::values(Quantity first, Quantity second,
                                                     const RayLanes& rays) const noexcept {
  const Series *const a = &series_[first], *const b = &series_[second];
  const Rays x = (rays.sigma - middle_) * per_half_;
  Rays a0 = (*a)[terms - 1][0], a1 = (*a)[terms - 1][1], a2 = (*a)[terms - 1][2];
  Rays b0 = (*b)[terms - 1][0], b1 = (*b)[terms - 1][1], b2 = (*b)[terms - 1][2];
  for (std::size_t j = terms - 1; j-- > 0;) {
    a0 = a0 * x + (*a)[j][0], a1 = a1 * x + (*a)[j][1], a2 = a2 * x + (*a)[j][2];
    b0 = b0 * x + (*b)[j][0], b1 = b1 * x + (*b)[j][1], b2 = b2 * x + (*b)[j][2];
  }
  return {{{a0, a1, a2}, {b0, b1, b2}}};
}

ColumnLanes LegSeries::sums(const RayLanes& rays) const noexcept {
  const auto [range, slope] = values(per_slowness, d_range, rays);
  const Rays per_sigma = 1.0 / rays.sigma;
  return {.up = {.per_slowness = range[0], .d_range = slope[0] * per_sigma},
          .middle = {.per_slowness = range[1], .d_range = slope[1] * per_sigma},
          .down = {.per_slowness = range[2], .d_range = slope[2] * per_sigma},
          .turns_above = turns_above_,
          .turns_below = turns_below_};
}

ColumnLanes LegSeries::all(const RayLanes& rays) const noexcept {
  ColumnLanes all = sums(rays);
  const auto [times, lengths] = values(intercept, length, rays);
  LegLanes* legs[3] = {&all.up, &all.middle, &all.down};
  for (std::size_t leg = 0; leg < 3; ++leg) {
    legs[leg]->intercept = times[leg];
    legs[leg]->length = lengths[leg];
  }
  return all;
}

IntervalSeries::IntervalSeries(const Column& column, double c_ref, std::span<const double> nodes)
    : column_(column), c_ref_(c_ref), nodes_(nodes) {
  if (nodes.empty()) return;
  // Seen from σ, the nearest singularity is where s vanishes at the next slower knot, at ±ia. On a
  // stretch of 1.5 times its distance n terms leave about 4^(−n).
  double slower = 0.0;
  for (const Layer& layer : column.layers())
    for (const double c : {layer.c_top, layer.c_bottom})
      if (c < c_ref * (1.0 - 1e-12)) slower = std::max(slower, c);
  const double ratio = slower > 0.0 ? c_ref / slower : 2.0, a2 = ratio * ratio - 1.0;
  for (std::size_t cell = 0; cell + 1 < nodes.size(); ++cell) {
    const double from = pieces_.empty() ? 0.0 : nodes[pieces_.back().first];
    if (!pieces_.empty() && nodes[cell + 1] - from <= 0.7 * std::sqrt(a2 + from * from))
      pieces_.back().last = cell + 1;
    else
      pieces_.push_back({cell, cell + 1});
  }
}

std::size_t IntervalSeries::piece_of(std::size_t cell) const noexcept {
  std::size_t i = 0;
  while (pieces_[i].last <= cell) ++i;
  return i;
}

IntervalSeries::Cells IntervalSeries::around(std::size_t cell) const noexcept {
  const Piece& piece = pieces_[piece_of(cell)];
  return {piece.first, piece.last};
}

const LegSeries* IntervalSeries::at(std::size_t cell) {
  for (;;) {
    const std::size_t i = piece_of(cell);
    Piece& piece = pieces_[i];
    if (!piece.series)
      piece.series =
          std::make_unique<LegSeries>(column_, c_ref_, nodes_[piece.first], nodes_[piece.last]);
    if (piece.series->good()) return piece.series.get();
    if (piece.last - piece.first == 1) return nullptr;
    const std::size_t first = piece.first, last = piece.last, middle = (first + last) / 2;
    piece = {first, middle};
    pieces_.insert(pieces_.begin() + static_cast<std::ptrdiff_t>(i) + 1, Piece{middle, last});
  }
}

}  // namespace asdic
