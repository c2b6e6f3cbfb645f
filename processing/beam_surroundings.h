#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "processing/array_shape.h"

namespace asdic::detail {

/// What the beams around a beam receive: the background of what is loud at many bearings but not
/// for long, to which the beam's surroundings in time are silent.
///
/// Those *beside* are 2 to 6 resolution cells (λ/extent) away on either side: what they receive at
/// the same time (the sea answering from right above or below). Those *on a side* are 1.5 to 4
/// cells away, further along the array's axis or less far: what they receive then, before and after
/// (a patch of sea whose edge this is, in time or in bearing). Each time the median of their powers
/// is taken, nearly their mean (0.9 of it where each is the mean of three exponential cells); a few
/// loud ones among them, another echo, do not count: an ordered-statistic CFAR over bearing;
/// Rohling, IEEE Trans. AES 19, 608 (1983). docs/theory/processing.md, "Background and threshold"
class BeamSurroundings {
 public:
  BeamSurroundings(const ArrayShape& shape, std::span<const Vec3> looks, double wavelength);

  /// Indices of the beams meant; none where fewer than eight are there.
  [[nodiscard]] std::span<const std::uint32_t> beside(std::size_t beam) const noexcept {
    return beside_.of(beam);
  }
  /// The same of either side, 0 or 1; none where fewer than four are there.
  [[nodiscard]] std::span<const std::uint32_t> on_side(std::size_t side,
                                                       std::size_t beam) const noexcept {
    return sides_[side].of(beam);
  }

 private:
  struct Lists {
    std::vector<std::uint32_t> beams;
    std::vector<std::size_t> first{0};  // [beams + 1]

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t beam) const noexcept {
      return {beams.data() + first[beam], beams.data() + first[beam + 1]};
    }
    void end_beam(std::size_t fewest);  ///< the last list: none if shorter, some if long
  };
  Lists beside_;
  std::array<Lists, 2> sides_;
};

/// What a plane wave of power 1 out of a beam's look leaves in the beams around: medians, as of
/// what is received there. A sparse array receives an echo everywhere at about 1/N.
struct OwnLeak {
  double beside = 0.0;
  std::array<double, 2> side{};

  OwnLeak() = default;
  /// \param pattern  power of that wave in a beam, by its index
  OwnLeak(const BeamSurroundings& around, std::size_t beam,
          const std::function<double(std::size_t)>& pattern);
};

/// The filters' mean power in every cell of time: what a whole ping's beams receive, in brief.
class CellPowers {
 public:
  /// \param cell  samples of a cell, may be a fraction
  CellPowers(std::size_t filters, std::size_t beams, std::size_t samples, double cell);

  void set(std::size_t filter, std::size_t beam, std::span<const float> power) noexcept;
  /// Mean power there in a cell and the one on either side.
  [[nodiscard]] float mean(std::size_t filter, std::size_t beam, std::size_t cell) const noexcept;
  /// The background by the beams around one: what those beside it receive in that cell and the
  /// next, or, if more, the second greatest of what either side receives then, and in the cells
  /// before and after: one more echo in all that is forgiven. What the peak in question leaks there
  /// at its own time is taken off. 0 where there are no such beams. \param power  of the peak
  /// \param scratch  any
  [[nodiscard]] float background(const BeamSurroundings& around, std::size_t filter,
                                 std::size_t beam, std::size_t sample, double power,
                                 const OwnLeak& leak, std::vector<float>& scratch) const;

 private:
  std::size_t beams_, samples_, cells_;
  double cell_;
  std::vector<float> mean_;  // [filters × beams × cells]
};

}  // namespace asdic::detail
