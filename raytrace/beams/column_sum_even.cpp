#include <cmath>

#include "raytrace/beams/column_sum.h"
#include "raytrace/beams/lanes.h"

namespace asdic {
namespace {

/// A Gaussian of constant width along a column, so many rows at a time as there are lanes: over D =
/// lanes·(row spacing) its logarithm changes by −a(2·dz·D + D²), a = cos²θ/2σ², and that by −2aD²;
/// the phase turns evenly, |q| grows evenly.
struct EvenBeam {
  Lanes bell, ratio, c, s, q;
  float ratio_of_ratio, turn_c, turn_s, growth;

  [[nodiscard]] Lanes weight() const noexcept { return bell * sqrt(q); }
  void step() noexcept {
    q += growth;
    bell *= ratio;
    ratio *= ratio_of_ratio;
    const Lanes c_next = c * turn_c - s * turn_s;
    s = s * turn_c + c * turn_s;
    c = c_next;
  }
  /// From here on each step goes two steps on: ratio of n and n + 1 together, ρₙρₙ₊₁ = ρₙ²·ϱ, ϱ =
  /// ρₙ₊₁/ρₙ, which grows by ϱ⁴.
  void stride() noexcept {
    growth *= 2.0F;
    ratio *= ratio * ratio_of_ratio;
    ratio_of_ratio *= ratio_of_ratio;
    ratio_of_ratio *= ratio_of_ratio;
    const float c2 = turn_c * turn_c - turn_s * turn_s;
    turn_s *= 2.0F * turn_c;
    turn_c = c2;
  }
};

}  // namespace

void ColumnSum::add_evenly(std::size_t i, float* real, float* imaginary) const {
  const auto row_spacing = static_cast<float>(spacing_);
  const float step = static_cast<float>(lanes) * row_spacing;
  const float a = sharpness_[i];
  const Lanes dz = offset_[i] + row_spacing * ramp();
  const float q_slope = q_[i] < 0.0F ? -growth_[i] : growth_[i];
  EvenBeam beam{.bell = height_[i] * exponential(-a * dz * dz),
                .ratio = exponential(-a * step * (2.0F * dz + step)),
                .c = {},
                .s = {},
                .q = std::abs(q_[i]) + q_slope * dz,
                .ratio_of_ratio = ratio_of_ratio_[i],
                .turn_c = turn_cosine_[i],
                .turn_s = turn_sine_[i],
                .growth = q_slope * step};
  cos_sin(phase_[i] + wave_number_[i] * dz, beam.c, beam.s);
  auto k = static_cast<std::size_t>(first_[i]);
  const auto last = static_cast<std::size_t>(last_[i]);
  const auto put = [&](std::size_t at, const EvenBeam& b, const Lanes& weight) {
    store(load(real + at) + weight * b.c, real + at);
    store(load(imaginary + at) + weight * b.s, imaginary + at);
  };
  // Two side by side, for a step waits for the one before.
  if (k + 2 * lanes <= last) {
    EvenBeam next = beam;
    next.step();
    beam.stride();
    next.stride();
    do {
      put(k, beam, beam.weight());
      put(k + lanes, next, next.weight());
      beam.step();
      next.step();
      k += 2 * lanes;
    } while (k + 2 * lanes <= last);
    if (k + lanes <= last) {
      put(k, beam, beam.weight());
      beam = next;
      k += lanes;
    }
  } else if (k + lanes <= last) {
    put(k, beam, beam.weight());
    beam.step();
    k += lanes;
  }
  if (k == last) return;
  Lanes weight = beam.weight();  // not a number where q would be negative: behind the last row
  where(ramp() >= static_cast<float>(last - k), weight) = 0.0F;
  put(k, beam, weight);
}

}  // namespace asdic
