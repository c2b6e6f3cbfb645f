#include "raytrace/waves/diffraction.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "core/units.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double nearest_shadow = 10.0;   // wavelengths: where the far field begins
constexpr double faintest = 1e-3;         // of 1/r: the integral's own noise is 1e-5
constexpr double faintest_beside = 0.01;  // of the rays
constexpr double slowness_share = 0.02;   // by which slownesses may differ from 1/c
constexpr std::size_t own_bytes = std::size_t{1} << 30;

constexpr double finer_layers = 10.0;   // in phase: in the dark little is left of great waves
constexpr double usual_speed = 1500.0;  // of sound [m/s]
constexpr double blended = 0.005;       // of a range, below a step of the furthest

/// What waves are at one place.
struct WaveThere {
  WaveAt wave;
  double delay = 0.0;  ///< [s]
};

/// The water's own field between two depths, of waves that no bottom returns.
class WaterborneField {
 public:
  WaterborneField(const Environment& ocean, double source_depth, double receiver_depth,
                  double frequency, const OceanMemory& memory)
      : ocean_(ocean),
        source_(source_depth),
        receiver_(receiver_depth),
        frequency_(frequency),
        memory_(memory) {}

  /// Nothing where it is fainter than some amplitude. \throws Interrupted
  [[nodiscard]] std::optional<WaveThere> at(double range, double least) const {
    // Kernels are shared up to a furthest range. Before that is exceeded the next ones fade in, so
    // that a path whose ends move has no jump: each has its own 1e-5.
    const double furthest = furthest_in_step(range);
    const double share = std::clamp((range / furthest - (1.0 - blended)) / blended, 0.0, 1.0);
    const auto within = [&](double furthest_range) {
      return std::abs(field(frequency_, furthest_range, range).p) > least;
    };
    if (!within(furthest)) return std::nullopt;
    const WaveThere here = up_to(furthest, range);
    if (!(share > 0.0)) return here;
    const WaveThere next = up_to(furthest_in_step(1.01 * furthest), range);
    const double smooth = share * share * (3.0 - 2.0 * share);
    return WaveThere{here.wave.mixed_with(next.wave, smooth),
                     (1.0 - smooth) * here.delay + smooth * next.delay};
  }

 private:
  [[nodiscard]] WaveAt field(double frequency, double furthest, double range) const {
    const bool source_is_upper = source_ <= receiver_;
    const WaterborneWaves::Need need{.frequency = frequency,
                                     .cut_for = finer_layers * frequency_,
                                     .upper = std::min(source_, receiver_),
                                     .lower = std::max(source_, receiver_),
                                     .furthest = furthest};
    return memory_.memory
        .remember(ExactKey(Kept::waterborne_waves, memory_.ocean, need),
                  [&] { return std::make_shared<WaterborneWaves>(ocean_, need, memory_); })
        ->at(range, source_is_upper);
  }

  /// The delay by a second frequency, so near that delays which differ are resolved.
  [[nodiscard]] WaveThere up_to(double furthest, double range) const {
    const WaveAt wave = field(frequency_, furthest, range);
    const double about = range / ocean_.water.at(receiver_).c;
    const double step = std::min(1.0, 0.25 / (slowness_share * furthest / usual_speed));
    const std::complex<double> turned = std::conj(wave.p) *
                                        field(frequency_ + step, furthest, range).p *
                                        std::polar(1.0, std::fmod(step * about, 1.0) * 2.0 * pi);
    return {wave, about - std::arg(turned) / (2.0 * pi * step)};
  }

  const Environment& ocean_;
  double source_, receiver_, frequency_;
  const OceanMemory& memory_;
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

/// Share of a wave that comes with what the bottom close below one of its ends sends back at once:
/// p(z) + R·p(2D − z) over p(z), with p exponential on so short a way, as it was without the
/// bottom. It is 1 where the end is too high for the two to be one arrival. \param slope  ∂p/∂z of
/// the end
Complex share_beside_bottom(const Environment& ocean, double depth, double slowness,
                            double frequency, Complex p, Complex slope) {
  constexpr double steepest = 0.07;  // of waves that stay in the water, 4° [rad]
  const double bottom = ocean.bottom.depth, height = bottom - depth, c = ocean.water.at(bottom).c;
  const Complex change = 2.0 * height * slope / p;
  const double phase =
      std::max(std::abs(change), 2.0 * height * steepest * 2.0 * pi * frequency / c);
  if (!(phase < pi)) return 1.0;
  const double near = std::pow(std::cos(0.5 * phase), 2);
  const Complex reflected = reflection_coefficient(
      ocean.bottom.material, std::acos(std::clamp(slowness * c, 0.0, 1.0)),
      {.speed = c, .density = ocean.water_density.at(bottom), .frequency = frequency});
  return 1.0 + near * reflected * std::exp(change);
}

/// Pressure of a wave with what the bottom close below its ends sends back.
Complex beside_bottom(const Environment& ocean, double source_depth, double receiver_depth,
                      double frequency, const WaveAt& wave) {
  const double slowness = wavenumber(wave.p, wave.along) / (2.0 * pi * frequency);
  return wave.p *
         share_beside_bottom(ocean, source_depth, slowness, frequency, wave.p, wave.by_source) *
         share_beside_bottom(ocean, receiver_depth, slowness, frequency, wave.p, wave.by_receiver);
}

/// \param least  amplitude below which there is nothing   \param with_bottom  close below an end
std::optional<Arrival> louder_arrival(const Environment& ocean, double source_depth,
                                      double receiver_depth, double range, double frequency,
                                      double least, const OceanMemory* kept, bool with_bottom) {
  const double c = ocean.water.at(receiver_depth).c;
  if (range * frequency < nearest_shadow * c) return std::nullopt;
  if (!diffraction_is_affordable(ocean, range, frequency, kept)) return std::nullopt;
  PropagationMemory own(own_bytes);
  const OceanMemory alone{own};
  const WaterborneField there(ocean, source_depth, receiver_depth, frequency,
                              kept != nullptr ? *kept : alone);
  const auto found = there.at(range, std::max(least, faintest / range));
  if (!found) return std::nullopt;
  const WaveAt& wave = found->wave;
  const double slowness = wavenumber(wave.p, wave.along) / (2.0 * pi * frequency);
  const Complex p =
      with_bottom ? beside_bottom(ocean, source_depth, receiver_depth, frequency, wave) : wave.p;

  Arrival path;
  path.kind = ArrivalKind::diffracted;
  path.delay = found->delay;
  path.amplitude = p * std::polar(1.0, 2.0 * pi * std::fmod(frequency * path.delay, 1.0));
  path.spreading = std::abs(wave.p);
  path.reflection = p / wave.p;
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

std::optional<double> pressure_beside_surface_rays(const Environment& ocean, double source_depth,
                                                   double receiver_depth, double range,
                                                   double frequency, const Arrivals& rays) {
  Arrivals in_the_water;
  for (const Arrival& ray : rays)
    if (ray.bottom_bounces == 0) in_the_water.push_back(ray);
  const auto off_the_surface = [](const Arrival& ray) { return ray.surface_bounces == 1; };
  if (in_the_water.empty() || !std::ranges::all_of(in_the_water, off_the_surface) ||
      !diffraction_is_affordable(ocean, range, frequency))
    return std::nullopt;
  PropagationMemory memory(own_bytes);
  const OceanMemory kept{memory};
  const WaterborneWaves waves(ocean,
                              {.frequency = frequency,
                               .cut_for = finer_layers * frequency,
                               .upper = std::min(source_depth, receiver_depth),
                               .lower = std::max(source_depth, receiver_depth),
                               .furthest = furthest_in_step(range)},
                              kept);
  WaveAt wave = waves.at(range, source_depth <= receiver_depth);
  for (const Arrival& ray : in_the_water) {
    const double omega = 2.0 * pi * frequency, xi = omega * ray.horizontal_slowness;
    const auto vertical = [&](double depth, double elevation) {
      return omega / ocean.water.at(depth).c * std::sin(elevation);
    };
    const Complex p = waves.weight(xi) * ray.amplitude *
                      std::polar(1.0, -2.0 * pi * std::fmod(frequency * ray.delay, 1.0));
    wave.p -= p;
    wave.along += Complex(0.0, xi) * p;
    wave.by_source += Complex(0.0, vertical(source_depth, ray.launch_elevation)) * p;
    wave.by_receiver -= Complex(0.0, vertical(receiver_depth, ray.arrival_elevation)) * p;
  }
  // A plane wave that grazes is sent back with −1; waves about it, a Fresnel zone off, are not.
  const double zone = std::sqrt(ocean.water.at(source_depth).c / (pi * frequency * range)),
               slowness = std::cos(zone) / ocean.water.at(ocean.bottom.depth).c;
  const double beside = std::abs(
      share_beside_bottom(ocean, source_depth, slowness, frequency, wave.p, wave.by_source) *
      share_beside_bottom(ocean, receiver_depth, slowness, frequency, wave.p, wave.by_receiver));
  return std::max(beside * std::abs(wave.p),
                  std::abs(beside_bottom(ocean, source_depth, receiver_depth, frequency, wave)));
}

bool diffraction_is_affordable(const Environment& ocean, double range, double frequency,
                               const OceanMemory* kept) {
  const auto make = [&] { return std::make_shared<WaterColumn>(ocean, frequency, frequency); };
  const auto water =
      kept == nullptr ? make()
                      : kept->memory.remember(
                            ExactKey(Kept::water_column, kept->ocean, frequency, frequency), make);
  const WaveColumn& column = water->column();
  const double steps =
      double(column.layers()) *
      double(water_window(column, angle_of_spreading(ocean, frequency), range).count);
  return 2.0 * steps <= most_diffraction_steps;
}

std::optional<Arrival> diffracted_arrival(const Environment& ocean, double source_depth,
                                          double receiver_depth, double range, double frequency,
                                          const OceanMemory* kept, bool beside_bottom) {
  return louder_arrival(ocean, source_depth, receiver_depth, range, frequency, 0.0, kept,
                        beside_bottom);
}

std::optional<Arrival> diffracted_arrival(const Environment& ocean, double source_depth,
                                          double receiver_depth, double range, double frequency,
                                          const Arrivals& rays, const OceanMemory* kept,
                                          bool beside_bottom) {
  double power = 0.0;
  for (const Arrival& ray : rays) {
    if (ray.bottom_bounces == 0) return std::nullopt;
    power += std::norm(ray.amplitude);
  }
  return louder_arrival(ocean, source_depth, receiver_depth, range, frequency,
                        faintest_beside * std::sqrt(power), kept, beside_bottom);
}

}  // namespace asdic::detail
