#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "processing/array_shape.h"
#include "processing/beams.h"
#include "processing/detection.h"
#include "processing/matched_filter.h"
#include "processing/mvdr.h"
#include "processing/normaliser.h"

namespace asdic::detail {

/// A cell of time, Doppler factor and direction whose threshold is asked for.
struct Probe {
  double time = 0.0, doppler = 1.0;
  Vec3 look = Vec3::UnitY();
};

enum class Beamformer { conventional, mvdr };
inline constexpr std::string_view beamformer_words[] = {"conventional", "mvdr"};
constexpr std::span<const std::string_view> words(Beamformer /*any*/) { return beamformer_words; }

/// Of the phones, in conventional beams.
enum class Shading { none, hann };
inline constexpr std::string_view shading_words[] = {"none", "hann"};
constexpr std::span<const std::string_view> words(Shading /*any*/) { return shading_words; }

/// ProcessingSettings describes them.
struct DetectorSettings {
  Beamformer beamformer = Beamformer::conventional;
  Shading shading = Shading::none;
  MvdrSettings mvdr;
  NormaliserSettings normaliser;
  int sub_bands = 1;  ///< that a pulse is cut into; their powers are averaged
  double lowest_elevation = -0.5 * pi, highest_elevation = 0.5 * pi;  ///< of planes, volumes [rad]
  std::optional<double> first_time;  ///< nothing is detected before [s]; none: all of the record
  std::optional<double> last_time;   ///< nor after; none: to the end
  double leak_margin_db = 6.0;  ///< what a loud echo leaks into other cells is taken so much louder
  std::size_t most_detections = 1000;  ///< the loudest of a ping
  std::size_t map_columns = 600;       ///< of the maps
};

/// For pictures: what all cells hold, the largest of those that fall together.
struct DetectionMaps {
  std::vector<double> time;      ///< [columns] middle of each [s]
  std::vector<float> beam_time;  ///< [beams × columns] power over background, largest factor [1]
  std::vector<float> doppler_time;  ///< [filters × columns] the same, largest beam [1]
};

/// Standard deviation of an estimate whose resolution cell is this wide: Cramér and Rao's bound is
/// about cell/√(2·SNR)/2; nothing is trusted to better than a tenth of a cell. \param snr  E/N₀
[[nodiscard]] double sigma_of(double cell, double snr);

struct DetectorResult {
  BeamGrid grid;
  std::vector<double> dopplers;       ///< [filters]
  std::vector<Detection> detections;  ///< sorted by time
  DetectionMaps maps;
  double time_cell = 0.0;     ///< [s]
  double doppler_cell = 0.0;  ///< half the factors' span in which a filter answers within 3 dB
  double delay_per_doppler =
      0.0;  ///< by which a sweep's delay errs for an error of η: its ridge [s]
  std::vector<double> thresholds_db;  ///< [probes] level of an echo that just meets the threshold
                                      ///< there [dB re 1 µPa]; ∞ outside of what is searched
  std::size_t peaks = 0;              ///< local maxima over the threshold, before clustering
  /// That were searched: beams × Doppler filters × 1/B of time. Beams and filters are half of what
  /// they resolve apart.
  double cells = 0.0;
  double false_alarm_probability = 0.0;  ///< that is set, of each
  bool rough = false;                    ///< the filter's answer to noise: of a pulse with edges
  bool shaded = false;                   ///< beams are: wider, so that more of them are one
  int sub_bands = 1;
};

/// How many false alarms even Rayleigh noise gives, at least and at most: cells × the set
/// probability × 1.4 to 2 with one Doppler filter, 0.95 to 1.3 with several, up to 6 of a tone
/// without a window, 1.4 to 5 with sub-bands, from 0.6 with shaded beams. In a cell the largest of
/// overlapping samples counts, and peaks of neighbouring filters and beams are one. Counted;
/// docs/theory/processing.md, "Background and threshold"
struct ExpectedAlarms {
  double least = 0.0, most = 0.0;
};
[[nodiscard]] ExpectedAlarms expected_alarms(const DetectorResult& of) noexcept;

/// What a detection's Doppler factor is trusted to [1]: its noise, doppler_sigma, but no better
/// than a tenth of the span in which a filter answers within 3 dB, nor worse than the bank tells.
/// Paths of one echo that lie within a cell move it by as much, however loud.
[[nodiscard]] double trusted_sigma(const Detection& detection, const DetectorResult& of);

/// Matched filters in beams, compared with their surroundings: what stands out, one detection a
/// thing.
///
/// Every beam goes through every Doppler filter; each such series is normalised over time, and its
/// maxima over the threshold are peaks. From the loudest down, a peak is a detection unless a
/// louder one explains it: what that leaks into its cell by the pulse's ambiguity function and the
/// beams' pattern, times a margin. Time and Doppler factor are then interpolated, and the direction
/// is the one that fits the phones' own filter outputs best. A sweep whose bank lies within one
/// Doppler cell and whose loudest filter is the bank's first or last has no Doppler factor: told is
/// the bank's middle, with the bank's own deviation, and the time there. Deterministic for any
/// number of threads. Source: docs/theory/processing.md
/// \param phones       [channels] relative to the point that delays refer to [m]
/// \param sound_speed  at the array [m/s]
/// \param probes       cells whose thresholds are told
/// \param proceed      asked now and then; false stops (Interrupted is thrown)
[[nodiscard]] DetectorResult detect(const Baseband& baseband, std::span<const Vec3> phones,
                                    double sound_speed, const Replica& replica,
                                    std::span<const double> dopplers,
                                    const DetectorSettings& settings,
                                    std::span<const Probe> probes = {},
                                    const std::function<bool()>& proceed = {});

}  // namespace asdic::detail
