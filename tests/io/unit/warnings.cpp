#include "sonar/warnings/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "io/bellhop/finite_field.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/cases/beam_error_text.h"
#include "raytrace/propagation.h"
#include "raytrace/warnings/warnings.h"
#include "support/plain_sea.h"

// What a scenario is warned of: just outside of a law's range, and not inside it.

namespace asdic::detail {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> of(std::vector<std::string> overrides) {
  return parse_scenario(support::plain_sea, "s.toml", overrides).notes;
}

std::string table(double first, double last) {
  const auto text = [](double x) { return std::to_string(x); };
  return "environment.sound_speed={kind=\"table\", depth=[" + text(first) + ", " + text(last) +
         "], speed=[1500.0, 1501.0]}";
}

/// A tone, and the samples that it needs.
std::vector<std::string> tone(double frequency, std::vector<std::string> more) {
  more.push_back("pulse.frequency=" + std::to_string(frequency));
  return more;
}

TEST(Warnings, AnOrdinarySeaHasNone) { EXPECT_THAT(of({}), IsEmpty()); }

// Over a slope, and not over a level floor.
TEST(Warnings, WhatStaysInPlanesBesideThreeDimensions) {
  const std::string slope =
      "environment.bottom={kind=\"rigid\", shape={range=[0.0, 5000.0], depth=[1000.0, 1100.0], "
      "interpolation=\"piecewise-linear\"}}";
  const std::string three = "propagation.dimension=3";
  EXPECT_THAT(of({three}), IsEmpty());
  EXPECT_THAT(of({slope}), testing::Not(testing::Contains(HasSubstr("propagation.dimension"))));
  EXPECT_THAT(of({slope, three}),
              testing::Contains(HasSubstr("propagation.dimension: echoes, direct sound and ships' "
                                          "noise are turned sideways")));
  EXPECT_THAT(of({slope, three, "reverberation={enabled=true}"}),
              testing::Contains(HasSubstr("reverberation, the numbers of bounces")));
}

// Eight lines from 3900 to 4100 Hz: the 3rd and the 4th gap of ratio 1.2 together, 49.1 Hz, are the
// last but 3.0 Hz. Half a line is 5 Hz wide of a pulse of 0.1 s, 0.5 Hz of one of a second.
TEST(Warnings, LinesOfACombThatMeetOthers) {
  const auto comb = [](const std::string& duration) {
    return of(
        {"pulse={kind=\"geometric_comb\", start_frequency=3900, end_frequency=4100, lines=8, "
         "window=\"hann\", duration=" +
         duration + "}"});
  };
  EXPECT_THAT(comb("1.0"), IsEmpty());
  EXPECT_THAT(comb("0.1"), ElementsAre(AllOf(HasSubstr("pulse: a Doppler factor of "),
                                             HasSubstr("of its 8 lines on others"))));
}

TEST(Warnings, AProfileThatDoesNotCoverTheWater) {  // of 0 to 1000 m
  EXPECT_THAT(of({table(500.0, 600.0)}),
              ElementsAre(AllOf(HasSubstr("environment.sound_speed: levels from 500 to 600 m"),
                                HasSubstr("for water from 0 to 1000 m"))));
  EXPECT_THAT(of({table(0.0, 985.0)}), testing::SizeIs(1));
  EXPECT_THAT(of({table(15.0, 1000.0)}), testing::SizeIs(1));
  EXPECT_THAT(of({table(10.0, 990.0)}), IsEmpty());  // 1 % at either end
  EXPECT_THAT(of({table(-5.0, 2000.0)}), IsEmpty());
  const std::string cast =
      "environment.sound_speed={kind=\"temperature-salinity\", depth=[0.0, 300.0], "
      "temperature=[15.0, 9.0], salinity=[35.0, 35.0]}";
  EXPECT_THAT(of({cast}), ElementsAre(HasSubstr("levels from 0 to 300 m")));
  const std::string section =
      "environment.sound_speed={kind=\"section\", range=[0.0, 5000.0], depth=[0.0, 400.0], "
      "speed=[[1500.0, 1501.0], [1500.0, 1502.0]]}";
  EXPECT_THAT(of({section}), testing::Contains(HasSubstr("levels from 0 to 400 m")));
}

TEST(Warnings, WaterOutsideOfAnEquationsRange) {
  const auto water = [](const std::string& equation, double temperature, double salinity) {
    return "environment.sound_speed={kind=\"temperature-salinity\", equation=\"" + equation +
           "\", depth=[0.0, 1000.0], temperature=[" + std::to_string(temperature) +
           ", 4.0], salinity=[" + std::to_string(salinity) + ", 35.0]}";
  };
  EXPECT_THAT(
      of({water("mackenzie", 1.0, 35.0)}),
      ElementsAre(HasSubstr("environment.sound_speed: at 0 m temperature 1 degC is outside "
                            "of 2 to 30 degC, where mackenzie holds (JASA 70, 807, 1981)")));
  EXPECT_THAT(of({water("mackenzie", 2.0, 24.0)}), ElementsAre(HasSubstr("salinity 24 psu")));
  EXPECT_THAT(of({water("del-grosso", 10.0, 29.0)}), ElementsAre(HasSubstr("salinity 29 psu")));
  EXPECT_THAT(of({water("chen-millero", -1.0, 35.0)}), ElementsAre(HasSubstr("temperature -1")));
  for (const std::string equation : {"mackenzie", "del-grosso", "chen-millero"})
    EXPECT_THAT(of({water(equation, 10.0, 35.0)}), IsEmpty()) << equation;
  // At 10 km the pressure is above Mackenzie's 8000 m and Del Grosso's 1000 kg/cm².
  const std::string trench = "environment.bottom.depth=10500.0";
  const std::string deep =
      "\", depth=[0.0, 10500.0], temperature=[10.0, 2.5], salinity=[35.0, 35.0]}";
  for (const auto& [equation, what] :
       {std::pair{"mackenzie", "depth 10500 m"}, {"del-grosso", "MPa is outside of"}})
    EXPECT_THAT(of({trench, std::string("environment.sound_speed={kind=\"temperature-salinity\", "
                                        "equation=\"") +
                                equation + deep}),
                ElementsAre(AllOf(HasSubstr("at 10500 m"), HasSubstr(what))));
}

TEST(Warnings, AbsorptionOutsideOfItsLaw) {
  EXPECT_THAT(of(tone(50001.0, {})),
              ElementsAre(HasSubstr("environment.absorption: frequency 50001 Hz is outside of 100 "
                                    "to 50000 Hz, where Thorp's formula holds")));
  EXPECT_THAT(of(tone(50000.0, {})), IsEmpty());
  EXPECT_THAT(of(tone(99.0, {})), ElementsAre(HasSubstr("frequency 99 Hz")));
  const auto water = [](const std::string& more) {
    return "environment.absorption={kind=\"francois-garrison\", " + more + "}";
  };
  EXPECT_THAT(of({water("salinity=38.0")}), ElementsAre(HasSubstr("salinity 38 psu")));
  EXPECT_THAT(of({water("depth=4000.0")}), ElementsAre(HasSubstr("depth 4000 m")));
  EXPECT_THAT(of({water("temperature=25.0")}), ElementsAre(HasSubstr("temperature 25 degC")));
  EXPECT_THAT(of({water("temperature=22.0, salinity=30.0, depth=3500.0")}), IsEmpty());
}

TEST(Warnings, NoiseOutsideOfItsCurves) {
  const std::string none = "environment.absorption={kind=\"none\"}";
  EXPECT_THAT(
      of(tone(1e5, {none, "noise={kind=\"knudsen\", sea_state=3.0}"})),
      ElementsAre(HasSubstr("noise.kind: frequency 100000 Hz is outside of 100 to 25000 Hz, "
                            "where Knudsen's noise holds")));
  EXPECT_THAT(of(tone(25000.0, {none, "noise={kind=\"knudsen\", sea_state=3.0}"})), IsEmpty());
  EXPECT_THAT(of({"noise={kind=\"knudsen\", wind_speed=20.0}"}),
              ElementsAre(HasSubstr("noise.wind_speed: wind speed 20 m/s")));
  EXPECT_THAT(of({"noise={kind=\"knudsen\", wind_speed=15.0}"}), IsEmpty());
  EXPECT_THAT(of(tone(100001.0, {none, "noise={kind=\"wenz\"}"})),
              ElementsAre(HasSubstr("Wenz's noise")));
  EXPECT_THAT(of(tone(1e5, {none, "noise={kind=\"wenz\"}"})), IsEmpty());
}

TEST(Warnings, ANoiseTableUsedOutsideOfItsBand) {
  const auto levels = [](const std::string& frequencies) {
    return "noise={kind=\"table\", frequency=" + frequencies + ", level_db=[60.0, 50.0]}";
  };
  EXPECT_THAT(
      of({levels("[2000.0, 4000.0]")}),
      ElementsAre(HasSubstr("noise: levels from 2000 to 4000 Hz stand for a pulse from 1000 "
                            "to 1000 Hz")));
  EXPECT_THAT(of({levels("[500.0, 2000.0]")}), IsEmpty());
  const std::vector<std::string> passband{"pings.samples=pressure", "pings.sample_rate=4000.0"};
  const auto with = [&](const std::string& noise) {
    std::vector<std::string> all = passband;
    all.push_back(noise);
    return of(all);
  };
  EXPECT_THAT(with(levels("[10.0, 1500.0]")),
              ElementsAre(HasSubstr("for a recorded band from 0 to 2000 Hz")));
  EXPECT_THAT(with(levels("[10.0, 2000.0]")), IsEmpty());
}

// A ship at rest, 100 m of water below her, and a line of 40 m about her: 20²/(2·100·1.5) periods.
TEST(Warnings, PlaneWavesOfReverberationOnALongLine) {
  const std::string where = "platform.position=[0.0, 0.0, 900.0]";
  const auto line = [](double spacing) {
    return "array={kind=\"horizontal\", phones=41, spacing=" + std::to_string(spacing) + "}";
  };
  const auto sea = [](const std::string& synthesis) {
    return "reverberation={enabled=true, synthesis=\"" + synthesis +
           "\", surface={enabled=false}, bottom={kind=\"lambert\", frozen=false}}";
  };
  EXPECT_THAT(of({where, line(1.0), sea("covariance"), "pulse.duration=0.05"}),
              ElementsAre(AllOf(HasSubstr("reverberation.synthesis: drawn from its covariance"),
                                HasSubstr("up to 1.3 periods off"))));
  EXPECT_THAT(of({where, line(0.1), sea("covariance"), "pulse.duration=0.05"}), IsEmpty());
  for (const char* with_round_fronts : {"automatic", "streams", "scatterers"})
    EXPECT_THAT(of({where, line(1.0), sea(with_round_fronts), "pulse.duration=0.05"}), IsEmpty());
  EXPECT_THAT(of({where, line(1.0), sea("covariance"), "pulse.duration=0.05",
                  "propagation.exact_per_phone=true"}),
              IsEmpty());
}

// The line turns by a right angle 50 s after the ping: while two neighbours pass the corner, in
// less than a block, they come nearer by √2. Received for 10 s it is what it was; phones many
// wavelengths apart are not coherent anyway.
TEST(Warnings, CoherentNoiseOfALineThatTurns) {
  const std::string track =
      "platform={waypoints=[{time=0.0, position=[0.0, 0.0, 100.0]}, {time=50.0, position=[250.0, "
      "0.0, 100.0]}, {time=100.0, position=[250.0, 250.0, 100.0]}]}";
  const std::string array = "array={kind=\"towed\", behind=[10.0, 10.5, 11.0]}",
                    sparse = "array={kind=\"towed\", behind=[10.0, 20.0, 30.0]}";
  const auto noise = [](const std::string& more) {
    return "noise={spectral_level_db=50.0" + more + "}";
  };
  const std::string coherent = noise(", coherence=\"isotropic\"");
  EXPECT_THAT(of({track, array, coherent, "pings.recording_duration=60.0"}),
              ElementsAre(HasSubstr("noise.coherence: array array turns, and in each block")));
  EXPECT_THAT(of({track, sparse, coherent, "pings.recording_duration=60.0"}), IsEmpty());
  EXPECT_THAT(of({track, array, coherent, "pings.recording_duration=10.0"}), IsEmpty());
  EXPECT_THAT(of({track, array, noise(""), "pings.recording_duration=60.0"}), IsEmpty());
}

// Over a level bottom its guide is received; over one that slopes the sheet alone, and that is
// told.
TEST(Warnings, NoiseFromTheSurfaceOverASlopeThatReflects) {
  const auto noise = [](const std::string& coherence) {
    return "noise={spectral_level_db=50.0, coherence=\"" + coherence + "\"}";
  };
  const auto bottom = [](double speed, double density) {
    return "environment.bottom={shape={range=[0.0, 5000.0], depth=[1000.0, 900.0]}, "
           "kind=\"fluid\", speed=" +
           std::to_string(speed) + ", density=" + std::to_string(density) + "}";
  };
  EXPECT_THAT(of({noise("surface")}), IsEmpty());
  EXPECT_THAT(of({noise("surface"), bottom(1700.0, 1800.0)}),
              testing::Contains(HasSubstr("\"surface\" is the sheet of sources above alone")));
  EXPECT_THAT(of({noise("surface"), bottom(1500.0, 1100.0)}),
              testing::Not(testing::Contains(HasSubstr("noise.coherence"))));
  EXPECT_THAT(of({noise("isotropic")}), IsEmpty());
}

TEST(Warnings, ScatteringOutsideOfItsLaw) {
  const auto sea = [](const std::string& law, double frequency, double wind) {
    return of(tone(frequency, {"reverberation={enabled=true, surface={kind=\"" + law + "\"}}",
                               "environment.wind_speed=" + std::to_string(wind)}));
  };
  EXPECT_THAT(sea("nrl", 5001.0, 8.0),
              ElementsAre(HasSubstr("reverberation.surface.kind: frequency 5001 Hz is outside of 0 "
                                    "to 5000 Hz, where the NRL law holds")));
  EXPECT_THAT(sea("nrl", 5000.0, 8.0), IsEmpty());
  EXPECT_THAT(sea("chapman-harris", 399.0, 8.0), ElementsAre(HasSubstr("Chapman and Harris")));
  EXPECT_THAT(sea("chapman-harris", 6401.0, 8.0), ElementsAre(HasSubstr("Chapman and Harris")));
  EXPECT_THAT(sea("chapman-harris", 1000.0, 16.0), ElementsAre(HasSubstr("wind speed 16 m/s")));
  EXPECT_THAT(sea("chapman-harris", 6400.0, 15.0), IsEmpty());
  EXPECT_THAT(sea("ogden-erskine", 1001.0, 8.0), ElementsAre(HasSubstr("Ogden and Erskine")));
  EXPECT_THAT(sea("ogden-erskine", 1000.0, 8.0), IsEmpty());
  // Where nothing scatters at the surface no law is asked.
  EXPECT_THAT(of(tone(8000.0, {"reverberation={enabled=false, surface={kind=\"nrl\"}}"})),
              IsEmpty());
}

// "A Cerveny beam whose default makes no sound": Munk's profile, minimum width.
constexpr const char* silent = R"(
[environment.sound_speed]
kind = "munk"
[environment.bottom]
depth = 5000.0
kind = "table"
grazing_deg = [0.0, 90.0]
magnitude = [0.0, 0.0]
[environment.absorption]
kind = "none"
[run]
frequency = 60.0
[run.source]
depth = 600.0
[run.receivers]
depth = [600.0]
range = { first = 5000.0, last = 20000.0, count = 16 }
[run.fan]
lowest_deg = -20.0
highest_deg = 20.0
[run.beams]
kind = "cerveny-cartesian"
[run.beams.cerveny]
width = "minimum"
)";

TEST(Warnings, SilentBeamsAreThoseThatCarryNoSound) {
  const auto run_with = [](const std::vector<std::string>& overrides,
                           std::vector<std::string>& told) {
    const PropagationCase run_case = parse_propagation_case(silent, "r.toml", overrides, told);
    const PropagationResult result = run(run_case);
    return std::any_of(result.field.begin(), result.field.end(),
                       [](std::complex<float> p) { return std::abs(p) > 0.0F; });
  };
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{},
        {"run.beams.cerveny.loop_range=0"},
        {"run.beams.cerveny={width=\"space-filling\", window=0}"},
        {"run.beams.cerveny={width=\"space-filling\"}"},
        {"run.beams.cerveny.loop_range=10000.0"}}) {
    std::vector<std::string> told;
    const bool sound = run_with(overrides, told);
    EXPECT_EQ(told.empty(), sound) << (overrides.empty() ? "" : overrides[0]);
    if (!told.empty()) {
      EXPECT_THAT(told[0], AllOf(HasSubstr("run.beams.cerveny: "),
                                 HasSubstr("no sound reaches any receiver")));
    }
  }
}

TEST(Warnings, ASolidThatReflectsMoreThanComesIn) {
  Environment ocean;
  ElasticHalfSpace solid{.speed = 2000.0,
                         .shear_speed = 1500.0,
                         .density = 2000.0,
                         .attenuation_db_per_wavelength = 1.0,
                         .shear_attenuation_db_per_wavelength = 0.1};
  ocean.bottom.material = solid;
  EXPECT_EQ(checks::gaining_boundary(ocean), "");
  solid.attenuation_db_per_wavelength = 0.01;  // 4/3 α_s c_s² > α_p c_p²
  solid.shear_attenuation_db_per_wavelength = 5.0;
  const std::vector<double> range = {0.0, 1000.0}, depth = {100.0, 200.0};
  ocean.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear,
                                     {Rigid{}, BoundaryMaterial(solid)});
  EXPECT_THAT(checks::gaining_boundary(ocean),
              AllOf(HasSubstr("environment.bottom: its solid at range 1000 m reflects more"),
                    HasSubstr("degrees")));
  EXPECT_THAT(warnings(ocean, 1000.0, 1000.0),
              ElementsAre(HasSubstr("reflects more than comes in")));
}

TEST(Warnings, NoBoundIsNoNumber) {
  EXPECT_EQ(beam_error_text(0.42, true),
            "more beams would change no more than 0.42 dB at 95 % of the receivers");
  EXPECT_THAT(beam_error_text(infinity, true),
              AllOf(HasSubstr("cannot be bounded"), testing::Not(HasSubstr("99"))));
}

TEST(FiniteField, IsTheOnlyOneThatIsWritten) {
  std::vector<std::complex<float>> field(10, {1.0F, 2.0F});
  EXPECT_NO_THROW(require_finite(field));
  field[3] = {0.0F, std::nanf("")};
  field[7] = {INFINITY, 0.0F};
  try {
    require_finite(field);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("not a finite number at 2 of 10 receivers"));
  }
}

}  // namespace
}  // namespace asdic::detail
