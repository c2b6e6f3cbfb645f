// Part of ocean.h: [environment.sound_speed].
#include <array>
#include <span>

#include "io/scenario/ocean.h"
#include "io/scenario/profiles/profiles.h"
#include "io/settings/reader.h"

namespace asdic::detail {
namespace {

/// The names of the first `count` values of an enumeration.
template <class Enum, std::size_t count>
std::array<std::string_view, count> names_of() {
  std::array<std::string_view, count> names;
  for (std::size_t i = 0; i < count; ++i) names[i] = name(static_cast<Enum>(i));
  return names;
}

}  // namespace

std::span<const std::string_view> words(Interpolation) {
  static const auto all = names_of<Interpolation, 5>();
  return all;
}

std::span<const std::string_view> words(ShapeInterpolation) {
  static const auto all = names_of<ShapeInterpolation, 3>();
  return all;
}

std::span<const std::string_view> words(SeawaterEquation) {
  static const auto all = names_of<SeawaterEquation, 3>();
  return all;
}

namespace scenario {
namespace {

/// [environment.sound_speed]
struct SoundSpeedTable {
  AnyProfile profile = {};

  void describe(Fields& field) {
    field.one_of(required("kind"), profile, "how the speed of sound is given");
  }
};

}  // namespace

void read_sound_speed(TomlTable table, const OceanReading& reading, Environment& ocean) {
  KnownSettings known{.folder = reading.folder};
  SoundSpeedTable settings;
  TomlReader reader(table, known);
  settings.describe(reader);
  const WaterToMake water{table, reading, ocean};
  std::visit([&](const auto& one) { one.make(water); }, settings.profile);
  table.finish();
}

void describe_sound_speed(Fields& field, const Environment& ocean) {
  SoundSpeedTable settings;
  find_form(ocean, settings.profile);
  field(live("sound_speed"), settings, "of the water");
}

}  // namespace scenario
}  // namespace asdic::detail
