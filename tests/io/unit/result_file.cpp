#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "io/hdf5/environment_group.h"
#include "io/result/field_file.h"
#include "io/result/result_file.h"
#include "support/temporary_directory.h"

// Fields, arrivals and rays as HDF5, and BELLHOP's files through it.

namespace asdic::detail {
namespace {

using bellhop::ArrivalsFile;
using bellhop::RayFile;
using bellhop::ShadeFile;

/// To HDF5 and back.
PropagationFile round_trip(const PropagationFile& file) {
  const support::TemporaryDirectory folder;
  Hdf5File hdf5 = Hdf5File::create(folder / "result.h5");
  write_hdf5_result(hdf5, file);
  hdf5.close();
  return read_result(folder / "result.h5");
}

ShadeFile field(bool irregular) {
  ShadeFile file{.title = "a title",
                 .irregular = irregular,
                 .frequency = 250.0,
                 .source_depths = {10.0, 20.0},
                 .receiver_depths = {5.0, 15.0, 30.0},
                 .receiver_ranges = {100.0, 250.0, 800.0}};
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (std::size_t i = 0; i < 2 * file.rows() * 3; ++i) {
    const float re = normal(random), im = normal(random);
    file.pressure.emplace_back(re, im);
  }
  return file;
}

TEST(ResultFile, FieldsComeBackAsTheyWere) {
  for (const bool irregular : {false, true}) {
    const ShadeFile before = field(irregular);
    const auto after = std::get<ShadeFile>(round_trip(before));
    EXPECT_EQ(after.title, before.title);
    EXPECT_EQ(after.irregular, irregular);
    EXPECT_EQ(after.frequency, before.frequency);
    EXPECT_EQ(after.source_depths, before.source_depths);
    EXPECT_EQ(after.receiver_depths, before.receiver_depths);
    EXPECT_EQ(after.receiver_ranges, before.receiver_ranges);
    EXPECT_EQ(after.pressure, before.pressure);
  }
}

// The field is the sum of the arrivals; a .shd holds its negative (docs/formats/bellhop.md).
TEST(ResultFile, AShadeFileIsTheNegativeOfTheField) {
  const ShadeFile file = field(false);
  const FieldData data = from_shade_file(file);
  ASSERT_EQ(data.pressure.size(), file.pressure.size());
  EXPECT_EQ(data.pressure[3], -file.pressure[3]);
  EXPECT_EQ(data.kind, FieldKind::coherent);
  ShadeFile real = file;
  for (auto& p : real.pressure) p = -std::abs(p);
  EXPECT_EQ(from_shade_file(real).kind, FieldKind::incoherent);
}

TEST(ResultFile, ArrivalsComeBackAsTheyWere) {
  ArrivalsFile before{.frequency = 3500.0,
                      .source_depths = {10.0},
                      .receiver_depths = {5.0, 15.0},
                      .receiver_ranges = {100.0, 250.0}};
  before.arrivals.resize(4);
  before.arrivals[2] = {{.amplitude = 1e-3,
                         .phase_deg = 540.0,  // not wrapped: three reflections at the surface
                         .delay = 2.5,
                         .delay_imaginary = -1e-5,
                         .launch_angle_deg = 12.5,
                         .arrival_angle_deg = -7.0,
                         .surface_bounces = 3,
                         .bottom_bounces = 2},
                        {.amplitude = 2e-4, .delay = 2.6}};
  const auto after = std::get<ArrivalsFile>(round_trip(before));
  EXPECT_EQ(after.frequency, before.frequency);
  EXPECT_EQ(after.receiver_depths, before.receiver_depths);
  EXPECT_EQ(after.receiver_ranges, before.receiver_ranges);
  ASSERT_EQ(after.arrivals.size(), 4U);
  EXPECT_TRUE(after.arrivals[0].empty());
  ASSERT_EQ(after.arrivals[2].size(), 2U);
  const auto &a = after.arrivals[2][0], &b = before.arrivals[2][0];
  EXPECT_EQ(a.amplitude, b.amplitude);
  EXPECT_EQ(a.phase_deg, b.phase_deg);
  EXPECT_EQ(a.delay, b.delay);
  EXPECT_EQ(a.delay_imaginary, b.delay_imaginary);
  EXPECT_EQ(a.launch_angle_deg, b.launch_angle_deg);
  EXPECT_EQ(a.arrival_angle_deg, b.arrival_angle_deg);
  EXPECT_EQ(a.surface_bounces, b.surface_bounces);
  EXPECT_EQ(a.bottom_bounces, b.bottom_bounces);
}

// So that a converted file can be converted back into the same bytes.
TEST(ResultFile, DialectAndBinaryComeBack) {
  for (const auto dialect : {bellhop::Dialect::fortran, bellhop::Dialect::wide}) {
    ShadeFile shade = field(false);
    shade.dialect = dialect;
    const auto shade_after = std::get<ShadeFile>(round_trip(shade));
    EXPECT_EQ(bellhop::shade_file_bytes(shade_after), bellhop::shade_file_bytes(shade));
    for (const bool binary : {false, true}) {
      ArrivalsFile arrivals{.binary = binary,
                            .frequency = 3500.0,
                            .source_depths = {10.0},
                            .receiver_depths = {5.0},
                            .receiver_ranges = {100.0},
                            .arrivals = {{{.amplitude = 0.25, .phase_deg = 180.0, .delay = 2.5}}},
                            .dialect = dialect};
      const auto after = std::get<ArrivalsFile>(round_trip(arrivals));
      EXPECT_EQ(bellhop::arrivals_file_bytes(after), bellhop::arrivals_file_bytes(arrivals));
    }
  }
}

TEST(ResultFile, RaysComeBackAsTheyWere) {
  RayFile before{
      .title = "rays", .frequency = 50.0, .sources_z = 2, .angles = 7, .bottom_depth = 80.0};
  before.rays = {
      {.launch_angle_deg = -3.0, .surface_bounces = 1, .range = {0, 10}, .depth = {5, 6}},
      {.launch_angle_deg = 4.0, .bottom_bounces = 2, .range = {0}, .depth = {5}}};
  const auto after = std::get<RayFile>(round_trip(before));
  EXPECT_EQ(after.title, before.title);
  EXPECT_EQ(after.sources_z, 2);
  EXPECT_EQ(after.angles, 7);
  EXPECT_EQ(after.bottom_depth, 80.0);
  ASSERT_EQ(after.rays.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after.rays[i].launch_angle_deg, before.rays[i].launch_angle_deg);
    EXPECT_EQ(after.rays[i].surface_bounces, before.rays[i].surface_bounces);
    EXPECT_EQ(after.rays[i].bottom_bounces, before.rays[i].bottom_bounces);
    EXPECT_EQ(after.rays[i].range, before.rays[i].range);
    EXPECT_EQ(after.rays[i].depth, before.rays[i].depth);
  }
}

TEST(ResultFile, WhatIsNoneIsRefused) {
  const support::TemporaryDirectory folder;
  EXPECT_THROW(static_cast<void>(read_result(folder / "none.shd")), InputError);
  EXPECT_THROW(static_cast<void>(read_result(folder.path())), InputError);
  EXPECT_THROW(static_cast<void>(read_result(folder.write("text.txt", "hello"))), InputError);
  EXPECT_THROW(static_cast<void>(read_result(folder.write("field.shd", "hello"))), InputError);
  Hdf5File other = Hdf5File::create(folder / "other.h5");
  other.set_attribute("", "filetype", "asdic field");
  other.close();
  EXPECT_THROW(static_cast<void>(read_result(folder / "other.h5")), InputError);
}

// A sloping floor: its nodes are among the samples, so a picture shows every corner.
TEST(EnvironmentGroup, SamplesTheSeaAndKeepsItsCorners) {
  const support::TemporaryDirectory folder;
  Environment ocean;
  const std::vector<double> range = {0.0, 3333.3, 9000.0}, depth = {500.0, 200.0, 400.0};
  ocean.bottom = {.depth = 500.0,
                  .shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear)};
  Hdf5File file = Hdf5File::create(folder / "sea.h5");
  write_environment_group(file, ocean, 0.0, 8000.0);
  const auto r = file.read<double>("environment/boundary_range");
  const auto z = file.read<double>("environment/bottom_depth");
  const auto corner = std::find(r.begin(), r.end(), 3333.3);
  ASSERT_NE(corner, r.end());
  EXPECT_DOUBLE_EQ(z[static_cast<std::size_t>(corner - r.begin())], 200.0);
  EXPECT_EQ(r.back(), 8000.0);
  EXPECT_EQ(file.read<double>("environment/depth").back(), 500.0);
}

}  // namespace
}  // namespace asdic::detail
