#include "raytrace/area/map_axis.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/text.h"
#include "raytrace/ocean/samples.h"

namespace asdic::detail {
namespace {

/// 1/spacing of places that are even to a ten-thousandth of it; else 0.
double even_step(std::span<const double> places) {
  const double step = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::abs(places[i] - (places.front() + static_cast<double>(i) * step)) > 1e-4 * step)
      return 0.0;
  return 1.0 / step;
}

}  // namespace

MapAxis::MapAxis(const char* name, std::vector<double> places) : places_(std::move(places)) {
  check_count(places_.size(), name, 2);
  const std::string beyond = "a " + std::string(name) + " beyond";
  for (std::size_t i = 0; i < places_.size(); ++i) check_place(places_, i, name, beyond.c_str());
  // Two places that should be one make cells without a width.
  constexpr double least = 1e-4;  // of the mean step
  const double mean = (places_.back() - places_.front()) / double(places_.size() - 1);
  for (std::size_t i = 1; i < places_.size(); ++i)
    if (places_[i] - places_[i - 1] < least * mean)
      throw InputError({.where = name,
                        .got = "places " + to_text(places_[i - 1]) + " and " + to_text(places_[i]),
                        .expected = "steps of at least " + to_text(least * mean) +
                                    ", a ten-thousandth of the mean step"});
  per_step_ = even_step(places_);
}

std::size_t MapAxis::interval(double x) const noexcept {
  const std::size_t last = places_.size() - 2;
  if (per_step_ > 0.0) {  // a guess, and then the places themselves
    const double steps = std::clamp((x - places_.front()) * per_step_, 0.0, double(last));
    auto i = static_cast<std::size_t>(steps);
    if (i < last && x >= places_[i + 1]) ++i;
    if (i > 0 && x < places_[i]) --i;
    return i;
  }
  const auto above = std::upper_bound(places_.begin() + 1, places_.end() - 1, x);
  return static_cast<std::size_t>(above - places_.begin()) - 1;
}

std::size_t MapAxis::nearest(double x) const noexcept {
  const std::size_t i = interval(x);
  return x - places_[i] < places_[i + 1] - x ? i : i + 1;
}

MapAxis::Cubic MapAxis::inside(double x) const noexcept {
  const std::size_t i = interval(x), last = places_.size() - 1;
  const double h = places_[i + 1] - places_[i], t = (x - places_[i]) / h, u = 1.0 - t;
  Cubic found{.index = {i > 0 ? i - 1 : i, i, i + 1, i + 1 < last ? i + 2 : i + 1}};
  // Hermite's cubic in t: of the values at both ends, and of the slopes there.
  const double a = u * u * (1.0 + 2.0 * t), b = t * t * (1.0 + 2.0 * u);
  const double rise = 6.0 * t * u / h, turn = (6.0 - 12.0 * t) / (h * h);
  found.value = {0.0, a, b, 0.0};
  found.slope = {0.0, -rise, rise, 0.0};
  found.bend = {0.0, -turn, turn, 0.0};
  const auto add_slope = [&](std::size_t node, double value, double slope, double bend) {
    // The slope at a place: (h₁²·f₂ + (h₂² − h₁²)·f − h₂²·f₁)/(h₁h₂(h₁ + h₂)), f₁ before it at h₁,
    // f₂ after it at h₂.
    const std::size_t k = found.index[node];
    std::array<double, 4> of{};
    if (k == 0 || k == last) {
      of = {0.0, -1.0 / h, 1.0 / h, 0.0};  // the outermost line, which is this interval's
    } else {
      const double h1 = places_[k] - places_[k - 1], h2 = places_[k + 1] - places_[k];
      const double scale = 1.0 / (h1 * h2 * (h1 + h2));
      of[node - 1] = -h2 * h2 * scale;
      of[node] = (h2 * h2 - h1 * h1) * scale;
      of[node + 1] = h1 * h1 * scale;
    }
    for (std::size_t n = 0; n < 4; ++n) {
      found.value[n] += value * of[n];
      found.slope[n] += slope * of[n];
      found.bend[n] += bend * of[n];
    }
  };
  add_slope(1, h * t * u * u, u * (1.0 - 3.0 * t), (6.0 * t - 4.0) / h);
  add_slope(2, -h * t * t * u, t * (3.0 * t - 2.0), (6.0 * t - 2.0) / h);
  return found;
}

MapAxis::Cubic MapAxis::cubic(double x) const noexcept {
  Cubic found = inside(std::clamp(x, begin(), end()));
  if (x < begin() || x > end()) found.slope = found.bend = {};
  return found;
}

MapAxis::Cubic MapAxis::cubic_going_on(double x) const noexcept {
  const double held = std::clamp(x, begin(), end());
  Cubic found = inside(held);
  if (x == held) return found;
  for (std::size_t n = 0; n < 4; ++n) found.value[n] += (x - held) * found.slope[n];
  found.bend = {};
  return found;
}

}  // namespace asdic::detail
