#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "processing/detector.h"
#include "processing/tracker.h"

namespace asdic::detail {

/// Whether transmissions that are known are taken out of the record first.
enum class BlastCancelling {
  automatic,  ///< where echoes are looked for while they last: known_blasts.h, sends_on()
  on,
  off,
};
inline constexpr std::string_view blast_cancelling_words[] = {"auto", "on", "off"};
constexpr std::span<const std::string_view> words(BlastCancelling /*any*/) {
  return blast_cancelling_words;
}

/// What a receiver is told, by `asdic process` and by [measure.receiver] of a study. The source of
/// this header describes its parts as well: MvdrSettings, NormaliserSettings, TrackerSettings.
struct ProcessingSettings {
  DetectorSettings detector;
  double max_speed = 15.0;     ///< closing or opening, the Doppler filters reach so far [m/s]
  double bank_loss_db = 0.25;  ///< at most, between two of them
  BlastCancelling cancel_direct_blast = BlastCancelling::automatic;
  std::optional<double> target_depth;  ///< as LocaliserSettings::depth [m]
  std::optional<double> range_speed;   ///< as LocaliserSettings::speed [m/s]
  TrackerSettings tracker;

  /// What one ping needs; tracker, which needs several, describes itself.
  void describe(Fields& field);
};

}  // namespace asdic::detail
