#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "reverb/pairs/boundary_fans.h"

namespace asdic::detail {

/// How alike paths to one place may be to be received as one sound: what pulse, array, motion and a
/// piece of ground do not resolve. All 0: every path by itself. docs/theory/reverberation.md, "Many
/// paths"
struct PathResolution {
  double delay = 0.0;  ///< between the first and the last of a group [s]
  /// Lengths over which the phases of paths are compared [m]: along the boundary, as a share of the
  /// range as well; in depth at the end of the leg; and in depth at the scatterer.
  double level = 0.0, level_of_range = 0.0, depth = 0.0, thickness = 0.0;

  /// What neither of two resolves.
  [[nodiscard]] PathResolution finer(const PathResolution& other) const noexcept;
  bool operator==(const PathResolution&) const = default;
};

/// Paths of a cell that are received as one sound, their pressures added. Its delay and its
/// directions are those of its strongest path.
struct PathGroup {
  std::uint32_t first = 0, count = 0;  ///< among the members of the cell's groups
  std::uint32_t strongest = 0;         ///< among the paths of the cell
  float share = 1.0F;                  ///< of the power of its PathBundle
  float gain = 1.0F;                   ///< of its pressure: below 1 for one of two images
};

/// A group of a cell that is strong, or others that follow each other in delay, of which one stands
/// for all: drawn with a known chance, and as much stronger as it is rarely drawn, it has the mean
/// of whatever the groups do, by any law.
struct PathBundle {
  std::uint32_t first = 0, count = 0;  ///< among the groups of the cell
};

/// One group of a bundle, drawn by its power, and one in ten times evenly: else the weak and late
/// ones would be received from few places, and there too loud.
struct DrawnGroup {
  std::uint32_t group = 0;  ///< among the groups of the cell
  double gain = 1.0;        ///< of its pressure, to stand for all: 1/√chance
};
/// \param uniform  in (0, 1)
[[nodiscard]] DrawnGroup draw(const PathBundle& bundle, std::span<const PathGroup> groups,
                              double uniform) noexcept;

/// The groups of all cells of a plane, and their bundles where there are very many.
class GroupedPaths {
 public:
  /// \param frequency  [Hz]
  GroupedPaths(const FanPlane& plane, const PathResolution& resolution, double frequency);

  [[nodiscard]] std::size_t cells() const noexcept {
    return first_.empty() ? 0 : first_.size() - 1;
  }
  [[nodiscard]] std::span<const PathGroup> groups(std::size_t cell) const noexcept {
    return {groups_.data() + first_[cell], first_[cell + 1] - first_[cell]};
  }
  /// Paths of the cell, in their order.
  [[nodiscard]] std::span<const std::uint32_t> members(const PathGroup& group) const noexcept {
    return {members_.data() + group.first, group.count};
  }
  /// Of a cell of very many groups; empty where each is followed by itself.
  [[nodiscard]] std::span<const PathBundle> bundles(std::size_t cell) const noexcept {
    if (first_bundle_.empty()) return {};
    return {bundles_.data() + first_bundle_[cell], first_bundle_[cell + 1] - first_bundle_[cell]};
  }
  [[nodiscard]] bool bundled() const noexcept { return !bundles_.empty(); }
  /// Somewhere paths are added.
  [[nodiscard]] bool added() const noexcept { return groups_.size() < members_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

  static constexpr std::size_t few = 5;  ///< paths of a cell, which are followed each by itself
  static constexpr std::size_t bundled_above = 12;  ///< groups of a cell
  /// Bundles of a cell, but for strong groups: with 8 of those and more, 4.
  static constexpr std::size_t most_bundles = 8;

 private:
  class Sorter;

  std::vector<std::uint32_t> first_;  // [cells + 1]
  std::vector<PathGroup> groups_;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> first_bundle_;  // [cells + 1], or none
  std::vector<PathBundle> bundles_;
};

/// Of every plane of a fan.
struct FanGroups {
  PathResolution resolution;
  std::vector<GroupedPaths> planes;

  FanGroups(const BoundaryFan& fan, const PathResolution& alike, double frequency);
  [[nodiscard]] bool bundled() const noexcept;
  [[nodiscard]] bool added() const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Out of a memory, if they are there. \param memory  must have been given the fan
  [[nodiscard]] static std::shared_ptr<const FanGroups> of(const BoundaryFan& fan,
                                                           const PathResolution& alike,
                                                           double frequency,
                                                           PropagationMemory& memory);
};

}  // namespace asdic::detail
