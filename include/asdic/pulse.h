#pragma once

/// \file
/// What a transmitter sends. `scenario.set("pulse", …)` for all of them,
/// `scenario.set("transmitter.0.pulse", …)` for one.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.set("pulse", asdic::Lfm{.start_frequency = 3500.0,
///                                  .end_frequency = 4500.0,
///                                  .duration = 0.5,
///                                  .window = "tukey",
///                                  .tukey_fraction = 0.1});
/// std::cout << scenario.to_toml();
/// scenario.set("pulse.duration", 1.0);
/// ```

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "asdic/scenario.h"
#include "asdic/value.h"

namespace asdic {

/// One frequency.
struct ASDIC_API Cw {
  double frequency = 0.0;                     ///< [Hz]
  double duration = 0.0;                      ///< [s]
  std::string window = "none";                ///< none, hann, tukey
  std::optional<double> tukey_fraction = {};  ///< of the duration; 0.1
  operator Value() const;
};

/// A sweep whose frequency goes linearly with time.
struct ASDIC_API Lfm {
  double start_frequency = 0.0;  ///< [Hz]
  double end_frequency = 0.0;    ///< [Hz]; below the first: a down-sweep
  double duration = 0.0;         ///< [s]
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// A sweep whose period goes linearly with time: it keeps its shape under Doppler.
struct ASDIC_API Hfm {
  double start_frequency = 0.0;  ///< [Hz]
  double end_frequency = 0.0;    ///< [Hz]
  double duration = 0.0;         ///< [s]
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// A frequency that swings as a cosine.
struct ASDIC_API Sfm {
  double frequency = 0.0;                               ///< [Hz] about which it swings
  double swing = 0.0;                                   ///< [Hz] from the lowest to the highest
  double modulation_frequency = 0.0;                    ///< [Hz] of the swings
  std::optional<double> end_modulation_frequency = {};  ///< [Hz] that it sweeps to
  double duration = 0.0;                                ///< [s]
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// Chips of one tone each, in the order of a Costas array: `order`, or Welch's of a `prime`.
struct ASDIC_API Costas {
  double frequency = 0.0;           ///< [Hz] in the middle of all chips'
  std::vector<double> order = {};   ///< of the chips' frequencies, 1 the lowest; or
  std::optional<int> prime = {};    ///< prime − 1 chips
  std::optional<int> root = {};     ///< a primitive one of the prime; the smallest
  std::optional<double> step = {};  ///< [Hz] between neighbours; chips / duration
  double duration = 0.0;            ///< [s]
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// Linear sweeps one after another without a jump of the phase: its spectrum is a comb.
struct ASDIC_API Ptfm {
  double start_frequency = 0.0;  ///< [Hz] of each sweep
  double end_frequency = 0.0;    ///< [Hz]
  int sweeps = 0;                ///< within the duration
  double duration = 0.0;         ///< [s] of all
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// Tones at once, each gap between neighbours a ratio times the one before.
struct ASDIC_API GeometricComb {
  double start_frequency = 0.0;  ///< [Hz] of the line beside the smallest gap
  double end_frequency = 0.0;    ///< [Hz] of the one beside the largest
  int lines = 0;
  std::optional<double> gap_ratio = {};  ///< 1.2
  double duration = 0.0;                 ///< [s]
  std::string window = "none";
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// Short pulses with silence between them: of one `frequency`, or sweeps.
struct ASDIC_API PulseTrain {
  std::optional<double> frequency = {};        ///< [Hz]; or
  std::optional<double> start_frequency = {};  ///< [Hz] of each sweep, and
  std::optional<double> end_frequency = {};    ///< [Hz]
  int pulses = 0;                              ///< within the duration
  double pulse_duration = 0.0;                 ///< [s] of each
  double duration = 0.0;                       ///< [s] of all
  std::string window = "none";                 ///< of each
  std::optional<double> tukey_fraction = {};
  operator Value() const;
};

/// Samples in a file: a mono WAV, or CSV with the header time,pressure. Scaled to a peak of 1.
struct ASDIC_API PulseFile {
  std::string file;
  operator Value() const;
};

/// What a transmitter sends, sampled: the replica of a matched filter.
struct Waveform {
  double sample_rate = 0.0;                      ///< [Hz]
  std::vector<std::complex<double>> analytic{};  ///< s₊, of unit peak before its window
  double source_level_db = 0.0;                  ///< p at 1 m = Re{√2·10^(SL/20) µPa · s₊}
  double centre_frequency = 0.0;                 ///< [Hz]
  double energy = 0.0;                           ///< ∫|s₊|²dt [s]
};

/// \param scenario  with a sonar   \param sample_rate  [Hz]; that of its record, or of pressure
/// that holds the pulse where the record is baseband   \throws InputError
[[nodiscard]] ASDIC_API Waveform waveform(const Scenario& scenario, int transmitter = 0,
                                          std::optional<double> sample_rate = {});

}  // namespace asdic
