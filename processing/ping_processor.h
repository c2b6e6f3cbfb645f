#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "processing/blast_canceller.h"
#include "processing/detector.h"
#include "processing/localiser.h"
#include "processing/processing_settings.h"
#include "processing/replica.h"
#include "processing/scoring.h"
#include "processing/tracker.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

struct BlastSearch;

/// What one array recorded of one ping.
struct ArrayRecording {
  int ping = 1;                               ///< counted from 1
  int transmitter = 0;                        ///< that sent it, an index
  int array = 0;                              ///< an index
  double ping_time = 0.0;                     ///< since the start of the scenario [s]
  double start = 0.0;                         ///< of the first sample, after the ping's start [s]
  double sample_rate = 0.0;                   ///< [Hz]
  std::optional<double> carrier;              ///< of complex baseband [Hz]; none: passband
  std::vector<Vec3> phones;                   ///< positions at the ping's start [m]
  std::vector<float> pressure;                ///< passband [phones × samples] [Pa]
  std::vector<std::complex<float>> envelope;  ///< or baseband
};

/// What a time on a map is in range from the array [m]; NaN where no pair of paths takes so long.
struct MapRanges {
  std::vector<double> of_time;  ///< [times] sender and array in one place: the same in all bearings
  /// [beams × times] of a pair that lies apart, where the array tells bearings: on the beam's side
  /// of a line (its right)
  std::vector<double> of_beam;
  std::vector<double> of_mirror;  ///< and on the other side of a line; else empty
};

struct ProcessedArray {
  int ping = 1, array = 0;
  ArrayShape shape;
  DetectorResult result;
  double sound_speed = 0.0;      ///< at the array [m/s]
  double elevation_sigma = 0.0;  ///< of a measured elevation [rad]
  SonarPlaces places;
  double searched_from = 0.0;        ///< nothing is detected before [s]
  double searched_until = infinity;  ///< nor after
  bool sends_on = false;             ///< echoes are looked for while the transmitter sends
  BlastCancellation blast;           ///< what was taken out of the record first
};

/// The receiver of a whole scenario: band, beams, matched filters, detections, places, tracks.
/// const and shared by threads once made. Source: docs/theory/processing.md
class PingProcessor {
 public:
  /// \param replicas  [transmitters] of each, as the file stores them; one serves all
  /// \throws InputError naming the setting at fault
  PingProcessor(Scenario scenario, std::vector<Replica> replicas, ProcessingSettings settings);

  /// \param proceed  asked now and then; false stops (Interrupted is thrown)
  /// \param echoes   that the simulation knows of: told is the level each had to have to be
  /// detected
  [[nodiscard]] ProcessedArray process(const ArrayRecording& recording,
                                       const std::function<bool()>& proceed = {},
                                       std::span<const TrueEcho> echoes = {}) const;

  /// What a tracker takes of a processed ping: one contact a detection that has a place.
  /// \param side  0 or 1: which of two places, where there are two
  [[nodiscard]] std::vector<Contact> contacts(const ProcessedArray& processed, double ping_time,
                                              int side) const;

  /// The ranges that an echo has at each of some times, by the sound paths.
  /// \param times  rising, after the ping's start [s]
  [[nodiscard]] MapRanges ranges_at(const ProcessedArray& processed, int transmitter,
                                    std::span<const double> times) const;

  /// What the places found so far lack, in one line; "" where nothing: to be told at the end.
  [[nodiscard]] std::string lack() const;

  /// Tolerances by which detections are told from false alarms.
  [[nodiscard]] Resolution resolution(const ProcessedArray& processed) const;
  [[nodiscard]] const ProcessingSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] const PropagationPaths& paths() const noexcept { return paths_; }
  [[nodiscard]] const Replica& replica(int transmitter) const noexcept {
    return replicas_[replicas_.size() > 1 ? static_cast<std::size_t>(transmitter) : 0];
  }
  [[nodiscard]] std::span<const double> dopplers(int transmitter) const noexcept {
    return banks_[banks_.size() > 1 ? static_cast<std::size_t>(transmitter) : 0];
  }

 private:
  /// Where the settings leave it open. \param search  the ping and array
  [[nodiscard]] double first_time(const BlastSearch& search) const;

  Scenario scenario_;
  std::vector<Replica> replicas_;
  ProcessingSettings settings_;
  PropagationPaths paths_;
  std::vector<std::vector<double>> banks_;              // [replicas]
  std::vector<std::unique_ptr<Localiser>> localisers_;  // [replicas]
};

}  // namespace asdic::detail
