// Power series of a ray in a section: c bilinear in range and depth.
#include <utility>

#include "core/simd.h"
#include "raytrace/tracing/power_series_terms.h"

namespace asdic::detail::tracing {
namespace {

using Four = Lanes<double, 4>;
using Two = Lanes<double, 2>;

[[gnu::always_inline]] inline Four both(double x) noexcept { return Four{x, x, x, x}; }

[[gnu::always_inline]] inline Four magnitude(const Four& x) noexcept { return x > -x ? x : -x; }

/// (a + b, a + b, c + d, c + d).
[[gnu::always_inline]] inline Four sums_of_pairs(const Four& x) noexcept {
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
    place_[0] = Four{0.0, 0.0, y.place[0][2], y.place[0][3]};
    motion_[0] = load_lanes<Four>(y.motion[0].data());
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
    const Four &p = place_[i], &m = motion_[i];
    constexpr double minus = -1.0;
    twice_[i] = __builtin_shufflevector(p, p, 0, 1, 0, 1);
    across_[i] = __builtin_shufflevector(m, m, 0, 1, 1, 0) * Four{1.0, minus, 1.0, 1.0};
    turned_[i] = __builtin_shufflevector(m, m, 1, 0, 2, 3) * Four{1.0, minus, 1.0, 1.0};
    ranges_[i] = Two{p[0], m[0]};
    depths_[i] = Two{p[1], m[1]};
    tubes_[i] = Two{p[2], p[3]};
  }

  /// Coefficient k of the product of two series. The terms with the latest coefficients come last:
  /// all others wait for nothing.
  template <std::size_t k, class Numbers>
  [[gnu::always_inline]] static Numbers product(const Numbers* x, const Numbers* y) noexcept {
    if constexpr (k == 0) {
      return x[0] * y[0];
    } else if constexpr (k == 1) {
      return x[0] * y[1] + x[1] * y[0];
    } else {
      const Numbers before = [&]<std::size_t... i>(std::index_sequence<i...>)
          __attribute__((always_inline)) {
        return ((x[i + 1] * y[k - 1 - i]) + ...);
      }
      (std::make_index_sequence<k - 1>{});
      return (before + x[0] * y[k]) + x[k] * y[0];
    }
  }

  [[gnu::always_inline]] double size(std::size_t i) const noexcept {
    const Four a = magnitude(place_[i]) * place_weights_,
               b = magnitude(motion_[i]) * motion_weights_;
    const Four m = a > b ? a : b;
    const double left = m[0] > m[1] ? m[0] : m[1], right = m[2] > m[3] ? m[2] : m[3];
    return left > right ? left : right;
  }

  /// Term k + 1 from the terms up to k; false when it was the last.
  template <std::size_t k>
  [[gnu::always_inline]] bool next() noexcept {
    constexpr double share = 1.0 / static_cast<double>(k + 1);
    const Two crossed = product<k>(ranges_, depths_);  // r·z, t_r·t_z
    double c = s_.c_r * place_[k][0] + s_.c_z * place_[k][1] + s_.c_rz * crossed[0];
    if constexpr (k == 0) c += s_.c;
    c_[k] = both(c);
    rates_[k] = sums_of_pairs(both(s_.c_rz) * product<k>(twice_, across_) + gradient_ * across_[k]);
    const double bend = 2.0 * s_.c_rz * crossed[1];  // −c_nn
    bends_[k] = Two{bend, bend};
    const Two spread = product<k>(bends_, tubes_);
    place_[k + 1] = both(share) * product<k>(c_, motion_);
    motion_[k + 1] =
        both(share) * (product<k>(rates_, turned_) + Four{0.0, 0.0, spread[0], spread[1]});
    lay_out<k + 1>();
    store_lanes(place_[k + 1], y_.place[k + 1].data());
    store_lanes(motion_[k + 1], y_.motion[k + 1].data());
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
  const Four place_weights_ = load_lanes<Four>(end_.place_weights().data());
  const Four motion_weights_ = load_lanes<Four>(SeriesEnd::motion_weights.data());
  const Four gradient_;          // (c_z, c_r, c_z, c_r)
  Four place_[most_terms + 1];   // (r, z, q, q_plane)
  Four motion_[most_terms + 1];  // (t_r, t_z, P, P_plane)
  Four twice_[most_terms + 1];   // (r, z, r, z)
  Four across_[most_terms + 1];  // (t_r, −t_z, t_z, t_r)
  Four turned_[most_terms + 1];  // (t_z, −t_r, P, P_plane)
  Four c_[most_terms + 1];       // four times
  Four rates_[most_terms + 1];   // (c_n, c_n, c_s, c_s)
  Two ranges_[most_terms + 1];   // (r, t_r)
  Two depths_[most_terms + 1];   // (z, t_z)
  Two tubes_[most_terms + 1];    // (q, q_plane)
  Two bends_[most_terms + 1];    // −c_nn, twice
};

}  // namespace

void expand_bilinear(const SoundSpeed2D& s, const Row& row, double wanted,
                     PowerSeries& y) noexcept {
  BilinearExpansion(s, row, wanted, y).run();
}

}  // namespace asdic::detail::tracing
