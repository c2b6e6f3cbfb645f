#pragma once
#include "core/quantities.h"
#include "io/scenario/profiles/profile.h"

namespace asdic::detail::scenario {

/// One speed everywhere.
struct IsovelocityProfile {
  static constexpr std::string_view name = "isovelocity";
  double speed = 1500.0;

  void describe(Fields& field) {
    field(required("speed"), speed, quantity::sound_speed, "everywhere");
  }
  void make(const WaterToMake& to) const { to.ocean.water = SoundSpeedProfile::isovelocity(speed); }
};
static_assert(ProfileForm<IsovelocityProfile>);

}  // namespace asdic::detail::scenario
