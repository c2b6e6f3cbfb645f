#pragma once
#include <optional>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "sonar/noise/block_noise.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

/// The sea's own noise at all phones of a scenario.
///
/// White noise, independent from phone to phone, is drawn sample by sample
/// (sonar/noise/noise.h). All other noise is BlockNoise: one coherent group an array, in the shape
/// that it has in a ping (a line that turns: in the middle of each block), arrays independent of
/// one another; separate pings are draws of their own, a stream is one draw of its absolute time.
class AmbientNoise {
 public:
  /// \param scenario, paths  must outlive this
  AmbientNoise(const Scenario& scenario, const PropagationPaths& paths);

  /// Adds the noise to a record's pressure. \param later  samples by which what is added lies after
  /// the record's; white noise of separate
  /// pings has no time: before the record's it is another, else the same
  void add(const RecordSamples& record, std::int64_t later = 0) const;

  /// Mean-square pressure within the recorded band [Pa²].
  [[nodiscard]] double recorded_power() const noexcept { return recorded_power_; }

 private:
  const NoiseSettings& settings_;
  std::uint64_t seed_;
  bool continuous_;
  bool white_ = false;  // independent samples are all the noise
  double rate_, carrier_, recorded_power_ = 0.0;
  std::vector<ArrayMotion> motions_;         // [arrays]
  std::vector<BlockNoise> arrays_;           // [arrays], empty for plain noise
  std::vector<std::size_t> first_channels_;  // [arrays + 1]
};

/// How long the blocks are in which an array's coherent noise is made [s].
[[nodiscard]] double noise_block(const Scenario& scenario, int array);

}  // namespace asdic::detail
