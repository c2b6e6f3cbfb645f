#include "raytrace/layered/leg_series.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

LegSeries::LegSeries(const Column& column, double c_ref, double low, double high)
    : extent_(low, high) {
  for (std::size_t j = 0; j < LegFit<3>::terms; j += rays_at_once) {
    const SimdRays rays(c_ref, LegFit<3>::sigmas(extent_, j));
    const SimdColumn sums = walk_all(column, rays);
    turns_above_ = sums.turns_above;
    turns_below_ = sums.turns_below;
    legs_.put(0, j, sums.up, rays);
    legs_.put(1, j, sums.middle, rays);
    legs_.put(2, j, sums.down, rays);
  }
  legs_.fit();
  good_ = true;
  for (std::size_t leg = 0; leg < 3; ++leg)
    good_ = good_ && legs_.good(leg, c_ref, {.range = 1e-7, .time = 1e-13, .slope = 1e-8});
}

SimdColumn LegSeries::sums(const SimdRays& rays) const noexcept {
  const auto [range, slope] = legs_.at(extent_.x(rays.sigma), per_slowness, d_range);
  const Rays per_sigma = 1.0 / rays.sigma;
  return {.up = {.per_slowness = range[0], .d_range = slope[0] * per_sigma},
          .middle = {.per_slowness = range[1], .d_range = slope[1] * per_sigma},
          .down = {.per_slowness = range[2], .d_range = slope[2] * per_sigma},
          .turns_above = turns_above_,
          .turns_below = turns_below_};
}

SimdColumn LegSeries::all(const SimdRays& rays) const noexcept {
  SimdColumn all = sums(rays);
  const auto [times, lengths] = legs_.at(extent_.x(rays.sigma), intercept, length);
  SimdLegs* legs[3] = {&all.up, &all.middle, &all.down};
  for (std::size_t leg = 0; leg < 3; ++leg) {
    legs[leg]->intercept = times[leg];
    legs[leg]->length = lengths[leg];
  }
  return all;
}

IntervalSeries::IntervalSeries(const Column& column, double c_ref, std::span<const double> nodes)
    : column_(column), c_ref_(c_ref), nodes_(nodes) {
  if (nodes.empty()) return;
  double slower = 0.0;
  for (const Layer& layer : column.layers())
    for (const double c : {layer.c_top, layer.c_bottom})
      if (c < c_ref * (1.0 - 1e-12)) slower = std::max(slower, c);
  for (std::size_t cell = 0; cell + 1 < nodes.size(); ++cell) {
    const double from = pieces_.empty() ? 0.0 : nodes[pieces_.back().first];
    if (!pieces_.empty() && nodes[cell + 1] - from <= series_reach(from, c_ref, slower))
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

}  // namespace asdic::detail
