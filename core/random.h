#pragma once
#include <array>
#include <complex>
#include <cstdint>

namespace asdic::detail {

/// What a random number is for: streams with different purposes never share a draw.
enum class Draw : std::uint32_t {
  ambient_noise = 1,
  surface_weight = 2,
  bottom_weight = 3,
  volume_weight = 4,
  scatterer_place = 10,
  scatterer_velocity = 11,
  scatterer_texture = 12,
  sector_weight = 13,
  covariance_weight = 14,
  forward_scatter = 15,
  target_fluctuation = 20,
  element_gain = 21,
  element_phase = 22,
  coherent_noise = 30,
  ship_noise = 31,
  ship_tonal = 32,
  study_input = 40,
  study_noise = 41,
  study_permutation = 42,
  study_scramble = 43,
};

/// Philox's key of all streams of one seed and purpose.
[[nodiscard]] std::array<std::uint32_t, 2> random_key(std::uint64_t seed, Draw purpose) noexcept;

/// A stream of random numbers that belongs to the thing simulated, not to the thread that happens
/// to compute it.
///
/// Counter-based (Philox4x32-10, Salmon et al., SC'11): the key is (seed, purpose), the counter
/// (realisation, entity, draw), so any draw of any stream can be had in any order and the same bits
/// come out for any number of threads.
class RandomStream {
 public:
  /// \param realisation  ping or Monte Carlo index   \param entity  phone, ground cell, target …
  RandomStream(std::uint64_t seed, Draw purpose, std::uint32_t realisation, std::uint64_t entity);

  double uniform();  ///< in (0, 1), 32 bits
  double normal();   ///< mean 0, variance 1 (Box–Muller)
  std::complex<double>
  complex_normal();  ///< mean 0, E|w|² = 1, real and imaginary part independent

  /// Four 32-bit words of block `block` of this stream, without moving it.
  [[nodiscard]] std::array<std::uint32_t, 4> block(std::uint32_t block) const noexcept;

 private:
  std::uint32_t next();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 3>
      counter_;  // realisation, entity low, entity high; the fourth word is the block
  std::uint32_t next_block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace asdic::detail
