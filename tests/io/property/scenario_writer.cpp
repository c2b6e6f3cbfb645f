#include "io/scenario/writer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/scenario/propagation.h"
#include "io/settings/axis.h"

namespace asdic::detail {
namespace {

/// A number with all its bits, between two ends.
double between(double low, double high) {
  const double share = static_cast<double>(*rc::gen::arbitrary<std::uint64_t>() >> 11) * 0x1p-53;
  return std::clamp(low + (high - low) * share, low, high);
}

bool perhaps() { return *rc::gen::arbitrary<bool>(); }

std::vector<double> some(int least, int most, double low, double high) {
  std::vector<double> values(static_cast<std::size_t>(*rc::gen::inRange(least, most + 1)));
  for (double& value : values) value = between(low, high);
  return values;
}

/// Strictly increasing, so far apart that no table is refused.
std::vector<double> axis(int least, int most, double low, double high) {
  std::vector<double> values = some(least, most, 0.1, 1.0);
  double sum = 0.0;
  for (double& value : values) value = sum += value;
  for (double& value : values) value = low + (high - low) * (value / sum);
  return values;
}

ReflectionTable any_curve() {
  ReflectionTable table{.grazing = axis(1, 5, 0.0, 0.5 * pi - 1e-9), .magnitude = {}, .phase = {}};
  for (std::size_t i = 0; i < table.grazing.size(); ++i) {
    table.magnitude.push_back(between(0.0, 1.0));
    table.phase.push_back(between(-pi, pi));
  }
  return table;
}

/// A layer that gives no energy.
FloorLayer any_layer() {
  FloorLayer layer{.thickness = between(0.0, 100.0),
                   .speed = between(1500.0, 7000.0),
                   .density = between(100.0, 9000.0),
                   .attenuation_db_per_wavelength = between(0.1, 5.0)};
  if (perhaps()) {
    layer.shear_speed = between(100.0, 700.0);
    layer.shear_attenuation_db_per_wavelength = between(0.0, 0.3);
  }
  return layer;
}

BoundaryMaterial any_material() {
  switch (*rc::gen::inRange(0, 7)) {
    case 0:
      return Vacuum{};
    case 1:
      return Rigid{};
    case 2:
      return FluidHalfSpace{between(200.0, 7000.0), between(100.0, 9000.0), between(0.0, 5.0)};
    case 3:
      return ElasticHalfSpace{between(1500.0, 7000.0), perhaps() ? 0.0 : between(1.0, 1500.0),
                              between(100.0, 9000.0), between(0.0, 5.0), between(0.0, 5.0)};
    case 4: {
      ReflectionCurves curves{.frequency = axis(1, 4, 10.0, 1e5), .curve = {}};
      for (std::size_t i = 0; i < curves.frequency.size(); ++i) curves.curve.push_back(any_curve());
      return curves;
    }
    case 5: {
      LayeredFloor floor{.layers = {}, .below = any_layer()};
      for (int i = *rc::gen::inRange(0, 4); i > 0; --i) floor.layers.push_back(any_layer());
      floor.below.thickness = FloorLayer{}.thickness;
      return floor;
    }
    default:
      return any_curve();
  }
}

/// \param surface  it alone has bubbles
Roughness any_roughness(bool surface) {
  Roughness rough;
  if (perhaps()) {
    rough.rms_height = between(0.01, 5.0);
    rough.sea_wind = perhaps() ? between(1.0, 20.0) : 0.0;
    rough.floor_db = between(-300.0, 0.0);
  }
  if (surface && perhaps()) rough.bubble_wind = between(1.0, 20.0);
  return rough;
}

Boundary any_boundary(bool surface, double low, double high) {
  Boundary boundary{.depth = between(low, high),
                    .material = any_material(),
                    .shape = {},
                    .roughness = any_roughness(surface)};
  if (perhaps()) return boundary;
  const std::vector<double> range = axis(1, 6, -5e3, between(1.0, 1e5));
  std::vector<double> depth;
  std::vector<BoundaryMaterial> material;
  const bool varied = perhaps();
  for (std::size_t i = 0; i < range.size(); ++i) {
    depth.push_back(between(low, high));
    if (varied) material.push_back(any_material());
  }
  const auto kind = *rc::gen::element(ShapeInterpolation::piecewise_linear,
                                      ShapeInterpolation::smooth, ShapeInterpolation::curvilinear);
  boundary.shape = BoundaryShape(range, depth, kind, material);
  boundary.depth = boundary.shape->depth_at(0.0);
  if (varied && perhaps()) boundary.material = material.front();
  return boundary;
}

DepthFunction any_depth_function(double low, double high) {
  if (perhaps()) return between(low, high);
  std::vector<double> depth = axis(1, 5, -10.0, 1000.0), value;
  if (depth.size() > 2 && perhaps()) depth[1] = depth[0];  // a step
  for (std::size_t i = 0; i < depth.size(); ++i) value.push_back(between(low, high));
  return DepthFunction::table(depth, value);
}

void any_water(Environment& ocean) {
  const std::vector<double> depth = axis(2, 8, -20.0, 1100.0);
  const auto speeds = [&] {
    std::vector<double> speed;
    for (std::size_t i = 0; i < depth.size(); ++i) speed.push_back(between(1495.0, 1505.0));
    return speed;
  };
  switch (*rc::gen::inRange(0, 4)) {
    case 0:
      ocean.water = SoundSpeedProfile::munk({between(1450.0, 1550.0), between(0.0, 2000.0),
                                             between(500.0, 2000.0), between(0.0, 0.02)});
      return;
    case 1:
      ocean.water = SoundSpeedProfile::isovelocity(between(1400.0, 1600.0));
      return;
    case 2: {
      const auto rule = *rc::gen::element(Interpolation::c_linear, Interpolation::n2_linear,
                                          Interpolation::spline, Interpolation::pchip,
                                          Interpolation::pchip_spline_slopes);
      // A spline through rough samples may swing and be refused; these are two at most.
      const std::vector<double> ends = {-20.0, 1100.0}, c = {between(1490.0, 1510.0), 1500.0};
      ocean.water = SoundSpeedProfile::table(ends, c, rule);
      return;
    }
    default: {
      const std::vector<double> range = axis(1, 5, -1e4, 1e5);
      std::vector<double> all, at_start;
      for (std::size_t i = 0; i < range.size(); ++i)
        for (const double c : speeds()) all.push_back(c);
      ocean.section = SoundSpeedSection(range, depth, all);
      for (const double z : depth) at_start.push_back(ocean.section->at(0.0, z).c);
      ocean.water = SoundSpeedProfile::table(depth, at_start, Interpolation::c_linear);
    }
  }
}

Environment any_ocean() {
  Environment ocean;
  ocean.surface = any_boundary(true, -10.0, 10.0);
  ocean.bottom = any_boundary(false, 11.0, 1000.0);
  ocean.water_density = any_depth_function(990.0, 1060.0);
  ocean.attenuation_db_per_km = any_depth_function(0.0, 10.0);
  any_water(ocean);
  ocean.absorption = *rc::gen::element<Absorption>(
      NoAbsorption{}, Thorp{}, FrancoisGarrison{between(0.0, 30.0), between(30.0, 40.0), 8.1, 50.0},
      AinslieMcColm{between(0.0, 30.0), between(30.0, 40.0), 7.9, 500.0});
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i)
    ocean.biology.push_back({between(0.0, 100.0), between(101.0, 500.0), between(100.0, 5000.0),
                             between(1.0, 10.0), between(0.0, 2.0)});
  if (perhaps()) ocean.spreading = Spreading::cylindrical;
  return ocean;
}

BeamSettings any_beams() {
  BeamSettings beams;
  beams.kind = static_cast<BeamKind>(*rc::gen::inRange(0, 7));
  beams.source = perhaps() ? SourceKind::point : SourceKind::line;
  beams.displacement = perhaps();
  beams.count = *rc::gen::inRange(0, 10'000);
  if (perhaps()) {
    beams.elevations = axis(1, 6, -1.5, 1.5);
    beams.lowest = beams.elevations.front();
    beams.highest = beams.elevations.back();
  } else {
    beams.lowest = between(-pi, 0.0);
    beams.highest = perhaps() ? radians(std::round(between(0.0, 90.0))) : between(0.0, pi);
  }
  if (perhaps()) {
    SourcePattern pattern{.elevation = axis(1, 5, -1.5, 1.5), .amplitude = {}};
    for (std::size_t i = 0; i < pattern.elevation.size(); ++i)
      pattern.amplitude.push_back(between(0.0, 2.0));
    beams.pattern = pattern;
  }
  if (beams.kind == BeamKind::cerveny_cartesian || beams.kind == BeamKind::cerveny_ray_centred ||
      perhaps())
    beams.cerveny =
        CervenyBeams{.width = static_cast<CervenyBeams::Width>(*rc::gen::inRange(0, 4)),
                     .curvature = static_cast<CervenyBeams::Curvature>(*rc::gen::inRange(0, 3)),
                     .width_multiplier = between(0.1, 5.0),
                     .loop_range = between(0.0, 1e5),
                     .images = *rc::gen::inRange(1, 4),
                     .window = *rc::gen::inRange(1, 20),
                     .component = static_cast<CervenyBeams::Component>(*rc::gen::inRange(0, 3))};
  return beams;
}

PropagationCase any_case() {
  PropagationCase run;
  run.title = *rc::gen::element<std::string>("", "a wedge", "quoted \"twice\" \\ and\ttabbed");
  run.frequency = between(1.0, 1e5);
  run.environment = any_ocean();
  run.source_depths = some(1, 4, 0.0, 1000.0);
  run.task = static_cast<Task>(*rc::gen::inRange(0, 5));
  run.field = static_cast<FieldKind>(*rc::gen::inRange(0, 3));
  if (run.task != Task::rays || perhaps()) {
    run.receivers.depths = axis(1, 6, 0.0, 1000.0);
    run.receivers.ranges = perhaps() ? evenly_spaced(0.0, 1e5, 101) : axis(1, 6, 0.0, 1e5);
    if (perhaps()) {
      run.receivers.irregular = true;
      run.receivers.depths = some(5, 5, 0.0, 1000.0);
      run.receivers.ranges = some(5, 5, 0.0, 1e5);
    }
  }
  run.beams = any_beams();
  run.dimension = perhaps() ? 3 : 2;
  if (perhaps()) run.off_transect = between(-3.0, 3.0);
  run.box_range = between(0.0, 2e5);
  run.box_depth = between(0.0, 2000.0);
  run.literal.step = between(0.0, 500.0);
  run.literal.beams = *rc::gen::inRange(0, 10'000);
  if (perhaps()) run.literal.single_beam = *rc::gen::inRange(1, 100);
  return run;
}

PropagationCase read_back(const std::string& text) {
  std::vector<std::string> notes;
  return parse_propagation_case(text, "case.toml", {}, notes);
}

void expect_same(std::span<const double> a, std::span<const double> b) {
  RC_ASSERT(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    RC_ASSERT(std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]));
}

// Numbers are written in the shortest way that reads back as the same bits, and every member is
// written: so the same text twice means the same case, bit for bit. Members are looked at besides,
// by a sample of each kind.
RC_GTEST_PROP(ScenarioWriter, ReadsBackBitForBit, ()) {
  const PropagationCase run = any_case();
  const std::string text = to_toml(run);
  const PropagationCase same = read_back(text);
  RC_ASSERT(to_toml(same) == text);

  RC_ASSERT(same.title == run.title);
  RC_ASSERT(same.dimension == run.dimension);
  RC_ASSERT(same.off_transect == run.off_transect);
  expect_same(same.source_depths, run.source_depths);
  expect_same(same.receivers.depths, run.receivers.depths);
  expect_same(same.receivers.ranges, run.receivers.ranges);
  expect_same(same.beams.elevations, run.beams.elevations);
  const double numbers[] = {run.frequency,    run.box_range,     run.box_depth,
                            run.beams.lowest, run.beams.highest, run.literal.step};
  const double read[] = {same.frequency,    same.box_range,     same.box_depth,
                         same.beams.lowest, same.beams.highest, same.literal.step};
  expect_same(read, numbers);
  const Environment &a = run.environment, &b = same.environment;
  RC_ASSERT(spreading_across(a) == spreading_across(b));
  for (double z = -15.0; z < 1100.0; z += 37.0) {
    const double values[] = {a.water.at(z).c, a.water_density.at(z), a.attenuation_db_per_km.at(z),
                             sound_speed(a, 500.0, z).c, attenuation_np_per_m(a, 1e3).at(z)};
    const double again[] = {b.water.at(z).c, b.water_density.at(z), b.attenuation_db_per_km.at(z),
                            sound_speed(b, 500.0, z).c, attenuation_np_per_m(b, 1e3).at(z)};
    expect_same(again, values);
  }
  for (const auto& [left, right] : {std::pair{&a.surface, &b.surface}, {&a.bottom, &b.bottom}})
    for (double r = -6e3; r < 1.1e5; r += 3.3e3) {
      RC_ASSERT(left->roughness == right->roughness);
      const auto p = reflection_coefficient(left->material_at(r), 0.3, {});
      const auto q = reflection_coefficient(right->material_at(r), 0.3, {});
      const double values[] = {left->depth_at(r), p.real(), p.imag()};
      const double again[] = {right->depth_at(r), q.real(), q.imag()};
      expect_same(again, values);
    }
}

}  // namespace
}  // namespace asdic::detail
