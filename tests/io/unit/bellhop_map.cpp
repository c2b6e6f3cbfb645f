// Files of BELLHOP3D: cases over a map as they are read and written, and their results.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/units.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/case_writer.h"
#include "io/bellhop/grid_file.h"
#include "io/bellhop/map_run.h"
#include "io/bellhop/map_scenario.h"
#include "io/bellhop/results.h"
#include "io/compare/arrivals.h"
#include "io/compare/fields.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/own_files.h"
#include "io/result/result_file.h"
#include "io/scenario/propagation.h"
#include "io/scenario/writer.h"
#include "raytrace/propagation.h"
#include "support/same_case.h"
#include "support/temporary_directory.h"

namespace asdic::detail::bellhop {
namespace {

const std::vector<std::string> lines_of_a_case = {
    "'an island'",           // 1
    "1000.",                 // 2
    "1",                     // 3
    "'HVW'",                 // 4
    "3 0.0 400.0",           // 5
    "0 1500 /",              // 6
    "50 1490 0 1.1 0.2 /",   // 7
    "400 1510 /",            // 8
    "'A~' 0.0",              // 9
    "400 1700 0 1.8 0.5 /",  // 10
    "2 ! source x",          // 11
    "-1 0.5 /",              // 12
    "1",                     // 13
    "0.25 /",                // 14
    "1",                     // 15
    "30 /",                  // 16
    "2",                     // 17
    "10 90 /",               // 18
    "3",                     // 19
    "0 2 /",                 // 20
    "5 ! azimuths",          // 21
    "0 360 /",               // 22
    "'CG   3'",              // 23
    "21",                    // 24
    "-40 40 /",              // 25
    "37",                    // 26
    "0 360 /",               // 27
    "0 8 9 500",             // 28
};

const std::string island = "'R'\n3\n-9 9 /\n2\n-9 9\n300 200.5 300\n310 -2 290\n";
const std::string water =
    "2\n-10 10\n2\n-10 10\n3\n0 50 400\n"
    "1500 1501\n1502 1503\n1490 1491\n1492 1493\n1510 1511\n1512 1513\n";

/// Replaces a line, or a companion.
Texts island_case(std::size_t line = 0, const std::string& text = "",
                  const std::string& bty = island, const std::string& ssp = water) {
  Texts texts;
  for (std::size_t i = 0; i < lines_of_a_case.size(); ++i)
    texts.env += (i + 1 == line ? text : lines_of_a_case[i]) + '\n';
  texts.companions = {{".bty", bty}, {".ssp", ssp}};
  return texts;
}

std::string complaint(const Texts& texts) {
  try {
    (void)read_case(texts, "case");
    return "none";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(BellhopMap, WhatACaseSays) {
  const Input input = read_case(island_case(), "case");
  ASSERT_TRUE(input.map.has_value());
  const MapInput& map = *input.map;
  EXPECT_EQ(map.source_x, (std::vector<double>{-1000.0, 500.0}));
  EXPECT_EQ(map.source_y, (std::vector<double>{250.0}));
  EXPECT_EQ(map.azimuths_deg, (std::vector<double>{0.0, 90.0, 180.0, 270.0, 360.0}));
  EXPECT_EQ(map.planes(), 10u);
  EXPECT_EQ(map.fan, 37);
  EXPECT_EQ(map.box_x, 8000.0);
  EXPECT_EQ(map.box_y, 9000.0);
  EXPECT_EQ(input.run_case.box_depth, 500.0);
  EXPECT_EQ(input.run_case.dimension, 3);
  EXPECT_EQ(input.run_case.receivers.ranges, (std::vector<double>{0.0, 1000.0, 2000.0}));
  EXPECT_EQ(map.bathymetry->x, (std::vector<double>{-9000.0, 0.0, 9000.0}));
  EXPECT_FALSE(map.bathymetry->curvilinear);
  EXPECT_EQ(map.water->z, (std::vector<double>{0.0, 50.0, 400.0}));

  // The third plane: from the first source to the west, azimuth 180.
  const PropagationCase west = on_plane(input, 2);
  ASSERT_TRUE(west.on_area.has_value());
  EXPECT_NEAR(std::remainder(west.on_area->bearing - radians(270.0), 2.0 * pi), 0.0, 1e-12);
  EXPECT_NEAR(west.box_range, 8000.0, 1e-6);
  // The second source is 1500 m east of the first, where the map has its [0, 0].
  EXPECT_EQ(on_plane(input, 5).on_area->place.x(), 1500.0);
  // y = 9 km is the second row of depths, x = 0 its second column: land
  EXPECT_EQ(map.area->bottom_depth(1000.0, 8750.0), -2.0);
  EXPECT_EQ(map.area->bottom_depth(1000.0, -9250.0), 200.5);
  EXPECT_EQ(map.area->bottom_depth(10000.0, 8750.0), 290.0);
  // x = 10, y = −10 km at 50 m
  EXPECT_NEAR(map.area->speed_at(11000.0, -10250.0, 50.0).c, 1491.0, 1e-9);
}

// Bearings are clockwise from north, azimuths counter-clockwise from east.
TEST(BellhopMap, PlanesGoWhereTheirAzimuthsPoint) {
  const Input input = read_case(island_case(23, "'CG   2'"), "case");
  for (std::size_t i = 0; i < 5; ++i) {
    const PropagationCase plane = on_plane(input, i);
    EXPECT_FALSE(plane.on_area.has_value());
    EXPECT_EQ(plane.dimension, 2);
    const double turn = radians(input.map->azimuths_deg[i]);
    for (const double r : {500.0, 2000.0, 7000.0})
      EXPECT_NEAR(std::max(plane.environment.bottom.depth_at(r), Area::film),
                  std::max(input.map->area->bottom_depth(r * std::cos(turn), r * std::sin(turn)),
                           Area::film),
                  1e-3)
          << i << ' ' << r;
  }
}

void expect_same(const Input& a, const Input& b) {
  ASSERT_EQ(a.map.has_value(), b.map.has_value());
  EXPECT_EQ(support::CaseComparison::difference(a.run_case, b.run_case), "");
  EXPECT_EQ(a.run_case.dimension, b.run_case.dimension);
  EXPECT_EQ(a.binary_arrivals, b.binary_arrivals);
  if (!a.map) return;
  EXPECT_EQ(a.map->source_x, b.map->source_x);
  EXPECT_EQ(a.map->source_y, b.map->source_y);
  EXPECT_EQ(a.map->azimuths_deg, b.map->azimuths_deg);
  EXPECT_EQ(a.map->fan, b.map->fan);
  EXPECT_EQ(a.map->lowest_azimuth_deg, b.map->lowest_azimuth_deg);
  EXPECT_EQ(a.map->highest_azimuth_deg, b.map->highest_azimuth_deg);
  EXPECT_EQ(a.map->box_x, b.map->box_x);
  EXPECT_EQ(a.map->box_y, b.map->box_y);
  EXPECT_TRUE(a.map->bathymetry == b.map->bathymetry);
  EXPECT_TRUE(a.map->altimetry == b.map->altimetry);
  EXPECT_TRUE(a.map->water == b.map->water);
}

TEST(BellhopMap, ACaseThatIsWrittenReadsBackAsTheSame) {
  Texts rough = island_case(4, "'CVWT~'");
  rough.env.replace(rough.env.find("'CG   3'"), 8, "'aB   2'");
  rough.companions.emplace_back(".ati", "'C'\n2\n-20 20\n3\n-20 20 /\n0 0.5\n0.25 0\n1 0\n");
  const std::string curved =
      "'CS'\n3\n-9.1 0.3 9\n4\n-9 9 /\n300 200.5 300\n310.25 120 290\n"
      "310 120 290\n1e2 1.5d2 200\n";
  for (const Texts& texts :
       {island_case(), island_case(23, "'I    3'"), island_case(23, "'Ab'"), island_case(26, "0"),
        island_case(0, "", curved), island_case(22, "-30 -29.9 0.1 47 333.3"),
        island_case(4, "'CRF'"), rough}) {
    const Input input = read_case(texts, "case");
    const Written written = write_map_case(input);
    SCOPED_TRACE(written.texts.env);
    expect_same(read_case(written.texts, "case"), input);
    EXPECT_EQ(write_map_case(read_case(written.texts, "case")).texts.env, written.texts.env);
  }
}

TEST(BellhopMap, AGridFileReadsBackAsTheSame) {
  GridFile grid{.curvilinear = true,
                .x = {-1234.5, 0.1, 1e5 / 3.0},
                .y = {0.0, 7.0},
                .values = {1.0, 2.0, 0.1, 1.0 / 3.0, 200.0, -3.25}};
  EXPECT_EQ(grid_file_text(grid).substr(0, 4), "'C'\n");
  Texts texts = island_case(12, "0 /\n", grid_file_text(grid));
  texts.env.replace(texts.env.find("2 ! source x"), 1, "1");
  texts.env.replace(texts.env.find("\n0.25 /"), 7, "\n0.003 /");
  EXPECT_TRUE(*read_case(texts, "case").map->bathymetry == grid);
}

TEST(BellhopMap, WhatIsWrongIsToldWithItsLine) {
  const auto bty = [](const std::string& text) { return complaint(island_case(0, "", text)); };
  const auto ssp = [](const std::string& text) {
    return complaint(island_case(0, "", island, text));
  };
  EXPECT_EQ(complaint(island_case()), "none");
  EXPECT_EQ(complaint(island_case(12, "-1 x /")),
            "case.env:12: source x: value 2: found \"x\", expected a number");
  EXPECT_EQ(complaint(island_case(21, "0 ! azimuths")),
            "case.env:21: number of receiver azimuths: found 0, expected a whole number from 1 to "
            "1000000");
  EXPECT_EQ(complaint(island_case(22, "0 1000 /")),
            "case.env:22: receiver azimuths: receiver azimuths: found 1000 degrees, expected a "
            "value from -720 to 720 degrees");
  EXPECT_EQ(complaint(island_case(23, "'RG   3'")),
            "case.env:23: run type: letter 6: found \"3\" in a run that draws rays, expected 2: "
            "rays are drawn in planes; arrivals (A, a) and fields (C, I) go in three dimensions");
  EXPECT_EQ(complaint(island_case(23, "'R'")),
            "case.env:23: run type: letter 1: found \"R\" in 10 planes, expected one source place "
            "and one azimuth: a .ray file holds one plane");
  EXPECT_EQ(complaint(island_case(23, "'SG   3'")),
            "case.env:23: run type: letter 1: found \"S\" in three dimensions, expected C or I, or "
            "letter 6 \"2\"");
  EXPECT_EQ(complaint(island_case(23, "'CC   3'")),
            "case.env:23: run type: letter 2: found \"C\", expected G, g, B or b: what BELLHOP3D "
            "has, over a map");
  EXPECT_EQ(complaint(island_case(23, "'CG X'")),
            "case.env:23: run type: letter 4: found \"X\", expected R, a point source: a line "
            "makes no sense over a map");
  EXPECT_EQ(complaint(island_case(27, "0 800 /")),
            "case.env:27: launch azimuths: azimuth: found 800 degrees, expected an azimuth from "
            "-720 to 720 degrees");
  EXPECT_EQ(complaint(island_case(28, "0 8 0 500")),
            "case.env:28: STEP XBOX YBOX ZBOX: box y: found 0 km, expected a range above 0 km");
  EXPECT_EQ(complaint(island_case(4, "'HVW  I'")),
            "case.env: top options: letter 6: found \"I\", a single beam, in a case over a map, "
            "expected a blank");

  EXPECT_EQ(bty("'L'\n"),
            "case.bty:1: type: letter 1: found \"L\", expected R (facets) or C (curvilinear): the "
            "case is over a map");
  EXPECT_EQ(bty("'RL'\n"),
            "case.bty:1: type: letter 2: found \"L\", expected a blank or S (depths alone): "
            "materials over a map are not read");
  EXPECT_EQ(bty("'R'\n1\n0\n"),
            "case.bty:2: number of x: found 1, expected a whole number from 2 to 100000");
  EXPECT_EQ(bty("'R'\n3\n0 2 1\n"),
            "case.bty:3: x: value 3: found 1 km, expected above the one before, 2 km");
  EXPECT_EQ(bty("'R'\n3\n0 2 2.00005\n"),
            "case.bty:3: x: value 3: found 2.00005 km, expected at least 0.1 m above the one "
            "before, 2 km");
  EXPECT_EQ(bty("'R'\n2\n-9 9\n2\n-9 9\n300 200\n300\n"),
            "case.bty:8: depths at y = 9 km: depth: found the end of the file, expected a number");
  EXPECT_EQ(bty("'R'\n2\n-9 9\n2\n-9 9\n300 200\n300 x\n"),
            "case.bty:7: depths at y = 9 km: depth: found \"x\", expected a number");
  EXPECT_EQ(bty("'R'\n2\n-9 9\n2\n-9 9\n300 200\n300 500\n"),
            "case.bty: depth at x = 9 km, y = 9 km: found 500 m, expected not below the profile, "
            "which ends at 400 m");
  EXPECT_EQ(bty(island + "1 2 3\n"),
            "case.bty:8: end: found \"1\", expected nothing after the last of 1 times 2 rows, one "
            "for each y");
  EXPECT_EQ(bty("'R'\n2\n0 9\n2\n-9 9\n300 200\n300 300\n"),
            "case.bty: found a grid that does not reach the source at x = -1 km, y = 0.25 km, "
            "expected one that goes from x = 0 to 9 km and y = -9 to 9 km to hold all sources: its "
            "edge is not drawn on for them");
  EXPECT_EQ(ssp("2\n-10 10\n2\n-10 10\n2\n0 400\n1500 1501\n1502 15\n"),
            "case.ssp:8: speeds at 0 m, y = 10 km: speed: found 15 m/s, expected a speed from "
            "200 to 10000 m/s");
  // Numbers that Fortran's READ would drop, and rows of the other axis, are not a row.
  EXPECT_EQ(bty("'R'\n2\n-9 0 9\n2\n-9 9\n300 200\n300 300\n"),
            "case.bty:3: x: found \"9\" after 2 numbers, expected as many as the line above says");
  EXPECT_EQ(
      bty("'R'\n2\n-9 9\n3\n-9 0 9\n300 200 100\n310 210 110\n"),
      "case.bty:6: depths at y = -9 km: found \"100\" after 2 numbers, expected a row for each "
      "of the 3 y, with a number for each of the 2 x");
  EXPECT_EQ(
      bty("'R'\n2\n-9 9\n2\n-9 9\n3*300\n300 200\n"),
      "case.bty:6: depths at y = -9 km: found \"300\" after 2 numbers, expected a row for each "
      "of the 2 y, with a number for each of the 2 x");
  EXPECT_EQ(bty("'R'\n4\n-9 9 /\n2\n-9 9\n300 310\n200 210\n100 110\n100 110\n"),
            "case.bty: found lines of 2 numbers, as many as y, expected a row for each of the 2 y, "
            "with a number for each of the 4 x");
  EXPECT_EQ(bty("'R'\n4\n-9 9 /\n2\n-9 9\n300 310 290 ! goes on\n"
                "200 \n 210 100 110 100 ! and ends\n"),
            "case.bty:6: depths at y = -9 km: depth: found \"!\", expected a number");
  EXPECT_EQ(bty("'R'\n4\n-9 9 /\n2\n-9 9\n300 310 290\n200 ! a row over two lines\n"
                "210 100 110 100 ! and on one\n"),
            "none");
  EXPECT_EQ(complaint(island_case(21, "1000000 ! azimuths")),
            "case.env:23: run type: found 2000000 places of sources and azimuths of receivers, "
            "expected at most 1000000, each with a plane of its own");
  Texts missing = island_case();
  missing.companions.pop_back();
  EXPECT_NE(complaint(missing).find("the file that \"H\" in case.env asks for"), std::string::npos)
      << complaint(missing);
}

bool says(const Texts& texts, const std::string& words) {
  const Input input = read_case(texts, "case");
  return std::any_of(input.notes.begin(), input.notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

// No document tells which way a grid stands: where it would fit the other way, too, a note says so.
TEST(BellhopMap, WhatIsChosenOfALayoutIsNoted) {
  const std::string words = "this grid would fit the other way, too";
  EXPECT_FALSE(says(island_case(), words));  // 3 by 2
  EXPECT_TRUE(says(island_case(0, "", "'R'\n2\n-9 9\n2\n-9 9\n300 310\n200 300\n"), words));
  EXPECT_FALSE(says(island_case(0, "", "'R'\n2\n-9 9\n2\n-9 9\n300 200\n200 300\n"), words));
  EXPECT_TRUE(says(island_case(), "case.ssp: a row of speeds is taken for one y of one depth"));
  EXPECT_TRUE(says(island_case(), "no document says which diagonal BELLHOP3D takes"));
}

TEST(BellhopMap, ASurfaceWithReliefGoesInPlanesOnly) {
  Texts texts = island_case(4, "'CVW ~'");
  texts.companions.emplace_back(".ati", "'R'\n2\n-20 20\n2\n-20 20\n0 1\n0 2\n");
  EXPECT_EQ(complaint(texts),
            "case.ati: found a surface with relief in a three-dimensional run, expected one depth "
            "everywhere, or run type letter 6 \"2\": rays in three dimensions know a flat surface "
            "only");
  texts.env.replace(texts.env.find("'CG   3'"), 8, "'CG   2'");
  const Input planes = read_case(texts, "case");
  // along x at y = 0.25 km of a cell from −20 to 20: the lower triangle
  const double s = 20.5 / 40.0, t = 20.25 / 40.0;
  EXPECT_NEAR(on_plane(planes, 5).environment.surface.depth_at(0.0), s * 1.0 + t * 1.0, 1e-4);
  texts.companions.back().second = "'R'\n2\n-20 20\n2\n-20 20\n3 3\n3 3\n";
  texts.env.replace(texts.env.find("'CG   2'"), 8, "'CG   3'");
  EXPECT_EQ(read_case(texts, "case").map->area->surface_depth(), 3.0);
}

TEST(BellhopMap, AVolumeOfWaterNeedsAMapAndASectionAPlane) {
  Texts plane;
  for (const char* line :
       {"'plane'", "100", "1", "'HVW'", "2 0 100", "0 1500 /", "100 1500 /", "'R' 0", "1", "10 /",
        "1", "10 /", "1", "1 /", "'C'", "0", "-10 10 /", "0 200 2"})
    plane.env += std::string(line) + '\n';
  EXPECT_EQ(complaint(plane),
            "case.env: top options: letter 1: found \"H\", a volume of water, in a case of one "
            "plane, expected \"Q\" for water that varies with range; or the six vectors of "
            "BELLHOP3D: source x, y and depths, receiver depths, ranges and azimuths");
  Texts map = island_case(4, "'QVW'", island, "2\n0 1\n1500 1500\n1500 1500\n1500 1500\n");
  EXPECT_EQ(complaint(map),
            "case.env: top options: letter 1: found \"Q\", water along one plane, in a case over a "
            "map, expected \"H\", over map and depth, or a profile");
  EXPECT_THROW(require_one_plane(read_case(island_case(), "case")), InputError);
}

TEST(BellhopMap, TheFanOfAzimuthsHasHalfASpacingMore) {
  MapInput map{.fan = 3, .lowest_azimuth_deg = -10.0, .highest_azimuth_deg = 30.0};
  EXPECT_TRUE(map.shines_at(-19.0));
  EXPECT_TRUE(map.shines_at(39.0 + 360.0));
  EXPECT_FALSE(map.shines_at(-21.0));
  EXPECT_FALSE(map.shines_at(180.0));
  map = {.fan = 36, .lowest_azimuth_deg = 0.0, .highest_azimuth_deg = 350.0};
  for (double azimuth = -400.0; azimuth < 400.0; azimuth += 7.0)
    EXPECT_TRUE(map.shines_at(azimuth)) << azimuth;
}

ShadeFile field_over_map(Dialect dialect, bool irregular) {
  ShadeFile file{
      .title = "BELLHOP- around",
      .irregular = irregular,
      .frequency = 512.5,
      .source_depths = {10, 20},
      .receiver_depths = {5, 6},
      .receiver_ranges = {100, 200},
      .dialect = dialect,
      .map = {.source_x = {-1000.0, 0.0, 250.5}, .source_y = {0.0, 7.0}, .azimuths_deg = {}}};
  for (int i = 0; i < 50; ++i) file.map.azimuths_deg.push_back(-30.0 + 7.5 * i);
  const std::size_t n = file.map.planes() * 2 * file.rows() * 2;
  for (std::size_t i = 0; i < n; ++i) file.pressure.emplace_back(float(i), -0.5F * float(i));
  return file;
}

TEST(BellhopMap, FieldsOfManyPlanesReadBack) {
  const support::TemporaryDirectory folder;
  for (const Dialect dialect : {Dialect::fortran, Dialect::wide})
    for (const bool irregular : {false, true}) {
      const ShadeFile file = field_over_map(dialect, irregular);
      const std::string bytes = shade_file_bytes(file);
      const ShadeFile read = parse_shade_file(bytes, "file");
      EXPECT_EQ(read.dialect, dialect);
      EXPECT_TRUE(read.map == file.map);
      EXPECT_TRUE(read.pressure == file.pressure);
      EXPECT_TRUE(shade_file_bytes(read) == bytes);
      // The record of the layout that is documented: l = 1, k = 1, j = 3, i = 0, h = 2.
      if (!irregular) {
        const std::size_t record = 11 + 1 + 2 * (1 + 2 * (3 + 50 * (0 + 2 * 2)));
        std::int32_t words = 0;
        std::memcpy(&words, bytes.data(), 4);
        std::complex<float> p;
        std::memcpy(static_cast<void*>(&p), bytes.data() + 4 * std::size_t(words) * (record - 1),
                    8);
        EXPECT_EQ(p, file.pressure[((((2 * 2 + 0) * 50 + 3) * 2 + 1) * 2 + 1) * 2]);
      }
      const std::filesystem::path there = folder / "field.h5";
      {
        Hdf5File hdf5 = Hdf5File::create(there);
        write_hdf5_result(hdf5, read);
        hdf5.close();
      }
      const auto back = std::get<ShadeFile>(read_result(there));
      EXPECT_TRUE(shade_file_bytes(back) == bytes);
      std::filesystem::remove(there);
    }
}

TEST(BellhopMap, FieldsOfOtherAzimuthsAreNotCompared) {
  const ShadeFile a = field_over_map(Dialect::fortran, false);
  EXPECT_EQ(compare::compare_fields(a, a).cells, a.pressure.size());
  ShadeFile b = a;
  b.map.azimuths_deg[3] += 1.0;
  EXPECT_THROW((void)compare::compare_fields(a, b), InputError);
  ShadeFile one = a;  // of a single plane against one without a map
  one.map = {.source_x = {500.0}, .source_y = {0.0}, .azimuths_deg = {45.0}};
  one.pressure.resize(one.source_depths.size() * one.rows() * one.receiver_ranges.size());
  ShadeFile plain = one;
  plain.map = {};
  EXPECT_EQ(compare::compare_fields(one, plain).cells, one.pressure.size());
  ShadeFile coarse = a;  // every other range of A
  coarse.receiver_ranges = {200};
  coarse.pressure.clear();
  for (std::size_t i = 1; i < a.pressure.size(); i += 2) coarse.pressure.push_back(a.pressure[i]);
  EXPECT_EQ(compare::align(a, coarse, true).a, coarse.pressure);
}

ArrivalsFile arrivals_over_map(bool binary, bool irregular, Dialect dialect) {
  ArrivalsFile file{
      .binary = binary,
      .frequency = 512.5,
      .source_depths = {10, 20},
      .receiver_depths = {5, 6},
      .receiver_ranges = {100, 200},
      .irregular = irregular,
      .dialect = dialect,
      .three_dimensional = true,
      .map = {.source_x = {0.0, 500.0}, .source_y = {-250.0}, .azimuths_deg = {0.0, 45.0, 350.0}}};
  const std::size_t n = 2 * 3 * 2 * file.rows() * 2;
  for (std::size_t i = 0; i < n; ++i)
    file.arrivals.emplace_back(i % 3, ArrivalRow{.amplitude = 0.25,
                                                 .phase_deg = 180,
                                                 .delay = 1.5,
                                                 .delay_imaginary = -0.0009765625,
                                                 .launch_angle_deg = 12.5,
                                                 .arrival_angle_deg = -13.75,
                                                 .surface_bounces = int(i),
                                                 .bottom_bounces = 3,
                                                 .launch_deflection_deg = 11.25,
                                                 .arrival_deflection_deg = -20.5});
  return file;
}

TEST(BellhopMap, ArrivalsWithAzimuthsReadBack) {
  const support::TemporaryDirectory folder;
  for (const bool binary : {false, true})
    for (const bool irregular : {false, true})
      for (const Dialect dialect : {Dialect::fortran, Dialect::wide}) {
        const ArrivalsFile file = arrivals_over_map(binary, irregular, dialect);
        const std::string bytes = arrivals_file_bytes(file);
        const ArrivalsFile read = parse_arrivals_file(bytes, "file");
        EXPECT_TRUE(read.three_dimensional);
        EXPECT_EQ(read.irregular, irregular);
        EXPECT_EQ(read.dialect, dialect);
        EXPECT_TRUE(read.map == file.map);
        ASSERT_EQ(read.arrivals.size(), file.arrivals.size());
        for (std::size_t i = 0; i < file.arrivals.size(); ++i) {
          ASSERT_EQ(read.arrivals[i].size(), file.arrivals[i].size());
          for (const ArrivalRow& row : read.arrivals[i]) {
            EXPECT_EQ(row.surface_bounces, int(i));
            EXPECT_EQ(row.launch_deflection_deg, 11.25);
            EXPECT_EQ(row.arrival_deflection_deg, -20.5);
          }
        }
        EXPECT_TRUE(arrivals_file_bytes(read) == bytes);
        const std::filesystem::path there = folder / "arrivals.h5", own = folder / "case.arr";
        {
          Hdf5File hdf5 = Hdf5File::create(there);
          write_hdf5_result(hdf5, read);
          hdf5.close();
        }
        EXPECT_TRUE(arrivals_file_bytes(std::get<ArrivalsFile>(read_result(there))) == bytes);
        write_arrivals_file(own, file);
        EXPECT_TRUE(own::arrivals_file(own));
        std::filesystem::remove(there);
        std::filesystem::remove(own);
        EXPECT_EQ(compare::compare_arrivals(read, file).matched_pct(), 100.0);
      }
}

// An azimuth of travel is the receiver's less the deflection, which is clockwise.
TEST(BellhopMap, AzimuthsOfArrivalsCountAsTheFilesDo) {
  ArrivalsFile file = arrivals_over_map(false, false, Dialect::wide);
  file.arrivals.assign(48, {});
  file.arrivals[8].push_back({.amplitude = 1.0, .launch_deflection_deg = 10.0});  // azimuth 45
  const std::string text = arrivals_file_bytes(file);
  EXPECT_NE(text.find("35.0000000"), std::string::npos) << text;
  EXPECT_NE(text.find("45.0000000"), std::string::npos);
}

TEST(BellhopMap, DamagedCountsOfAFileAskForNothing) {
  std::string bytes = shade_file_bytes(field_over_map(Dialect::fortran, false));
  std::int32_t words = 0;
  std::memcpy(&words, bytes.data(), 4);
  const std::size_t counts = 8 * std::size_t(words);
  for (const std::size_t i : {1, 2, 3}) {
    std::string damaged = bytes;
    const std::int32_t many = words + 1;  // one more than a record has room for
    std::memcpy(damaged.data() + counts + 4 * i, &many, 4);
    EXPECT_THROW((void)parse_shade_file(damaged, "file"), InputError) << i;
  }
  EXPECT_THROW((void)parse_arrivals_file(" '3D'\n 100\n 1 0\n 1 0\n 1 2\n 1 3\n 90000*1\n", "file"),
               InputError);
}

template <class Parse>
std::string file_complaint(Parse parse, const std::string& bytes) {
  try {
    (void)parse(bytes, "file");
    return "none";
  } catch (const InputError& error) {
    return error.what();
  }
}

// A file that is cut anywhere is refused; but of the last number of a text some digits may do.
TEST(BellhopMap, FilesThatAreCutAreRefused) {
  for (const bool binary : {false, true}) {
    const std::string bytes =
        arrivals_file_bytes(arrivals_over_map(binary, false, Dialect::fortran));
    for (std::size_t n = 0; n + 24 < bytes.size(); n += 1 + n / 20)
      EXPECT_NE(file_complaint(parse_arrivals_file, bytes.substr(0, n)), "none") << n;
  }
  const std::string bytes = shade_file_bytes(field_over_map(Dialect::fortran, false));
  for (std::size_t n = 0; n < bytes.size() - 400; n += 1 + n / 20)
    EXPECT_NE(file_complaint(parse_shade_file, bytes.substr(0, n)), "none") << n;
  for (std::size_t n = 0; n + 4 < island.size(); ++n)
    EXPECT_NE(complaint(island_case(0, "", island.substr(0, n))), "none") << n;
  for (std::size_t n = 0; n + 5 < water.size(); ++n)
    EXPECT_NE(complaint(island_case(0, "", island, water.substr(0, n))), "none") << n;
}

// Layouts of .arr that are not asdic's own are found by what cannot be.
TEST(BellhopMap, ArrivalsOfAnotherLayoutAreTold) {
  const std::string head = " '3D'\n 100\n 1 0\n 1 0\n 1 10\n 1 20\n 1 500\n 1 270\n";
  EXPECT_EQ(file_complaint(parse_arrivals_file, head + " 1\n 1\n 0.1 0 1.5 0 10 270 -10 270 0 0\n"),
            "none");
  EXPECT_EQ(file_complaint(parse_arrivals_file, head + " 1\n 1\n 0.1 0 1.5 0 270 10 270 -10 0 0\n"),
            "file:11: launch angle: found 270 degrees, expected a declination from -180 to 180 "
            "degrees");
  EXPECT_EQ(file_complaint(parse_arrivals_file, head + " 1\n 2\n"),
            "file:10: number of arrivals: found 2, expected at most 1, the largest number that "
            "stands before its source's receivers");
}

// A case becomes a scenario with its maps in a netCDF file: what that is read as runs to the same
// numbers as the case's first plane.
TEST(BellhopMap, ACaseBecomesAScenarioWithItsMaps) {
  const support::TemporaryDirectory folder;
  for (const auto& [run, profile] :
       {std::pair{"'AG   2'", "'HVW'"}, {"'AG   2'", "'CVW'"}, {"'AG   3'", "'CVW'"}}) {
    Texts texts = island_case(23, run, "'R'\n3\n-9 9 /\n2\n-9 9\n300 200.5 300\n310 120 290\n",
                              "2\n-10 10\n2\n-10 10\n2\n0 400\n1500 1500\n1500 1500\n1500 "
                              "1500\n1500 1500\n");
    texts.env.replace(texts.env.find("'HVW'"), 5, profile);
    texts.env.replace(texts.env.find("50 1490"), 7, "50 1500");
    texts.env.replace(texts.env.find("400 1510"), 8, "400 1500");
    texts.env.replace(texts.env.find("5 ! azimuths\n0 360 /"), 20, "1\n30 /");
    texts.env.replace(texts.env.find("-40 40"), 6, "-10 10");
    texts.env.replace(texts.env.find("3\n0 2 /"), 7, "1\n1 /");
    const Input input = read_case(texts, "case");
    const MapScenario made = map_scenario(input, (folder / "maps.nc").string());
    ASSERT_TRUE(made.maps);
    ASSERT_EQ(made.notes.size(), 1u);  // two places of the source
    std::filesystem::remove(folder / "maps.nc");
    write_maps(OutputFile(folder / "maps.nc", {}), input);
    std::vector<std::string> notes;
    const PropagationCase read =
        parse_propagation_case(to_toml(made.run_case), folder / "case.toml", {}, notes);
    SCOPED_TRACE(to_toml(made.run_case));
    EXPECT_EQ(read.dimension, input.run_case.dimension);
    EXPECT_EQ(read.environment.spreading, input.run_case.environment.spreading);
    const PropagationResult there = asdic::detail::run(read),
                            here = asdic::detail::run(input.run_case);
    ASSERT_EQ(there.arrivals.size(), here.arrivals.size());
    std::size_t compared = 0;
    for (std::size_t i = 0; i < here.arrivals.size(); ++i) {
      ASSERT_EQ(there.arrivals[i].size(), here.arrivals[i].size()) << i;
      for (std::size_t k = 0; k < here.arrivals[i].size(); ++k, ++compared) {
        EXPECT_NEAR(there.arrivals[i][k].delay, here.arrivals[i][k].delay, 1e-7);
        EXPECT_NEAR(std::abs(there.arrivals[i][k].amplitude),
                    std::abs(here.arrivals[i][k].amplitude),
                    1e-3 * std::abs(here.arrivals[i][k].amplitude));
      }
    }
    EXPECT_GT(compared, 3u);
  }
  Texts waves = island_case(23, "'CG   2'");
  waves.env.replace(waves.env.find("'HVW'"), 5, "'CVW ~'");
  waves.companions.emplace_back(".ati", "'R'\n2\n-20 20\n2\n-20 20\n0 1\n0 2\n");
  EXPECT_THROW((void)map_scenario(read_case(waves, "case"), "maps.nc"), InputError);
}

}  // namespace
}  // namespace asdic::detail::bellhop
