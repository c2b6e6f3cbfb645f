#include "sonar/noise/ambient_noise.h"

#include <algorithm>
#include <cmath>

#include "sonar/noise/noise.h"
#include "sonar/noise/noise_in_guide.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/paths/plane_wave.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

constexpr std::uint32_t before_all = 0x80000000U;  // no ping has that number

/// Its phones to the micrometre: a towed line that goes straight on has the shape that it had, and
/// its factors are found again.
std::vector<Vec3> shape_of(const ArrayMotion& motion, int ping, double time) {
  std::vector<Vec3> phones = motion.phones(ping, time);
  const ReceiverArray& one = motion.array();
  if (!one.towed && one.shapes.empty()) return phones;
  for (Vec3& phone : phones) phone = (phone * 1e6).array().round().matrix() / 1e6;
  return phones;
}

/// A bound on how long an array is in any ping's shape [m].
double extent(const ReceiverArray& array) {
  double most = 0.0;
  if (array.towed) {
    const auto [first, last] =
        std::minmax_element(array.towed->behind.begin(), array.towed->behind.end());
    return *last - *first;
  }
  for (const std::vector<Vec3>& shape : array.shapes)
    for (const Vec3& phone : shape) most = std::max(most, (phone - shape.front()).norm());
  return 2.0 * most;
}

}  // namespace

double noise_block(const Scenario& scenario, int array) {
  const ArrayMotion motion(scenario, array);
  const double rate = recorded_rate(scenario);
  const std::size_t samples =
      BlockNoise::block_length(rate, motion.phones(1, 0.0), extent(motion.array()),
                               speed_at(scenario, motion.at(0.0).position));
  return static_cast<double>(samples) / rate;
}

AmbientNoise::AmbientNoise(const Scenario& scenario, const PropagationPaths& paths)
    : settings_(scenario.noise),
      seed_(scenario.seed),
      continuous_(scenario.pings.continuous),
      rate_(recorded_rate(scenario)),
      carrier_(recorded_carrier(scenario)),
      motions_(array_motions(scenario)) {
  if (!settings_.any()) return;
  const double low = carrier_ > 0.0 ? std::max(0.0, carrier_ - 0.5 * rate_) : 0.0;
  recorded_power_ = noise_power(settings_, low, carrier_ + 0.5 * rate_);
  // A baseband that reaches below 0 Hz has noise above it alone.
  white_ = settings_.plain() && (carrier_ == 0.0 || carrier_ >= 0.5 * rate_);
  if (white_) return;
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a) {
    first_channels_.push_back(first_channel(scenario, static_cast<int>(a)));
    const double c = paths.speed_at(motions_[a].at(0.0).position);
    const NoiseField field = noise_field(scenario, static_cast<int>(a));
    arrays_.emplace_back([&](double f) { return noise_density(settings_, f); }, rate_, carrier_,
                         shape_of(motions_[a], 1, 0.0), field.coherence, field.directions, c,
                         NoiseKey{.seed = seed_,
                                  .purpose = Draw::coherent_noise,
                                  .first_channel = first_channels_.back()},
                         extent(scenario.arrays[a]), &paths.memory());
  }
  first_channels_.push_back(channels_of(scenario));
  recorded_power_ = 0.0;  // the mean over all phones of what is made
  for (std::size_t a = 0; a < arrays_.size(); ++a)
    recorded_power_ += arrays_[a].power() *
                       static_cast<double>(first_channels_[a + 1] - first_channels_[a]) /
                       static_cast<double>(first_channels_.back());
}

void AmbientNoise::add(const RecordSamples& record, std::int64_t later) const {
  if (!settings_.any() || record.pressure.empty()) return;
  const auto ping = static_cast<std::uint32_t>(record.ping);
  // Pings of a stream leave at whole samples: the first sample of this part, counted from the
  // scenario's start.
  const std::int64_t first = (continuous_ ? std::llround(record.start_time * rate_) : 0) + later;
  if (white_) {
    const double level = *settings_.flat_level_db();
    const double variance = record.recording.is_complex() ? white_baseband_variance(level, rate_)
                                                          : white_noise_variance(level, rate_);
    if (continuous_)
      add_stream_of_white_noise(record.pressure, record.channels, variance, seed_,
                                first * static_cast<std::int64_t>(record.recording.components()));
    else
      add_white_noise(record.pressure, record.channels, variance, seed_,
                      later < 0 ? ping | before_all : ping);
    return;
  }
  const double zero = record.recording.start + (continuous_ ? 0.0 : record.start_time);
  const std::size_t row = record.recording.samples * record.recording.components();
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    const std::span<float> rows = record.pressure.subspan(
        first_channels_[a] * row, (first_channels_[a + 1] - first_channels_[a]) * row);
    const std::uint32_t realisation = continuous_ ? 0 : ping;
    const auto shape = [&](double time) { return shape_of(motions_[a], record.ping, time); };
    if (motions_[a].deforms())
      arrays_[a].add(rows, first, realisation, [&](std::int64_t sample) {
        return shape(zero + static_cast<double>(sample) / rate_);
      });
    else
      arrays_[a].add(rows, first, realisation, shape(record.start_time));
  }
}

}  // namespace asdic::detail
