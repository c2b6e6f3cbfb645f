#pragma once
#include "core/quantities.h"
#include "io/scenario/profiles/profile.h"

namespace asdic::detail::scenario {

/// Samples of speed over depth.
struct TableProfile {
  static constexpr std::string_view name = "table";
  Interpolation interpolation = Interpolation::c_linear;
  std::vector<double> depth = {}, speed = {};

  void describe(Fields& field) {
    field("interpolation", interpolation, "how the speed runs between the samples");
    field.columns({{"depth", depth, quantity::water_depth, "of the samples, rising"},
                   {"speed", speed, quantity::sound_speed, "at each depth"}},
                  {.file = true});
  }
  void make(const WaterToMake& to) const {
    to.ocean.water = profile_of(to.table, depth, speed, interpolation);
    check_reach(to.table, to.table.has("file") ? "file" : "depth", depth, speed, to.ocean);
  }
  [[nodiscard]] static std::optional<TableProfile> of(const Environment& ocean) {
    return TableProfile{.interpolation = ocean.water.interpolation(),
                        .depth = copied(ocean.water.depths()),
                        .speed = copied(ocean.water.speeds())};
  }
};
static_assert(WrittenProfile<TableProfile>);

}  // namespace asdic::detail::scenario
