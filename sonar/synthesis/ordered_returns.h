#pragma once
#include <algorithm>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sonar/paths/return_source.h"
#include "sonar/synthesis/doppler_expansion.h"

namespace asdic::detail {

/// Returns as the synthesis reads them: one array per quantity, sorted by Doppler band, then by who
/// receives them, then by the sample of the grid in which they fall. Private to the synthesis. Its
/// memory is used again from batch to batch.
class OrderedReturns {
 public:
  struct Band {
    std::size_t first_node = 0, nodes = 0;  ///< among the nodes of all bands
    std::size_t first_weight = 0;           ///< in `weights`: [returns of the band × nodes]
    bool moved = false;                     ///< impulses, along a ridge
    std::vector<std::size_t>
        ends;  ///< [2 + channels] begin; end of those all receive; of channel 0's …
  };
  /// Where the grid lies in time.
  struct Grid {
    double first = 0.0, rate = 1.0;  ///< time of sample 0 [s]; [Hz]
    double carrier = 0.0;            ///< [Hz]
    std::size_t samples = 0;
  };

  /// \param bands  that hold every Doppler factor   \param pulse_duration  not stretched [s]
  /// \param frequency responses  amplitudes of every return
  OrderedReturns(std::vector<DopplerBand> bands, const Grid& grid, double pulse_duration,
                 std::size_t channels, std::size_t responses);

  /// Takes the returns of a batch in place of what is there.
  void take(std::span<const ReturnBlock> blocks);

  [[nodiscard]] std::size_t size() const noexcept { return impulse.size(); }
  /// The largest that `late` may be, either way [s].
  [[nodiscard]] double latest() const noexcept;
  /// Of the grid, in which an impulse falls: 0 and `Grid::samples` also for all beyond.
  [[nodiscard]] std::size_t sample_at(double delay) const noexcept {
    return static_cast<std::size_t>(
        std::clamp((delay - grid_.first) * grid_.rate, 0.0, static_cast<double>(grid_.samples)));
  }
  /// Memory that a return takes while it is here, its Return included.
  [[nodiscard]] std::size_t bytes_each() const noexcept;

  std::vector<Band> bands;
  std::vector<DopplerNode> nodes;  ///< of all bands
  std::vector<double> impulse;     ///< its delay at the reference point [s]
  std::vector<double> late;        ///< behind the pulse's middle, in bands that are moved [s]
  std::vector<double> slowness_x, slowness_y, slowness_z;  ///< [s/m]
  std::vector<float> real, imag;                           ///< [responses × returns] amplitude
  std::vector<float> weights;  ///< ℓ_m(η) of every return; none for a band of one node
  double largest_slowness = 0.0;

 private:
  void sort(std::size_t count);
  /// Moves impulses of a band along its ridge. \param begin, end  of the returns, in order
  void move(const DopplerBand& band, std::size_t begin, std::size_t end) noexcept;

  std::vector<DopplerBand> expansion_;
  Grid grid_;
  double pulse_duration_;
  std::size_t channels_, responses_;
  std::vector<std::uint64_t> source_;             // block << 32 | index in it
  std::vector<double> doppler_;                   // in order
  std::vector<std::uint32_t> sample_, group_;     // of each, as they came
  std::vector<std::uint32_t> by_sample_, order_;  // permutations
  std::vector<std::uint32_t> counts_;
  std::vector<std::size_t> group_ends_;
};

}  // namespace asdic::detail
