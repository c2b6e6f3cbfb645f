// Cases of BELLHOP3D, from their files to their files, against closed forms and the plane's solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/units.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/grid_file.h"
#include "io/bellhop/map_run.h"
#include "io/bellhop/results.h"
#include "support/deep.h"

namespace asdic::detail::bellhop {
namespace {

/// The statements of a case that differ between the tests.
struct MapCase {
  std::string profile, bottom;  // lines, without the last line end
  std::string source_x = "1\n0 /", source_y = "1\n0 /", source_depth, depths, ranges, azimuths;
  std::string run, fan = "0\n-90 90 /", around = "37\n0 360 /", box = "0 100 100 10000";
  Texts texts{};

  [[nodiscard]] Input read() const {
    Texts all = texts;
    all.env = "'validation'\n200\n1\n" + profile + '\n' + bottom + '\n' + source_x + '\n' +
              source_y + '\n' + source_depth + '\n' + depths + '\n' + ranges + '\n' + azimuths +
              "\n'" + run + "'\n" + fan + '\n' + around + '\n' + box + '\n';
    return read_case(all, "case");
  }
};

ShadeFile field_of(const Input& input) {
  return parse_shade_file(
      shade_file_bytes(shade_file(input, run_all_planes(input, false), Dialect::wide)), "case.shd");
}

ArrivalsFile arrivals_of(const Input& input) {
  return parse_arrivals_file(
      arrivals_file_bytes(arrivals_file(input, run_all_planes(input, false), Dialect::wide)),
      "case.arr");
}

// Free space: half spaces of water above and below reflect nothing, so that the pressure is 1/R
// wherever the receiver is, and the file's is −e^{−ikR}/R. In planes and in three dimensions, in
// water that is the same everywhere and in the same given as a volume.
TEST(Bellhop3d, FreeSpaceSpreadsSpherically) {
  for (const char* run : {"CG   2", "CG   3"})
    for (const bool volume : {false, true}) {
      MapCase free{.profile = std::string(volume ? "'HAW'" : "'CAW'") +
                              "\n0 1500 0 1 /\n2 0 2000\n0 1500 0 1 /\n2000 1500 /",
                   .bottom = "'A' 0\n2000 1500 0 1 /",
                   .source_x = "2\n-1 2 /",
                   .source_depth = "1\n900 /",
                   .depths = "2\n500 1500 /",
                   .ranges = "2\n0.5 3.5 /",
                   .azimuths = "3\n0 300 /",
                   .run = run};
      if (volume)
        free.texts.companions = {
            {".ssp", "2\n-9 9\n2\n-9 9\n2\n0 2000\n1500 1500\n1500 1500\n1500 1500\n1500 1500\n"}};
      const Input input = free.read();
      EXPECT_EQ(input.map->area != nullptr, volume);
      const ShadeFile field = field_of(input);
      ASSERT_EQ(field.map.planes(), 6u);
      ASSERT_EQ(field.pressure.size(), 6u * 4);
      const double k = 2.0 * pi * 200.0 / 1500.0;
      std::size_t i = 0;
      for (std::size_t plane = 0; plane < 6; ++plane)
        for (const double zs : field.source_depths)
          for (const double z : field.receiver_depths)
            for (const double r : field.receiver_ranges) {
              const double distance = std::hypot(r, z - zs);
              const std::complex<double> truth = -std::polar(1.0 / distance, -k * distance);
              EXPECT_LT(std::abs(std::complex<double>(field.pressure[i]) - truth),
                        2e-5 / distance)  // single precision, and 2 µm of a ray's end
                  << run << (volume ? " volume" : "") << " plane " << plane << ", " << r << " m, "
                  << z << " m";
              ++i;
            }
    }
}

/// A path of a wedge between the surface and a plane floor that sinks along x from the line x = 0:
/// that of an image, at the angle 2jα ± θ about the line.
struct Image {
  double delay, level_db, declination_deg, azimuth_deg, arrival_declination_deg,
      arrival_azimuth_deg;
  int surface, bottom;
};

std::vector<Image> images(int n, const Vec3& s, const Vec3& r, double c) {
  const double wedge = pi / n;
  const double ds = std::hypot(s.x(), s.z()), as = std::atan2(s.z(), s.x());
  const double dr = std::hypot(r.x(), r.z()), ar = std::atan2(r.z(), r.x());
  std::vector<Image> all;
  for (int j = -n; j <= n; ++j)
    for (const double sign : {1.0, -1.0}) {
      const double angle = 2.0 * j * wedge + sign * ar;
      if (!(std::abs(angle - as) < pi)) continue;
      Image image{};
      const int low = int(std::floor(std::min(angle, as) / wedge)),
                high = int(std::floor(std::max(angle, as) / wedge));
      for (int k = low + 1; k <= high; ++k) ++(k % 2 == 0 ? image.surface : image.bottom);
      const double out = dr * std::cos(angle) - ds * std::cos(as),
                   down = dr * std::sin(angle) - ds * std::sin(as), along = r.y() - s.y();
      const double length = std::sqrt(out * out + down * down + along * along);
      image.delay = length / c;
      image.level_db = -20.0 * std::log10(length);
      image.declination_deg = degrees(std::asin(down / length));
      image.azimuth_deg = degrees(std::atan2(along, out));
      // where it arrives the copy is turned by its angle, and mirrored where the sign is −
      const double turn = 2.0 * j * wedge;
      const double back_out = out * std::cos(turn) + down * std::sin(turn);
      const double back_down = sign * (down * std::cos(turn) - out * std::sin(turn));
      image.arrival_azimuth_deg = degrees(std::atan2(along, back_out));
      image.arrival_declination_deg = degrees(std::asin(back_down / length));
      all.push_back(image);
    }
  return all;
}

/// A floor that sinks along x with a slope, on a grid.
GridFile sinking(double slope, std::vector<double> x, std::vector<double> y, bool curvilinear) {
  GridFile floor{.curvilinear = curvilinear, .x = std::move(x), .y = std::move(y)};
  for (std::size_t j = 0; j < floor.y.size(); ++j)
    for (const double place : floor.x) floor.values.push_back(slope * place);
  return floor;
}

constexpr int wedge_of = 8;  // an angle of π/8, 22.5°

MapCase wedge_case(const GridFile& floor) {
  MapCase wedge{.profile = "'CVW'\n2 0 90000\n0 1500 /\n90000 1500 /",
                .bottom = "'R~' 0",
                .source_x = "1\n2 /",
                .source_y = "1\n0.25 /",
                .source_depth = "1\n300 /",
                .depths = "1\n200 /",
                .ranges = "2\n0.8 3 /",
                .azimuths = "3\n-80 35 100",
                .run = "AG   3"};
  wedge.texts.companions = {{".bty", grid_file_text(floor)}};
  return wedge;
}

/// Every image is an eigenray, with its angles at both ends as the .arr has them, and there is
/// nothing else.
void expect_every_image(const ArrivalsFile& file) {
  const std::size_t ranges = file.receiver_ranges.size();
  ASSERT_EQ(file.arrivals.size(), file.map.azimuths_deg.size() * ranges);
  for (std::size_t i = 0; i < file.arrivals.size(); ++i) {
    const double there = file.map.azimuths_deg[i / ranges],
                 range = file.receiver_ranges[i % ranges];
    const Vec3 s(2000.0, 250.0, 300.0), r(2000.0 + range * std::cos(radians(there)),
                                          250.0 + range * std::sin(radians(there)), 200.0);
    const std::vector<Image> truth = images(wedge_of, s, r, 1500.0);
    EXPECT_EQ(file.arrivals[i].size(), truth.size()) << i;
    for (const Image& image : truth) {
      const auto path = std::find_if(
          file.arrivals[i].begin(), file.arrivals[i].end(), [&](const ArrivalRow& row) {
            return row.surface_bounces == image.surface && row.bottom_bounces == image.bottom &&
                   std::abs(row.delay - image.delay) < 1e-6 &&
                   std::abs(row.launch_angle_deg - image.declination_deg) < 0.01;
          });
      if (path == file.arrivals[i].end()) {
        ADD_FAILURE() << "receiver " << i << ": no path of " << image.delay << " s, "
                      << image.surface << '+' << image.bottom;
        continue;
      }
      EXPECT_NEAR(20.0 * std::log10(path->amplitude), image.level_db, 0.05);
      const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 360.0)); };
      EXPECT_LT(apart(there - path->launch_deflection_deg, image.azimuth_deg), 0.01);
      EXPECT_LT(apart(there - path->arrival_deflection_deg, image.arrival_azimuth_deg), 0.01);
      EXPECT_NEAR(path->arrival_angle_deg, image.arrival_declination_deg, 0.01);
      EXPECT_NEAR(std::remainder(path->phase_deg - 180.0 * image.surface, 360.0), 0.0, 1e-3);
    }
  }
}

// The guide's perfect wedge. Azimuths tell whether x, y and their sense are right. All that is
// reached lies on one facet here: parted ones of one plane are the deep test's.
TEST(Bellhop3d, ThePerfectWedgeHasEveryImage) {
  MapCase wedge = wedge_case(
      sinking(std::tan(pi / wedge_of), {-2000.0, 150000.0}, {-200000.0, 50000.0}, false));
  if (!support::deep()) wedge.azimuths = "1\n35 /";
  if (!support::deep()) wedge.ranges = "1\n3 /";
  expect_every_image(arrivals_of(wedge.read()));
}

TEST(Bellhop3d, ThePerfectWedgeOfManyFacetsHasEveryImage) {
  if (!support::deep()) GTEST_SKIP() << "with ASDIC_DEEP=1";
  MapCase wedge = wedge_case(sinking(std::tan(pi / wedge_of),
                                     {-2000.0, -1000.0, 0.0, 1000.0, 2500.0, 4000.0, 6000.0},
                                     {-6000.0, -1000.0, 500.0, 3000.0, 9000.0}, false));
  wedge.azimuths = "1\n35 /";  // 20 s of processor time a receiver
  wedge.ranges = "1\n3 /";
  expect_every_image(arrivals_of(wedge.read()));
}

// Beams are launched between two azimuths: paths outside of them are not there.
TEST(Bellhop3d, TheFanOfAzimuthsCutsPathsOff) {
  MapCase wedge = wedge_case(
      sinking(std::tan(pi / wedge_of), {-2000.0, 150000.0}, {-200000.0, 50000.0}, false));
  wedge.source_y = "1\n0 /";
  wedge.ranges = "1\n2 /";
  wedge.azimuths = "1\n80 /";
  wedge.around = "0\n60 100 /";
  const Vec3 r(2000.0 + 2000.0 * std::cos(radians(80.0)), 2000.0 * std::sin(radians(80.0)), 200.0);
  std::size_t within = 0;
  for (const Image& image : images(wedge_of, {2000.0, 0.0, 300.0}, r, 1500.0))
    within += image.azimuth_deg > 60.0 && image.azimuth_deg < 100.0 ? 1 : 0;
  EXPECT_GT(within, 1u);
  EXPECT_LT(within, 16u);
  EXPECT_EQ(arrivals_of(wedge.read()).arrivals[0].size(), within);
}

/// A case of one plane beside it, with the same sea.
Input plane_case(const std::string& profile, const std::string& bottom, const MapCase& map,
                 const std::string& letters,
                 std::vector<std::pair<std::string, std::string>> files) {
  Texts texts;
  texts.env = "'validation'\n200\n1\n" + profile + '\n' + bottom + '\n' + map.source_depth + '\n' +
              map.depths + '\n' + map.ranges + "\n'" + letters + "'\n" + map.fan +
              "\n0 10000 100\n";
  texts.companions = std::move(files);
  return read_case(texts, "plane");
}

// Where the sea is the same everywhere every azimuth has the numbers of the case of one plane.
TEST(Bellhop3d, ALevelSeaIsThePlanesOnEveryAzimuth) {
  const std::string profile = "'SVW'\n4 0 200\n0 1520 /\n50 1500 /\n120 1490 /\n200 1495 /",
                    material = "\n200 1650 0 1.8 0.5 /";
  for (const char* letter : {"C", "I"})
    for (const char* dimension : {"2", "3"}) {
      MapCase level{.profile = profile,
                    .bottom = "'A~' 0" + material,
                    .source_depth = "1\n40 /",
                    .depths = "5\n10 190 /",
                    .ranges = "6\n0.5 3 /",
                    .azimuths = "3\n0 359 /",
                    .run = std::string(letter) + "G   " + dimension,
                    .fan = "60\n-60 60 /"};
      level.texts.companions = {{".bty", "'R'\n2\n-9 9\n2\n-9 9\n200 200\n200 200\n"}};
      const ShadeFile around = field_of(level.read());
      const Input plane =
          plane_case(profile, "'A' 0" + material, level, std::string(letter) + "G", {});
      const ShadeFile one = field_of(plane);
      ASSERT_EQ(around.pressure.size(), 3 * one.pressure.size());
      for (std::size_t i = 0; i < around.pressure.size(); ++i)
        EXPECT_EQ(around.pressure[i], one.pressure[i % one.pressure.size()]);
    }
}

// The same where the sea is level but a map all the same: speeds that grow evenly with depth, as a
// volume, which is not known to be alike everywhere. Every azimuth has the paths of the plane.
TEST(Bellhop3d, ALevelVolumeIsThePlaneOnEveryAzimuth) {
  const std::string rows = "\n2 0 200\n0 1490 /\n200 1500 /", material = "\n200 1650 0 1.8 0.5 /";
  MapCase level{.profile = "'HVW'" + rows,
                .bottom = "'A' 0" + material,
                .source_x = "1\n1 /",
                .source_y = "1\n-2 /",
                .source_depth = "1\n40 /",
                .depths = "1\n120 /",
                .ranges = "1\n1.5 /",
                .azimuths = "3\n-20 77 200",
                .fan = "0\n-35 35 /"};
  level.texts.companions = {
      {".ssp", "2\n-9 9\n2\n-9 9\n2\n0 200\n1490 1490\n1490 1490\n1500 1500\n1500 1500\n"}};
  const ArrivalsFile one = arrivals_of(plane_case("'CVW'" + rows, level.bottom, level, "AG", {}));
  ASSERT_GT(one.arrivals[0].size(), 4u);
  for (const char* run : {"AG   2", "AG   3"}) {
    level.run = run;
    const ArrivalsFile around = arrivals_of(level.read());
    for (std::size_t a = 0; a < 3; ++a)
      for (const ArrivalRow& row : one.arrivals[0]) {
        const auto same = std::find_if(
            around.arrivals[a].begin(), around.arrivals[a].end(), [&](const ArrivalRow& other) {
              return other.surface_bounces == row.surface_bounces &&
                     other.bottom_bounces == row.bottom_bounces &&
                     std::abs(other.launch_angle_deg - row.launch_angle_deg) < 0.01;
            });
        if (same == around.arrivals[a].end()) {
          ADD_FAILURE() << run << ": no path of " << row.delay << " s";
          continue;
        }
        EXPECT_NEAR(same->delay, row.delay, 1e-6);
        EXPECT_NEAR(20.0 * std::log10(same->amplitude / row.amplitude), 0.0, 0.01);
        EXPECT_NEAR(same->launch_deflection_deg, 0.0, 1e-3);
      }
  }
}

// The guide's seamount in planes: the floor along an azimuth is known by hand where the azimuth
// follows the lines of the grid or the diagonals of its cells, those that part them and the others.
TEST(Bellhop3d, ASeamountInPlanesIsTheSectionThroughItsFacets) {
  constexpr double step = 500.0;
  GridFile floor;
  for (int i = -16; i <= 16; ++i) floor.x.push_back(step * i);
  floor.y = floor.x;
  const auto depth = [](double x, double y) {
    return std::min(1500.0, 400.0 + 0.2 * std::hypot(x - 200.0, y - 900.0));
  };
  for (const double y : floor.y)
    for (const double x : floor.x) floor.values.push_back(double(float(depth(x, y))));
  const auto node = [&](double x, double y) { return double(float(depth(x, y))); };
  MapCase mount{.profile = "'CVW'\n3 0 1500\n0 1520 /\n300 1480 /\n1500 1500 /",
                .bottom = "'A~' 0\n1500 1700 0 1.9 0.4 /",
                .source_x = "1\n-4 /",
                .source_y = "1\n1 /",
                .source_depth = "1\n100 /",
                .depths = "3\n50 350 /",
                .ranges = "5\n1 7 /",
                .azimuths = "3\n-45 0 45",
                .run = "IB   2",
                .fan = "400\n-80 80 /"};
  mount.texts.companions = {{".bty", grid_file_text(floor)}};
  const ShadeFile around = field_of(mount.read());
  const std::size_t n = around.pressure.size() / 3;
  EXPECT_LT(node(0.0, 1000.0), 460.0);  // on the way
  for (std::size_t a = 0; a < 3; ++a) {
    std::string bty;
    int nodes = 0;
    for (int i = -2; i <= 32; ++i) {         // half steps, where the other diagonal is crossed
      const double stride = 0.5 * step * i;  // along x
      const double turn = radians(around.map.azimuths_deg[a]);
      const double range = stride / std::cos(turn);
      const double x = -4000.0 + stride, y = 1000.0 + std::round(std::tan(turn)) * stride;
      if (around.map.azimuths_deg[a] >= 0.0 && i % 2 != 0) continue;
      // the other diagonal crosses that which parts the cell in its middle
      const double z =
          i % 2 == 0
              ? node(x, y)
              : 0.5 * (node(x - 0.5 * step, y - 0.5 * step) + node(x + 0.5 * step, y + 0.5 * step));
      char line[80];
      std::snprintf(line, sizeof line, "%.17g %.17g\n", range / 1000.0, z);
      bty += line;
      ++nodes;
    }
    const Input plane = plane_case(mount.profile, mount.bottom, mount, "IB",
                                   {{".bty", "'L'\n" + std::to_string(nodes) + '\n' + bty}});
    const ShadeFile one = field_of(plane);
    for (std::size_t i = 0; i < n; ++i) {
      // Depths of nodes differ by rounding, which grows with every bounce.
      const double there = std::abs(around.pressure[a * n + i]), here = std::abs(one.pressure[i]);
      if (here < 1e-6) continue;
      EXPECT_NEAR(20.0 * std::log10(there / here), 0.0, 0.01)
          << around.map.azimuths_deg[a] << " degrees, " << i;
    }
  }
}

// An eddy's place: a field of speeds that is linear in x and z, which a volume of profile H and a
// section of profile Q both hold exactly, along x and against it.
TEST(Bellhop3d, ASlopingFieldOfSpeedsIsTheSectionsAlongIt) {
  const auto speed = [](double x, double z) { return 1500.0 + 2e-4 * x + 0.02 * z; };
  const std::vector<double> levels = {0.0, 100.0, 250.0, 400.0};
  GridFile water{
      .x = {-10000.0, -3000.0, 2000.0, 10000.0}, .y = {-10000.0, 0.0, 10000.0}, .z = levels};
  for (const double z : levels)
    for (std::size_t j = 0; j < 3; ++j)
      for (const double x : water.x) water.values.push_back(speed(x, z));
  const std::string rows = "\n4 0 400\n0 1500 /\n100 1500 /\n250 1500 /\n400 1500 /";
  MapCase eddy{.profile = "'HVW'" + rows,
               .bottom = "'R' 0",
               .source_x = "1\n1 /",
               .source_depth = "1\n80 /",
               .depths = "2\n30 300 /",
               .ranges = "2\n2 5 /",
               .azimuths = "2\n0 180 /",
               .run = "AG   2",
               .fan = "0\n-35 35 /"};
  eddy.texts.companions = {{".ssp", grid_file_text(water)}};
  const ArrivalsFile around = arrivals_of(eddy.read());
  for (const int a : {0, 1}) {
    const double sign = a == 0 ? 1.0 : -1.0;
    std::string ssp = "2\n0 8\n";
    for (const double z : levels) {
      char line[80];
      std::snprintf(line, sizeof line, "%.17g %.17g\n", speed(1000.0, z),
                    speed(1000.0 + sign * 8000.0, z));
      ssp += line;
    }
    const ArrivalsFile one =
        arrivals_of(plane_case("'QVW'" + rows, eddy.bottom, eddy, "AG", {{".ssp", ssp}}));
    for (std::size_t i = 0; i < one.arrivals.size(); ++i) {
      const auto& there = around.arrivals[std::size_t(a) * one.arrivals.size() + i];
      ASSERT_EQ(there.size(), one.arrivals[i].size()) << a << ' ' << i;
      for (std::size_t k = 0; k < there.size(); ++k) {
        EXPECT_EQ(there[k].surface_bounces, one.arrivals[i][k].surface_bounces);
        // speeds in single precision, 6e-5 m/s: 0.2 µs in 5 km
        EXPECT_NEAR(there[k].delay, one.arrivals[i][k].delay, 1e-6);
        EXPECT_NEAR(20.0 * std::log10(there[k].amplitude / one.arrivals[i][k].amplitude), 0.0,
                    0.01);
      }
    }
  }
}

// Up the slope sound stays in its plane: three dimensions have its delays and angles, too. Water of
// one speed, where the search is quick.
TEST(Bellhop3d, StraightUpTheSlopePlanesAndVolumeAgree) {
  GridFile floor = sinking(0.03, {-8000.0, 8000.0}, {-9000.0, 80000.0}, false);
  for (double& depth : floor.values) depth += 300.0;
  MapCase slope{.profile = "'CVW'\n2 0 600\n0 1500 /\n600 1500 /",
                .bottom = "'A~' 0\n600 1700 0 1.9 0.4 /",
                .source_depth = "1\n80 /",
                .depths = "1\n60 /",
                .ranges = "1\n2 /",
                .azimuths = "1\n180 /",
                .run = "AG   2",
                .fan = "0\n-25 25 /"};
  slope.texts.companions = {{".bty", grid_file_text(floor)}};
  const ArrivalsFile planes = arrivals_of(slope.read());
  slope.run = "AG   3";
  const ArrivalsFile volume = arrivals_of(slope.read());
  int matched = 0;
  for (const ArrivalRow& row : planes.arrivals[0])
    for (const ArrivalRow& other : volume.arrivals[0])
      if (row.surface_bounces == other.surface_bounces &&
          row.bottom_bounces == other.bottom_bounces &&
          std::abs(row.launch_angle_deg - other.launch_angle_deg) < 0.01) {
        EXPECT_NEAR(row.delay, other.delay, 1e-6);
        EXPECT_NEAR(row.arrival_angle_deg, other.arrival_angle_deg, 0.01);
        EXPECT_NEAR(other.launch_deflection_deg, 0.0, 1e-3);
        ++matched;
      }
  EXPECT_EQ(matched, int(planes.arrivals[0].size()));
  EXPECT_GT(matched, 3);
}

}  // namespace
}  // namespace asdic::detail::bellhop
