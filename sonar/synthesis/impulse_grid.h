#pragma once
#include <array>
#include <complex>
#include <cstddef>

#include "sonar/synthesis/delay_kernel.h"
#include "sonar/synthesis/ordered_returns.h"

namespace asdic::detail {

/// A channel's impulse responses, one grid per Doppler node.
struct ImpulseGrid {
  const DelayKernel& kernel;
  double rate;           ///< [Hz]
  double first;          ///< time of grid sample 0 [s]
  double carrier;        ///< [Hz]
  double last_position;  ///< pulses whose middle is beyond are not received in the record [samples]
  std::size_t stride;    ///< from the grid of one node to the next
  std::size_t length;    ///< of each: impulses that do not lie on it with their taps are left out
  double first_position = DelayKernel::taps;  ///< nor are those before [samples]

  static constexpr std::size_t most_nodes = 32;  ///< grids filled at one time: they stay in cache

  /// Some of the returns of a band at one phone.
  struct Part {
    std::size_t begin = 0, end = 0;  ///< of the returns
    std::size_t response = 0;        ///< which of their amplitudes
    std::size_t first_node = 0;      ///< of the band's, and how many
    std::size_t nodes = 1;
  };
  /// Adds their impulses to the grids of those nodes. \param grids [nodes × stride]
  void add(const OrderedReturns& returns, const OrderedReturns::Band& band, const Part& part,
           const Vec3& phone, std::complex<float>* grids) const noexcept;

 private:
  template <bool moved>
  void add_band(const OrderedReturns& returns, const OrderedReturns::Band& band, const Part& part,
                const Vec3& phone, std::complex<float>* grids) const noexcept;

  static constexpr std::size_t block = 256;  // returns located at one time
  struct Block {                             // where they fall at one phone, and what they weigh
    std::array<double, block> position;      // [samples]
    std::array<float, block> real, imag;     // amplitude·e^{−i2π f_c τ}
  };
  template <bool moved>
  void locate(const OrderedReturns& returns, std::size_t start, std::size_t n, std::size_t response,
              const Vec3& phone, Block& at) const noexcept;
};

}  // namespace asdic::detail
