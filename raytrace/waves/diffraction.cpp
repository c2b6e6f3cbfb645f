#include "raytrace/waves/diffraction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel.h"
#include "raytrace/stop.h"
#include "raytrace/waves/wave_column.h"

namespace asdic {
namespace {

using Complex = std::complex<double>;

constexpr double least_angle = radians(4.0), airy_spreads = 6.0;
constexpr double bell_width = 60.0;  // wavenumbers of an edge, times the range
constexpr double ranges_of_a_period = 1.5, suppressed = 9.21;
constexpr double nearest_shadow = 50.0;   // wavelengths: no shadow is nearer
constexpr double faintest = 1e-3;         // of 1/r: the integral's own noise is 1e-5
constexpr double faintest_beside = 0.01;  // of the rays
constexpr double slowness_share = 0.02;   // by which slownesses may differ from 1/c
constexpr double depth_step = 0.05;       // wavelengths

/// The pressure at a place and how it changes there.
struct WaveAt {
  Complex p = 0.0, along = 0.0;                ///< and ∂p/∂r
  Complex by_source = 0.0, by_receiver = 0.0;  ///< ∂p/∂z of either end
};

/// The water's own field at one range, of waves that no bottom returns.
class WaterborneField {
 public:
  WaterborneField(const Environment& ocean, double source_depth, double receiver_depth,
                  double range)
      : ocean_(ocean), source_(source_depth), receiver_(receiver_depth), range_(range) {
    ocean_.bottom.material = ReflectionTable{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
    ocean_.bottom.roughness = {};
    for (std::size_t i = 0; i < ocean_.water.intervals(); ++i) steepest(ocean_.water.law(i).z0);
    steepest(ocean_.surface.depth);
    steepest(ocean_.bottom.depth);
  }

  /// Whether two frequencies are.
  [[nodiscard]] bool affordable(double frequency) const {
    const WaveColumn column(ocean_, frequency, source_, std::span(&receiver_, 1));
    const double steps = double(column.layers()) * double(window(column, frequency).count);
    return 2.0 * steps <= most_diffraction_steps;
  }

  /// \throws Interrupted
  [[nodiscard]] WaveAt field(double frequency) const {
    const double h = depth_step * ocean_.water.at(receiver_).c / frequency;
    const std::array<double, rows> depths = {std::max(ocean_.surface.depth, receiver_ - h),
                                             receiver_,
                                             std::min(ocean_.bottom.depth, receiver_ + h)};
    const WaveColumn column(ocean_, frequency, source_, depths);
    const Window w = window(column, frequency);
    constexpr std::size_t stretch = 16;
    std::vector<Complex> g(rows * w.count), by_source(rows * w.count);
    in_parallel_stretches(w.count, stretch, [&](std::size_t begin, std::size_t end) {
      std::array<double, rows> growth{};
      for (std::size_t j = begin; j < end; ++j) {
        stop_point();
        column.kernel(w.at(j), growth, std::span(g).subspan(rows * j, rows),
                      std::span(by_source).subspan(rows * j, rows));
      }
    });
    WaveAt sum;
    const double scale = 0.5 * w.spacing * std::sqrt(2.0 / (pi * range_));
    for (std::size_t j = 0; j < w.count; ++j) {
      const Complex xi = w.at(j), down = (g[rows * j + 2] - g[rows * j]) / (depths[2] - depths[0]);
      const Complex f = scale * w.weight(xi.real()) * std::sqrt(xi) *
                        std::exp(Complex(0.0, -1.0) * (xi * range_ - 0.25 * pi));
      sum.p += f * g[rows * j + 1];
      sum.along += Complex(0.0, -1.0) * xi * f * g[rows * j + 1];
      sum.by_source += f * by_source[rows * j + 1];
      sum.by_receiver += f * down;
    }
    return sum;
  }

 private:
  struct Window {
    double spacing, offset, begin, end, low_width, high_width;
    std::size_t count;
    [[nodiscard]] Complex at(std::size_t j) const {
      return {begin + (double(j) + 0.5) * spacing, offset};
    }
    [[nodiscard]] double weight(double s) const {
      const auto rise = [](double x) { return 0.5 * std::erfc(-4.0 * (2.0 * x - 1.0)); };
      return rise((s - begin) / low_width) * rise((end - s) / high_width);
    }
  };

  static constexpr std::size_t rows = 3;

  void steepest(double depth) {
    gradient_ = std::max(gradient_, std::abs(ocean_.water.at(depth).dc_dz));
  }

  /// From waves too steep to stay in the water at this range: those whose angle at the fastest
  /// depth is above four degrees and above what Airy's function spreads, (2c′/ω)^{1/3}, by far.
  Window window(const WaveColumn& column, double frequency) const {
    const double slow = column.largest_wavenumber(), fast = column.smallest_wavenumber();
    const double spread = std::cbrt(2.0 * gradient_ / (2.0 * pi * frequency));
    const double angle = std::clamp(airy_spreads * spread, least_angle, radians(50.0));
    const double flat = fast * std::cos(angle), steep = fast * std::cos(1.5 * angle);
    Window w{};
    w.spacing = 2.0 * pi / (ranges_of_a_period * range_);
    w.offset = suppressed / (ranges_of_a_period * range_);
    w.low_width = std::max(flat - steep, bell_width / range_);
    w.high_width = std::max(0.003 * slow, bell_width / range_);
    w.begin = std::max(flat - w.low_width, 0.02 * fast);
    w.end = slow + w.high_width;
    w.count = std::size_t((w.end - w.begin) / w.spacing);
    return w;
  }

  Environment ocean_;
  double source_, receiver_, range_;
  double gradient_ = 0.0;  ///< the steepest |dc/dz| [1/s]
};

/// Elevation of travel at a depth, positive up, of a slowness [s/m]. \param down  downward flux
double elevation_of(double slowness, double speed, double down) {
  const double angle = std::acos(std::clamp(slowness * speed, 0.0, 1.0));
  return down > 0.0 ? -angle : angle;
}

/// Of Σ conj(p)·∂p over Σ|p|², the wavenumber: p goes as e^{−ikx}.
double wavenumber(Complex p, Complex slope) {
  return -(std::conj(p) * slope).imag() / std::norm(p);
}

/// \param least  amplitude below which there is nothing
std::optional<Arrival> louder_arrival(const Environment& ocean, double source_depth,
                                      double receiver_depth, double range, double frequency,
                                      double least) {
  const double c = ocean.water.at(receiver_depth).c;
  if (range * frequency < nearest_shadow * c) return std::nullopt;
  const WaterborneField there(ocean, source_depth, receiver_depth, range);
  if (!there.affordable(frequency)) return std::nullopt;
  const WaveAt wave = there.field(frequency);
  if (!(std::abs(wave.p) > std::max(least, faintest / range))) return std::nullopt;

  // A second frequency, so near that delays which differ are told apart.
  const double about = range / c, step = std::min(1.0, 0.25 / (slowness_share * about));
  const Complex turned = std::conj(wave.p) * there.field(frequency + step).p *
                         std::polar(1.0, std::fmod(step * about, 1.0) * 2.0 * pi);
  const double slowness = wavenumber(wave.p, wave.along) / (2.0 * pi * frequency);

  Arrival path;
  path.kind = ArrivalKind::diffracted;
  path.delay = about - std::arg(turned) / (2.0 * pi * step);
  path.amplitude = wave.p * std::polar(1.0, 2.0 * pi * std::fmod(frequency * path.delay, 1.0));
  path.spreading = std::abs(wave.p);
  path.horizontal_slowness = slowness;
  // p goes as e^{+ikz} with the depth of the source.
  path.launch_elevation =
      elevation_of(slowness, ocean.water.at(source_depth).c, -wavenumber(wave.p, wave.by_source));
  path.arrival_elevation = elevation_of(slowness, c, wavenumber(wave.p, wave.by_receiver));
  path.path_length = range / std::max(0.5, std::min(1.0, slowness * c));
  const double loss = attenuation_np_per_m(ocean, frequency).at(receiver_depth);
  path.absorption_db = db_from_amplitude(std::exp(loss * path.path_length));
  path.spreading *= std::exp(loss * path.path_length);
  return path;
}

}  // namespace

bool diffraction_is_affordable(const Environment& ocean, double source_depth, double receiver_depth,
                               double range, double frequency) {
  return WaterborneField(ocean, source_depth, receiver_depth, range).affordable(frequency);
}

std::optional<Arrival> diffracted_arrival(const Environment& ocean, double source_depth,
                                          double receiver_depth, double range, double frequency) {
  return louder_arrival(ocean, source_depth, receiver_depth, range, frequency, 0.0);
}

std::optional<Arrival> diffracted_arrival(const Environment& ocean, double source_depth,
                                          double receiver_depth, double range, double frequency,
                                          const Arrivals& rays) {
  double power = 0.0;
  for (const Arrival& ray : rays) {
    if (ray.bottom_bounces == 0) return std::nullopt;
    power += std::norm(ray.amplitude);
  }
  return louder_arrival(ocean, source_depth, receiver_depth, range, frequency,
                        faintest_beside * std::sqrt(power));
}

}  // namespace asdic
