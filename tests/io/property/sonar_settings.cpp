#include <gtest/gtest.h>

#include "core/settings_words.h"
#include "io/settings/reader.h"
#include "io/settings/writer.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {
namespace {

/// Of a scenario, what settings of others refer to.
KnownSettings around() {
  return {.numbers = {{"environment.wind_speed", 7.5},
                      {"environment.shallowest", 0.0},
                      {"environment.deepest", 5000.0},
                      {"transmitter.has_elevation", 0.0}}};
}

struct Ships {
  std::vector<Platform> platforms;
  std::vector<Interferer> interferers;
  void describe(Fields& field) {
    field("platform", platforms, "carriers", {.one_or_more = true, .named = "platform"});
    field("interferer", interferers, "ships", {.named = "interferer"});
  }
};

/// What is written of a struct is read as that struct, bit for bit.
template <class T>
void expect_kept(const T& settings) {
  const std::string text = print_toml(settings_tree(settings, around()));
  const TomlValue file = parse_toml(text, "s.toml");
  KnownSettings known = around();
  T read;
  ASSERT_NO_THROW(read_settings(TomlTable(file), read, known)) << text;
  EXPECT_EQ(settings_words(read), settings_words(settings)) << text;
}

const NoiseDirections from_above{
    .dipole_exponent = 2.5, .elevation = {-0.7, 0.1, 1.2}, .level_db = {1.0, 2.0, -3.0}};

TEST(SonarSettings, NoiseIsKept) {
  expect_kept(NoiseSettings{});
  const NoiseTable table{.frequency = {10.0, 333.3}, .level_db = {90.5, 61.0}};
  for (const AnyNoise& law :
       std::vector<AnyNoise>{WhiteNoise{41.5}, WenzNoise{.shipping = 0.3, .wind_speed = 4.0},
                             KnudsenNoise{2.75}, table})
    for (const NoiseCoherence coherence : {NoiseCoherence::independent, NoiseCoherence::isotropic,
                                           NoiseCoherence::surface, NoiseCoherence::profile})
      for (const bool thermal : {false, true})
        expect_kept(NoiseSettings{
            .law = law, .thermal = thermal, .coherence = coherence, .directions = from_above});
}

TEST(SonarSettings, ReverberationIsKept) {
  expect_kept(ReverberationSettings{});
  using Kind = ScattererMotion::Kind;
  const ScattererField waves{
      .motion = {.kind = Kind::bragg, .receding_share = 0.3, .current = Vec2(0.1, -0.2)},
      .statistics = {.coherence_time = 2.5, .k_shape = 0.7, .correlation_length = 300.0}};
  const ScattererField fish{
      .motion = {.kind = Kind::spread, .speed_rms = 0.4, .current = Vec2::Zero()},
      .statistics = {.coherence_time = infinity, .k_shape = {}}};
  ReverberationSettings sea;
  sea.enabled = false;
  sea.azimuths = 72;
  sea.ground_spacing = 2.5;
  sea.scatterers_per_cell = 3;
  sea.resolve_azimuth = false;
  sea.surface_scatters = false;
  sea.surface = OgdenErskine{};
  sea.surface_field = waves;
  sea.bottom = EllisCrowe{};
  sea.volume = {{.top = 50.0, .bottom = 99.5, .strength_db = -70.0, .sheets = {}, .field = waves},
                {.top = 150.0, .bottom = 300.0, .strength_db = -75.0, .sheets = 7, .field = fish}};
  sea.synthesis = ScattererSynthesis::streams;
  sea.most_returns = 123456;
  expect_kept(sea);
  for (const double coherence : {0.0, 3.0, infinity}) {
    sea.bottom_field.statistics.coherence_time = coherence;
    expect_kept(sea);
  }
}

TEST(SonarSettings, PingsAndPathsAreKept) {
  expect_kept(PingSchedule{});
  PingSchedule pings{.count = 7, .interval = 12.5, .elevations = {-0.1, 0.3}};
  pings.recording_duration = 9.0;
  pings.blanking = true;
  for (const Samples samples : {Samples::pressure, Samples::baseband})
    for (const bool continuous : {false, true}) {
      pings.samples = samples;
      pings.continuous = continuous;
      pings.recording_start = continuous ? 0.0 : 0.5;
      pings.carrier = pings.carrier ? std::nullopt : std::optional(3300.0);
      pings.baseband_rate = continuous ? std::nullopt : std::optional(450.0);
      expect_kept(pings);
    }
  expect_kept(PropagationSettings{});
  expect_kept(PropagationSettings{.dimension = 3,
                                  .max_surface_bounces = 0,
                                  .max_bottom_bounces = 5,
                                  .max_launch_angle = 0.3,
                                  .direct_blast = false,
                                  .fathometer = true,
                                  .band = BandOfLosses::wide,
                                  .diffraction = false,
                                  .exact_per_phone = true});
}

TEST(SonarSettings, PlatformsTracksAndShipsAreKept) {
  const Track straight{.start = {.position = Vec3(1.5, -2.0, 30.0), .velocity = Vec3(3.0, 0, 0)},
                       .waypoints = {}};
  Track turning;
  turning.waypoints = {{.time = -5.0, .position = Vec3(0, 0, 10)},
                       {.time = 60.0, .position = Vec3(100, 50, 12)}};
  turning.start.position = turning.waypoints.front().position;
  const NoiseTable table{.frequency = {10.0, 333.3}, .level_db = {150.5, 131.0}};
  expect_kept(
      Ships{.platforms = {{.name = "ship", .track = straight}, {.name = "buoy", .track = turning}},
            .interferers = {
                {.name = "a", .track = turning, .level_db = 140.0, .table = {}, .tonals = {}},
                {.name = "b", .track = straight, .level_db = {}, .table = table, .tonals = {}},
                {.name = "c",
                 .track = straight,
                 .level_db = 150.0,
                 .slope_db_per_decade = -12.0,
                 .table = {},
                 .tonals = {{.frequency = 60.0, .level_db = 151.0}}}}});
}

}  // namespace
}  // namespace asdic::detail
