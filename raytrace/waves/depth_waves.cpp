#include "raytrace/waves/depth_waves.h"

#include <cmath>

#include "core/simd.h"
#include "raytrace/waves/airy_series.h"

namespace asdic::detail {
namespace {

using Doubles = SimdDoubles;
using Mask = Doubles::mask_type;
static_assert(DepthWaves::count % doubles_at_once == 0);

/// Complex numbers, one in each lane.
struct Numbers {
  Doubles re = 0.0, im = 0.0;

  friend Numbers operator+(const Numbers& a, const Numbers& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend Numbers operator-(const Numbers& a, const Numbers& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend Numbers operator-(const Numbers& a) { return {-a.re, -a.im}; }
  friend Numbers operator*(const Numbers& a, const Numbers& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Numbers operator*(const Doubles& a, const Numbers& b) { return {a * b.re, a * b.im}; }
  friend Numbers operator/(const Numbers& a, const Numbers& b) {
    const Doubles per = 1.0 / (b.re * b.re + b.im * b.im);
    return {(a.re * b.re + a.im * b.im) * per, (a.im * b.re - a.re * b.im) * per};
  }
};

Numbers conjugate(const Numbers& z) { return {z.re, -z.im}; }
/// i·z
Numbers turned(const Numbers& z) { return {-z.im, z.re}; }
Doubles norm(const Numbers& z) { return z.re * z.re + z.im * z.im; }
void choose(const Mask& mask, Numbers& z, const Numbers& other) {
  where(mask, z.re) = other.re;
  where(mask, z.im) = other.im;
}

/// The square root with Re ≥ 0.
Numbers root(const Numbers& q) {
  const Doubles size = sqrt(norm(q)), greater = sqrt(0.5 * (size + abs(q.re)));
  Doubles lesser = 0.5 * q.im / greater;
  where(!(size > 0.0), lesser) = 0.0;
  Numbers found{greater, lesser};
  choose(!(q.re > 0.0), found, {abs(lesser), copysign(greater, q.im)});
  return found;
}

Numbers vertical_wavenumbers(const Numbers& q) {
  Numbers w = root(q);
  choose(w.im > 0.0, w, -w);
  return w;
}

struct Corrections {
  Numbers down, up, down_slope, up_slope;
};

/// Corrections of depth_wave.cpp. Each lane has as many terms as it would have alone.
Corrections corrections(const Numbers& inverse_eta) {
  const Doubles size = abs(inverse_eta.re) + abs(inverse_eta.im);
  Doubles terms = double(airy_terms);
  where(size < 0.02, terms) = 6.0;
  where(size < 1e-3, terms) = 4.0;
  where(size < 1e-5, terms) = 2.0;
  const Numbers x{-inverse_eta.im, inverse_eta.re};  // i/η
  Numbers power{1.0, 0.0}, c[2], d[2];
  const int most = int(hmax(terms));
  for (int k = 0; k < most; ++k) {
    const std::size_t n = std::size_t(k);
    c[n % 2] = c[n % 2] + Doubles(for_large.c[n]) * power;
    d[n % 2] = d[n % 2] + Doubles(for_large.d[n]) * power;
    power = power * x;
    choose(terms < k + 1.5, power, {});
  }
  return {c[0] + c[1], c[0] - c[1], d[0] + d[1], d[0] - d[1]};
}

/// Waves in lanes.
struct Waves {
  Numbers u, du;
  Doubles growth;
};

void choose(const Mask& mask, Waves& waves, const Waves& other) {
  choose(mask, waves.u, other.u);
  choose(mask, waves.du, other.du);
  where(mask, waves.growth) = other.growth;
}

/// \param slope  of q [1/m³]
void follow_far(Waves& wave, const Numbers& q_from, const Numbers& q_to, const Numbers& slope,
                const Doubles& thickness) {
  const Numbers a = vertical_wavenumbers(q_from), b = vertical_wavenumbers(q_to);
  const Numbers steep = Doubles(1.5) * slope;
  const Corrections from = corrections(steep / (q_from * a)), to = corrections(steep / (q_to * b));
  const Numbers tilt = turned(wave.du) / a;
  const Numbers down = Doubles(0.5) * (from.up_slope * wave.u + from.up * tilt);
  const Numbers up = Doubles(0.5) * (from.down_slope * wave.u - from.down * tilt);
  // ∫w = ⅔(b³ − a³)/slope, without the difference
  const Numbers phase = (thickness * (2.0 / 3.0)) * ((q_from + a * b + q_to) / (a + b));
  const Doubles shrink = exponential(max(2.0 * phase.im, Doubles(-700.0)));
  Numbers turn;
  cos_sin(phase.re, turn.re, turn.im);
  const Numbers scale = root(a / b);
  const Numbers down_there = shrink * (scale * down * conjugate(turn));
  const Numbers up_there = scale * up * turn;
  wave.u = to.down * down_there + to.up * up_there;
  wave.du = turned(b * (to.up_slope * up_there - to.down_slope * down_there));
  wave.growth -= phase.im;
}

void follow_near(Waves& wave, const Numbers& q, const Numbers& slope, const Doubles& step) {
  Numbers before, last = wave.u, now = step * wave.du;  // of u, times step^n
  Numbers sum = last + now, slope_sum = now;
  const Doubles step2 = step * step;
  const Numbers a = -step2 * q, b = -(step2 * step) * slope;
  for (int n = 2; n < power_terms; ++n) {
    const Numbers next = Doubles(1.0 / (n * (n - 1))) * (a * last + b * before);
    sum = sum + next;
    slope_sum = slope_sum + Doubles(double(n)) * next;
    before = last;
    last = now;
    now = next;
  }
  wave.u = sum;
  wave.du = (1.0 / step) * slope_sum;
}

void normalise(Waves& wave, const Numbers& q) {
  const Doubles square = norm(wave.u) + norm(wave.du) / (sqrt(norm(q)) + 1e-300);
  const Mask off = !(square > 1e-60 && square < 1e60) && square > 0.0;
  if (none_of(off)) return;
  Doubles size = 1.0;
  where(off, size) = sqrt(square);
  const Doubles per = 1.0 / size;
  wave.u = per * wave.u;
  wave.du = per * wave.du;
  for (std::size_t l = 0; l < doubles_at_once; ++l)
    if (off[l]) wave.growth[l] += std::log(double(size[l]));
}

/// follow(), each lane by its own pieces: far from zero, near it, far from it again.
/// \param steepness2  |slope|² [1/m⁶]   \param far2  square of |q| from which it is far [1/m⁴]
void follow(Waves& wave, const Numbers& q_from, const Numbers& q_to, const Numbers& slope,
            double thickness, double steepness2, double far2) {
  const Doubles middle =
      steepness2 > 0.0 ? -(slope.re * q_from.re + slope.im * q_from.im) / steepness2 : Doubles(0.0);
  const Doubles nearest2 = norm(q_from + middle * slope);
  const Mask near = nearest2 < far2;
  if (none_of(near)) {
    follow_far(wave, q_from, q_to, slope, thickness);
    return normalise(wave, q_to);
  }
  Doubles reach = 0.0;
  where(near, reach) = sqrt((far2 - nearest2) / steepness2);
  const Doubles low = 0.0, high = thickness;
  Doubles begin = clamp(middle - reach, low, high), end = clamp(middle + reach, low, high);
  const Mask bends = near && end > begin;
  where(!bends, begin) = high;
  where(!bends, end) = high;
  const auto at = [&](const Doubles& t) { return q_from + t * slope; };

  const Mask before = begin > 0.0;
  if (any_of(before)) {
    Waves there = wave;
    Numbers until = at(begin);
    choose(!bends, until, q_to);
    follow_far(there, q_from, until, slope, begin);
    choose(before, wave, there);
  }
  if (any_of(bends)) {
    const Doubles widest = sqrt(sqrt(max(norm(at(begin)), norm(at(end)))));
    Doubles steps = ceil((end - begin) * widest * (1.0 / power_phase));
    steps = max(steps, Doubles(1.0));
    where(!bends, steps) = 0.0;
    Doubles step = thickness;
    where(bends, step) = (end - begin) / steps;
    const int most = int(hmax(steps));
    for (int k = 0; k < most; ++k) {
      Waves there = wave;
      follow_near(there, at(begin + double(k) * step), slope, step);
      normalise(there, step * slope);
      choose(steps > double(k) + 0.5, wave, there);
    }
  }
  const Mask after = bends && end < high;
  if (any_of(after)) {
    Waves there = wave;
    follow_far(there, at(end), q_to, slope, high - end);
    choose(after, wave, there);
  }
  normalise(wave, q_to);
}

}  // namespace

void follow(DepthWaves& waves, const Wavenumbers& xi, std::complex<double> k2_from,
            std::complex<double> k2_to, double thickness) noexcept {
  const std::complex<double> steep = (k2_to - k2_from) / thickness;
  const Numbers slope{steep.real(), steep.imag()};
  // Far from zero is |q|³ ≥ (1.5·least_eta·|slope|)².
  constexpr double eta2 = 2.25 * least_eta * least_eta;
  const double steepness2 = std::norm(steep),
               far2 = std::cbrt(eta2 * eta2 * steepness2 * steepness2);
  for (std::size_t i = 0; i < DepthWaves::count; i += doubles_at_once) {
    const Numbers squares{load(&xi.square_re[i]), load(&xi.square_im[i])};
    const auto q = [&](std::complex<double> k2) {
      return Numbers{k2.real() - squares.re, k2.imag() - squares.im};
    };
    Waves wave{{load(&waves.u_re[i]), load(&waves.u_im[i])},
               {load(&waves.du_re[i]), load(&waves.du_im[i])},
               load(&waves.growth[i])};
    follow(wave, q(k2_from), q(k2_to), slope, thickness, steepness2, far2);
    store(wave.u.re, &waves.u_re[i]), store(wave.u.im, &waves.u_im[i]);
    store(wave.du.re, &waves.du_re[i]), store(wave.du.im, &waves.du_im[i]);
    store(wave.growth, &waves.growth[i]);
  }
}

}  // namespace asdic::detail
