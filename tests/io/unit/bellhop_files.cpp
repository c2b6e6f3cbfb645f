#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/units.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/fortran_format.h"
#include "io/bellhop/results.h"
#include "io/files/input_file.h"

// BELLHOP's output files: read and written again they are the same bytes; what is wrong with one is
// told with its place; our results become its numbers.

namespace asdic::detail::bellhop {
namespace {

const std::filesystem::path data = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop";

std::string again(const std::string& extension, std::string_view bytes) {
  if (extension == ".shd") return shade_file_bytes(parse_shade_file(bytes, "file"));
  if (extension == ".arr") return arrivals_file_bytes(parse_arrivals_file(bytes, "file"));
  return ray_file_bytes(parse_ray_file(bytes, "file"));
}

// The default outputs are BELLHOP's bytes.
TEST(BellhopFiles, ReadAndWrittenAgainAreTheSameBytes) {
  int files = 0;
  for (const auto& folder : std::filesystem::directory_iterator(data))
    for (const char* extension : {".shd", ".arr", ".ray"}) {
      const auto path = folder.path() / (std::string("case") + extension);
      if (!std::filesystem::exists(path)) continue;
      const std::string bytes = read_input(path, "");
      EXPECT_TRUE(again(extension, bytes) == bytes) << path;
      ++files;
    }
  EXPECT_EQ(files, 16);
}

// A run of the same problem with a small step has the same shape of output.
TEST(BellhopFiles, ConvergedOutputsAreRead) {
  const RayFile rays = read_ray_file(data / "rays-upslope/converged/case.ray");
  EXPECT_EQ(rays.title, "BELLHOP- ray paths over a slope");
  EXPECT_EQ(rays.rays.size(), 21U);
  EXPECT_EQ(rays.rays.front().launch_angle_deg, -40.0);
  const ArrivalsFile arrivals = read_arrivals_file(data / "elastic-arrivals/converged/case.arr");
  EXPECT_EQ(arrivals.arrivals.size(), 63U);
  EXPECT_EQ(arrivals.frequency, 6000.0);
  EXPECT_EQ(arrivals.dialect, Dialect::fortran);
  EXPECT_FALSE(arrivals.irregular);
}

TEST(BellhopFiles, NumbersAreAsGfortranPrintsThem) {
  std::string text;
  for (const float x : {0.0F, 1.0F, -0.5F, 0.1F, 123456789.0F, 1e9F, 2.65924237e-3F, -1e-38F}) {
    append_real4(text, x);
    text += '|';
  }
  EXPECT_EQ(text,
            "   0.00000000    |   1.00000000    | -0.500000000    |  0.100000001    |"
            "   123456792.    |   1.00000000E+09|   2.65924237E-03|  -9.99999935E-39|");
  text.clear();
  for (const double x : {0.0, 6000.0, -40.0, 0.25, 1e17, -1.5e-100}) {
    append_real8(text, x);
    text += '|';
  }
  EXPECT_EQ(text,
            "   0.0000000000000000     |   6000.0000000000000     |  -40.000000000000000     |"
            "  0.25000000000000000     |   1.0000000000000000E+017|  -1.5000000000000000E-100|");
  text.clear();
  append_integer(text, 21);
  append_integer(text, -7);
  EXPECT_EQ(text, "          21          -7");
}

ShadeFile small_field(Dialect dialect, bool irregular) {
  ShadeFile file{.title = "BELLHOP- x",
                 .irregular = irregular,
                 .frequency = 100.1,
                 .source_depths = {10, 20},
                 .receiver_depths = {5, 6, 7},
                 .receiver_ranges = {100, 200.5, 300},
                 .dialect = dialect};
  for (std::size_t i = 0; i < 6 * file.rows(); ++i)
    file.pressure.emplace_back(float(i), -0.5F * float(i));
  return file;
}

TEST(BellhopFiles, BothDialectsAndBothGridsOfFields) {
  for (const Dialect dialect : {Dialect::fortran, Dialect::wide})
    for (const bool irregular : {false, true}) {
      const ShadeFile file = small_field(dialect, irregular);
      const ShadeFile read = parse_shade_file(shade_file_bytes(file), "file");
      EXPECT_EQ(read.dialect, dialect);
      EXPECT_EQ(read.irregular, irregular);
      EXPECT_EQ(read.title, file.title);
      EXPECT_EQ(read.frequency, file.frequency);
      EXPECT_EQ(read.receiver_ranges, file.receiver_ranges);
      EXPECT_EQ(read.pressure, file.pressure);
    }
}

// The last record of a run may end where only zeros would follow.
TEST(BellhopFiles, AFieldMayEndWithinItsLastRow) {
  const std::string bytes = shade_file_bytes(small_field(Dialect::fortran, false));
  const ShadeFile cut = parse_shade_file(bytes.substr(0, bytes.size() - 148), "file");
  EXPECT_EQ(cut.pressure[16], std::complex<float>(16.0F, -8.0F));
  EXPECT_EQ(cut.pressure[17], std::complex<float>(0.0F, 0.0F));
}

ArrivalsFile small_arrivals(bool binary, bool irregular, Dialect dialect) {
  ArrivalsFile file{.binary = binary,
                    .frequency = 512.5,
                    .source_depths = {10},
                    .receiver_depths = {5, 6},
                    .receiver_ranges = {100, 200},
                    .irregular = irregular,
                    .dialect = dialect};
  const std::size_t receivers = irregular ? 2 : 4;
  for (std::size_t i = 0; i < receivers; ++i)
    file.arrivals.emplace_back(i,
                               ArrivalRow{0.25, 180, 1.5, -0.0009765625, 12.5, -13.75, int(i), 3});
  return file;
}

TEST(BellhopFiles, AllKindsOfArrivals) {
  for (const bool binary : {false, true})
    for (const bool irregular : {false, true})
      for (const Dialect dialect : {Dialect::fortran, Dialect::wide}) {
        const ArrivalsFile file = small_arrivals(binary, irregular, dialect);
        const std::string bytes = arrivals_file_bytes(file);
        const ArrivalsFile read = parse_arrivals_file(bytes, "file");
        EXPECT_EQ(read.binary, binary);
        EXPECT_EQ(read.irregular, irregular);
        EXPECT_EQ(read.dialect, dialect);
        EXPECT_EQ(read.arrivals.size(), file.arrivals.size());
        EXPECT_EQ(read.arrivals.back().back().delay_imaginary, -0.0009765625);
        EXPECT_EQ(read.arrivals.back().back().surface_bounces, int(file.arrivals.size()) - 1);
        EXPECT_TRUE(arrivals_file_bytes(read) == bytes);
      }
}

template <class Parse>
std::string complaint(Parse parse, const std::string& bytes) {
  try {
    (void)parse(bytes, "file");
    return "none";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(BellhopFiles, MalformedFieldsAreTold) {
  const std::string good = shade_file_bytes(small_field(Dialect::fortran, false));
  const auto with = [&](std::size_t byte, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + byte, &value, sizeof value);
    return complaint(parse_shade_file, bytes);
  };
  EXPECT_EQ(
      complaint(parse_shade_file, ""),
      "file: byte 0: record length: found the end of the file at byte 0, expected 4 more bytes");
  EXPECT_EQ(with(0, -1),
            "file: byte 0: record length: found -1 words of 4 bytes, expected 21 or more, and ten "
            "records in the file's 2624 bytes");
  EXPECT_EQ(
      with(164, 'x'),
      "file: byte 164: plot type: found \"xectilin\", expected \"rectilin\" or \"irregular\"");
  EXPECT_EQ(with(328, 7),
            "file: byte 328: number of frequencies: found 7, expected 1: a field of one frequency");
  EXPECT_EQ(with(352, 1'000'000),
            "file: byte 352: number of receiver ranges: found 1000000, expected a number from 1 to "
            "20, which is what a record can hold");
  EXPECT_EQ(with(344, 40),
            "file: byte 2624: pressure: found the end of the file after 6 rows, expected 120 rows");
  EXPECT_EQ(with(492, -1.0),
            "file: byte 492: frequency: found -1 Hz, expected a frequency above 0 Hz");
}

TEST(BellhopFiles, MalformedArrivalsAndRaysAreTold) {
  EXPECT_EQ(complaint(parse_arrivals_file, ""),
            "file:1: dimension: found \"\", expected '2D' or '3D'");
  EXPECT_EQ(complaint(parse_arrivals_file, " '4D'\n"),
            "file:1: dimension: found \"'4D'\", expected '2D' or '3D'");
  EXPECT_EQ(complaint(parse_arrivals_file, " '2D'\n 100\n 1 2\n 1 x\n"),
            "file:4: receiver depths: found \"x\", expected a number");
  EXPECT_EQ(complaint(parse_arrivals_file, " '2D'\n 100\n 1 2\n 1 3\n 1 4\n 1\n -1\n"),
            "file:7: number of arrivals: found -1, expected a whole number from 0 to 2000000000");
  EXPECT_EQ(complaint(parse_arrivals_file, " '2D'\n 100\n 1 2\n 1 3\n 1 4\n 2\n 2000000000\n 1 2"),
            "file:8: delay: found the end of the file, expected a number");
  EXPECT_EQ(
      complaint(parse_arrivals_file, " '2D'\n 100\n 1 2\n 1 3\n 1 4\n 0\n 0\n 5\n"),
      "file:8: end: found something after the arrivals of the last receiver, expected nothing");
  EXPECT_EQ(complaint(parse_arrivals_file, std::string("\4\0\0\0ab", 6)),
            "file: byte 4: dimension: found the end of the file at byte 6, expected 4 more bytes");
  std::string binary = arrivals_file_bytes(small_arrivals(true, false, Dialect::fortran));
  binary[13] = 5;
  EXPECT_EQ(complaint(parse_arrivals_file, binary),
            "file: byte 16: frequency: found the end of the file at byte 380, expected 1284 more "
            "bytes");

  EXPECT_EQ(complaint(parse_ray_file, ""),
            "file:2: frequency: found the end of the file, expected a number");
  EXPECT_EQ(complaint(parse_ray_file, "'t'\n 1\n 1 1 1\n 5 1\n 0\n 9\n 'xyz'\n"),
            "file:7: coordinates: found \"xyz\", expected 'rz', rays in a plane");
  EXPECT_EQ(complaint(parse_ray_file, "'t'\n 1\n 1 1 1\n 5 1\n 0\n 9\n 'rz'\n 3\n 2 0 0\n 1 2\n 3"),
            "file:11: depth: found the end of the file, expected a number");
  EXPECT_EQ(complaint(parse_ray_file, "'t'\n 1 9000000000000*1\n"),
            "file:2: number of source x: found \"9000000000000*1\", expected a number, repeated at "
            "most 100023 times");
}

// One path by hand: 2 surface bounces, 1 caustic, R = 0.5·e^{i·0.3} at the bottom, 6 dB of
// absorption (0.6908 Np): what is written has A without absorption, Im τ = −0.6908/ω and the whole
// phase.
TEST(BellhopResults, AnArrivalBecomesARow) {
  PropagationCase run_case;
  run_case.frequency = 100.0;
  run_case.receivers = {.depths = {10.0}, .ranges = {1000.0}};
  Arrival path;
  path.launch_elevation = radians(10.0);
  path.arrival_elevation = radians(-12.0);
  path.delay = 0.75;
  path.surface_bounces = 2;
  path.bottom_bounces = 1;
  path.caustics = 1;
  path.spreading = 1e-3;
  path.reflection = std::polar(0.5, 0.3);
  path.absorption_db = 6.0;
  path.amplitude = 1e-3 * path.reflection * std::polar(amplitude_from_db(-6.0), 0.5 * pi);
  const ArrivalsFile file = arrivals_file(run_case, {.arrivals = {{path}}}, false);
  const ArrivalRow& row = file.arrivals[0][0];
  EXPECT_NEAR(row.amplitude, 0.5e-3, 1e-15);
  EXPECT_NEAR(row.phase_deg, 360.0 + 90.0 + degrees(0.3), 1e-10);
  EXPECT_EQ(row.delay, 0.75);
  EXPECT_NEAR(std::exp(2.0 * pi * 100.0 * row.delay_imaginary), amplitude_from_db(-6.0), 1e-12);
  EXPECT_EQ(row.launch_angle_deg, -10.0);
  EXPECT_NEAR(row.arrival_angle_deg, 12.0, 1e-14);
}

// BELLHOP's field of a point source is minus the sum of its arrivals, that of a line source plus.
TEST(BellhopResults, SignOfTheField) {
  PropagationCase run_case;
  run_case.title = "t";
  run_case.receivers = {.depths = {10.0}, .ranges = {1000.0}};
  const PropagationResult result{.field = {{1.0F, 2.0F}}};
  EXPECT_EQ(shade_file(run_case, result).pressure[0], std::complex<float>(-1.0F, -2.0F));
  run_case.beams.source = SourceKind::line;
  EXPECT_EQ(shade_file(run_case, result).pressure[0], std::complex<float>(1.0F, 2.0F));
  EXPECT_EQ(shade_file(run_case, result).title, "BELLHOP- t");
  EXPECT_THROW((void)shade_file(run_case, {}), InputError);
}

TEST(BellhopResults, RaysAreInOrderOfDeclination) {
  PropagationCase run_case;
  RayPath down{.launch_elevation = -0.1, .points = {{0.0, 100.0, 0.0}, {10.0, 101.0, 0.1}}};
  RayPath up{.launch_elevation = 0.1, .surface_bounces = 1, .points = {{0.0, 100.0, 0.0}}};
  const RayFile file = ray_file(run_case, {.rays = {{down, up}}, .beams = 2});
  ASSERT_EQ(file.rays.size(), 2U);
  EXPECT_EQ(file.rays[0].launch_angle_deg, -degrees(0.1));
  EXPECT_EQ(file.rays[0].surface_bounces, 1);
  EXPECT_EQ(file.rays[1].depth, (std::vector<double>{100.0, 101.0}));
  EXPECT_EQ(file.angles, 2);
}

}  // namespace
}  // namespace asdic::detail::bellhop
