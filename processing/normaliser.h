#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/quantity.h"

namespace asdic::detail {

/// How the background around a cell is estimated.
enum class Normaliser {
  cell_averaging,  ///< the mean of the reference cells on both sides (CA-CFAR)
  split_window,  ///< the same, and twice again with what stands out of the last mean put back to it
};

inline constexpr std::string_view normaliser_words[] = {"cell-averaging", "split-window"};
constexpr std::span<const std::string_view> words(Normaliser /*any*/) { return normaliser_words; }

/// Of a cell of Rayleigh background.
inline constexpr Quantity false_alarm_probability_of_cell{
    .noun = "probability", .low = 1e-30, .high = 0.5};

class Fields;

/// A cell is 1/noise bandwidth of the matched filter: values so far apart are independent.
struct NormaliserSettings {
  Normaliser method = Normaliser::split_window;
  double guard_cells = 2.0;               ///< left out on either side, at least: the echo itself
  double reference_cells = 12.0;          ///< averaged on either side
  double false_alarm_probability = 1e-6;  ///< of a cell
  bool across_beams = true;  ///< compared with the beams around as well (BeamSurroundings)

  void describe(Fields& field);
};

/// Threshold over the mean of `cells` independent exponential cells (Rayleigh envelope) for a
/// constant false-alarm rate: α = N·(P^(−1/N) − 1); −ln P for very many.
/// Finn & Johnson, RCA Review 29, 414 (1968). docs/theory/processing.md, eq. (7)
/// \param looks  independent exponential values whose mean each cell is (sub-bands)
[[nodiscard]] double cfar_multiplier(double false_alarm_probability, double cells, int looks = 1);

/// Compares each value of a series of powers with its surroundings.
class BackgroundEstimator {
 public:
  /// \param cell  samples per cell, may be a fraction   \param guard  samples left out on either
  /// side where these are more than the settings'
  /// \throws InputError ("reference_cells", "guard_cells", "false_alarm_probability")
  /// \param looks  as of cfar_multiplier()
  BackgroundEstimator(const NormaliserSettings& settings, double cell, double guard = 0.0,
                      int looks = 1);

  struct Scratch {
    std::vector<double> sums;
    std::vector<float> clipped;
  };

  /// \param power       [n]
  /// \param background  [n] mean of the surroundings; ∞ where there are none
  /// \param threshold   [n] power that a false-alarm probability allows for
  void operator()(std::span<const float> power, std::span<float> background,
                  std::span<float> threshold, Scratch& scratch) const;

 private:
  NormaliserSettings settings_;
  std::size_t guard_, reference_;  // samples on either side
  double put_back_ = 1.0;          // mean of what is clipped, over the mean
  std::vector<float> multiplier_;  // [1 + 2·reference_] by number of reference samples
};

}  // namespace asdic::detail
