// The recipes "A beam of a transmitter", "An array shape" and "A scattering law" of
// docs/develop/recipes.md, and transmitters, arrays and targets written and read back.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/check_settings.h"
#include "core/error.h"
#include "core/propagation_memory.h"
#include "core/settings_words.h"
#include "io/settings/reader.h"
#include "io/settings/writer.h"
#include "reverb/scattering/lambert.h"
#include "sonar/scenario/array.h"
#include "sonar/scenario/shapes/shapes.h"
#include "sonar/scenario/target.h"
#include "sonar/scenario/transmitter.h"
#include "support/lommel_seeliger.h"

namespace asdic::detail {
namespace {

// [beam]
/// cos(bearing − axis): loud ahead and behind, in antiphase.
struct DipolePattern {
  static constexpr bool azimuthally_symmetric = false;
  double axis = 0.0;  ///< [rad]
  [[nodiscard]] std::complex<double> towards(double bearing, double elevation) const noexcept {
    return std::cos(bearing - axis) * std::cos(elevation);
  }
  [[nodiscard]] double longest_delay() const noexcept { return 0.0; }
};

struct DipoleBeam {
  static constexpr std::string_view name = "dipole";
  static constexpr bool steers = false;
  BeamBearing turned = {};

  void describe(Fields& field) { turned.describe(field); }
  [[nodiscard]] DipolePattern pattern(const BeamMount& mount) const {
    return {turned.north_of_frame(mount.heading) + turned.bearing};
  }
  [[nodiscard]] std::string text(double /*elevation*/) const {
    return "dipole to " + turned.text();
  }
};
// [beam]

using OneMoreBeam = OneOfBeams<LineBeam, ProjectorBeam, TableBeam, DipoleBeam>;
struct TransmitterOfOneMore {
  OneMoreBeam beam = LineBeam{};
  void describe(Fields& field) { field.one_of("kind", beam, "what it sends where"); }
};

template <class Settings>
Settings read(std::string_view text) {
  const TomlValue root = parse_toml(text, "s.toml");
  Settings settings;
  KnownSettings known;
  read_settings(TomlTable(root), settings, known);
  return settings;
}

// Two projectors 2d apart in antiphase, steered abeam, send sin(kd·cos θ)·i: over its value ahead
// cos θ to (kd)²/6 = 2e-5.
TEST(BeamRecipe, IsReadAndSendsWhatItSays) {
  const auto read_beam =
      read<TransmitterOfOneMore>("kind = \"dipole\"\nbearing_deg = 30\nbearing_from = \"heading\"");
  EXPECT_EQ(name_of(read_beam.beam), "dipole");
  const BeamMount mount{.wavelength = 2.0 * pi, .sound_speed = 1500.0, .heading = radians(20.0)};
  const PatternsOf<OneMoreBeam>::type pattern = std::visit(
      [&](const auto& one) -> PatternsOf<OneMoreBeam>::type { return one.pattern(mount); },
      read_beam.beam);
  const auto towards = [](const auto& any, double degrees) {
    return std::visit([&](const auto& one) { return one.towards(radians(degrees), 0.0); }, any);
  };
  constexpr double d = 0.01;
  const Vec3 along(std::sin(radians(50.0)) * d, std::cos(radians(50.0)) * d, 0.0);
  const ProjectorBeam pair{.projectors = {{.offset = along}, {.offset = -along, .phase = pi}},
                           .turned = {.bearing = radians(140.0)}};
  const std::variant<ProjectorPattern> of_pair = pair.pattern(mount);
  for (const double bearing : {50.0, 80.0, 120.0, 200.0, 230.0})
    EXPECT_LT(
        std::abs(towards(of_pair, bearing) / towards(of_pair, 50.0) - towards(pattern, bearing)),
        3e-5)
        << bearing;
  EXPECT_EQ(std::visit([](const auto& one) { return one.text(0.0); }, read_beam.beam),
            "dipole to 30 deg relative to the heading");
  const auto key = [](const OneMoreBeam& beam) { return ExactKey(Kept::legs, 0, beam); };
  EXPECT_EQ(key(read_beam.beam), key(OneMoreBeam(read_beam.beam)));
  EXPECT_NE(key(read_beam.beam), key(DipoleBeam{.turned = {.bearing = radians(31.0)}}));
}

// [shape]
/// Phones on a horizontal circle.
struct RingShape {
  static constexpr std::string_view name = "ring";
  int phones = 1;
  double radius = 1.0;  ///< [m]

  void describe(Fields& field) {
    field(required("phones"), phones, 1, 4096, "how many");
    field(required("radius"), radius, {.noun = "radius", .unit = "m", .low = 0.0, .high = 1e4},
          "of the circle");
  }
  void build(ReceiverArray& array) const {
    for (int i = 0; i < phones; ++i) {
      const double bearing = 2.0 * pi * i / phones;
      array.phones.emplace_back(radius * std::sin(bearing), radius * std::cos(bearing), 0.0);
    }
  }
};
// [shape]
static_assert(PhoneShape<RingShape>);

using OneMoreShape =
    OneOfShapes<HorizontalShape, VerticalShape, LineShape, PositionsShape, TowedShape, RingShape>;
struct ArrayOfOneMore {
  OneMoreShape shape = PositionsShape{};
  void describe(Fields& field) { field.one_of(required("kind"), shape, "how its phones lie"); }
};

// Neighbours on a circle are a chord of 2R·sin(π/n) apart.
TEST(ShapeRecipe, IsReadAndPlacesItsPhones) {
  const auto ring = read<ArrayOfOneMore>("kind = \"ring\"\nphones = 12\nradius = 0.4\n");
  ReceiverArray array;
  std::visit([&](const auto& one) { one.build(array); }, ring.shape);
  ASSERT_EQ(array.phones.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR((array.phones[i] - array.phones[(i + 1) % 12]).norm(), 0.8 * std::sin(pi / 12.0),
                1e-15);
}

/// As a scenario has them.
struct Sonar {
  std::vector<Transmitter> transmitters = {};
  std::vector<ReceiverArray> arrays = {};
  std::vector<Target> targets = {};
  void describe(Fields& field) {
    field("transmitter", transmitters, "", {.one_or_more = true, .named = "transmitter"});
    field("array", arrays, "", {.one_or_more = true, .named = "array"});
    field("target", targets, "", {.named = "target"});
  }
};

Sonar read_back(const Sonar& sonar) {
  const KnownSettings platforms{.names = {{"platform", {"ship", "buoy"}}}};
  const TomlValue tree = parse_toml(print_toml(settings_tree(sonar, platforms)), "s.toml");
  Sonar again;
  KnownSettings known = platforms;
  read_settings(TomlTable(tree), again, known);
  return again;
}

TEST(SonarSettings, AreWrittenAndReadBackBitForBit) {
  Sonar sonar;
  sonar.transmitters = {
      {.source_level_db = 0.1 + 0.2, .elevation = 0.3, .name = "a", .platform = 1},
      {.beam = LineBeam{.taper = Taper::omnidirectional},
       .name = "b",
       .offset = {1.0, 2.0, 1.0 / 3.0},
       .pulse = PulseSettings{.waveform = Hfm{}, .duration = 0.7},
       .interval = 12.0,
       .elevations = {0.1, -0.2}},
      {.elevation = 0.2,
       .beam = ProjectorBeam{.projectors = {{.offset = {0.1, 0.2, 0.3}}, {.phase = 1.0}},
                             .turned = {.bearing = 1.0, .frame = BearingFrame::heading}},
       .name = "c"},
      {.beam = TableBeam{.table = {.bearings = {0.0, 1.0, 3.0},
                                   .elevations = {-0.1, 0.1},
                                   .level_db = {0, -1, -2, -3, -4, -5}}},
       .name = "d"}};
  ReceiverArray line = line_array(5, 0.7, 0.3, 0.2);
  line.electronics = {.gain_db = {0, 1, 2, 3, 4},
                      .phase = {0, 0.1, 0.2, 0.3, 0.4},
                      .gain_std_db = 0.5,
                      .phase_std = 0.1,
                      .dead = {1, 4},
                      .band_pass = Electronics::BandPass{.low = 100.0, .high = 1000.0},
                      .converter = Electronics::Converter{.bits = 12, .full_scale = 3.0}};
  ReceiverArray bent;
  bent.name = "bent";
  bent.shapes = {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0.9, 0.1, 0}}};
  bent.phones = bent.shapes[0];
  ReceiverArray towed;
  towed.name = "towed";
  towed.platform = 1;
  towed.towed = TowedLine{.behind = {100.0, 101.3}, .heading = 0.1};
  towed.phones.resize(2);
  sonar.arrays = {line, bent, towed};
  const AspectTable sides{.aspect = {0.0, 0.7, 3.0}, .strength_db = {1.0, 20.0, -3.0}};
  sonar.targets = {
      {.name = "point", .track = {.start = {.position = {1, 2, 30}, .velocity = {0.1, 0, 0}}}},
      {.name = "whole", .last_ping = 7, .heading = 0.3, .aspect = sides},
      {.name = "body",
       .track = {.start = {.position = {5, 6, 7}},
                 .waypoints = {{1.0, {5, 6, 7}}, {9.0, {10, 6, 7}}}},
       .first_ping = 2,
       .highlights = {{.offset = {10, 0, 1}, .strength_db = 4.0}, {.aspect = sides}},
       .hull = Hull{.length = 70.0, .beam = 7.0},
       .fluctuation = Fluctuation::swerling_3,
       .scan_pings = 4}};
  const Sonar again = read_back(sonar);
  EXPECT_EQ(settings_words(again), settings_words(sonar));
  EXPECT_EQ(again.arrays[0].phones, line.phones);
  EXPECT_EQ(again.arrays[1].shapes, bent.shapes);
  EXPECT_EQ(again.arrays[2].towed->behind, towed.towed->behind);
  EXPECT_EQ(again.arrays[0].electronics.dead, line.electronics.dead);
  EXPECT_EQ(again.transmitters[1].pulse, sonar.transmitters[1].pulse);
  EXPECT_EQ(again.transmitters[3].name, "d");
  EXPECT_EQ(again.targets[2].track.waypoints[1].position, Vec3(10, 6, 7));
  EXPECT_EQ(again.targets[2].highlights[1].aspect->strength_db, sides.strength_db);
}

struct FloorOfOneMore {
  std::variant<Lambert, LommelSeeliger> law;
  void describe(Fields& field) { field.one_of("kind", law, "what it scatters"); }
};

// The recipe "A scattering law": its file and its name in a list are a law that files may name.
// At 30° in and out σ = μ·(1/2)²/(1/2 + 1/2) = μ/4.
TEST(ScatteringRecipe, ALawIsAFileAndAWord) {
  const auto floor = read<FloorOfOneMore>("kind = \"lommel-seeliger\"\nmu_db = -20\n");
  const auto& law = std::get<LommelSeeliger>(floor.law);
  const ScatterGeometry steep{.grazing_in = pi / 6, .grazing_out = pi / 6};
  EXPECT_NEAR(law.cross_section(steep, 1000.0), 0.01 / 4.0, 1e-15);
  EXPECT_NE(settings_words(floor), settings_words(FloorOfOneMore{.law = LommelSeeliger{}}));
}

// What a struct holds that no file could say is told where it is.
TEST(SonarSettings, OfCppAreHeldAgainstTheSameRanges) {
  const auto fault = [](const auto& settings) {
    try {
      check_settings(settings);
    } catch (const InputError& error) {
      return error.fault().where + ": " + error.fault().got + ", " + error.fault().expected;
    }
    return std::string();
  };
  Sonar sonar;
  sonar.transmitters.resize(2);
  sonar.transmitters[1].pulse = PulseSettings{.waveform = Cw{-5.0}};
  EXPECT_EQ(fault(sonar),
            "transmitter[1].pulse.frequency: -5 Hz, a frequency from 0.1 to 1000000 Hz");
  sonar.transmitters[1].pulse.reset();
  sonar.arrays = {line_array(3, 1.0, 0.0, 0.0)};
  sonar.targets.resize(1);
  EXPECT_EQ(fault(sonar), "");
  sonar.arrays[0].electronics.dead = {3};
  EXPECT_EQ(fault(sonar), "array[0].electronics.dead[0]: another, the number of a phone, 0 to 2");
  sonar.arrays[0].electronics = {.band_pass = Electronics::BandPass{.low = 900.0, .high = 800.0}};
  EXPECT_EQ(fault(sonar),
            "array[0].electronics.band_pass.high: 800, a frequency above low, 900 Hz");
}

}  // namespace
}  // namespace asdic::detail
