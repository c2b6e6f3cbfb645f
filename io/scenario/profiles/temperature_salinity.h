#pragma once
#include "core/quantities.h"
#include "io/scenario/profiles/profile.h"
#include "raytrace/ocean/seawater.h"

namespace asdic::detail {

[[nodiscard]] std::span<const std::string_view> words(SeawaterEquation);

namespace scenario {

/// What a probe measures: the speed follows by an equation.
struct TemperatureSalinityProfile {
  static constexpr std::string_view name = "temperature-salinity";
  Interpolation interpolation = Interpolation::c_linear;
  SeawaterEquation equation = SeawaterEquation::chen_millero;
  double latitude_deg = 45.0;
  std::vector<double> depth = {}, temperature = {}, salinity = {};

  void describe(Fields& field) {
    constexpr Quantity latitude{
        .noun = "latitude", .unit = "degrees north", .low = -90.0, .high = 90.0};
    field("interpolation", interpolation, "how the speed runs between the levels");
    field("equation", equation, "of sea water");
    field("latitude_deg", latitude_deg, latitude, "for the pressure at a depth");
    field.columns({{"depth", depth, quantity::depth, "of the levels, rising"},
                   {"temperature", temperature, quantity::temperature, "at each level, in situ"},
                   {"salinity", salinity, quantity::salinity, "at each level"}},
                  {.file = true});
  }
  void make(const WaterToMake& to) const;
};
static_assert(ProfileForm<TemperatureSalinityProfile>);

}  // namespace scenario
}  // namespace asdic::detail
