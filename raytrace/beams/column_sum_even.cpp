#include <algorithm>
#include <cmath>

#include "raytrace/beams/column_sum.h"
#include "raytrace/math/lanes.h"

// Gaussians of constant width along evenly spaced rows: their logarithm is a polynomial of second
// degree in the depth, so that each group of rows follows from the one before by multiplications.
namespace asdic {
namespace {

/// z ← z·w, complex.
void turn(Lanes& re, Lanes& im, const Lanes& w_re, const Lanes& w_im) noexcept {
  const Lanes next = re * w_re - im * w_im;
  im = re * w_im + im * w_re;
  re = next;
}

/// The first group of rows of as many crossings as there are lanes, [crossings][rows].
struct FirstRows {
  alignas(64) float re[lanes * lanes], im[lanes * lanes];  // z, height included
  alignas(64) float ratio[lanes * lanes];                  // |z| a group further on, over |z|
  alignas(64) float turn_c[lanes], turn_s[lanes];          // e^(iκD), from group to group
  alignas(64) float ratio_of_ratio[lanes];                 // of ratio, from group to group
};

/// Of z(dz) = h·exp(−a·dz² + b·dz + i(φ + κ·dz)), rows h apart and groups of them D apart:
///   z(dz + h)/z(dz) = exp(−a(2·dz·h + h²) + b·h + iκh), which changes by exp(−2ah²) a row,
///   |z(dz + D)/z(dz)| = exp(−a(2·dz·D + D²) + b·D), which changes by exp(−2ahD) a row.
struct EvenBeams {
  Lanes height, a, b, phase, wave_number, offset;

  void first_rows(float spacing, FirstRows& out) const noexcept {
    const float group = static_cast<float>(lanes) * spacing;
    Lanes re, im, c, s;
    cos_sin(phase + wave_number * offset, re, im);
    const Lanes bell = height * exponential((b - a * offset) * offset);
    re *= bell, im *= bell;
    cos_sin(wave_number * spacing, c, s);
    const Lanes by_row = exponential(spacing * (b - a * (2.0F * offset + spacing)));
    c *= by_row, s *= by_row;
    const Lanes a2 = -2.0F * a * spacing;
    const Lanes per_row = exponential(a2 * spacing), per_row_of_group = exponential(a2 * group);
    Lanes ratio = exponential(group * (b - a * (2.0F * offset + group)));
    for (std::size_t l = 0; l < lanes; ++l) {
      store(re, out.re + l * lanes);
      store(im, out.im + l * lanes);
      store(ratio, out.ratio + l * lanes);
      turn(re, im, c, s);
      c *= per_row, s *= per_row;
      ratio *= per_row_of_group;
    }
    transpose(out.re), transpose(out.im), transpose(out.ratio);
    cos_sin(wave_number * group, c, s);
    store(c, out.turn_c), store(s, out.turn_s);
    store(exponential(static_cast<float>(lanes) * a2 * group), out.ratio_of_ratio);
  }
};

void add_to(float* sum, const Lanes& value) noexcept { store(load(sum) + value, sum); }

/// Adds rows 0 … count − 1 of crossing i of those.
void add_groups(const FirstRows& first, std::size_t i, std::size_t count, float* real,
                float* imaginary) noexcept {
  Lanes re = load(first.re + i * lanes), im = load(first.im + i * lanes);
  const Lanes ratio = load(first.ratio + i * lanes), ratio_of_ratio = first.ratio_of_ratio[i];
  Lanes w_re = ratio * first.turn_c[i], w_im = ratio * first.turn_s[i];
  std::size_t k = 0;
  for (; k + lanes <= count; k += lanes) {
    add_to(real + k, re);
    add_to(imaginary + k, im);
    turn(re, im, w_re, w_im);
    w_re *= ratio_of_ratio, w_im *= ratio_of_ratio;
  }
  if (k == count) return;
  const auto beyond = ramp() >= static_cast<float>(static_cast<int>(count - k));
  where(beyond, re) = 0.0F;
  where(beyond, im) = 0.0F;
  add_to(real + k, re);
  add_to(imaginary + k, im);
}

}  // namespace

/// With a = cos²θ/2σ². Where |q| = q₀(1 + t) grows little, the amplitude's √|q| =
/// √q₀·exp(t/2 − t²/4 + …) is part of the bell: t/2 to b, t²/4 to a.
void ColumnSum::add_even_gaussians(const Crossings& x) {
  const auto spacing = static_cast<float>(spacing_);
  const float share_scale = static_cast<float>(setting_.spacing / std::sqrt(2.0 * pi));
  find_even(x.size());
  FirstRows first;
  for (std::size_t i = 0; i < x.size(); i += lanes) {
    const std::size_t used = std::min(lanes, x.size() - i);
    const Lanes q = load(&q_[i]), per_sigma = 1.0F / load(&least_[i]);
    const Lanes u = load(&cosine_[i]) * per_sigma, tilt = 0.5F * load(&growth_[i]) / q;
    const EvenBeams beams{.height = load(&amplitude_[i]) * share_scale * per_sigma * sqrt(abs(q)),
                          .a = 0.5F * u * u + tilt * tilt,
                          .b = tilt,
                          .phase = load(&phase_[i]),
                          .wave_number = load(&wave_number_[i]),
                          .offset = load(&offset_[i])};
    beams.first_rows(spacing, first);
    for (std::size_t l = 0; l < used; ++l) {
      const std::size_t j = i + l;
      if (is_even_[j] == 0) {
        add_crossing_rows<true, false>(x, j);
        continue;
      }
      const std::size_t at = x.column[j] * stride_ + static_cast<std::size_t>(first_[j]);
      add_groups(first, l, static_cast<std::size_t>(last_[j] - first_[j]), &real_[at],
                 &imaginary_[at]);
    }
  }
}

/// Which crossings are Gaussians of constant width and nearly constant |q|, told for all at once.
void ColumnSum::find_even(std::size_t n) {
  // t³/6 is left out of the logarithm of √(1 + t). At u σ from the ray, where the bell is e^(−u²/2)
  // of its height, t is u/4 of what it is at the beam's edge t₄: 3e-3·t₄³ of the height at most.
  constexpr float most_growth = 0.1F;
  is_even_.resize(n);
  const auto spacing = static_cast<float>(setting_.spacing);
  const float *growth_of = growth_.data(), *q_of = q_.data(), *cosine = cosine_.data(),
              *least = least_.data();
  const double *above = above_.data(), *below = below_.data();
  const std::int32_t *first = first_.data(), *last = last_.data();
  std::int32_t* is_even = is_even_.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) {
    const float growth = std::abs(growth_of[i]), q = std::abs(q_of[i]);
    const auto reach = static_cast<float>(above[i] > below[i] ? above[i] : below[i]);
    const bool constant = (growth * reach < most_growth * q) &
                          ((q + growth * reach) * spacing < least[i]);  // σ is its least all over
    is_even[i] = constant & (cosine[i] >= 8.0F * spacing * growth) & (last[i] > first[i]);
  }
}

}  // namespace asdic
