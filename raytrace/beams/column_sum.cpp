#include "raytrace/beams/column_sum.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "raytrace/beams/crossing.h"
#include "raytrace/beams/geometric.h"

namespace asdic::detail {

namespace {

const float root_of_two_pi = static_cast<float>(std::sqrt(2.0 * pi));

}  // namespace

ColumnSum::ColumnSum(const BeamSetting& setting, std::span<const double> depths,
                     std::span<float> memory)
    : setting_(setting),
      spacing_of_fan_(setting.spacing),
      depths_(depths),
      padded_depths_(depths.begin(), depths.end()) {
  padded_depths_.resize(depths.size() + simd_width, depths.back() + 1e6);
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

void ColumnSum::add_simd(std::size_t at, const SimdFloats& re, const SimdFloats& im) {
  if (paired_) {
    for (std::size_t l = 0; l < simd_width; ++l) {
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
  const SimdFloats depth_ramp = ramp() * row_spacing;
  const float cosine = cosine_[i], q0 = q_[i], growth = growth_[i], amplitude = amplitude_[i];
  const auto last = static_cast<std::size_t>(last_[i]);
  float offset = offset_[i];
  for (auto k = static_cast<std::size_t>(first_[i]); k < last; k += simd_width) {
    SimdFloats dz;
    if (spacing_ > 0.0)
      dz = offset + depth_ramp;
    else
      dz = SimdFloats(
          [&](auto l) { return static_cast<float>(padded_depths_[k + l] - x.depth[i]); });
    offset += static_cast<float>(simd_width) * row_spacing;
    const SimdFloats n = abs(dz) * cosine;
    const SimdFloats signed_q = q0 + growth * dz;
    const SimdFloats q = max(abs(signed_q), SimdFloats(1e-30F));
    SimdFloats weight;
    if constexpr (is_hat) {
      const SimdFloats per_q = 1.0F / q;
      weight = amplitude * max(SimdFloats(0.0F), 1.0F - n * per_q * per_spacing);
      weight *= coherent ? sqrt(per_q) : per_q;
      // half a hat ends at its ray, where it is not zero
      if (half_ != Half::both) where(ramp() >= static_cast<float>(last - k), weight) = 0.0F;
    } else {
      const SimdFloats per_sigma = 1.0F / max(q * spacing, SimdFloats(least_[i]));
      const SimdFloats u = n * per_sigma;
      weight = amplitude * share_scale * per_sigma * exponential(-0.5F * u * u);
      if constexpr (coherent) weight *= sqrt(q);
      where(u >= 4.0F, weight) = 0.0F;
    }
    if constexpr (coherent) {
      SimdFloats angle = phase_[i] + wave_number_[i] * dz;
      if constexpr (!is_hat) {  // a caustic lies between the ray and the foot
        const SimdFloats quarter =
            with_sign(SimdFloats(static_cast<float>(0.5 * pi)), dz * sine_[i]);
        where(signed_q * q0 < 0.0F, angle) = angle + quarter;
      }
      SimdFloats c, s;
      cos_sin(angle, c, s);
      add_simd(column + k, weight * c, weight * s);
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
    if (walls != nullptr) add_partners(crossings, *walls);
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

// What the loops over receivers need, for all crossings of a beam: loops that the compiler
// vectorises.

template <bool is_hat>
void ColumnSum::prepare(const BeamLaunch& launch, const Crossings& x) {
  const std::size_t n = x.size();
  const auto make_room = [n](auto& array) {  // the last lanes are read, and count for nothing
    array.resize(n + simd_width);
    std::fill_n(array.end() - simd_width, simd_width, 0);
  };
  for (auto* array :
       {&amplitude_, &phase_, &wave_number_, &cosine_, &sine_, &q_, &growth_, &least_, &offset_})
    make_room(*array);
  make_room(first_), make_room(last_);
  above_.resize(n), below_.resize(n);
  const double f = setting_.frequency, spacing = setting_.spacing;
  launched_ = beams::launch_factor(setting_, launch, x.source_speed);
  const bool coherent = setting_.coherent;
  // n < times·L; for a Gaussian L is σ, which may stay at its least and then grow.
  constexpr double times = is_hat ? 1.0 : 4.0;
  const double widening_scale = times * spacing;
  const double *speeds = x.speed.data(), *qs = x.q.data(), *levels = x.level.data(),
               *times_of = x.time.data(), *phases = x.phase.data(), *sines = x.sine.data(),
               *cosines = x.cosine.data(), *dq_ds = x.dq_ds.data();
  float *amplitude = amplitude_.data(), *phase = phase_.data(), *wave_number = wave_number_.data(),
        *cosine_out = cosine_.data(), *sine_out = sine_.data(), *q_out = q_.data(),
        *growth_out = growth_.data(), *least_out = least_.data();
  double *above = above_.data(), *below = below_.data();
  const double launched2 = launched_ * launched_ / x.source_speed;
  const double k_unit = -2.0 * pi * f, wavelength_share = pi / f;
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) {
    const double c = speeds[i], q = qs[i];
    const double intensity = launched2 * levels[i] * levels[i] * c;
    amplitude[i] = static_cast<float>(intensity);
    const double cycles = f * times_of[i];
    phase[i] = static_cast<float>(phases[i] - 2.0 * pi * (cycles - std::floor(cycles)));
    const double cosine = std::abs(cosines[i]);
    const double growth = dq_ds[i] * sines[i];
    cosine_out[i] = static_cast<float>(cosine);
    sine_out[i] = static_cast<float>(sines[i]);
    q_out[i] = static_cast<float>(q);
    growth_out[i] = static_cast<float>(growth);
    double widening = widening_scale * (q < 0.0 ? -growth : growth);
    double width = times * std::abs(q) * spacing;
    if constexpr (!is_hat) {
      const double a = 0.2 * f * times_of[i], b = wavelength_share * c;
      const double least = a < b ? a : b;
      least_out[i] = static_cast<float>(least);
      // (|q| + |dq/dz|·4σ/cos θ)·Δα < σ: the least width holds all over the beam
      const double most = (std::abs(q) * cosine + std::abs(growth) * times * least) * spacing;
      widening = most < least * cosine ? 0.0 : widening;
      width = width > times * least ? width : times * least;
    }
    // width/cos θ on the side where the beam narrows, width/(cos θ − |widening|) on the other
    const double far = cosine - std::abs(widening), both = cosine * far;
    const double per_all = 1.0 / (both * c), per_both = width * per_all * c;
    above[i] = per_both * (widening < 0.0 ? cosine : far);
    below[i] = per_both * (widening > 0.0 ? cosine : far);
    wave_number[i] = static_cast<float>(k_unit * sines[i] * both * per_all);
  }
  if (coherent)
    for (std::size_t i = 0; i < n; ++i) amplitude[i] = std::sqrt(amplitude[i]);
  find_rows(x);
}

template void ColumnSum::prepare<true>(const BeamLaunch&, const Crossings&);
template void ColumnSum::prepare<false>(const BeamLaunch&, const Crossings&);

void ColumnSum::find_rows(const Crossings& x) {
  const std::size_t n = x.size();
  const double top = first_depth_, per = per_spacing_, step = spacing_;
  const auto rows = static_cast<double>(depths_.size());
  if (half_ != Half::both) return find_rows_of_half(x);
  const double *depth = x.depth.data(), *above = above_.data(), *below = below_.data();
  std::int32_t *first_out = first_.data(), *last_out = last_.data();
  float* offset = offset_.data();
  if (step > 0.0) {
    ASDIC_INDEPENDENT
    for (std::size_t i = 0; i < n; ++i) {
      const double z = depth[i];
      double first = std::ceil((z - above[i] - top) * per);
      double last = std::floor((z + below[i] - top) * per) + 1.0;
      first = first < 0.0 ? 0.0 : first;
      last = last > rows ? rows : last;
      first = first > rows ? rows : first;
      last = last < first ? first : last;
      first_out[i] = static_cast<std::int32_t>(first);
      last_out[i] = static_cast<std::int32_t>(last);
      offset[i] = static_cast<float>(top + first * step - z);
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = [&](double z) {
        return static_cast<std::int32_t>(std::lower_bound(depths_.begin(), depths_.end(), z) -
                                         depths_.begin());
      };
      first_[i] = row(x.depth[i] - above_[i]);
      last_[i] = row(x.depth[i] + below_[i]);
    }
  }
}

/// Rows on one side of each ray; one at the ray itself belongs to the higher half.
void ColumnSum::find_rows_of_half(const Crossings& x) {
  const bool higher = half_ == Half::higher;
  const auto rows = static_cast<double>(depths_.size());
  const auto first_not_above = [&](double z) {
    if (spacing_ > 0.0)
      return static_cast<std::int32_t>(
          std::clamp(std::ceil((z - first_depth_) * per_spacing_), 0.0, rows));
    return static_cast<std::int32_t>(std::lower_bound(depths_.begin(), depths_.end(), z) -
                                     depths_.begin());
  };
  const auto first_below = [&](double z) {
    if (spacing_ > 0.0)
      return static_cast<std::int32_t>(
          std::clamp(std::floor((z - first_depth_) * per_spacing_) + 1.0, 0.0, rows));
    return static_cast<std::int32_t>(std::upper_bound(depths_.begin(), depths_.end(), z) -
                                     depths_.begin());
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double z = x.depth[i];
    const bool deeper = (x.q[i] * x.cosine[i] * x.mirror[i] <= 0.0) == higher;
    if (deeper) {
      first_[i] = higher ? first_not_above(z) : first_below(z);
      last_[i] = std::max(first_[i], first_below(z + below_[i]));
    } else {
      last_[i] = higher ? first_below(z) : first_not_above(z);
      first_[i] = std::min(last_[i], first_not_above(z - above_[i]));
    }
    if (spacing_ > 0.0)
      offset_[i] = static_cast<float>(first_depth_ + static_cast<double>(first_[i]) * spacing_ - z);
  }
}

// Gaussians of constant width along evenly spaced rows: their logarithm is a polynomial of second
// degree in the depth, so that each group of rows follows from the one before by multiplications.

namespace {

/// z ← z·w, complex.
void rotate(SimdFloats& re, SimdFloats& im, const SimdFloats& w_re,
            const SimdFloats& w_im) noexcept {
  const SimdFloats next = re * w_re - im * w_im;
  im = re * w_im + im * w_re;
  re = next;
}

/// The first group of rows of as many crossings as there are lanes, [crossings][rows].
struct FirstRows {
  alignas(64) float re[simd_width * simd_width], im[simd_width * simd_width];  // z, height included
  alignas(64) float ratio[simd_width * simd_width];  // |z| a group further on, over |z|
  alignas(64) float rotation_c[simd_width], rotation_s[simd_width];  // e^(iκD), from group to group
  alignas(64) float ratio_of_ratio[simd_width];  // of ratio, from group to group
};

/// Of z(dz) = h·exp(−a·dz² + b·dz + i(φ + κ·dz)), rows h apart and groups of them D apart:
///   z(dz + h)/z(dz) = exp(−a(2·dz·h + h²) + b·h + iκh), which changes by exp(−2ah²) a row,
///   |z(dz + D)/z(dz)| = exp(−a(2·dz·D + D²) + b·D), which changes by exp(−2ahD) a row.
struct EvenBeams {
  SimdFloats height, a, b, phase, wave_number, offset;

  void first_rows(float spacing, FirstRows& out) const noexcept {
    const float group = static_cast<float>(simd_width) * spacing;
    SimdFloats re, im, c, s;
    cos_sin(phase + wave_number * offset, re, im);
    const SimdFloats bell = height * exponential((b - a * offset) * offset);
    re *= bell, im *= bell;
    cos_sin(wave_number * spacing, c, s);
    const SimdFloats by_row = exponential(spacing * (b - a * (2.0F * offset + spacing)));
    c *= by_row, s *= by_row;
    const SimdFloats a2 = -2.0F * a * spacing;
    const SimdFloats per_row = exponential(a2 * spacing),
                     per_row_of_group = exponential(a2 * group);
    SimdFloats ratio = exponential(group * (b - a * (2.0F * offset + group)));
    for (std::size_t l = 0; l < simd_width; ++l) {
      store(re, out.re + l * simd_width);
      store(im, out.im + l * simd_width);
      store(ratio, out.ratio + l * simd_width);
      rotate(re, im, c, s);
      c *= per_row, s *= per_row;
      ratio *= per_row_of_group;
    }
    transpose(out.re), transpose(out.im), transpose(out.ratio);
    cos_sin(wave_number * group, c, s);
    store(c, out.rotation_c), store(s, out.rotation_s);
    store(exponential(static_cast<float>(simd_width) * a2 * group), out.ratio_of_ratio);
  }
};

void add_to(float* sum, const SimdFloats& value) noexcept { store(load(sum) + value, sum); }

/// Adds rows 0 … count − 1 of crossing i of those.
void add_groups(const FirstRows& first, std::size_t i, std::size_t count, float* real,
                float* imaginary) noexcept {
  SimdFloats re = load(first.re + i * simd_width), im = load(first.im + i * simd_width);
  const SimdFloats ratio = load(first.ratio + i * simd_width),
                   ratio_of_ratio = first.ratio_of_ratio[i];
  SimdFloats w_re = ratio * first.rotation_c[i], w_im = ratio * first.rotation_s[i];
  std::size_t k = 0;
  for (; k + simd_width <= count; k += simd_width) {
    add_to(real + k, re);
    add_to(imaginary + k, im);
    rotate(re, im, w_re, w_im);
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
  for (std::size_t i = 0; i < x.size(); i += simd_width) {
    const std::size_t used = std::min(simd_width, x.size() - i);
    const SimdFloats q = load(&q_[i]), per_sigma = 1.0F / load(&least_[i]);
    const SimdFloats u = load(&cosine_[i]) * per_sigma, tilt = 0.5F * load(&growth_[i]) / q;
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

namespace {

/// Hats that reach more rows than these are added one by one.
constexpr std::int32_t most_rows = 12;

}  // namespace

/// Where each crossing's rows begin in the sum, and how many they are; none beyond the last
/// crossing.
void ColumnSum::find_places(const Crossings& x) {
  const std::size_t n = x.size();
  place_.resize(n + simd_width), rows_.resize(n + simd_width);
  const auto stride = static_cast<std::int32_t>(stride_);
  const std::uint32_t* column = x.column.data();
  const std::int32_t *first = first_.data(), *last = last_.data();
  const float* q = q_.data();
  std::int32_t *place = place_.data(), *rows = rows_.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) {
    place[i] = static_cast<std::int32_t>(column[i]) * stride + first[i];
    rows[i] = q[i] == 0.0F ? 0 : last[i] - first[i];
  }
  std::fill_n(rows + n, simd_width, 0);
}

/// Puts side by side what add_hats needs of the crossings that reach a few evenly spaced rows:
/// where hats are narrower than rows are apart, half of them reach none. Adds those that reach
/// many. \return how many there are
template <bool coherent>
std::size_t ColumnSum::pack_hats(const Crossings& x) {
  const auto spacing = static_cast<float>(setting_.spacing);
  find_places(x);
  std::size_t n = 0;
  for (std::size_t i = 0; i < x.size(); i += simd_width) {
    const SimdInts rows = load(&rows_[i]);
    const SimdFloats cosine = load(&cosine_[i]);
    const SimdFloats alone = to_floats(rows) - static_cast<float>(most_rows);  // > 0, or widening:
    const SimdFloats widening = 2.0F * spacing * abs(load(&growth_[i])) - cosine;
    if (any_of(max(alone, widening) > 0.0F)) {
      for (std::size_t l = 0; l < std::min(simd_width, x.size() - i); ++l)
        if (rows_[i + l] > most_rows || widening[l] > 0.0F) {
          add_crossing_rows<coherent, true>(x, i + l);
          rows_[i + l] = 0;
        }
    }
    const Packing packing(load(&rows_[i]) > 0);
    for (auto* array : {&amplitude_, &cosine_, &q_, &growth_, &offset_})
      packing.pack(&(*array)[i], &(*array)[n]);
    if constexpr (coherent)
      for (auto* array : {&phase_, &wave_number_}) packing.pack(&(*array)[i], &(*array)[n]);
    for (auto* array : {&place_, &rows_}) packing.pack(&(*array)[i], &(*array)[n]);
    n += packing.count();
  }
  std::fill_n(rows_.begin() + static_cast<std::ptrdiff_t>(n), simd_width, 0);
  return n;
}

/// As many crossings at a time as there are lanes, row by row downwards, where the phase turns
/// evenly. A square of rows, real and imaginary parts in turn, is transposed, to add those of each
/// crossing to its column together.
template <bool coherent>
void ColumnSum::add_hats(const Crossings& x) {
  constexpr std::size_t group = coherent ? simd_width / 2 : simd_width;  // rows of a square
  const std::size_t n = pack_hats<coherent>(x);
  const auto spacing = static_cast<float>(setting_.spacing), per_spacing = 1.0F / spacing;
  const auto row_spacing = static_cast<float>(spacing_);
  float* sum = sum_.data();
  alignas(64) float square[simd_width * simd_width];
  for (std::size_t i = 0; i < n; i += simd_width) {
    const std::size_t used = std::min(simd_width, n - i);
    for (std::size_t l = 0; l < used; ++l)
      __builtin_prefetch(sum + static_cast<std::size_t>(place_[i + l]) * (coherent ? 2 : 1), 1);
    const SimdFloats q0 = load(&q_[i]), growth = load(&growth_[i]),
                     amplitude = load(&amplitude_[i]);
    const SimdFloats per_width = load(&cosine_[i]) * per_spacing,
                     count = to_floats(load(&rows_[i]));
    SimdFloats dz = load(&offset_[i]), c, s, rotation_c, rotation_s;
    if constexpr (coherent) {
      const SimdFloats wave_number = load(&wave_number_[i]);
      cos_sin(load(&phase_[i]) + wave_number * dz, c, s);
      cos_sin(wave_number * row_spacing, rotation_c, rotation_s);
    }
    const auto rows = static_cast<std::size_t>(hmax(count));
    for (std::size_t row = 0; row < rows; row += group) {
      for (std::size_t m = 0; m < group; ++m) {
        const SimdFloats per_q = 1.0F / max(abs(q0 + growth * dz), SimdFloats(1e-30F));
        // zero beyond its rows, but for half a hat, which ends at its ray
        const SimdFloats share = max(SimdFloats(0.0F), 1.0F - abs(dz) * per_width * per_q);
        SimdFloats weight = amplitude * share * (coherent ? sqrt(per_q) : per_q);
        if (half_ != Half::both)
          where(count <= static_cast<float>(static_cast<int>(row + m)), weight) = 0.0F;
        if constexpr (coherent) {
          store(weight * c, square + 2 * m * simd_width);
          store(weight * s, square + (2 * m + 1) * simd_width);
          const SimdFloats c_next = c * rotation_c - s * rotation_s;
          s = s * rotation_c + c * rotation_s;
          c = c_next;
        } else {
          store(weight, square + m * simd_width);
        }
        dz += row_spacing;
      }
      transpose(square);
      for (std::size_t l = 0; l < used; ++l) {
        // a column's padding has room for one group that begins at its last row
        if (row > 0 && row >= static_cast<std::size_t>(rows_[i + l])) continue;
        const std::size_t at = static_cast<std::size_t>(place_[i + l]) + row;
        float* to = sum + at * (coherent ? 2 : 1);
        store(load(to) + load(square + l * simd_width), to);
      }
    }
  }
}

template void ColumnSum::add_hats<true>(const Crossings&);
template void ColumnSum::add_hats<false>(const Crossings&);

// Receivers on the boundaries, which every beam serves once more by its partner (boundary_rows.h).

/// Of the beam, or the half of one, that was added last: where it reaches a boundary's row.
void ColumnSum::add_partners(const Crossings& x, const BoundaryRows& walls) {
  const bool is_hat = setting_.kind == BeamKind::hat;
  const float steep = (is_hat ? 2.0F : 8.0F) * static_cast<float>(setting_.spacing);
  for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    if (!walls.received(kind)) continue;
    const std::int32_t same = walls.row_of_all(kind);
    for (std::size_t i = 0; i < x.size(); i += simd_width) {
      if (same >= 0) {  // mostly no beam of several
        const auto reached = load(&first_[i]) <= same && load(&last_[i]) > same;
        if (none_of(reached) && none_of(load(&cosine_[i]) < steep * abs(load(&growth_[i]))))
          continue;
      }
      const std::size_t end = std::min(i + simd_width, x.size());
      for (std::size_t k = i; k < end; ++k) {
        const std::int32_t row = walls.row(kind, x.column[k]);
        if (row < 0 || walls.silent(kind, x.column[k])) continue;
        if ((row >= first_[k] && row < last_[k]) || way(k) == Way::plain)
          add_partner(x, k, kind, static_cast<std::size_t>(row), walls);
      }
    }
  }
}

void ColumnSum::add_partner(const Crossings& x, std::size_t i, BoundaryKind kind, std::size_t row,
                            const BoundaryRows& walls) {
  Crossing there = crossing_at(x, i);
  there.loss *= walls.partner(kind, x.column[i], there);
  const std::size_t at = x.column[i] * stride_ + row;
  beams::add_crossing(setting_, launch_, launched_, x.source_speed, there, depths_.subspan(row, 1),
                      [&](std::size_t, std::complex<double> p) { add_number(at, p); });
}

void ColumnSum::silence(const BoundaryRows& walls) {
  const std::size_t columns = real_.size() / stride_;
  for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom})
    for (std::size_t j = 0; j < columns; ++j)
      if (const std::int32_t row = walls.row(kind, j); row >= 0 && walls.silent(kind, j)) {
        const std::size_t at = j * stride_ + static_cast<std::size_t>(row);
        if (paired_)
          sum_[2 * at] = sum_[2 * at + 1] = 0.0F;
        else if (setting_.coherent)
          real_[at] = imaginary_[at] = 0.0F;
        else
          real_[at] = 0.0F;
      }
}

}  // namespace asdic::detail
