#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail::study {

/// How the points of the input space are chosen. docs/theory/designs.md
enum class Design { random, latin_hypercube, sobol, grid, saltelli };

[[nodiscard]] std::string_view name(Design design) noexcept;

/// What a design is told beside its name.
struct DesignOptions {
  std::uint64_t replicates = 1;  ///< sobol: independently scrambled nets that take turns
  bool second_order = false;     ///< saltelli: for indices of pairs, too
  bool chance = false;           ///< saltelli: and of what a realisation draws beside its inputs
  /// saltelli: names of inputs that have one index together; others have their own
  std::vector<std::vector<std::string>> groups{};
};

/// The rows of Saltelli's blocks. A block has two independent points A and B, and for every group
/// of coordinates A with B's values of this group; for indices of pairs B with A's, too.
/// Source: Saltelli, Comput. Phys. Commun. 145, 280 (2002); docs/theory/designs.md
class SaltelliBlocks {
 public:
  /// \param groups  at least one
  SaltelliBlocks(std::size_t groups, bool second_order) noexcept
      : groups_(groups), second_order_(second_order) {}

  [[nodiscard]] std::size_t groups() const noexcept { return groups_; }
  [[nodiscard]] bool second_order() const noexcept { return second_order_; }
  /// Of a block: groups + 2, or 2·groups + 2 for indices of pairs.
  [[nodiscard]] std::size_t rows() const noexcept { return (second_order_ ? 2 : 1) * groups_ + 2; }

  // Where in its block a row lies.
  static constexpr std::size_t a = 0, b = 1;
  [[nodiscard]] std::size_t ab(std::size_t group) const noexcept { return 2 + group; }
  [[nodiscard]] std::size_t ba(std::size_t group) const noexcept { return 2 + groups_ + group; }

  /// Whether the values of a group are those of B. \param row  in its block
  [[nodiscard]] bool of_b(std::size_t row, std::size_t group) const noexcept {
    return (row == b || row >= ba(0)) != (row == ab(group) || row == ba(group));
  }

 private:
  std::size_t groups_;
  bool second_order_;
};

/// Points of the unit cube, each a function of (seed, index) alone: no table is as long as the
/// study, and any point can be had without those before it.
///
/// random: counter-based draws. latin_hypercube: of n points exactly one in each of the n equal
/// strata of every coordinate, by a keyed permutation of the indices. sobol: a digital (t, s)
/// sequence in base 2, scrambled by the seed, or several that take turns. saltelli: blocks of
/// points that share coordinates; the blocks are independent draws. Source: docs/theory/designs.md
class PointDesign {
 public:
  /// \param points  of the Latin hypercube, 0 < points; the others have no end
  /// \param dimensions  of the cube; sobol: at most most_sobol_dimensions, the rest is random
  /// \param groups  [dimensions] saltelli: to which group each coordinate belongs, from 0
  PointDesign(Design design, std::uint64_t seed, std::uint64_t points, std::size_t dimensions,
              const DesignOptions& options = {}, std::vector<std::size_t> groups = {});

  /// \param u  [dimensions] each in (0, 1)
  void point(std::uint64_t index, std::span<double> u) const noexcept;

  [[nodiscard]] std::size_t dimensions() const noexcept { return dimensions_; }
  /// What tells the realisation's own draws (noise, scatterers) from those of others: the index,
  /// but points of a block that differ in their inputs alone share it.
  [[nodiscard]] std::uint64_t chance_of(std::uint64_t index) const noexcept;
  /// Its number among the points that take the values of a list in turn: of replicates each by
  /// itself.
  [[nodiscard]] std::uint64_t turn_of(std::uint64_t index) const noexcept {
    return index / options_.replicates;
  }

 private:
  Design design_;
  std::uint64_t seed_, points_;
  std::size_t dimensions_;
  DesignOptions options_;
  std::vector<std::size_t> groups_;  // [dimensions] of saltelli
  SaltelliBlocks blocks_;
};

/// A uniform number in (0, 1) of 52 bits, of (seed, index, dimension) alone.
[[nodiscard]] double uniform_draw(std::uint64_t seed, std::uint64_t index,
                                  std::uint32_t dimension) noexcept;

}  // namespace asdic::detail::study
