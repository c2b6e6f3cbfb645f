#pragma once
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "reverb/scattering/forward_scatter.h"
#include "sonar/noise/block_noise.h"
#include "sonar/noise/received_path.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

/// The noise of a scenario's interfering ships at its phones.
///
/// A ship's broadband signal is one BlockNoise of absolute time, its tonals run through. Each array
/// receives it along the eigenrays from where the ship was to where the array's reference point is,
/// found at nodes about half a second apart. Between nodes delay, amplitude and slowness of each
/// path are straight lines in time, so the signal q(t − τ(t)) is shifted and stretched
/// continuously; a path that is not there at one of them fades. A plane wave crosses the array;
/// where that is not what it receives (sonar/paths/plane_wave.h), every phone has paths of its own.
/// Nodes lie on the grid of absolute time in a stream: its parts join without a seam, and do not
/// depend on where they begin.
///
/// Losses are those at the first pulse's centre. With `band = "wide"` they are found at frequencies
/// f_k of the recorded band and interpolated linearly: the signal is a sum of parts q_k, each
/// through a hat over f_k, with an amplitude of its own.
///
/// What rough boundaries scatter about a path is received beside it, by a few paths of equal
/// strength (reverb/scattering/forward_scatter.h). docs/theory/interference.md
class Interference {
 public:
  Interference(const Scenario& scenario, const PropagationPaths& paths);

  /// Adds the ships to a record's pressure. \param later  samples by which what is added lies after
  /// the record's   \return how they are received at its first sample
  std::vector<ReceivedPath> add(const RecordSamples& record, std::int64_t later = 0) const;

 private:
  struct Clock;
  struct Segment;
  /// A path with its amplitudes across the band, and what is scattered about it.
  struct Received {
    ReceivedPath path;
    std::vector<std::complex<double>> band;  // [frequencies]
    std::vector<double> scattered_band;      // root of the intensity [frequencies]
    std::vector<ScatteredPart> parts;        // of equal strength: of their weights the phase counts
  };
  /// \param receiver  reference point or phone of the array
  [[nodiscard]] std::vector<Received> received_at(const Interferer& ship, int array,
                                                  const Carried& receiver, double time,
                                                  bool across_the_band) const;
  [[nodiscard]] std::vector<Segment> segments(const Interferer& ship, int array,
                                              const Carried& receiver, const Clock& clock) const;
  /// Draws what rough boundaries scatter about all that is received at a time.
  void scatter(const Interferer& ship, double time, std::vector<Received>& received) const;
  /// Adds the parts scattered about a path that is at both ends of a segment, or at one.
  static void add_parts(const Received* one, const Received* other, std::int64_t begin,
                        double seconds, std::vector<Segment>& all);
  /// Whether the phones receive a ship by plane waves about their reference point all through a
  /// record.
  [[nodiscard]] bool plane_waves(const Interferer& ship, int array, const RecordSamples& record,
                                 const Clock& clock) const;

  static void add_band(const Segment& path, std::span<const float> source, std::int64_t begin,
                       std::size_t length, std::array<double, 2> u, double at, double step,
                       std::complex<double> z, std::complex<double> rotation,
                       std::span<std::complex<double>> sum);

  const Scenario& scenario_;
  const PropagationPaths& paths_;
  std::vector<ArrayMotion> motions_;  // [arrays]
  double frequency_;                  ///< of the eigenrays' losses [Hz]
  double rate_, carrier_;
  std::vector<double> band_;         // frequencies of losses; empty: frequency_ alone
  std::vector<BlockNoise> sources_;  // [interferers × max(1, band)]
  double source_rate_, source_carrier_;
};

}  // namespace asdic::detail
