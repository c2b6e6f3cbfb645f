#include <algorithm>
#include <cmath>

#include "raytrace/beams/column_sum.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/math/lanes.h"

// What the loops over receivers need, for all crossings of a beam: loops that the compiler
// vectorises.
namespace asdic {

template <bool is_hat>
void ColumnSum::prepare(const BeamLaunch& launch, const Crossings& x) {
  const std::size_t n = x.size();
  const auto make_room = [n](auto& array) {  // the last lanes are read, and count for nothing
    array.resize(n + lanes);
    std::fill_n(array.end() - lanes, lanes, 0);
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

}  // namespace asdic
