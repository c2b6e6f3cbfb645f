#include "raytrace/waves/diffraction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

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
  }

  /// Whether two frequencies are.
  [[nodiscard]] bool affordable(double frequency) const {
    const WaveColumn column(ocean_, frequency, source_, std::span(&receiver_, 1));
    const double steps =
        double(column.layers()) * double(water_window(ocean_, column, frequency, range_).count);
    return 2.0 * steps <= most_diffraction_steps;
  }

  /// \throws Interrupted
  [[nodiscard]] WaveAt field(double frequency) const {
    const double h = depth_step * ocean_.water.at(receiver_).c / frequency;
    const std::array<double, rows> depths = {std::max(ocean_.surface.depth, receiver_ - h),
                                             receiver_,
                                             std::min(ocean_.bottom.depth, receiver_ + h)};
    const WaveColumn column(ocean_, frequency, source_, depths);
    const WaterWindow w = water_window(ocean_, column, frequency, range_);
    constexpr std::size_t piece = 16;
    std::vector<Complex> g(rows * w.count), by_source(rows * w.count);
    in_parallel_chunks(w.count, piece, [&](std::size_t begin, std::size_t end) {
      std::array<double, rows> growth{};
      for (std::size_t j = begin; j < end; ++j) {
        stop_point();
        column.kernel(w.at(j), growth, std::span(g).subspan(rows * j, rows),
                      std::span(by_source).subspan(rows * j, rows));
      }
    });
    WaveAt sum;
    for (std::size_t j = 0; j < w.count; ++j) {
      const Complex xi = w.at(j), down = (g[rows * j + 2] - g[rows * j]) / (depths[2] - depths[0]);
      const Complex f = w.factor(xi, range_);
      sum.p += f * g[rows * j + 1];
      sum.along += Complex(0.0, -1.0) * xi * f * g[rows * j + 1];
      sum.by_source += f * by_source[rows * j + 1];
      sum.by_receiver += f * down;
    }
    return sum;
  }

 private:
  static constexpr std::size_t rows = 3;

  Environment ocean_;
  double source_, receiver_, range_;
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

  // A second frequency, so near that delays which differ are resolved.
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

}  // namespace asdic::detail
