#include "raytrace/beams/column_sum.h"

#include <algorithm>
#include <cmath>

#include "raytrace/beams/crossing.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/beams/lanes.h"

namespace asdic {

namespace {

const float root_of_two_pi = static_cast<float>(std::sqrt(2.0 * pi));

}  // namespace

ColumnSum::ColumnSum(const BeamSetting& setting, std::span<const double> depths,
                     std::size_t columns)
    : setting_(setting),
      spacing_of_fan_(setting.spacing),
      depths_(depths),
      padded_depths_(depths.begin(), depths.end()) {
  padded_depths_.resize(depths.size() + lanes, depths.back() + 1e6);
  stride_ = (depths.size() + 2 * lanes - 1) / lanes * lanes;
  real_.assign(columns * stride_, 0.0F);
  if (setting.coherent) imaginary_.assign(columns * stride_, 0.0F);
  first_depth_ = depths.front();
  const double wavelength = 1500.0 / setting.frequency;
  const double step =
      depths.size() < 2 ? 0.0 : (depths.back() - first_depth_) / double(depths.size() - 1);
  bool even = step > 0.0;
  for (std::size_t k = 0; k < depths.size(); ++k)
    even = even && std::abs(depths[k] - (first_depth_ + double(k) * step)) <
                       std::min(1e-3 * step, 1e-5 * wavelength);
  if (even) spacing_ = step, per_spacing_ = 1.0 / step;
}

ColumnSum::Way ColumnSum::way(std::size_t i) const noexcept {
  const float growth = std::abs(growth_[i]), q = std::abs(q_[i]);
  const auto spacing = static_cast<float>(setting_.spacing);
  const bool is_hat = setting_.kind == BeamKind::hat;
  if (q == 0.0F) return Way::none;
  if (cosine_[i] < (is_hat ? 2.0F : 8.0F) * spacing * growth) return Way::plain;
  if (last_[i] <= first_[i]) return Way::none;
  return Way::lanes;
}

template <bool coherent, bool is_hat>
void ColumnSum::add_rows(const Crossings& x) {
  for (std::size_t i = 0; i < x.size(); ++i) add_crossing_rows<coherent, is_hat>(x, i);
}

template <bool coherent, bool is_hat>
void ColumnSum::add_crossing_rows(const Crossings& x, std::size_t i) {
  const Way how = way(i);
  if (how == Way::none) return;
  if (how == Way::plain) return add_plainly(x, i);
  float* real = real_.data() + x.column[i] * stride_;
  float* imaginary = coherent ? imaginary_.data() + x.column[i] * stride_ : nullptr;
  const auto spacing = static_cast<float>(setting_.spacing), per_spacing = 1.0F / spacing;
  const float share_scale = spacing / root_of_two_pi;
  const auto row_spacing = static_cast<float>(spacing_);
  const Lanes depth_ramp = ramp() * row_spacing;
  const float cosine = cosine_[i], q0 = q_[i], growth = growth_[i], amplitude = amplitude_[i];
  const auto last = static_cast<std::size_t>(last_[i]);
  float offset = offset_[i];
  for (auto k = static_cast<std::size_t>(first_[i]); k < last; k += lanes) {
    Lanes dz;
    if (spacing_ > 0.0)
      dz = offset + depth_ramp;
    else
      dz = Lanes([&](auto l) { return static_cast<float>(padded_depths_[k + l] - x.depth[i]); });
    offset += static_cast<float>(lanes) * row_spacing;
    const Lanes n = abs(dz) * cosine;
    const Lanes signed_q = q0 + growth * dz;
    const Lanes q = max(abs(signed_q), Lanes(1e-30F));
    Lanes weight;
    if constexpr (is_hat) {
      const Lanes per_q = 1.0F / q;
      weight = amplitude * max(Lanes(0.0F), 1.0F - n * per_q * per_spacing);
      weight *= coherent ? sqrt(per_q) : per_q;
      // half a hat ends at its ray, where it is not zero
      if (half_ != Half::both) where(ramp() >= static_cast<float>(last - k), weight) = 0.0F;
    } else {
      const Lanes per_sigma = 1.0F / max(q * spacing, Lanes(least_[i]));
      const Lanes u = n * per_sigma;
      weight = amplitude * share_scale * per_sigma * exponential(-0.5F * u * u);
      if constexpr (coherent) weight *= sqrt(q);
      where(u >= 4.0F, weight) = 0.0F;
    }
    if constexpr (coherent) {
      Lanes angle = phase_[i] + wave_number_[i] * dz;
      if constexpr (!is_hat) {  // a caustic lies between the ray and the foot
        const Lanes quarter = with_sign(Lanes(static_cast<float>(0.5 * pi)), dz * sine_[i]);
        where(signed_q * q0 < 0.0F, angle) = angle + quarter;
      }
      Lanes c, s;
      cos_sin(angle, c, s);
      store(load(real + k) + weight * c, real + k);
      store(load(imaginary + k) + weight * s, imaginary + k);
    } else {
      store(load(real + k) + weight, real + k);
    }
  }
}

/// Hats that reach a few evenly spaced rows only: as many crossings at a time as there are lanes,
/// row by row downwards, where the phase turns evenly.
template <bool coherent>
void ColumnSum::add_narrow_hats(const Crossings& x) {
  constexpr int most_rows = 12;
  const auto spacing = static_cast<float>(setting_.spacing), per_spacing = 1.0F / spacing;
  const auto row_spacing = static_cast<float>(spacing_);
  float re[most_rows * lanes], im[most_rows * lanes];
  for (std::size_t i = 0; i < x.size(); i += lanes) {
    const std::size_t used = std::min(lanes, x.size() - i);
    int rows = 0;
    for (std::size_t l = 0; l < used; ++l) rows = std::max(rows, last_[i + l] - first_[i + l]);
    const Lanes cosine = load(&cosine_[i]), q0 = load(&q_[i]), growth = load(&growth_[i]);
    if (rows > most_rows || any_of(cosine < 2.0F * spacing * abs(growth))) {
      for (std::size_t l = 0; l < used; ++l) add_crossing_rows<coherent, true>(x, i + l);
      continue;
    }
    Lanes amplitude = load(&amplitude_[i]), dz = load(&offset_[i]), c, s, turn_c, turn_s;
    where(q0 == 0.0F, amplitude) = 0.0F;
    if constexpr (coherent) {
      const Lanes wave_number = load(&wave_number_[i]);
      cos_sin(load(&phase_[i]) + wave_number * dz, c, s);
      cos_sin(wave_number * row_spacing, turn_c, turn_s);
    }
    for (int m = 0; m < rows; ++m) {
      const Lanes per_q = 1.0F / max(abs(q0 + growth * dz), Lanes(1e-30F));
      const Lanes share = max(Lanes(0.0F), 1.0F - abs(dz) * cosine * per_q * per_spacing);
      const Lanes weight = amplitude * share * (coherent ? sqrt(per_q) : per_q);
      float* to = re + static_cast<std::size_t>(m) * lanes;
      if constexpr (coherent) {
        store(weight * c, to);
        store(weight * s, im + static_cast<std::size_t>(m) * lanes);
        const Lanes c_next = c * turn_c - s * turn_s;
        s = s * turn_c + c * turn_s;
        c = c_next;
      } else {
        store(weight, to);
      }
      dz += row_spacing;
    }
    // A hat is zero beyond its rows, and columns are padded: as many rows for all cost less than
    // branches that nobody can foretell.
    const bool alike = half_ == Half::both && rows <= static_cast<int>(lanes);
    for (std::size_t l = 0; l < used; ++l) {
      const std::size_t base = x.column[i + l] * stride_ + static_cast<std::size_t>(first_[i + l]);
      const int count = alike ? rows : last_[i + l] - first_[i + l];
      for (int m = 0; m < count; ++m) {
        const std::size_t from = static_cast<std::size_t>(m) * lanes + l;
        real_[base + static_cast<std::size_t>(m)] += re[from];
        if constexpr (coherent) imaginary_[base + static_cast<std::size_t>(m)] += im[from];
      }
    }
  }
}

void ColumnSum::add_plainly(const Crossings& x, std::size_t i) {
  const Crossing crossing{.depth = x.depth[i],
                          .cosine = x.cosine[i],
                          .sine = x.sine[i],
                          .speed = x.speed[i],
                          .time = x.time[i],
                          .length = 0.0,
                          .q = x.q[i],
                          .dq_ds = x.dq_ds[i],
                          .loss = std::polar(x.level[i], x.phase[i]),
                          .mirror = x.mirror[i]};
  float* real = real_.data() + x.column[i] * stride_;
  float* imaginary = setting_.coherent ? imaginary_.data() + x.column[i] * stride_ : nullptr;
  beams::add_crossing(setting_, launch_, launched_, x.source_speed, crossing, depths_,
                      [&](std::size_t k, std::complex<double> p) {
                        real[k] += static_cast<float>(p.real());
                        if (imaginary != nullptr) imaginary[k] += static_cast<float>(p.imag());
                      });
}

void ColumnSum::add(const BeamLaunch& launch, const Crossings& crossings) {
  if (launch.higher == launch.lower) {
    setting_.spacing = launch.higher == 0.0 ? spacing_of_fan_ : launch.higher;
    launch_ = launch;
    return add_half(launch, crossings, Half::both);
  }
  setting_.spacing = launch.higher;
  launch_ = launch, launch_.lower = 0.0;
  add_half(launch, crossings, Half::higher);
  setting_.spacing = launch.lower;
  launch_ = launch, launch_.higher = 0.0;
  add_half(launch, crossings, Half::lower);
}

void ColumnSum::add_half(const BeamLaunch& launch, const Crossings& crossings, Half half) {
  half_ = half;
  prepare(launch, crossings);
  const bool is_hat = setting_.kind == BeamKind::hat, even = spacing_ > 0.0;
  if (setting_.coherent) {
    if (even) return is_hat ? add_narrow_hats<true>(crossings) : add_even_gaussians(crossings);
    is_hat ? add_rows<true, true>(crossings) : add_rows<true, false>(crossings);
  } else {
    if (is_hat && even) return add_narrow_hats<false>(crossings);
    is_hat ? add_rows<false, true>(crossings) : add_rows<false, false>(crossings);
  }
}

template void ColumnSum::add_crossing_rows<true, false>(const Crossings&, std::size_t);

}  // namespace asdic
