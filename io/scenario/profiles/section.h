#pragma once
#include "io/scenario/profiles/profile.h"

namespace asdic::detail::scenario {

/// Speeds on a grid of ranges and depths.
struct SectionProfile {
  static constexpr std::string_view name = "section";
  std::string file = {};  ///< a line for every point of the grid, in any order
  std::vector<double> range = {}, depth = {};
  std::vector<std::vector<double>> speed = {};

  void describe(Fields& field);
  void make(const WaterToMake& to) const;
  [[nodiscard]] static std::optional<SectionProfile> of(const Environment& ocean);
};
static_assert(WrittenProfile<SectionProfile>);

}  // namespace asdic::detail::scenario
