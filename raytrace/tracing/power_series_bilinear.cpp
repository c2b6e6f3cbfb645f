// Power series of a ray in a section: c bilinear in range and depth.
#include <cstring>
#include <utility>

#include "raytrace/tracing/power_series_terms.h"

namespace asdic::detail::tracing {
namespace {

using Doubles4 [[gnu::vector_size(32)]] = double;
using Doubles2 [[gnu::vector_size(16)]] = double;

[[gnu::always_inline]] inline Doubles4 both(double x) noexcept { return Doubles4{x, x, x, x}; }

[[gnu::always_inline]] inline Doubles4 simd_width(const std::array<double, 4>& x) noexcept {
  return Doubles4{x[0], x[1], x[2], x[3]};
}
[[gnu::always_inline]] inline Doubles4 magnitude(const Doubles4& x) noexcept {
  return x > -x ? x : -x;
}

/// (a + b, a + b, c + d, c + d).
[[gnu::always_inline]] inline Doubles4 sums_of_pairs(const Doubles4& x) noexcept {
  return x + __builtin_shufflevector(x, x, 1, 0, 3, 2);
}

/// With the place w = r + iz relative to the begin and the tangent t = t_r + it_z the gradient of
/// c = c₀ + c_r·r + c_z·z + c_rz·rz turns and lengthens the ray by one complex product,
///
///   c_n + i·c_s = (c_z + i·c_r)·t + c_rz·w·t,     c_nn = −2c_rz·t_r·t_z,
///
/// so that five sums of products, each of several lanes, make a term of everything.
class BilinearExpansion {
 public:
  BilinearExpansion(const SoundSpeed2D& s, const Row& row, double wanted, PowerSeries& y) noexcept
      : s_(s), row_(row), y_(y), end_(wanted, y), gradient_{s.c_z, s.c_r, s.c_z, s.c_r} {
    place_[0] = Doubles4{0.0, 0.0, y.place[0][2], y.place[0][3]};
    motion_[0] = Doubles4{y.motion[0][0], y.motion[0][1], y.motion[0][2], y.motion[0][3]};
    lay_out<0>();
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
  template <std::size_t i>
  [[gnu::always_inline]] void lay_out() noexcept {
    const Doubles4 &p = place_[i], &m = motion_[i];
    constexpr double minus = -1.0;
    twice_[i] = __builtin_shufflevector(p, p, 0, 1, 0, 1);
    across_[i] = __builtin_shufflevector(m, m, 0, 1, 1, 0) * Doubles4{1.0, minus, 1.0, 1.0};
    turned_[i] = __builtin_shufflevector(m, m, 1, 0, 2, 3) * Doubles4{1.0, minus, 1.0, 1.0};
    ranges_[i] = Doubles2{p[0], m[0]};
    depths_[i] = Doubles2{p[1], m[1]};
    tubes_[i] = Doubles2{p[2], p[3]};
  }

  /// Coefficient k of the product of two series. The terms with the latest coefficients come last:
  /// all others wait for nothing.
  template <std::size_t k, class SimdFloats>
  [[gnu::always_inline]] static SimdFloats product(const SimdFloats* x,
                                                   const SimdFloats* y) noexcept {
    if constexpr (k == 0) {
      return x[0] * y[0];
    } else if constexpr (k == 1) {
      return x[0] * y[1] + x[1] * y[0];
    } else {
      const SimdFloats before = [&]<std::size_t... i>(std::index_sequence<i...>)
          __attribute__((always_inline)) {
        return ((x[i + 1] * y[k - 1 - i]) + ...);
      }
      (std::make_index_sequence<k - 1>{});
      return (before + x[0] * y[k]) + x[k] * y[0];
    }
  }

  [[gnu::always_inline]] double size(std::size_t i) const noexcept {
    const Doubles4 a = magnitude(place_[i]) * place_weights_,
                   b = magnitude(motion_[i]) * motion_weights_;
    const Doubles4 m = a > b ? a : b;
    const double left = m[0] > m[1] ? m[0] : m[1], right = m[2] > m[3] ? m[2] : m[3];
    return left > right ? left : right;
  }

  /// Term k + 1 from the terms up to k; false when it was the last.
  template <std::size_t k>
  [[gnu::always_inline]] bool next() noexcept {
    constexpr double share = 1.0 / static_cast<double>(k + 1);
    const Doubles2 crossed = product<k>(ranges_, depths_);  // r·z, t_r·t_z
    double c = s_.c_r * place_[k][0] + s_.c_z * place_[k][1] + s_.c_rz * crossed[0];
    if constexpr (k == 0) c += s_.c;
    c_[k] = both(c);
    rates_[k] = sums_of_pairs(both(s_.c_rz) * product<k>(twice_, across_) + gradient_ * across_[k]);
    const double bend = 2.0 * s_.c_rz * crossed[1];  // −c_nn
    bends_[k] = Doubles2{bend, bend};
    const Doubles2 spread = product<k>(bends_, tubes_);
    place_[k + 1] = both(share) * product<k>(c_, motion_);
    motion_[k + 1] =
        both(share) * (product<k>(rates_, turned_) + Doubles4{0.0, 0.0, spread[0], spread[1]});
    lay_out<k + 1>();
    std::memcpy(y_.place[k + 1].data(), &place_[k + 1], sizeof(Doubles4));
    std::memcpy(y_.motion[k + 1].data(), &motion_[k + 1], sizeof(Doubles4));
    y_.length[k + 1] = share * c;
    y_.nepers[k + 1] = share * row_.alpha_top * c;
    if (row_.alpha_slope != 0.0) {
      double sunk = 0.0;
      for (std::size_t i = 0; i <= k; ++i) sunk += c_[i][0] * place_[k - i][1];
      y_.nepers[k + 1] += share * row_.alpha_slope * sunk;
    }
    return end_.goes_on<k>(y_, size(k + 1));
  }

  const SoundSpeed2D s_;
  const Row& row_;
  PowerSeries& y_;
  SeriesEnd end_;
  const Doubles4 place_weights_ = simd_width(end_.place_weights());
  const Doubles4 motion_weights_ = simd_width(SeriesEnd::motion_weights);
  const Doubles4 gradient_;          // (c_z, c_r, c_z, c_r)
  Doubles4 place_[most_terms + 1];   // (r, z, q, q_plane)
  Doubles4 motion_[most_terms + 1];  // (t_r, t_z, P, P_plane)
  Doubles4 twice_[most_terms + 1];   // (r, z, r, z)
  Doubles4 across_[most_terms + 1];  // (t_r, −t_z, t_z, t_r)
  Doubles4 turned_[most_terms + 1];  // (t_z, −t_r, P, P_plane)
  Doubles4 c_[most_terms + 1];       // four times
  Doubles4 rates_[most_terms + 1];   // (c_n, c_n, c_s, c_s)
  Doubles2 ranges_[most_terms + 1];  // (r, t_r)
  Doubles2 depths_[most_terms + 1];  // (z, t_z)
  Doubles2 tubes_[most_terms + 1];   // (q, q_plane)
  Doubles2 bends_[most_terms + 1];   // −c_nn, twice
};

}  // namespace

void expand_bilinear(const SoundSpeed2D& s, const Row& row, double wanted,
                     PowerSeries& y) noexcept {
  BilinearExpansion(s, row, wanted, y).run();
}

}  // namespace asdic::detail::tracing
