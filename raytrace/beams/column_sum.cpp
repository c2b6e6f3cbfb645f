#include "raytrace/beams/column_sum.h"

#include <algorithm>
#include <cmath>

#include "raytrace/beams/crossing.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/math/lanes.h"

namespace asdic {

namespace {

const float root_of_two_pi = static_cast<float>(std::sqrt(2.0 * pi));

}  // namespace

ColumnSum::ColumnSum(const BeamSetting& setting, std::span<const double> depths,
                     std::span<float> memory)
    : setting_(setting),
      spacing_of_fan_(setting.spacing),
      depths_(depths),
      padded_depths_(depths.begin(), depths.end()) {
  padded_depths_.resize(depths.size() + lanes, depths.back() + 1e6);
  stride_ = stride_of(depths.size());
  first_depth_ = depths.front();
  const double wavelength = 1500.0 / setting.frequency;
  const double step =
      depths.size() < 2 ? 0.0 : (depths.back() - first_depth_) / double(depths.size() - 1);
  bool even = step > 0.0;
  for (std::size_t k = 0; k < depths.size(); ++k)
    even = even && std::abs(depths[k] - (first_depth_ + double(k) * step)) <
                       std::min(1e-3 * step, 1e-5 * wavelength);
  if (even) spacing_ = step, per_spacing_ = 1.0 / step;
  paired_ = even && setting.coherent && setting.kind == BeamKind::hat;
  sum_ = setting.coherent ? memory : memory.first(memory.size() / 2);
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  real_ = sum_.first(memory.size() / 2);
  imaginary_ = sum_.subspan(real_.size());
}

ColumnSum::Way ColumnSum::way(std::size_t i) const noexcept {
  const float growth = std::abs(growth_[i]), q = std::abs(q_[i]);
  const auto spacing = static_cast<float>(setting_.spacing);
  const bool is_hat = setting_.kind == BeamKind::hat;
  if (q == 0.0F) return Way::none;
  if (cosine_[i] < (is_hat ? 2.0F : 8.0F) * spacing * growth) return Way::plain;
  if (last_[i] <= first_[i]) return Way::none;
  return Way::several;
}

void ColumnSum::absorb(const ColumnSum& other) {
  float* to = sum_.data();
  const float* from = other.sum_.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < sum_.size(); ++i) to[i] += from[i];
}

template <bool coherent, bool is_hat>
void ColumnSum::add_rows(const Crossings& x) {
  for (std::size_t i = 0; i < x.size(); ++i) add_crossing_rows<coherent, is_hat>(x, i);
}

void ColumnSum::add_lanes(std::size_t at, const Lanes& re, const Lanes& im) {
  if (paired_) {
    for (std::size_t l = 0; l < lanes; ++l) {
      sum_[2 * (at + l)] += re[l];
      sum_[2 * (at + l) + 1] += im[l];
    }
    return;
  }
  store(load(&real_[at]) + re, &real_[at]);
  store(load(&imaginary_[at]) + im, &imaginary_[at]);
}

template <bool coherent, bool is_hat>
void ColumnSum::add_crossing_rows(const Crossings& x, std::size_t i) {
  const Way how = way(i);
  if (how == Way::none) return;
  if (how == Way::plain) return add_plainly(x, i);
  const std::size_t column = x.column[i] * stride_;
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
      add_lanes(column + k, weight * c, weight * s);
    } else {
      float* to = real_.data() + column + k;
      store(load(to) + weight, to);
    }
  }
}

Crossing ColumnSum::crossing_at(const Crossings& x, std::size_t i) const {
  return {.depth = x.depth[i],
          .cosine = x.cosine[i],
          .sine = x.sine[i],
          .speed = x.speed[i],
          .time = x.time[i],
          .length = 0.0,
          .q = x.q[i],
          .dq_ds = x.dq_ds[i],
          .loss = std::polar(x.level[i], x.phase[i]),
          .mirror = x.mirror[i]};
}

void ColumnSum::add_number(std::size_t at, const std::complex<double>& p) {
  sum_[paired_ ? 2 * at : at] += static_cast<float>(p.real());
  if (paired_)
    sum_[2 * at + 1] += static_cast<float>(p.imag());
  else if (setting_.coherent)
    imaginary_[at] += static_cast<float>(p.imag());
}

void ColumnSum::add_plainly(const Crossings& x, std::size_t i) {
  const std::size_t column = x.column[i] * stride_;
  beams::add_crossing(setting_, launch_, launched_, x.source_speed, crossing_at(x, i), depths_,
                      [&](std::size_t k, std::complex<double> p) { add_number(column + k, p); });
}

void ColumnSum::add(const BeamLaunch& launch, const Crossings& crossings,
                    const BoundaryRows* walls) {
  const auto add_one = [&](Half half) {
    add_half(launch, crossings, half);
    if (walls != nullptr) add_twins(crossings, *walls);
  };
  if (launch.higher == launch.lower) {
    setting_.spacing = launch.higher == 0.0 ? spacing_of_fan_ : launch.higher;
    launch_ = launch;
    return add_one(Half::both);
  }
  setting_.spacing = launch.higher;
  launch_ = launch, launch_.lower = 0.0;
  add_one(Half::higher);
  setting_.spacing = launch.lower;
  launch_ = launch, launch_.higher = 0.0;
  add_one(Half::lower);
}

void ColumnSum::add_half(const BeamLaunch& launch, const Crossings& crossings, Half half) {
  half_ = half;
  const bool is_hat = setting_.kind == BeamKind::hat, even = spacing_ > 0.0;
  is_hat ? prepare<true>(launch, crossings) : prepare<false>(launch, crossings);
  if (setting_.coherent) {
    if (even) return is_hat ? add_hats<true>(crossings) : add_even_gaussians(crossings);
    is_hat ? add_rows<true, true>(crossings) : add_rows<true, false>(crossings);
  } else {
    if (is_hat && even) return add_hats<false>(crossings);
    is_hat ? add_rows<false, true>(crossings) : add_rows<false, false>(crossings);
  }
}

template void ColumnSum::add_crossing_rows<true, false>(const Crossings&, std::size_t);
template void ColumnSum::add_crossing_rows<true, true>(const Crossings&, std::size_t);
template void ColumnSum::add_crossing_rows<false, true>(const Crossings&, std::size_t);

}  // namespace asdic
