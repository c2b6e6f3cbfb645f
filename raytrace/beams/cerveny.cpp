#include "raytrace/beams/cerveny.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "raytrace/beams/crossing.h"
#include "raytrace/beams/foot.h"
#include "raytrace/beams/geometric.h"

namespace asdic::detail::beams {

namespace {

using Complex = std::complex<double>;

/// Beams are cut off smoothly between 50 and 100 wavelengths: 1, then a cubic down to 0.
double taper(double n, double wavelength) noexcept {
  const double x = std::clamp((std::abs(n) / wavelength - 50.0) / 50.0, 0.0, 1.0);
  return 1.0 - x * x * (3.0 - 2.0 * x);
}

/// What is added for pressure p of a wave that travels along (cosine, sine).
double component(const CervenyBeams& beam, double cosine, double sine) noexcept {
  switch (beam.component) {
    case CervenyBeams::Component::pressure:
      return 1.0;
    case CervenyBeams::Component::vertical:
      return sine;
    case CervenyBeams::Component::horizontal:
      return cosine;
  }
  return 1.0;
}

void add(const BeamSetting& setting, Complex contribution, Complex& sum) noexcept {
  if (setting.coherent)
    sum += contribution;
  else
    sum += std::norm(contribution);
}

/// a/b, of numbers far from the limits of their range.
Complex ratio(const Complex& a, const Complex& b) noexcept {
  return a * std::conj(b) / std::norm(b);
}

/// 1/√z on the branch of std::sqrt, of such a number.
Complex inverse_root(const Complex& z) noexcept {
  const double size = std::sqrt(std::norm(z));
  const double larger = std::sqrt(0.5 * (size + std::abs(z.real()))),
               other = 0.5 * std::abs(z.imag()) / larger;
  const bool right = z.real() >= 0.0;
  return Complex{right ? larger : other, -std::copysign(right ? other : larger, z.imag())} / size;
}

/// e^{−iωτ}.
Complex wave(double omega, const Complex& time) noexcept {
  return std::polar(std::exp(omega * time.imag()), -omega * time.real());
}

/// e^{−iω(τ + ζ·dz + γ·dz²/2)} at evenly spaced dz: its ratio from one to the next changes by a
/// constant factor, so that two multiplications do.
class EvenWave {
 public:
  EvenWave(double omega, double time, double zeta, const Complex& gamma, double dz, double step)
      : now_(wave(omega, time + zeta * dz + 0.5 * gamma * dz * dz)),
        ratio_(wave(omega, zeta * step + gamma * (dz * step + 0.5 * step * step))),
        change_(wave(omega, gamma * step * step)) {}
  [[nodiscard]] const Complex& now() const noexcept { return now_; }
  void next() noexcept {
    now_ *= ratio_;
    ratio_ *= change_;
  }

 private:
  Complex now_, ratio_, change_;
};

/// Rows that follow one another by multiplications before the next is worked out anew: rounding,
/// and what is nothing at the beam's edge, do not go on for ever.
constexpr std::size_t rows_at_once = 32;

/// From depth to depth if all are as far apart to a millionth of a wavelength [m], else 0.
double even_spacing(std::span<const double> depths, double frequency) noexcept {
  if (depths.size() < 2) return 0.0;
  const double step = (depths.back() - depths.front()) / static_cast<double>(depths.size() - 1);
  for (std::size_t k = 0; k < depths.size(); ++k)
    if (!(std::abs(depths[k] - depths.front() - static_cast<double>(k) * step) <
          1e-6 * 1500.0 / frequency))
      return 0.0;
  return step;
}

/// Φ·√c/√ε·Δα of the sum of beams: e^{−iπ/4}·√(f·cos α)·Δα·√c/c₀, which makes their integral by
/// stationary phase the ray's own pressure.
Complex beam_constant(const BeamSetting& setting, const BeamLaunch& launch,
                      const RayTrajectory& ray) {
  return std::polar(launch_factor(setting, launch, ray.source_speed) *
                        std::sqrt(setting.frequency) * setting.spacing / ray.source_speed,
                    -0.25 * pi);
}

/// What the images over the surface and under the bottom are multiplied with.
struct Image {
  bool mirrored = false;
  double depth = 0.0;  ///< of the mirror [m]
  double sign = 1.0;
  [[nodiscard]] double of(double z) const noexcept { return mirrored ? 2.0 * depth - z : z; }
};

/// The ray itself, its image in a pressure-release surface, its image in a rigid bottom.
Image image(const BeamSetting& setting, int index, double range) noexcept {
  if (index == 0) return {};
  const Environment& ocean = *setting.environment;
  if (index == 1) return {true, ocean.surface.depth_at(range), -1.0};
  return {true, ocean.bottom.depth_at(range), 1.0};
}

}  // namespace

Complex initial_ratio(const BeamSetting& setting, const RayTrajectory& ray, double last_range) {
  const CervenyBeams& beam = setting.cerveny;
  const double omega = 2.0 * pi * setting.frequency, c = ray.source_speed;
  const auto of_width_squared = [&](double w2) {
    return beam.width_multiplier * Complex{0.0, 0.5 * omega * w2};
  };
  switch (beam.width) {
    case CervenyBeams::Width::space_filling: {
      const double w = 2.0 * c / (omega * setting.spacing);
      return of_width_squared(w * w);
    }
    case CervenyBeams::Width::minimum:
      return of_width_squared(2.0 * c * beam.loop_range / omega);
    case CervenyBeams::Width::cerveny:
      return of_width_squared(2.0 * c * last_range / omega);
    case CervenyBeams::Width::wkb:
      break;
  }
  // P/Q = cos²θ·dζ/dz with ζ² = 1/c² − ξ²: the fronts of one horizontal slowness in a layered
  // ocean.
  const double cosine = std::cos(ray.launch_elevation), sine = -std::sin(ray.launch_elevation);
  const double gradient = ray.segments.empty() ? 0.0 : ray.segments.front().c_z_begin;
  const double curvature = -cosine * cosine * gradient / (c * c);  // P/Q·sin θ
  constexpr double flattest = 1e10;
  const double ratio =
      std::abs(curvature) * flattest < std::abs(sine) ? flattest : sine / curvature;
  // A trace of an imaginary part tells on which side √Q passes a zero of Q.
  return beam.width_multiplier * Complex{ratio, 1e-6 * std::max(std::abs(ratio), 1.0)};
}

ComplexBeam::ComplexBeam(CervenyBeams::Curvature curvature, double source_speed, Complex epsilon)
    : point_(source_speed), plane_(epsilon), last_(epsilon) {
  if (curvature == CervenyBeams::Curvature::doubled) jump_factor_ = 2.0;
  if (curvature == CervenyBeams::Curvature::zero) jump_factor_ = 0.0;
}

Complex ComplexBeam::spread(const RayState& state) const noexcept {
  return spread_ * inverse_root(ratio(q(state), last_));
}

void ComplexBeam::follow(const RayState& state) noexcept {
  spread_ = spread(state);
  last_ = q(state);
}

void ComplexBeam::pass(const RaySegment& before, const RaySegment& after) noexcept {
  follow(before.end);
  const bool reflected = after.history.surface_bounces != before.history.surface_bounces ||
                         after.history.bottom_bounces != before.history.bottom_bounces;
  if (!reflected || jump_factor_ == 1.0) return;
  const RayState &a = before.end, &b = after.begin;
  // Δp = k·q for either solution, weighted by its q (in one unit: times c₀).
  const double unit = std::norm(1.0 / b.xi);
  const double k = ((b.p - a.p) * a.q * unit + (b.p_plane - a.p_plane) * a.q_plane) /
                   (a.q * a.q * unit + a.q_plane * a.q_plane);
  const Complex q_now = q(a), p_now = p(a) + jump_factor_ * k * q_now;
  // (Q, P) = point·(q, p) + plane·(q_plane, p_plane) behind the jump.
  const double wronskian = b.q * b.p_plane - b.q_plane * b.p;
  point_ = (q_now * b.p_plane - p_now * b.q_plane) / wronskian;
  plane_ = (p_now * b.q - q_now * b.p) / wronskian;
}

void add_cerveny_cartesian(const BeamSetting& setting, const BeamLaunch& launch,
                           const RayTrajectory& ray, FieldSum& field) {
  const double omega = 2.0 * pi * setting.frequency;
  const double window = setting.cerveny.window;
  const Complex constant = beam_constant(setting, launch, ray);
  ComplexBeam beam(setting.cerveny.curvature, ray.source_speed,
                   initial_ratio(setting, ray, field.ranges.back()));
  const double spacing = field.irregular ? 0.0 : even_spacing(field.depths, setting.frequency);
  // Rows follow one another if at the beam's edge e^(−window²) is something to go on from.
  const bool followed = spacing > 0.0 && window * window < 300.0;
  for (std::size_t i = 0; i < ray.segments.size(); ++i) {
    const RaySegment& segment = ray.segments[i];
    if (i > 0) beam.pass(ray.segments[i - 1], segment);
    for_each_crossing(segment, field.ranges, [&](std::size_t column, const RayState& state) {
      const double c = 1.0 / std::sqrt(state.xi * state.xi + state.zeta * state.zeta);
      const double cosine = c * state.xi, sine = c * state.zeta;
      const double share =
          std::clamp((state.length - segment.begin.length) /
                         std::max(segment.end.length - segment.begin.length, 1e-300),
                     0.0, 1.0);
      const double c_r = segment.c_r_begin + share * (segment.c_r_end - segment.c_r_begin);
      const double c_z = segment.c_z_begin + share * (segment.c_z_end - segment.c_z_begin);
      const double c_s = c_r * cosine + c_z * sine, c_n = -c_r * sine + c_z * cosine;
      // ∂²τ/∂z² of the beam's front: (P/Q)cos² − 2(c_n/c²)sin·cos − (c_s/c²)sin²
      const Complex gamma = ratio(beam.p(state), beam.q(state)) * (cosine * cosine) -
                            (2.0 * c_n * sine * cosine + c_s * sine * sine) / (c * c);
      const double wavelength = c / setting.frequency;
      const double decay = 0.5 * omega * std::abs(gamma.imag());
      const double widest = std::min(window / std::sqrt(decay), 100.0 * wavelength);
      const Complex amplitude = constant * std::sqrt(c) * beam.spread(state) *
                                reflected(segment.history, setting.coherent) *
                                (std::exp(-state.nepers) * spread_across(setting, state));
      const std::span<const double> depths = field.column_depths(column);
      Complex* sum = field.column(column);
      for (int m = 0; m < setting.cerveny.images; ++m) {
        const Image mirror = image(setting, m, field.ranges[column]);
        const double a = mirror.of(state.depth - widest), b = mirror.of(state.depth + widest);
        auto k = static_cast<std::size_t>(
            std::upper_bound(depths.begin(), depths.end(), std::min(a, b)) - depths.begin());
        const Complex strength =
            mirror.sign * component(setting.cerveny, cosine, mirror.mirrored ? -sine : sine) *
            amplitude;
        const auto end = static_cast<std::size_t>(
            std::lower_bound(depths.begin(), depths.end(), std::max(a, b)) - depths.begin());
        const double step = mirror.mirrored ? -spacing : spacing;
        const auto add_row = [&](std::size_t row, const Complex& front) {
          const double dz = mirror.of(depths[row]) - state.depth;
          add(setting, taper(dz, wavelength) * strength * front, sum[row]);
        };
        while (followed && k < end) {
          EvenWave front(omega, state.time, state.zeta, gamma, mirror.of(depths[k]) - state.depth,
                         step);
          for (const std::size_t next = std::min(k + rows_at_once, end); k < next; ++k) {
            add_row(k, front.now());
            front.next();
          }
        }
        for (; k < end; ++k) {
          const double dz = mirror.of(depths[k]) - state.depth;
          add_row(k, wave(omega, state.time + state.zeta * dz + 0.5 * gamma * dz * dz));
        }
      }
    });
  }
}

void add_cerveny_ray_centred(const BeamSetting& setting, const BeamLaunch& launch,
                             const RayTrajectory& ray, FieldSum& field) {
  const double omega = 2.0 * pi * setting.frequency;
  const double window = setting.cerveny.window;
  const Complex constant = beam_constant(setting, launch, ray);
  const Complex epsilon = initial_ratio(setting, ray, field.ranges.back());
  for (int m = 0; m < setting.cerveny.images; ++m) {
    ComplexBeam beam(setting.cerveny.curvature, ray.source_speed, epsilon);
    const RaySegment* before = nullptr;
    Image mirror;
    const auto reach = [&](const RaySegment& segment) {
      if (before != nullptr) beam.pass(*before, segment);
      before = &segment;
      mirror = image(setting, m, segment.begin.range);
      double widest = 0.0;  // n with n²·ω·|Im(P/Q)|/2 = window², at the wider end
      for (const RayState& state : {segment.begin, segment.end})
        widest = std::max(
            widest,
            std::sqrt(2.0 / (omega * std::abs(ratio(beam.p(state), beam.q(state)).imag()))));
      return std::min(1.1 * window * widest, 100.0 * segment.c_begin / setting.frequency);
    };
    for_each_foot(
        ray, field, reach, [&](double z) { return mirror.of(z); },
        [&](const Foot& foot) {
          const RayState& state = foot.state;
          const double c = 1.0 / std::sqrt(state.xi * state.xi + state.zeta * state.zeta);
          const Complex gamma = ratio(beam.p(state), beam.q(state));
          const double n2 = foot.n * foot.n;
          if (0.5 * omega * std::abs(gamma.imag()) * n2 >= window * window) return;
          const double weight =
              mirror.sign * taper(foot.n, c / setting.frequency) *
              component(setting.cerveny, c * state.xi, (mirror.mirrored ? -c : c) * state.zeta);
          const Complex amplitude = constant * std::sqrt(c) * beam.spread(state) *
                                    reflected(foot.segment->history, setting.coherent) *
                                    (std::exp(-state.nepers) * spread_across(setting, state));
          add(setting, weight * amplitude * wave(omega, state.time + 0.5 * gamma * n2), *foot.sum);
        });
  }
}

}  // namespace asdic::detail::beams
