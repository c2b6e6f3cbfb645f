#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace asdic::detail::study {

/// How the points of the input space are chosen. docs/theory/designs.md
enum class Design { random, latin_hypercube, sobol, grid };

[[nodiscard]] std::string_view name(Design design) noexcept;

/// Points of the unit cube, each a function of (seed, index) alone: no table is as long as the
/// study, and any point can be had without those before it.
///
/// random: counter-based draws. latin_hypercube: of n points exactly one in each of the n equal
/// strata of every coordinate, by a keyed permutation of the indices. sobol: a digital (t, s)
/// sequence in base 2, scrambled by the seed. Source: docs/theory/designs.md
class PointDesign {
 public:
  /// \param points  of the Latin hypercube, 0 < points; the others have no end
  /// \param dimensions  of the cube; sobol: at most most_sobol_dimensions, the rest is random
  PointDesign(Design design, std::uint64_t seed, std::uint64_t points, std::size_t dimensions);

  /// \param u  [dimensions] each in (0, 1)
  void point(std::uint64_t index, std::span<double> u) const noexcept;

  [[nodiscard]] std::size_t dimensions() const noexcept { return dimensions_; }

 private:
  Design design_;
  std::uint64_t seed_, points_;
  std::size_t dimensions_;
};

/// A uniform number in (0, 1) of 52 bits, of (seed, index, dimension) alone.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::uint64_t index,
                                  std::uint32_t dimension) noexcept;

}  // namespace asdic::detail::study
