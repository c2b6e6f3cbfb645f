#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "sonar/band_limited_pulse.h"
#include "sonar/delay_kernel.h"
#include "sonar/doppler_expansion.h"
#include "sonar/returns.h"

namespace asdic {

/// Returns as the synthesis reads them: one array per quantity, sorted by Doppler band, then by who
/// hears them, then by delay. Private to the synthesis.
struct OrderedReturns {
  struct Band {
    std::size_t first_node = 0, nodes = 0;  ///< in `nodes` below
    std::size_t first_weight = 0;           ///< in `weights`: [returns of the band × nodes]
    std::vector<std::size_t>
        ends;  ///< [2 + channels] begin; end of those all hear; of channel 0's …

    [[nodiscard]] bool heard_by(std::size_t channel) const noexcept {
      return ends[1] > ends[0] || ends[channel + 2] > ends[channel + 1];
    }
  };

  OrderedReturns(std::span<const Return> returns, const DopplerExpansion& expansion,
                 double pulse_duration, std::size_t channels);

  std::vector<Band> bands;
  std::vector<double> nodes;   ///< Doppler factors of all bands' nodes
  std::vector<double> middle;  ///< delay of the pulse's middle at the reference point [s]
  std::vector<double> slowness_x, slowness_y, slowness_z;  ///< [s/m]
  std::vector<double> real, imag;                          ///< amplitude
  std::vector<float> weights;  ///< ℓ_m(η) of every return; none for a band of one node
};

/// A channel's impulse responses, one grid per Doppler node.
struct ImpulseGrid {
  const DelayKernel& kernel;
  double rate;           ///< [Hz]
  double first;          ///< time of grid sample 0 [s]
  double carrier;        ///< [Hz]
  double last_position;  ///< impulses beyond are not heard in the record [samples]
  std::size_t stride;    ///< from the grid of one node to the next

  static constexpr std::size_t most_nodes = 32;  ///< grids laid at one time: they stay in cache

  /// Adds the impulses that this phone hears to the grids of the band's nodes first…first + count.
  /// \param grids [count × stride]
  void lay(const OrderedReturns& returns, const OrderedReturns::Band& band, std::size_t first_node,
           std::size_t count, std::size_t channel, const Vec3& phone,
           std::complex<float>* grids) const noexcept;

 private:
  static constexpr std::size_t block = 256;  // returns located at one time
  struct Block {                             // where they fall at one phone, and what they weigh
    std::array<double, block> position;      // [samples]
    std::array<float, block> real, imag;     // amplitude·e^{−i2π f_c τ}
  };
  void locate(const OrderedReturns& returns, std::size_t start, std::size_t n, const Vec3& phone,
              Block& at) const noexcept;
};

}  // namespace asdic
