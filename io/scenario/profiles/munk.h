#pragma once
#include "core/quantities.h"
#include "io/scenario/profiles/profile.h"

namespace asdic::detail::scenario {

/// Munk's profile.
struct MunkProfile {
  static constexpr std::string_view name = "munk";
  MunkParameters munk = {};

  void describe(Fields& field) {
    constexpr Quantity scale{.noun = "depth", .unit = "m", .low = 10.0, .high = 1e5};
    field("axis_speed", munk.axis_speed, quantity::sound_speed, "on the channel's axis");
    field("axis_depth", munk.axis_depth, quantity::depth, "of the channel's axis");
    field("scale_depth", munk.scale_depth, scale, "of the law");
    field("perturbation", munk.perturbation, {.low = 0.0, .high = 0.1}, "of the law");
  }
  void make(const WaterToMake& to) const { to.ocean.water = SoundSpeedProfile::munk(munk); }
  [[nodiscard]] static std::optional<MunkProfile> of(const Environment& ocean) {
    const auto& found = ocean.water.munk_parameters();
    return found ? std::optional(MunkProfile{*found}) : std::nullopt;
  }
};
static_assert(WrittenProfile<MunkProfile>);

}  // namespace asdic::detail::scenario
