#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/random.h"
#include "sonar/noise/noise_coherence.h"

namespace asdic::detail {

/// Which random numbers a noise is made of.
struct NoiseKey {
  std::uint64_t seed = 1;
  Draw purpose = Draw::coherent_noise;
  std::uint64_t first_channel = 0;  ///< of the first phone: < 2¹⁶ in all
};

/// Stationary Gaussian noise of a given spectrum and coherence, a function of a sample's number
/// alone: whatever part of it is asked for, the same bits come out.
///
/// Blocks of N samples lie on a grid of N/2. Each is one period of keyed complex normals, scaled by
/// the root of the density, correlated between phones by the factor of that frequency, transformed,
/// and weighted by w = sin(π(n + ½)/N): w² of the two blocks at a sample add up to 1, so the
/// variance is exact, and the spectrum is the given one smoothed by |W|², three bins of fs/N wide.
/// N is at least a quarter of a second and 32 times the travel time across the array; the cross
/// spectra of the farthest phones are smoothed likewise. Phones that move against one another have
/// in each block the shape of its middle. docs/theory/noise.md.
class BlockNoise {
 public:
  /// Where the phones lie at a sample: [n] [m].
  using ShapeAt = std::function<std::vector<Vec3>(std::int64_t)>;

  /// N. \param across  of the phones' longest shape, if they have others [m]
  [[nodiscard]] static std::size_t block_length(double sample_rate, std::span<const Vec3> phones,
                                                double across, double sound_speed);

  /// \param density  one-sided, of frequency [Pa²/Hz]; asked for at frequencies above 0
  /// \param carrier  of complex baseband p₊·e^{−i2πft} [Hz]; 0: real pressure
  /// \param phones   [n] positions [m]   \param coherence  between them
  /// \param across   of their longest shape, if they have others [m]
  /// \param memory   of factors that others have made; must outlive this
  BlockNoise(const std::function<double(double)>& density, double sample_rate, double carrier,
             std::span<const Vec3> phones, NoiseCoherence coherence,
             const NoiseDirections& directions, double sound_speed, const NoiseKey& key,
             double across = 0.0, PropagationMemory* memory = nullptr);

  /// Adds the samples `first` … to rows. \param rows  [phones × samples × components] [Pa]
  void add(std::span<float> rows, std::int64_t first, std::uint32_t realisation) const;
  /// The same for phones in another shape: the same independent normals, correlated as it asks for.
  void add(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
           std::span<const Vec3> shape) const;
  /// The same for phones that move against one another: the same independent normals, correlated as
  /// the shape at each block's middle asks for.
  void add(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
           const ShapeAt& shape_at) const;

  [[nodiscard]] std::size_t block() const noexcept { return block_; }  ///< N
  /// Mean square of the pressure that it makes [Pa²]: the density summed over the bins above 0.
  /// What lies below the first of them, fs/N, is not made.
  [[nodiscard]] double power() const noexcept;
  /// Of the coherence; null where phones are independent.
  [[nodiscard]] const CoherenceFactors* factors() const noexcept { return factors_.get(); }

 private:
  struct Scratch;
  void draw(std::span<const std::int64_t> blocks, std::uint32_t realisation, Scratch& s) const;
  void correlate(const CoherenceFactors& factors, std::size_t from, std::size_t to,
                 Scratch& s) const;
  /// Their factors; null: none.
  using Factors = std::shared_ptr<const CoherenceFactors>;
  void add_blocks(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
                  const std::function<Factors(std::int64_t block)>& factors_in) const;
  [[nodiscard]] std::shared_ptr<const CoherenceFactors> factors_of(
      std::span<const Vec3> phones) const;
  void sound(std::size_t block, std::size_t phone, Scratch& s) const;

  std::vector<Vec3> shape_;
  std::size_t phones_, block_, bins_;
  bool complex_;
  NoiseKey key_;
  NoiseCoherence coherence_;
  NoiseDirections directions_;
  double sound_speed_, lowest_, step_;  // of the bins [Hz]
  PropagationMemory* memory_;
  std::vector<float> scale_;   // [bins] of the normals
  std::vector<float> window_;  // [block]
  std::shared_ptr<const CoherenceFactors> factors_;
};

}  // namespace asdic::detail
