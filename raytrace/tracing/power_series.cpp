#include "raytrace/tracing/power_series.h"

#include <cmath>
#include <utility>

#include "core/simd.h"
#include "raytrace/math/gauss_legendre.h"
#include "raytrace/tracing/power_series_terms.h"

namespace asdic::detail::tracing {
namespace {

using Four = Lanes<double, 4>;

Four load(const std::array<double, 4>& from) noexcept { return load_lanes<Four>(from.data()); }
void store(const Four& value, std::array<double, 4>& to) noexcept { store_lanes(value, to.data()); }

/// Coefficient k of a product. The terms with the latest coefficients come last: all others wait
/// for nothing.
template <std::size_t k>
[[gnu::always_inline]] inline double product(const Series& x, const Series& y) noexcept {
  double even = 0.0, odd = 0.0;
  for (std::size_t i = 1; i + 1 < k; i += 2) {
    even += x[i] * y[k - i];
    odd += x[i + 1] * y[k - i - 1];
  }
  if constexpr (k > 0 && k % 2 == 0) even += x[k - 1] * y[1];
  if constexpr (k > 0) odd += x[k] * y[0];
  return (even + odd) + x[0] * y[k];
}

/// The same of four products with one factor, and added to others.
template <std::size_t k>
[[gnu::always_inline]] inline Four product(const Series& x, const FourSeries& y) noexcept {
  Four even{}, odd{};
  for (std::size_t i = 1; i + 1 < k; i += 2) {
    even += x[i] * load(y[k - i]);
    odd += x[i + 1] * load(y[k - i - 1]);
  }
  if constexpr (k > 0 && k % 2 == 0) even += x[k - 1] * load(y[1]);
  if constexpr (k > 0) odd += x[k] * load(y[0]);
  return (even + odd) + x[0] * load(y[k]);
}

template <std::size_t k>
[[gnu::always_inline]] inline Four product(const FourSeries& x, const FourSeries& y) noexcept {
  Four even{}, odd{};
  for (std::size_t i = 1; i + 1 < k; i += 2) {
    even += load(x[i]) * load(y[k - i]);
    odd += load(x[i + 1]) * load(y[k - i - 1]);
  }
  if constexpr (k > 0 && k % 2 == 0) even += load(x[k - 1]) * load(y[1]);
  if constexpr (k > 0) odd += load(x[k]) * load(y[0]);
  return (even + odd) + load(x[0]) * load(y[k]);
}

/// The ray's place and direction, and the water along it, as series: c, its gradient, and ∂²c/∂n²
/// made of its second derivatives.
struct Water {
  Series z, tr, tz;
  Series c, c_z, c_nn;
};

/// c and c_z to order k, from the place to order k.
struct CubicWater {
  const Cell& cell;
  SoundSpeed2D s;
  Series square, c_zz, across;

  template <std::size_t k>
  void next(Water& w) noexcept {
    const double a3 = cell.a[3];
    square[k] = product<k>(w.z, w.z);
    w.c[k] = s.c_z * w.z[k] + 0.5 * s.c_zz * square[k] + a3 * product<k>(w.z, square);
    w.c_z[k] = s.c_zz * w.z[k] + 3.0 * a3 * square[k];
    c_zz[k] = 6.0 * a3 * w.z[k];
    if constexpr (k == 0) {
      w.c[0] = s.c;
      w.c_z[0] = s.c_z;
      c_zz[0] = s.c_zz;
    }
    across[k] = product<k>(w.tr, w.tr);
    w.c_nn[k] = product<k>(c_zz, across);
  }
};

/// E = e^(−η) follows from Ė = −(2/B)·ż·E.
struct MunkWater {
  const MunkParameters& munk;
  double depth;
  Series decay, c_zz, across, rise;

  template <std::size_t k>
  void next(Water& w) noexcept {
    const double per_metre = 2.0 / munk.scale_depth;
    const double strength = munk.axis_speed * munk.perturbation;
    const double eta = per_metre * (depth - munk.axis_depth);
    if constexpr (k == 0) {
      decay[0] = std::exp(-eta);
    } else {
      rise[k - 1] = static_cast<double>(k) * w.z[k];  // ż
      decay[k] = -per_metre * product<k - 1>(rise, decay) / static_cast<double>(k);
    }
    w.c[k] = strength * (per_metre * w.z[k] + decay[k]);
    w.c_z[k] = -strength * per_metre * decay[k];
    c_zz[k] = strength * per_metre * per_metre * decay[k];
    if constexpr (k == 0) {
      w.c[0] += munk.axis_speed + strength * (eta - 1.0);
      w.c_z[0] += strength * per_metre;
    }
    across[k] = product<k>(w.tr, w.tr);
    w.c_nn[k] = product<k>(c_zz, across);
  }
};

/// Terms of everything one by one. The water knows no range.
template <class Law>
class Expansion {
 public:
  Expansion(const Law& law, const Row& row, double wanted, PowerSeries& y) noexcept
      : row_(row), y_(y), end_(wanted, y), law_(law) {
    take(0);
  }

  void run() noexcept {
    run(std::make_index_sequence<most_terms>{});
    end_.shorten(y_);
  }

 private:
  template <std::size_t... k>
  void run(std::index_sequence<k...>) noexcept {
    (void)(next<k>() && ...);
  }

  /// Coefficient i, laid out as the sums take it.
  void take(std::size_t i) noexcept {
    const auto &place = y_.place[i], &motion = y_.motion[i];
    w_.z[i] = place[PowerSeries::depth];
    w_.tr[i] = motion[PowerSeries::tr];
    w_.tz[i] = motion[PowerSeries::tz];
    turned_[i] = {motion[1], -motion[0], motion[2], motion[3]};
  }

  /// Term k + 1 from the terms up to k; false when it was the last.
  template <std::size_t k>
  [[gnu::always_inline]] bool next() noexcept {
    law_.template next<k>(w_);
    const double c_n = product<k>(w_.c_z, w_.tr), c_s = product<k>(w_.c_z, w_.tz);
    rates_[k] = {c_n, c_n, c_s, c_s};
    bends_[k] = {0.0, 0.0, -w_.c_nn[k], -w_.c_nn[k]};
    constexpr double share = 1.0 / static_cast<double>(k + 1);
    const Four place = share * product<k>(w_.c, y_.motion);
    const Four motion = share * (product<k>(rates_, turned_) + product<k>(bends_, y_.place));
    store(place, y_.place[k + 1]);
    store(motion, y_.motion[k + 1]);
    take(k + 1);
    y_.length[k + 1] = share * w_.c[k];
    y_.nepers[k + 1] = share * row_.alpha_top * w_.c[k];
    if (row_.alpha_slope != 0.0)
      y_.nepers[k + 1] += share * row_.alpha_slope * product<k>(w_.c, w_.z);
    return end_.goes_on<k>(y_);
  }

  alignas(32) FourSeries turned_;  // (t_z, −t_r, P, P)
  alignas(32) FourSeries rates_;   // (c_n, c_n, c_s, c_s)
  alignas(32) FourSeries bends_;   // (0, 0, −c_nn, −c_nn)
  const Row& row_;
  PowerSeries& y_;
  SeriesEnd end_;
  Law law_;
  Water w_;
};

}  // namespace

void PowerSeries::expand(const Cell& cell, const RayState& y, const Local& here,
                         double wanted) noexcept {
  const SoundSpeed2D s = cell.speed(y.range, y.depth);
  place[0] = {0.0, 0.0, y.q, y.q_plane};
  motion[0] = {here.c * y.xi, here.c * y.zeta, here.c * y.p, here.c * y.p_plane};
  length[0] = nepers[0] = 0.0;
  Row row = *cell.row;  // α over the depth from here
  row.alpha_top = row.alpha(y.depth);
  if (cell.law == Law::bilinear)
    expand_bilinear(s, row, wanted, *this);
  else if (cell.law == Law::munk)
    Expansion<MunkWater>({*cell.munk, y.depth, {}, {}, {}, {}}, row, wanted, *this).run();
  else
    Expansion<CubicWater>({cell, s, {}, {}, {}}, row, wanted, *this).run();
}

std::array<double, 4> PowerSeries::values(const FourSeries& a, double h) const noexcept {
  Four v = load(a[order]);
  for (std::size_t i = order; i-- > 0;) v = load(a[i]) + h * v;
  std::array<double, 4> result;
  store(v, result);
  return result;
}

double PowerSeries::speed_integral(double h) const noexcept {
  using Rule =
      GaussLegendre<4>;  // c is ṡ, and the terms of c² from the eighth on are next to nothing
  Four at{}, weight{};
  for (std::size_t i = 0; i < 4; ++i) {
    at[i] = 0.5 * h * (1.0 + Rule::node[i]);
    weight[i] = 0.5 * h * Rule::weight[i];
  }
  static constexpr Series power = [] {
    Series i{};
    for (std::size_t k = 0; k < i.size(); ++k) i[k] = static_cast<double>(k);
    return i;
  }();
  Four c = power[order] * length[order] + Four{};
  for (std::size_t i = order - 1; i > 0; --i) c = power[i] * length[i] + at * c;
  const Four terms = weight * c * c;
  return (terms[0] + terms[2]) + (terms[1] + terms[3]);
}

std::array<ValueSlope, 2> PowerSeries::where(double h) const noexcept {
  using Two = Lanes<double, 2>;
  const auto two = [&](std::size_t i) { return load_lanes<Two>(place[i].data()); };
  Two v = two(order), d{};
  for (std::size_t i = order; i-- > 0;) {
    d = v + h * d;
    v = two(i) + h * v;
  }
  return {ValueSlope{v[0], d[0]}, ValueSlope{v[1], d[1]}};
}

}  // namespace asdic::detail::tracing
