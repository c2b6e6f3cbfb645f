// Keys of what is remembered: settings that differ in any one described number differ in their
// keys. A number that is forgotten would give one beam's sound to another.
#include <gtest/gtest.h>

#include <vector>

#include "core/propagation_memory.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/signal/pulse.h"
#include "support/changed_settings.h"

namespace asdic::detail {
namespace {

ExactKey key_of(const Transmitter& transmitter, const BeamMount& mount) {
  ExactKey key(Kept::expected_reverberation, 0);
  EXPECT_TRUE(
      BeamPattern(transmitter, mount.wavelength, mount.sound_speed, mount.heading, mount.reference)
          .add_to(key));
  return key;
}

ExactKey key_of(const AnyBeam& beam) {
  return key_of({.beam = beam}, {.wavelength = 0.5, .sound_speed = 1500.0});
}

ExactKey key_of(const PulseSettings& pulse) { return ExactKey(Kept::synthesis, 0, pulse); }

void expect_all_differ(const std::vector<ExactKey>& keys) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(keys[i], keys[j]) << j << " and " << i;
}

/// Of the settings themselves, and of each copy that differs in one of them.
template <class T>
std::vector<ExactKey> keys_around(const T& settings) {
  std::vector<ExactKey> keys{key_of(settings)};
  for (const T& changed : support::changed_in_one(settings)) keys.push_back(key_of(changed));
  return keys;
}

TEST(ExactKeys, TellBeamsApartThatDifferInAnyNumber) {
  const LineBeam line{.taper = Taper::hann, .beamwidth = 0.2};
  const ProjectorBeam projectors{.projectors = {{.offset = {0.1, 0.2, 0.3}}, {.amplitude = 0.5}},
                                 .turned = {.bearing = 0.3}};
  const TableBeam table{.table = {.bearings = {0.0, 1.0},
                                  .elevations = {-0.5, 0.5},
                                  .level_db = {0.0, -1.0, -2.0, -3.0}},
                        .turned = {.bearing = 0.3}};
  EXPECT_EQ(keys_around(line).size(), 1U + 2);  // taper, beamwidth
  EXPECT_EQ(keys_around(projectors).size(),
            1U + 2 + 2 * 6);  // bearing and frame; of each projector
  EXPECT_EQ(keys_around(table).size(), 1U + 2 + 2 + 2 + 4);
  std::vector<ExactKey> all;
  for (const auto& keys : {keys_around(line), keys_around(projectors), keys_around(table)})
    all.insert(all.end(), keys.begin(), keys.end());
  expect_all_differ(all);
}

TEST(ExactKeys, TellApartWhereABeamIsHeld) {
  const BeamMount here{.wavelength = 0.5, .sound_speed = 1500.0};
  const std::vector<BeamMount> other = {{.wavelength = 0.6, .sound_speed = 1500.0},
                                        {.wavelength = 0.5, .sound_speed = 1510.0},
                                        {.wavelength = 0.5, .sound_speed = 1500.0, .heading = 0.1},
                                        {.wavelength = 0.5, .sound_speed = 1500.0, .reference = 1}};
  std::vector<ExactKey> keys{key_of({}, here), key_of({.elevation = 0.1}, here)};
  for (const BeamMount& mount : other) keys.push_back(key_of({}, mount));
  expect_all_differ(keys);
  EXPECT_EQ(key_of({.source_level_db = 200.0}, here),
            key_of({}, here));  // of the axis, not the level
}

TEST(ExactKeys, TellPulsesApartThatDifferInAnyNumber) {
  std::vector<ExactKey> all;
  const auto look = [&](const AnyWaveform& waveform, std::size_t settings) {
    const std::vector<ExactKey> keys = keys_around(
        PulseSettings{.waveform = waveform, .window = PulseWindow::tukey, .tukey_fraction = 0.25});
    EXPECT_EQ(keys.size(), 1 + settings) << name_of(waveform);
    all.insert(all.end(), keys.begin(), keys.end());
  };
  look(Cw{}, 3 + 1);  // duration, window, fraction; its frequency
  look(Lfm{}, 3 + 2);
  look(Hfm{}, 3 + 2);
  look(Sfm{.end_modulation_frequency = 20.0}, 3 + 4);
  look(Costas{.step = 20.0}, 3 + 2 + 10);
  look(Ptfm{}, 3 + 3);
  look(GeometricComb{}, 3 + 4);
  look(PulseTrain{}, 3 + 4);
  look(SampledPulse{.samples = {0.5, 1.0, 0.25}, .sample_rate = 100.0}, 1 + 4);
  expect_all_differ(all);
}

// All limits, and not those alone that somebody thought of.
TEST(ExactKeys, TellApartLimitsOfPaths) {
  const auto changed = [](const auto& change) {
    PathLimits limits;
    change(limits);
    return ExactKey(Kept::legs, 0, limits);
  };
  expect_all_differ({changed([](PathLimits&) {}),
                     changed([](PathLimits& l) { l.max_surface_bounces = 7; }),
                     changed([](PathLimits& l) { l.max_bottom_bounces = 7; }),
                     changed([](PathLimits& l) { l.max_launch_angle = 0.5; }),
                     changed([](PathLimits& l) { l.max_vertices = 7; }),
                     changed([](PathLimits& l) { l.min_vertices = 2; }),
                     changed([](PathLimits& l) { l.diffraction = true; }),
                     changed([](PathLimits& l) { l.faintest = 0.5; }),
                     changed([](PathLimits& l) { l.max_delay = 0.5; }),
                     changed([](PathLimits& l) { l.home_slowness = 0.5; })});
}

// Lists go in with their lengths: what one ends with is not what the next begins with.
TEST(ExactKeys, TellListsApart) {
  const std::vector<double> one{1.0}, two{1.0, 2.0}, none;
  expect_all_differ({ExactKey(Kept::legs, 0, one, two), ExactKey(Kept::legs, 0, two, one),
                     ExactKey(Kept::legs, 0, none, two, 1.0), ExactKey(Kept::legs, 1, one, two),
                     ExactKey(Kept::slice, 0, one, two), ExactKey(Kept::legs, 0)});
  EXPECT_NE(ExactKey(Kept::legs, 0, std::optional<double>()),
            ExactKey(Kept::legs, 0, std::optional(0.0)));
}

}  // namespace
}  // namespace asdic::detail
