#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "io/bellhop/attenuation.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/case_writer.h"
#include "io/bellhop/list_reader.h"
#include "raytrace/propagation.h"
#include "support/same_case.h"
#include "support/temporary_directory.h"

// BELLHOP's input files: what list-directed reading means, what the sixteen cases of
// tests/data/bellhop hold, what every malformed line is told.

namespace asdic::detail::bellhop {
namespace {

const std::filesystem::path data = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop";

std::vector<std::filesystem::path> all_roots() {
  std::vector<std::filesystem::path> roots;
  for (const auto& folder : std::filesystem::directory_iterator(data))
    if (folder.is_directory()) {
      roots.push_back(folder.path() / "case");
      roots.push_back(folder.path() / "converged" / "case");
    }
  return roots;
}

/// A small case whose lines tests replace: line 8 is a profile row, 10 the bottom half space, …
const std::vector<std::string> small_lines = {
    "'a small case'",        // 1
    "1000.",                 // 2
    "1",                     // 3
    "'CVW'",                 // 4
    "3 0.0 100.0",           // 5
    "0 1500 /",              // 6
    "50 1490 0 1.1 0.2 /",   // 7
    "100 1510 /",            // 8
    "'A' 0.0",               // 9
    "100 1700 0 1.8 0.5 /",  // 10
    "1",
    "30 /",  // 11, 12
    "5",
    "10 90 /",  // 13, 14
    "11",
    "0 1 /",      // 15, 16
    "'CG'",       // 17
    "0",          // 18
    "-40 40 /",   // 19
    "0 120 1.1",  // 20
};

Texts small_case(std::size_t line = 0, const std::string& text = "") {
  Texts texts;
  for (std::size_t i = 0; i < small_lines.size(); ++i)
    texts.env += (i + 1 == line ? text : small_lines[i]) + '\n';
  return texts;
}

Input read_small(std::size_t line = 0, const std::string& text = "") {
  return read_case(small_case(line, text), "case");
}

TEST(ListReader, ReadsAsFortranDoes) {
  ListReader reader(
      "1 2.5D1, 3*.5 4 dropped\r\n\n'it''s' \"one\" bare/ 7\n,,6 / 9\n1-3 2*'ab' 1*\n", "file");
  reader.begin("first");
  for (const double expected : {1.0, 25.0, 0.5, 0.5, 0.5, 4.0})
    EXPECT_EQ(reader.need_real("x"), expected);
  reader.end();
  std::string text;
  reader.begin("second");  // blank lines are skipped
  for (const char* expected : {"it's", "one", "bare"}) {
    EXPECT_TRUE(reader.text(text, "word"));
    EXPECT_EQ(text, expected);
  }
  EXPECT_FALSE(reader.text(text, "after the slash"));
  EXPECT_EQ(text, "bare");
  reader.end();
  double value = -1.0;
  reader.begin("third");
  EXPECT_FALSE(reader.real(value, "left out"));
  EXPECT_FALSE(reader.real(value, "left out"));
  EXPECT_EQ(value, -1.0);
  EXPECT_TRUE(reader.real(value, "x"));
  EXPECT_EQ(value, 6.0);
  EXPECT_FALSE(reader.real(value, "after the slash"));
  reader.end();
  reader.begin("fourth");
  EXPECT_EQ(reader.need_real("exponent without a letter"), 1e-3);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(reader.text(text, "word"));
  EXPECT_EQ(text, "ab");
  EXPECT_FALSE(reader.real(value, "nothing, once"));
  EXPECT_EQ(reader.line(), 5U);
  reader.end();
  EXPECT_TRUE(reader.at_end());
}

TEST(ListReader, NumbersAreFortrans) {
  for (const auto& [text, value] : std::vector<std::pair<const char*, double>>{{"1", 1.0},
                                                                               {"+1.", 1.0},
                                                                               {"-.5", -0.5},
                                                                               {"1e3", 1e3},
                                                                               {"1.5D+03", 1500.0},
                                                                               {"2q-2", 0.02},
                                                                               {"1+3", 1e3},
                                                                               {"1d400", 0.0},
                                                                               {"1e-400", 0.0}}) {
    const auto number = fortran_number(text);
    if (std::string(text) == "1d400")
      EXPECT_FALSE(number) << text;
    else
      EXPECT_EQ(number.value_or(-99.0), value) << text;
  }
  for (const char* text :
       {"", "x", "1x", "--1", "1e", "e5", ".", "1.2.3", "nan", "inf", "0x10", "1e+-3"})
    EXPECT_FALSE(fortran_number(text)) << text;
}

TEST(BellhopCase, AllSixteenAreRead) {
  const auto roots = all_roots();
  EXPECT_EQ(roots.size(), 32U);
  for (const auto& root : roots) {
    const Input input = read_case(root);
    EXPECT_GT(input.run_case.source_depths.size(), 0U) << root;
    EXPECT_GT(input.run_case.literal.beams, 0) << root;
    EXPECT_GT(input.run_case.literal.step, 0.0) << root;
    EXPECT_NE(input.echo.find(input.run_case.title), std::string::npos) << root;
  }
}

// Depths and ranges are in single precision, spaced with a fused multiply-add: the very numbers
// that BELLHOP has written into the heads of its files.
TEST(BellhopCase, GridsAreBellhopsOwnBitForBit) {
  for (const auto& root : all_roots()) {
    const PropagationCase run_case = read_case(root).run_case;
    const std::string stem = root.string();
    if (std::filesystem::exists(stem + ".shd")) {
      const ShadeFile file = read_shade_file(stem + ".shd");
      EXPECT_EQ(file.source_depths, run_case.source_depths) << root;
      EXPECT_EQ(file.receiver_depths, run_case.receivers.depths) << root;
      EXPECT_EQ(file.receiver_ranges, run_case.receivers.ranges) << root;
      EXPECT_EQ(file.title, "BELLHOP- " + run_case.title);
    }
    if (std::filesystem::exists(stem + ".ray")) {
      const RayFile file = read_ray_file(stem + ".ray");
      EXPECT_EQ(file.surface_depth, run_case.environment.water.depths().front());
      EXPECT_EQ(file.bottom_depth, run_case.environment.water.depths().back());
      EXPECT_EQ(file.angles, run_case.literal.beams);
    }
  }
}

// BELLHOP's numbers of beams where the file says 0, from the meta.json of the cases.
TEST(BellhopCase, AutomaticBeamsAndSteps) {
  EXPECT_EQ(read_case(data / "munk-coherent-hat/case").run_case.literal.beams, 1920);
  EXPECT_EQ(read_case(data / "tables-and-pattern/case").run_case.literal.beams, 1272);
  EXPECT_EQ(read_case(data / "seamount-curved/case").run_case.literal.beams, 960);
  EXPECT_EQ(read_case(data / "swell-surface/case").run_case.literal.step, 15.4);
  EXPECT_EQ(read_case(data / "munk-coherent-hat/case").run_case.beams.count, 0);
}

TEST(BellhopCase, ElevationIsMinusDeclination) {
  const PropagationCase fan = read_small(19, "-10 40 /").run_case;
  EXPECT_EQ(fan.beams.lowest, radians(-40.0));
  EXPECT_EQ(fan.beams.highest, radians(10.0));
  EXPECT_TRUE(fan.beams.elevations.empty());
  Texts texts = small_case(18, "3");
  texts.env.replace(texts.env.find("-40 40 /"), 8, "5 -1 2.5");
  const PropagationCase list = read_case(texts, "case").run_case;
  EXPECT_EQ(list.beams.elevations,
            (std::vector<double>{radians(-5.0), radians(-2.5), radians(1.0)}));
}

TEST(BellhopCase, AFullTurnLosesItsLastBeam) {
  Texts texts = small_case(18, "361");
  texts.env.replace(texts.env.find("-40 40 /"), 8, "-180 180 /");
  const Input input = read_case(texts, "case");
  EXPECT_EQ(input.run_case.literal.beams, 360);
  EXPECT_EQ(input.run_case.beams.lowest, radians(-179.0));
  EXPECT_EQ(input.run_case.beams.highest, radians(180.0));
  EXPECT_EQ(input.notes.size(), 2U);
}

// A row that stops at its slash takes the rest from the row before, whatever that was for.
TEST(BellhopCase, ValuesLeftOutAreThoseOfTheRowBefore) {
  Texts texts = small_case(4, "'CAW'\n0 3300 1700 0.9 0.3 1 /");
  texts.env.replace(texts.env.find("100 1700 0 1.8 0.5 /"), 20, "100 1700 /");
  const Environment ocean = read_case(texts, "case").run_case.environment;
  const auto& ice = std::get<ElasticHalfSpace>(ocean.surface.material);
  EXPECT_EQ(ice.density, 900.0);
  EXPECT_EQ(ice.shear_attenuation_db_per_wavelength, 1.0);
  EXPECT_EQ(ocean.water_density.at(0.0), 900.0);     // from the ice
  EXPECT_EQ(ocean.water_density.at(100.0), 1100.0);  // from the row at 50 m
  const auto& bottom = std::get<FluidHalfSpace>(ocean.bottom.material);
  EXPECT_EQ(bottom.density, 1100.0);
  EXPECT_EQ(bottom.attenuation_db_per_wavelength, 0.2);
}

// Rows `z c /` of the water after a line of ice: its density and attenuation are in the water now.
// 0.3 dB per wavelength of 1.5 m at 1 kHz is 200 dB/km; the shear attenuation means nothing there.
TEST(BellhopCase, ALeakFromAnotherLineIsTold) {
  Texts texts = small_case(4, "'CAW'\n0 3300 1700 0.9 0.3 1");
  texts.env.replace(texts.env.find("50 1490 0 1.1 0.2 /"), 19, "50 1500 /");
  const Input input = read_case(texts, "case");
  const std::string leak =
      "case.env:7: profile row 1: density 0.9 g/cm^3, attenuation 0.3: left out there, so taken "
      "over from the surface half space, as BELLHOP does";
  EXPECT_EQ(input.leaks, std::vector<std::string>{leak});
  EXPECT_EQ(std::count(input.notes.begin(), input.notes.end(), leak), 1);
  EXPECT_NE(
      input.echo.find("\nabsorption 198.675 to 200 dB/km, 198.675 to 200 of it by the rows of "
                      "the profile\n"),
      std::string::npos)  // the row at 100 m has 1510 m/s: 200·1500/1510
      << input.echo;
  EXPECT_NE(input.echo.find("900 kg/m3\n"), std::string::npos) << input.echo;

  // the profile's last row has 1.1 g/cm^3, 0.2 dB per wavelength
  const Input short_bottom = read_small(10, "100 1700 /");
  ASSERT_EQ(short_bottom.leaks.size(), 1U);
  EXPECT_EQ(short_bottom.leaks[0],
            "case.env:10: bottom half space: density 1.1 g/cm^3, attenuation 0.2: left out there, "
            "so taken over from the profile, as BELLHOP does");
}

// Values of the profile's own row before, BELLHOP's initial ones, and what no fluid has are meant.
TEST(BellhopCase, WhatIsUsuallyLeftOutIsNoLeak) {
  EXPECT_TRUE(read_small().leaks.empty());
  EXPECT_TRUE(read_small(4, "'CAW'\n0 1600 0 1 0 /").leaks.empty());
  for (const auto& root : all_roots()) EXPECT_TRUE(read_case(root).leaks.empty()) << root;
  EXPECT_NE(read_small(7, "50 1490 /").echo.find("\nabsorption 0 dB/km\n"), std::string::npos);
}

std::size_t notes_with(const Input& input, const std::string& words) {
  return std::size_t(std::count_if(
      input.notes.begin(), input.notes.end(),
      [&](const std::string& note) { return note.find(words) != std::string::npos; }));
}

TEST(BellhopCase, AnIrregularGridThatIsSortedIsTold) {
  const auto irregular = [](const std::string& depths, const std::string& ranges) {
    Texts texts = small_case(17, "'CG  I'");
    texts.env.replace(texts.env.find("10 90 /"), 7, depths);
    texts.env.replace(texts.env.find("11\n0 1 /"), 8, "5\n" + ranges);
    return read_case(texts, "case");
  };
  const std::string words = "run type: letter 5: the depths and the ranges";
  EXPECT_EQ(notes_with(irregular("50 40 60 20 10", "0.1 0.2 0.3 0.4 0.5"), words), 1U);
  EXPECT_EQ(notes_with(irregular("10 20 30 40 50", "0.1 0.3 0.2 0.4 0.5"), words), 1U);
  EXPECT_EQ(notes_with(irregular("50 10 /", "0.1 0.5 /"), words), 1U);
  EXPECT_EQ(notes_with(irregular("10 20 30 40 50", "0.1 0.2 0.3 0.4 0.5"), words), 0U);
  EXPECT_EQ(notes_with(read_small(14, "90 10 /"), words), 0U);  // a grid is a grid
}

TEST(BellhopCase, ABottomAboveTheSurfaceIsTold) {
  Texts texts = small_case(9, "'A~' 0");
  texts.companions.emplace_back(".bty", "'L'\n3\n0 50\n0.5 -10\n1 -20\n");
  EXPECT_EQ(notes_with(read_case(texts, "case"),
                       "case.bty: 2 of 3 nodes are above the surface, the first of them node 2 at "
                       "0.5 km, -10 m deep"),
            1U);
}

TEST(BellhopCase, ASectionShorterThanTheReceiversIsTold) {
  Texts texts = small_case(4, "'QVW'");
  texts.companions.emplace_back(".ssp", "2\n0 0.5\n1500 1500\n1490 1490\n1510 1510\n");
  EXPECT_EQ(notes_with(read_case(texts, "case"),
                       "case.ssp: its profiles go from 0 to 0.5 km, the receivers from 0 to 1 km"),
            1U);
  texts.companions[0].second = "2\n0 1.0\n1500 1500\n1490 1490\n1510 1510\n";
  EXPECT_EQ(notes_with(read_case(texts, "case"), "case.ssp"), 0U);
}

TEST(BellhopCase, AByteOrderMarkIsSkipped) {
  Texts texts = small_case();
  texts.env = "\xEF\xBB\xBF" + texts.env;
  EXPECT_EQ(read_case(texts, "case").run_case.title, "a small case");
}

// What only a run finds is told of the line of the file it comes from.
TEST(BellhopCase, FaultsOfARunAreToldOfTheFile) {
  const Input input = read_small(19, "20 20 /");
  try {
    static_cast<void>(run(input.run_case));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(told_of_file(error, input).what(),
                 "case.env:19: launch angles: found -20.000000 deg, expected above the lowest, "
                 "-20.000000 deg");
  }
  EXPECT_STREQ(told_of_file(InputError({"bottom.depth", "1", "2"}), input).what(),
               "case.env: bottom.depth: found 1, expected 2");
}

// One loss in the six units, at 1 kHz and c = 1500 m/s (so λ = 1.5 m): 0.3 dB per wavelength is 0.2
// dB/m; 0.2/8.6858896 Np/m; Q = π·8.6858896/0.3; a loss parameter of 0.3/(2π·8.6858896).
TEST(BellhopCase, AttenuationInSixUnits) {
  const double neper = 8.6858896;
  const std::pair<const char*, double> same[] = {{"W", 0.3},
                                                 {"M", 0.2},
                                                 {"F", 0.2},
                                                 {"N", 0.2 / neper},
                                                 {"Q", pi * neper / 0.3},
                                                 {"L", 0.3 / (2.0 * pi * neper)}};
  for (const auto& [unit, value] : same) {
    std::ostringstream row;
    row.precision(17);
    row << value << " /";
    Texts texts = small_case(4, std::string("'CV") + unit + "'");
    texts.env.replace(texts.env.find("0 1500 /"), 8, "0 1500 0 1 " + row.str());
    texts.env.replace(texts.env.find("50 1490 0 1.1 0.2 /"), 19, "50 1500 /");
    texts.env.replace(texts.env.find("100 1510 /"), 10, "100 1500 /");
    texts.env.replace(texts.env.find("100 1700 0 1.8 0.5 /"), 20, "100 1500 0 1.8 " + row.str());
    const Environment ocean = read_case(texts, "case").run_case.environment;
    // a chain of ten roundings
    EXPECT_NEAR(ocean.attenuation_db_per_km.at(10.0), 200.0, 200.0 * 1e-15 * 10) << unit;
    EXPECT_NEAR(std::get<FluidHalfSpace>(ocean.bottom.material).attenuation_db_per_wavelength, 0.3,
                0.3 * 1e-15 * 10)
        << unit;
  }
}

// BELLHOP.md's Thorp and Francois-Garrison are our laws: the volume loss also goes into the half
// space.
TEST(BellhopCase, VolumeLossIsAddedToTheHalfSpace) {
  const PropagationCase run_case = read_small(4, "'CVWT'").run_case;
  const double per_km = absorption_db_per_km(run_case.environment.absorption, 1000.0);
  EXPECT_DOUBLE_EQ(per_km, 0.0033 + 0.11 / 2.0 + 44.0 / 4101.0 + 0.0003);
  EXPECT_NEAR(
      std::get<FluidHalfSpace>(run_case.environment.bottom.material).attenuation_db_per_wavelength,
      0.5 + per_km * 1e-3 * 1.7, 1e-15);
}

TEST(BellhopCase, LayersOfFishAreAttenuationAtTheNodes) {
  const Environment ocean = read_small(4, "'CVWB'\n1\n40 60 900 5 2 /").run_case.environment;
  const double x = 1.0 - 0.81, resonance = 2.0 / (x * x + 0.04);
  EXPECT_TRUE(ocean.biology.empty());
  EXPECT_EQ(ocean.attenuation_db_per_km.at(0.0), 0.0);
  EXPECT_NEAR(ocean.attenuation_db_per_km.at(50.0), 0.2 * 1000.0 / 1.49 + resonance, 1e-11);
}

TEST(BellhopCase, WhatIsOutsideTheWaterIsMovedAndTold) {
  Texts texts = small_case(12, "-5 /");
  texts.env.replace(texts.env.find("10 90 /"), 7, "10 130 /");
  const Input input = read_case(texts, "case");
  EXPECT_EQ(input.run_case.source_depths, std::vector<double>{0.0});
  EXPECT_EQ(input.run_case.receivers.depths, (std::vector<double>{10, 40, 70, 100, 100}));
  EXPECT_EQ(input.notes[0], "1 of 1 source depths were above the surface and moved to 0 m");
  EXPECT_EQ(input.notes[1], "1 of 5 receiver depths were below the bottom and moved to 100 m");
}

TEST(BellhopCase, LettersThatMeanNothingAreHatBeams) {
  const Input input = read_small(17, "'IQ XR'");
  EXPECT_EQ(input.run_case.beams.kind, BeamKind::hat);
  EXPECT_EQ(input.run_case.beams.source, SourceKind::line);
  EXPECT_EQ(input.run_case.field, FieldKind::incoherent);
  EXPECT_EQ(input.notes[0],
            "run type, letter 2: \"Q\" is no kind of beam; geometric hat beams, as BELLHOP does");
}

TEST(BellhopCase, CervenysLines) {
  Texts texts = small_case(17, "'RC'");
  texts.env += "'MZ' 0.5 2.5\n3 /\n";
  const PropagationCase run_case = read_case(texts, "case").run_case;
  ASSERT_TRUE(run_case.beams.cerveny);
  EXPECT_EQ(run_case.beams.cerveny->width, CervenyBeams::Width::minimum);
  EXPECT_EQ(run_case.beams.cerveny->curvature, CervenyBeams::Curvature::zero);
  EXPECT_EQ(run_case.beams.cerveny->width_multiplier, 0.5);
  EXPECT_EQ(run_case.beams.cerveny->loop_range, 2500.0);
  EXPECT_EQ(run_case.beams.cerveny->images, 3);
  EXPECT_EQ(run_case.beams.cerveny->window, 4);
}

// The third item of the line is the component, so the "!" of a comment is read as one.
TEST(BellhopCase, ACommentAfterCervenysWindowIsThePressure) {
  Texts texts = small_case(17, "'CC'");
  texts.env += "'MS' 1.0 20.0\n";
  const auto read = [&](const char* line) {
    Texts with_line = texts;
    with_line.env += line;
    return read_case(with_line, "case");
  };
  const Input comment = read("2 5 ! NIMAGE, IBWIN\n");
  EXPECT_EQ(comment.run_case.beams.cerveny->images, 2);
  EXPECT_EQ(comment.run_case.beams.cerveny->window, 5);
  EXPECT_EQ(comment.run_case.beams.cerveny->component, CervenyBeams::Component::pressure);
  EXPECT_EQ(comment.notes.size() + 1, read("2 5 X\n").notes.size());  // a letter by mistake is told
  EXPECT_EQ(read("2 5 V ! NIMAGE\n").run_case.beams.cerveny->component,
            CervenyBeams::Component::vertical);
}

TEST(BellhopCase, LongBathymetryHasMaterialsPerFacet) {
  Texts texts = small_case(9, "'A~' 0");
  texts.companions.emplace_back(".bty", "'LL'\n2\n0 90 1600 0 1.5 0.2 0\n1 80 2000 800 2.0 0 0\n");
  const PropagationCase run_case = read_case(texts, "case").run_case;
  const BoundaryShape& shape = *run_case.environment.bottom.shape;
  EXPECT_EQ(run_case.environment.bottom.depth, 90.0);
  EXPECT_EQ(shape.ranges()[1], 1000.0);
  EXPECT_EQ(std::get<FluidHalfSpace>(shape.materials()[0]).speed, true_speed(1600.0, 0.2));
  EXPECT_EQ(std::get<ElasticHalfSpace>(shape.materials()[1]).shear_speed, 800.0);
  EXPECT_EQ(std::get<FluidHalfSpace>(run_case.environment.bottom.material).speed,
            true_speed(1600.0, 0.2));
}

// BELLHOP's wave number is ω/(c + iαc²/ω); ours (ω/c′)(1 − iδ), δ the nepers in a radian: the same.
TEST(BellhopCase, TheWaveNumberOfALossyBottomIsBellhops) {
  const double omega = 2000.0 * pi, c = 1700.0, alpha = 0.5 * 1000.0 / (8.6858896 * c);
  const std::complex<double> theirs = omega / std::complex<double>(c, alpha * c * c / omega);
  const PropagationCase run_case = read_small().run_case;
  const auto& fluid = std::get<FluidHalfSpace>(run_case.environment.bottom.material);
  const double delta = fluid.attenuation_db_per_wavelength / (2.0 * pi * 8.6858896);
  const std::complex<double> ours = omega / fluid.speed * std::complex<double>(1.0, -delta);
  EXPECT_LT(std::abs(ours - theirs), 1e-15 * std::abs(theirs) * 4);  // a few roundings
}

TEST(BellhopCase, MunksProfileHasNoRows) {
  Texts texts = small_case(4, "'AVW'");
  texts.env.replace(texts.env.find("0 1500 /"), 8 + 1 + 20 + 11, "");
  const PropagationCase run_case = read_case(texts, "case").run_case;
  EXPECT_TRUE(run_case.environment.water.munk_parameters());
  EXPECT_EQ(run_case.environment.bottom.depth, 100.0);
}

// BELLHOP takes the sea for the same all around its source; a scenario for the same across its
// plane.
TEST(BellhopCase, SpreadsCylindrically) {
  const Input wedge = read_case(data / "wedge-gauss" / "case");
  EXPECT_EQ(spreading_across(wedge.run_case.environment), Spreading::cylindrical);
  EXPECT_EQ(read_small().run_case.environment.spreading,
            Spreading{});  // over level ground no matter
  PropagationCase plane = wedge.run_case;
  plane.environment.spreading = Spreading::plane;
  const Written written = write_case(plane, false);
  ASSERT_EQ(written.notes.size(), 1U);
  EXPECT_NE(written.notes[0].find("environment.spreading"), std::string::npos);
  plane.beams.source = SourceKind::line;  // spreads nowhere
  EXPECT_TRUE(write_case(plane, false).notes.empty());
}

TEST(BellhopCase, AllSixteenAreWrittenAndReadBackTheSame) {
  for (const auto& root : all_roots()) {
    const Input first = read_case(root);
    const Written written = write_case(first.run_case, first.binary_arrivals);
    EXPECT_TRUE(written.notes.empty()) << root << ": " << written.notes.front();
    const Input second = read_case(written.texts, "case");
    EXPECT_EQ(support::CaseComparison::difference(first.run_case, second.run_case), "") << root;
  }
}

struct Malformed {
  std::size_t line;
  const char* text;
  const char* message;
};

// Every message in full: file, line, field, found, expected.
TEST(BellhopCase, EveryMalformedLineIsTold) {
  const Malformed all[] = {
      {17, "'CG",
       "case.env:17: run type: found a quote that is never closed, expected a closing '"},
      {2, "fast", "case.env:2: frequency: found \"fast\", expected a number"},
      {2, "0", "case.env:2: frequency: found 0 Hz, expected a frequency above 0 Hz"},
      {2, "-5 /", "case.env:2: frequency: found -5 Hz, expected a frequency above 0 Hz"},
      {3, "2", "case.env:3: number of media: found 2, expected 1: rays know one medium"},
      {3, "1.5", "case.env:3: number of media: found \"1.5\", expected a whole number"},
      {4, "'ZVW'",
       "case.env:4: top options: letter 1: found \"Z\", expected N (1/c^2 linear), C (c linear), P "
       "(PCHIP), S (spline), Q (range-dependent), A (Munk) or, over a map, H (hexahedral)"},
      {4, "'CWW'",
       "case.env:4: top options: letter 2: found \"W\", expected V (vacuum), R (rigid), A (half "
       "space), F (table) or G (grain size)"},
      {4, "'CV'",
       "case.env:4: top options: letter 3: found \" \", expected an attenuation unit: N, F, M, W, "
       "Q or L"},
      {4, "'CVWX'",
       "case.env:4: top options: letter 4: found \"X\", expected a blank, T (Thorp), F "
       "(Francois-Garrison) or B (biology)"},
      {4, "'CVW x'",
       "case.env:4: top options: letter 5: found \"x\", expected ~ or * (altimetry), or -, _ or a "
       "blank"},
      {4, "'CVW  B'",
       "case.env:4: top options: letter 6: found \"B\" (several frequencies), expected a blank or "
       "I "
       "(a single beam)"},
      {4, "'QVW'",
       "case.ssp: found no such file, expected the file that \"Q\" in case.env asks for"},
      {4, "'CFW'",
       "case.trc: found no such file, expected the file that \"F\" in case.env asks for"},
      {5, "3 0.0 /",
       "case.env:5: profile: NPTS SIGMA DEPTH: bottom depth: found no value, expected a number"},
      {6, "0 -1500 /",
       "case.env:6: profile row 1: speed: found -1500 m/s, expected a speed from 200 to 10000 "
       "m/s"},
      {6, "0 1.5 /",
       "case.env:6: profile row 1: speed: found 1.5 m/s, expected a speed from 200 to 10000 m/s"},
      {6, "0 1500 0 0 /",
       "case.env:6: profile row 1: density: found 0 g/cm^3, expected a density above 0 g/cm^3"},
      {6, "0 1500 0 1 99 /",
       "case.env:6: profile row 1: attenuation: found 99, expected less than one neper in a radian "
       "of the wave"},
      {7, "0 1490 /",
       "case.env:7: profile row 2: depth: found 0 m, expected a depth below the one before, 0 m"},
      {8, "99 1510 /", "case.env:9: profile row 4: depth: found \"A\", expected a number"},
      {8, "101 1510 /",
       "case.env:8: profile row 3: depth: found 101 m, expected the last row at the bottom depth, "
       "100 m"},
      {9, "'X'",
       "case.env:9: bottom options: letter 1: found \"X\", expected V (vacuum), R (rigid), A (half "
       "space), F (table) or G (grain size)"},
      {9, "'A!'",
       "case.env:9: bottom options: letter 2: found \"!\", expected ~ or * (bathymetry), or -, _ "
       "or "
       "a blank"},
      {9, "'A~'",
       "case.bty: found no such file, expected the file that \"~\" in case.env asks for"},
      {10, "100 1700 0 -1 /",
       "case.env:10: bottom half space: density: found -1 g/cm^3, expected a density above 0 "
       "g/cm^3"},
      {10, "100 1700 0 1.5 60 /",
       "case.env:10: bottom half space: attenuation: found 60 dB per wavelength, expected less "
       "than "
       "one neper in a radian of the wave, 54.57 dB per wavelength"},
      {11, "0",
       "case.env:11: number of source depths: found 0, expected a whole number from 1 to 1000000"},
      {12, "/",
       "case.env:12: source depths: found 0 values, expected 1, or the two ends of a vector evenly "
       "spaced, or one"},
      {14, "10 20 90 /",
       "case.env:14: receiver depths: found 3 values, expected 5, or the two ends of a vector "
       "evenly "
       "spaced, or one"},
      {15, "1000000000",
       "case.env:15: number of receiver ranges: found 1000000000, expected a whole number from 1 "
       "to "
       "1000000"},
      {16, "0 1e99 /",
       "case.env:16: receiver ranges: value 2: found \"1e99\", expected a number below 1e30"},
      {17, "'XG'",
       "case.env:17: run type: letter 1: found \"X\", expected R (rays), E (eigenrays), A or a "
       "(arrivals), V or v (both), C, I or S (field)"},
      {17, "'CG*'",
       "case.sbp: found no such file, expected the file that \"*\" in case.env asks for"},
      {17, "'CG  I'",
       "case.env:17: run type: letter 5: found 5 receiver depths and 11 ranges, expected as many "
       "depths as ranges on an irregular grid (I)"},
      {18, "-1",
       "case.env:18: number of beams: found -1, expected a whole number from 0 to 10000000"},
      {19, "-40 400 /",
       "case.env:19: launch angles: angle: found 400 degrees, expected an angle from -360 to 360 "
       "degrees"},
      {20, "-1 120 1.1",
       "case.env:20: STEP ZBOX RBOX: step: found -1 m, expected a step of at least 0 m (0: "
       "automatic)"},
      {20, "0 120",
       "case.env:21: STEP ZBOX RBOX: box range: found the end of the file, expected a number"},
      {20, "0 120 0",
       "case.env:20: STEP ZBOX RBOX: box range: found 0 km, expected a range above 0 km"},
  };
  for (const Malformed& bad : all) try {
      (void)read_small(bad.line, bad.text);
      ADD_FAILURE() << "read: " << bad.text;
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), bad.message);
    }
}

TEST(BellhopCase, EveryMalformedCompanionIsTold) {
  struct Companion {
    std::size_t line;
    const char *options, *extension, *text, *message;
  };
  const Companion all[] = {
      {9, "'A~'", ".bty", "'X'\n2\n0 50\n1 60\n",
       "case.bty:1: type: letter 1: found \"X\", expected L (piecewise linear) or C (curvilinear)"},
      {9, "'A~'", ".bty", "'LX'\n2\n0 50\n1 60\n",
       "case.bty:1: type: letter 2: found \"X\", expected a blank, S (short) or L (long, with "
       "materials)"},
      {9, "'A~'", ".bty", "'L'\n2\n1 50\n1 60\n",
       "case.bty:4: node 2: range: found 1 km, expected above the one before, 1 km"},
      {9, "'A~'", ".bty", "'L'\n2\n0 50\n1 160\n",
       "case.bty:4: node 2: depth: found 160 m, expected not below the profile, which ends at 100 "
       "m"},
      {9, "'A~'", ".bty", "'L'\n3\n0 50\n1 60\n",
       "case.bty:5: node 3: range: found the end of the file, expected a number"},
      {9, "'A~'", ".bty", "'LL'\n1\n0 50 1600 0 /\n",
       "case.bty:3: node 1: density: found no value, expected a number"},
      {4, "'CVW*'", ".ati", "'L'\n1\n0 -1\n",
       "case.env:4: top options: letter 4: found \"*\", expected a blank, T (Thorp), F "
       "(Francois-Garrison) or B (biology)"},
      {4, "'CVW *'", ".ati", "'L'\n1\n0 -1\n",
       "case.ati:3: node 1: depth: found -1 m, expected not above the profile, which begins at 0 "
       "m"},
      {4, "'QVW'", ".ssp", "2\n0 1\n1500 1500\n1500 x\n1500 1500\n",
       "case.ssp:4: speeds at 50 m: speed: found \"x\", expected a number"},
      {4, "'QVW'", ".ssp", "0\n",
       "case.ssp:1: number of profiles: found 0, expected a whole number from 1 to 100000"},
      {9, "'F'", ".brc", "2\n0 1 0\n95 1 0\n",
       "case.brc:3: row 2: angle: found 95 degrees, expected a grazing angle from 0 to 90 degrees"},
      {9, "'F'", ".brc", "1\n0 -1 0\n",
       "case.brc:2: row 1: magnitude: found -1, expected a magnitude from 0 to 1: no boundary "
       "reflects more than comes in"},
      {9, "'F'", ".brc", "1\n0 1.2 0\n",
       "case.brc:2: row 1: magnitude: found 1.2, expected a magnitude from 0 to 1: no boundary "
       "reflects more than comes in"},
      {17, "'CG*'", ".sbp", "2\n0 0\n0 0\n",
       "case.sbp:3: row 2: angle: found 0 degrees, expected above the one before, 0 degrees"},
      {17, "'CG*'", ".sbp", "1\n0 0\n",
       "case.sbp:1: number of rows: found 1, expected a whole number from 2 to 10000000"},
  };
  for (const Companion& bad : all) {
    Texts texts = small_case(bad.line, bad.options);
    texts.companions.emplace_back(bad.extension, bad.text);
    try {
      (void)read_case(texts, "case");
      ADD_FAILURE() << "read: " << bad.text;
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), bad.message);
    }
  }
}

TEST(BellhopCase, AFolderInPlaceOfAFileIsTold) {
  const support::TemporaryDirectory folder;
  static_cast<void>(folder.write("case.env", small_case(9, "'A~' 0").env));
  std::filesystem::create_directory(folder / "case.bty");
  std::filesystem::create_directory(folder / "other.env");
  for (const auto& [root, says] :
       {std::pair{"case", "case.bty: found a folder, expected the file that"},
        std::pair{"other", "other.env: found a folder, expected the input of"}})
    try {
      (void)read_case(folder / root);
      ADD_FAILURE() << root;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
}

TEST(BellhopCase, AMissingFileIsTold) {
  try {
    (void)read_case(std::filesystem::path("nowhere/case"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "nowhere/case.env: found no such file, expected the input of a BELLHOP case");
  }
}

}  // namespace
}  // namespace asdic::detail::bellhop
