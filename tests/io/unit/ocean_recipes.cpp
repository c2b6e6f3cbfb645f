// The recipes "A profile" and "A bottom" of docs/develop/recipes.md.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "io/scenario/materials/materials.h"
#include "io/scenario/profiles/profiles.h"
#include "io/settings/reader.h"
#include "io/settings/writer.h"

namespace asdic::detail::scenario {
namespace {

// [profile]
/// A speed that grows evenly with depth.
struct GradientProfile {
  static constexpr std::string_view name = "gradient";
  double surface_speed = 1500.0;  ///< [m/s]
  double gradient = 0.017;        ///< of the speed over depth [1/s]: of water of one temperature

  void describe(Fields& field) {
    field("surface_speed", surface_speed, quantity::sound_speed, "at depth 0");
    field("gradient", gradient, {.noun = "gradient", .unit = "1/s", .low = -1.0, .high = 1.0},
          "of the speed over depth");
  }
  void make(const WaterToMake& to) const {
    const double bottom = to.ocean.bottom.depth;
    to.ocean.water =
        profile_of(to.table, {0.0, bottom}, {surface_speed, surface_speed + gradient * bottom},
                   Interpolation::c_linear);
  }
};
static_assert(ProfileForm<GradientProfile>);
// [profile]

using OneMoreProfile = OneOfProfiles<TableProfile, MunkProfile, IsovelocityProfile,
                                     TemperatureSalinityProfile, SectionProfile, GradientProfile>;
struct WaterOfOneMore {
  OneMoreProfile profile = {};
  void describe(Fields& field) { field.one_of(required("kind"), profile, "how it is given"); }
};

Environment sea() {
  Environment ocean;
  ocean.bottom = {.depth = 1000.0, .material = Rigid{}};
  return ocean;
}

std::string kind_and_water(const std::string& text, Environment& ocean) {
  const TomlValue root = parse_toml(text, "sea.toml");
  TomlTable table(root);
  KnownSettings known;
  WaterOfOneMore settings;
  TomlReader reader(table, known);
  settings.describe(reader);
  std::vector<std::string> notes;
  const OceanReading reading{.folder = ".", .notes = notes};
  const WaterToMake water{table, reading, ocean};
  std::visit([&](const auto& one) { one.make(water); }, settings.profile);
  table.finish();
  return std::string(name_of(settings.profile));
}

TEST(ProfileRecipe, AFileAndAWordAreWaterThatFilesMayHave) {
  Environment ocean = sea();
  EXPECT_EQ(kind_and_water("kind = \"gradient\"\ngradient = 0.5", ocean), "gradient");
  for (const double depth : {0.0, 10.0, 400.0, 999.0})  // linear, so exact to rounding
    EXPECT_NEAR(ocean.water.at(depth).c, 1500.0 + 0.5 * depth, 1e-9);
  EXPECT_THROW(kind_and_water("kind = \"gradient\"\ngradient = 2", ocean), InputError);
}

// Files are written as what has the water's bits: here a table, since it does not find itself.
TEST(ProfileRecipe, IsWrittenAsTheTableThatItMakes) {
  Environment ocean = sea(), again = sea();
  kind_and_water("kind = \"gradient\"\nsurface_speed = 1480", ocean);
  WaterOfOneMore settings;
  find_form(ocean, settings.profile);
  EXPECT_EQ(kind_and_water(print_toml(settings_tree(settings)), again), "table");
  for (const double depth : {0.0, 123.4, 1000.0})
    EXPECT_EQ(ocean.water.at(depth).c, again.water.at(depth).c);
}

// [bottom]
/// Grains that drift in water, too few to touch: a fluid. Its density and its compressibility are
/// the means of both by volume: Wood, A Textbook of Sound (1930).
struct SuspensionForm {
  static constexpr std::string_view name = "suspension";
  double porosity = 0.9;  ///< share of the water in the volume

  void describe(Fields& field) {
    field("porosity", porosity, {.noun = "porosity", .low = 0.5, .high = 1.0}, "of the mud");
  }
  [[nodiscard]] FluidHalfSpace build(const MaterialPlace& place) const {
    constexpr double grain_density = 2650.0, grain_speed = 4500.0;  // of quartz
    const auto compressibility = [](double density, double speed) {
      return 1.0 / (density * speed * speed);
    };
    const double density = std::lerp(grain_density, place.water.density, porosity);
    const double yields =
        std::lerp(compressibility(grain_density, grain_speed),
                  compressibility(place.water.density, place.water.speed), porosity);
    return {.speed = 1.0 / std::sqrt(density * yields),
            .density = density,
            .attenuation_db_per_wavelength = 0.0};
  }
};
static_assert(MaterialForm<SuspensionForm>);
// [bottom]

using OneMoreForm = OneOfForms<BareForm<Vacuum>, BareForm<Rigid>, FluidForm, ElasticForm,
                               GrainSizeForm, ReflectionForm, LayeredForm, SuspensionForm>;

BoundaryMaterial material_of(const std::string& text, const WaterAtBoundary& water) {
  const TomlValue root = parse_toml(text, "sea.toml");
  TomlTable table(root);
  KnownSettings known;
  OneMoreForm form;
  TomlReader(table, known).one_of(required("kind"), form, "what is behind the boundary");
  table.finish();
  std::vector<std::string> notes;
  const OceanReading reading{.folder = ".", .notes = notes};
  const MaterialPlace place{table, reading, water};
  return std::visit([&](const auto& one) { return BoundaryMaterial(one.build(place)); }, form);
}

// Nothing but water reflects nothing; with a tenth of quartz sound is slower than in either.
TEST(BottomRecipe, AFileAndAWordAreABottomThatFilesMayHave) {
  const WaterAtBoundary water{.speed = 1490.0, .density = 1030.0};
  const auto clear = material_of("kind = \"suspension\"\nporosity = 1.0", water);
  EXPECT_NEAR(std::abs(reflection_coefficient(clear, 0.3, water)), 0.0, 1e-12);
  const auto mud = std::get<FluidHalfSpace>(material_of("kind = \"suspension\"", water));
  EXPECT_LT(mud.speed, water.speed);
  EXPECT_NEAR(mud.density, 0.9 * 1030.0 + 0.1 * 2650.0, 1e-9);
  EXPECT_GT(std::abs(reflection_coefficient(mud, 0.3, water)), 0.01);
}

TEST(BottomRecipe, IsWrittenAsTheFluidThatItIs) {
  const WaterAtBoundary water{.speed = 1490.0, .density = 1030.0};
  const BoundaryMaterial mud = material_of("kind = \"suspension\"", water);
  OneMoreForm form;
  find_form(mud, form);
  ASSERT_TRUE(std::holds_alternative<FluidForm>(form));
  EXPECT_EQ(BoundaryMaterial(std::get<FluidForm>(form).fluid), mud);
}

}  // namespace
}  // namespace asdic::detail::scenario
