#include "raytrace/waves/depth_wave.h"

#include <algorithm>
#include <cmath>

#include "raytrace/waves/airy.h"
#include "raytrace/waves/airy_series.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

/// Of the two waves q^{−1/4}·e^{∓iη}, what their amplitudes and those of their derivatives are
/// multiplied with at one place.
struct Corrections {
  Complex down, up, down_slope, up_slope;
};

/// \param inverse_eta  1/η, η = ⅔w³/q′
Corrections corrections(Complex inverse_eta) {
  const double size = std::abs(inverse_eta.real()) + std::abs(inverse_eta.imag());
  const int terms = size < 1e-5 ? 2 : size < 1e-3 ? 4 : size < 0.02 ? 6 : airy_terms;
  const Complex x(-inverse_eta.imag(), inverse_eta.real());  // i/η
  Complex power = 1.0, c[2] = {0.0, 0.0}, d[2] = {0.0, 0.0};
  for (int k = 0; k < terms; ++k) {
    c[k % 2] += for_large.c[std::size_t(k)] * power;
    d[k % 2] += for_large.d[std::size_t(k)] * power;
    power *= x;
  }
  return {c[0] + c[1], c[0] - c[1], d[0] + d[1], d[0] - d[1]};
}

/// The square root with Re ≥ 0.
Complex root(Complex q) {
  const double size = std::sqrt(std::norm(q));
  if (!(size > 0.0)) return 0.0;
  // the greater part first: a sum, no difference
  const double greater = std::sqrt(0.5 * (size + std::abs(q.real())));
  const double lesser = 0.5 * q.imag() / greater;
  if (q.real() > 0.0) return {greater, lesser};
  return {std::abs(lesser), std::copysign(greater, q.imag())};
}

/// Where q is far from zero all the way.
void follow_far(DepthWave& wave, Complex q_from, Complex q_to, double thickness) {
  const Complex i(0.0, 1.0), slope = (q_to - q_from) / thickness;
  const Complex a = vertical_wavenumber(q_from), b = vertical_wavenumber(q_to);
  const Corrections from = corrections(1.5 * slope / (q_from * a));
  const Complex tilt = i * wave.du / a;
  const Complex down = 0.5 * (from.up_slope * wave.u + from.up * tilt);
  const Complex up = 0.5 * (from.down_slope * wave.u - from.down * tilt);
  // ∫w = ⅔(b³ − a³)/slope, without the difference
  const Complex phase = thickness * (2.0 / 3.0) * (q_from + a * b + q_to) / (a + b);
  const double shrink = std::exp(std::max(2.0 * phase.imag(), -700.0));
  const Complex turn(std::cos(phase.real()), -std::sin(phase.real()));
  const Complex scale = root(a / b);
  const Complex down_there = scale * down * turn * shrink;
  const Complex up_there = scale * up * std::conj(turn);
  const Corrections to = corrections(1.5 * slope / (q_to * b));
  wave.u = to.down * down_there + to.up * up_there;
  wave.du = i * b * (to.up_slope * up_there - to.down_slope * down_there);
  wave.growth -= phase.imag();
}

/// One step of the power series about the place where the wave is.
void follow_near(DepthWave& wave, Complex q, Complex slope, double step) {
  Complex before = 0.0, last = wave.u, now = wave.du * step;  // of u, times step^n
  Complex sum = last + now, slope_sum = now;
  const Complex a = -q * (step * step), b = -slope * (step * step * step);
  for (int n = 2; n < power_terms; ++n) {
    const Complex next = (a * last + b * before) / double(n * (n - 1));
    sum += next;
    slope_sum += double(n) * next;
    before = last;
    last = now;
    now = next;
  }
  wave.u = sum;
  wave.du = slope_sum / step;
}

/// Keeps the numbers of a size that can be calculated with.
void normalise(DepthWave& wave, Complex q) {
  const double square = std::norm(wave.u) + std::norm(wave.du) / (std::sqrt(std::norm(q)) + 1e-300);
  if (square > 1e-60 && square < 1e60) return;
  if (!(square > 0.0)) return;
  const double size = std::sqrt(square);
  wave.u /= size;
  wave.du /= size;
  wave.growth += std::log(size);
}

}  // namespace

Complex vertical_wavenumber(Complex q) noexcept {
  const Complex w = root(q);
  return w.imag() > 0.0 ? -w : w;
}

TravellingWaves travelling_waves(Complex q, double slope) noexcept {
  const Complex i(0.0, 1.0), w = vertical_wavenumber(q);
  if (std::abs(q * w) >= 1.5 * least_eta * std::abs(slope)) {
    const Corrections c = corrections(1.5 * slope / (q * w));
    return {c.down, -i * w * c.down_slope, c.up, i * w * c.up_slope};
  }
  const double scale = std::cbrt(slope);
  const Airy<Complex> a = airy(-q / (scale * scale));
  const TravellingWaves there{a.bi - i * a.ai, -scale * (a.bi_slope - i * a.ai_slope),
                              a.bi + i * a.ai, -scale * (a.bi_slope + i * a.ai_slope)};
  if (slope > 0.0) return there;
  return {there.up, there.up_slope, there.down, there.down_slope};
}

void follow(DepthWave& wave, Complex q_from, Complex q_to, double thickness) noexcept {
  const Complex slope = (q_to - q_from) / thickness;
  const double steep2 = std::norm(slope);
  // |q_from + slope·t|² = |slope|²·(t − middle)² + nearest²
  const double middle = steep2 > 0.0 ? -(std::conj(slope) * q_from).real() / steep2 : 0.0;
  const double nearest2 = std::norm(q_from + slope * middle);
  // Far from zero is |q|³ ≥ (1.5·least_eta·|slope|)²: mostly all the way.
  constexpr double eta2 = 2.25 * least_eta * least_eta;
  const bool near = nearest2 * nearest2 * nearest2 < eta2 * eta2 * steep2 * steep2;
  const double far2 = near ? std::cbrt(eta2 * eta2 * steep2 * steep2) : 0.0;
  const double reach = near ? std::sqrt((far2 - nearest2) / steep2) : -1.0;
  const double begin = std::clamp(middle - reach, 0.0, thickness);
  const double end = std::clamp(middle + reach, 0.0, thickness);
  const auto at = [&](double t) { return q_from + slope * t; };
  if (reach < 0.0 || end <= begin) {
    follow_far(wave, q_from, q_to, thickness);
  } else {
    if (begin > 0.0) follow_far(wave, q_from, at(begin), begin);
    const double widest = std::sqrt(std::max(std::abs(at(begin)), std::abs(at(end))));
    const int steps = std::max(1, int(std::ceil((end - begin) * widest / power_phase)));
    const double step = (end - begin) / steps;
    for (int k = 0; k < steps; ++k) {
      follow_near(wave, at(begin + k * step), slope, step);
      normalise(wave, slope * step);
    }
    if (end < thickness) follow_far(wave, at(end), q_to, thickness - end);
  }
  normalise(wave, q_to);
}

}  // namespace asdic::detail
