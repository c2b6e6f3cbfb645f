#pragma once

/// \file
/// The pressure field of a source over range and depth: transmission loss.
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// scenario.set("run.frequency", 100.0)
///     .set("run.receivers.depth", asdic::EvenlySpaced{100.0, 4000.0, 14})
///     .set("run.receivers.range", asdic::EvenlySpaced{500.0, 20e3, 40});
/// const asdic::Field field = asdic::field(scenario);
/// std::cout << field.loss_db(0, 39) << " dB at " << field.ranges[39] << " m\n";
/// ```

#include <complex>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/watch.h"

namespace asdic {

/// `count` numbers from first to last, both included.
struct ASDIC_API EvenlySpaced {
  double first = 0.0, last = 0.0;
  int count = 2;
  operator Value() const;
};

/// Pressure re 1 m from the source, e^{+iωt}. Of a field that was not added coherently: the root of
/// the intensity.
struct ASDIC_API Field {
  double frequency = 0.0;               ///< [Hz]
  std::vector<double> source_depths{};  ///< [m]
  std::vector<double> depths{};         ///< [rows] [m]
  std::vector<double> ranges{};         ///< [columns] [m]
  bool irregular = false;               ///< receiver i is at (ranges[i], depths[i]): one row
  std::vector<std::complex<float>> pressure{};  ///< [sources × rows × columns], range fastest
  double beam_error_db = 0.0;           ///< what more beams would change, at 95 % of receivers [dB]
  std::vector<std::string> warnings{};  ///< what to know before trusting it
  /// [columns] of the receivers on the Earth [degrees]; empty where they are not known
  std::vector<double> latitudes{}, longitudes{};

  /// −20·log₁₀|p| [dB]; infinite where there is no sound. \param row, column, source  from 0
  /// \throws InputError if there is no such receiver
  [[nodiscard]] double loss_db(std::size_t row, std::size_t column, std::size_t source = 0) const;
};

/// What [run] of the scenario asks for: `asdic field`. \throws InputError naming the key, Stopped
[[nodiscard]] ASDIC_API Field field(const Scenario& scenario, const Watch& watch = {});

}  // namespace asdic
