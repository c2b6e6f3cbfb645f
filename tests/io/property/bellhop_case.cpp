#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/bellhop/attenuation.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/case_writer.h"
#include "support/same_case.h"

// Any case whose numbers have so many decimals, as people write them, comes back from its .env file
// and companions bit for bit.

namespace asdic::detail::bellhop {
namespace {

/// A number with `decimals` decimals.
double decimal_between(double low, double high, int decimals) {
  const double unit = std::pow(10.0, decimals);
  const auto n = *rc::gen::inRange(std::int64_t(std::ceil(low * unit)),
                                   std::int64_t(std::floor(high * unit)) + 1);
  return double(n) / unit;
}

bool coin() { return *rc::gen::arbitrary<bool>(); }

template <class T>
T one_of(std::initializer_list<T> all) {
  return *rc::gen::elementOf(std::vector<T>(all));
}

/// Increasing numbers, each `step` to 5·step after the one before.
std::vector<double> increasing(std::size_t n, double first, double step, int decimals) {
  std::vector<double> x = {first};
  const double unit = std::pow(10.0, decimals);
  while (x.size() < n)
    x.push_back(std::round((x.back() + decimal_between(step, 5.0 * step, decimals)) * unit) / unit);
  return x;
}

class RandomCase {
 public:
  PropagationCase operator()() {
    run_.title = title();
    run_.frequency = decimal_between(10.0, 20e3, 2);
    if (const int law = *rc::gen::inRange(0, 3); law == 1)
      ocean().absorption = Thorp{};
    else if (law == 2)
      ocean().absorption =
          FrancoisGarrison{decimal_between(-1.0, 25.0, 1), decimal_between(0.0, 40.0, 1),
                           decimal_between(7.5, 8.3, 2), decimal_between(0.0, 5000.0, 0)};
    volume_loss_ =
        absorption_db_per_km(ocean().absorption, run_.frequency) / (1000.0 * db_per_neper);
    water();
    boundary(ocean().surface, true);
    boundary(ocean().bottom, false);
    receivers();
    beams();
    if (varies_with_range(ocean())) ocean().spreading = Spreading::cylindrical;  // all it knows
    return run_;
  }

 private:
  Environment& ocean() { return run_.environment; }

  static std::string title() {
    std::string text;
    for (int i = *rc::gen::inRange(1, 60); i > 0; --i)
      text += char(*rc::gen::inRange(int('!'), int('~') + 1));
    return text;
  }

  void water() {
    const auto n = *rc::gen::inRange<std::size_t>(2, 12);
    const double top = coin() ? 0.0 : decimal_between(-20.0, 0.0, 2);
    depth_ = increasing(n, top, 10.0, 2);
    std::vector<double> speed, density, attenuation;
    const bool lossy = coin(), dense = coin();
    for (std::size_t i = 0; i < n; ++i) {
      speed.push_back(decimal_between(1450.0, 1550.0, 4));
      density.push_back(1000.0 * (dense ? decimal_between(0.99, 1.05, 3) : 1.0));
      const double loss = lossy ? decimal_between(0.0, 0.5, 3) : 0.0;
      attenuation.push_back(
          1000.0 * db_per_neper *
          nepers_per_m(AttenuationUnit::db_per_wavelength, loss, speed.back(), run_.frequency));
    }
    ocean().surface.depth = depth_.front();
    ocean().bottom.depth = depth_.back();
    ocean().water_density = function(density);
    ocean().attenuation_db_per_km = function(attenuation);
    if (coin()) {
      // a spline that swings out of bounds is not a valid case; speeds here stay within ±3 %
      ocean().water =
          SoundSpeedProfile::table(depth_, speed,
                                   one_of({Interpolation::c_linear, Interpolation::n2_linear,
                                           Interpolation::pchip_spline_slopes}));
      return;
    }
    std::vector<double> range = increasing(*rc::gen::inRange<std::size_t>(1, 5), 0.0, 1.0, 3);
    for (double& r : range) r *= 1000.0;
    std::vector<double> speeds = speed;  // the first profile, at range 0, is the environment's own
    while (speeds.size() < range.size() * n) speeds.push_back(decimal_between(1450.0, 1550.0, 4));
    ocean().section = SoundSpeedSection(range, depth_, speeds);
    std::vector<double> here;
    for (const double z : depth_) here.push_back(ocean().section->at(0.0, z).c);
    ocean().water = SoundSpeedProfile::table(depth_, here, Interpolation::c_linear);
    if (lossy) {  // by the speed that the file will hold
      std::vector<double> again;
      for (std::size_t i = 0; i < n; ++i)
        again.push_back(
            1000.0 * db_per_neper *
            nepers_per_m(AttenuationUnit::db_per_wavelength, 0.25, here[i], run_.frequency));
      ocean().attenuation_db_per_km = function(again);
    }
  }

  [[nodiscard]] DepthFunction function(const std::vector<double>& value) const {
    if (std::all_of(value.begin(), value.end(), [&](double v) { return v == value.front(); }))
      return value.front();
    return DepthFunction::table(depth_, value);
  }

  [[nodiscard]] BoundaryMaterial half_space(double volume_loss) const {
    const auto attenuation = [&](double speed) {
      const double a = decimal_between(0.0, 2.0, 3);
      return volume_loss == 0.0 ? a : a + volume_loss * db_per_neper * speed / run_.frequency;
    };
    const double speed = decimal_between(1480.0, 5000.0, 1), loss = attenuation(speed);
    const double density = 1000.0 * decimal_between(0.9, 3.0, 2);
    if (coin()) return FluidHalfSpace{true_speed(speed, loss), density, loss};
    const double shear = decimal_between(100.0, 1400.0, 1), shear_loss = attenuation(shear);
    return ElasticHalfSpace{true_speed(speed, loss), true_speed(shear, shear_loss), density, loss,
                            shear_loss};
  }

  static ReflectionTable reflection_table() {
    ReflectionTable table;
    for (const double angle : increasing(*rc::gen::inRange<std::size_t>(1, 8), 0.0, 2.0, 2)) {
      table.grazing.push_back(radians(angle));
      table.magnitude.push_back(decimal_between(0.0, 1.0, 3));
      table.phase.push_back(radians(decimal_between(-360.0, 360.0, 2)));
    }
    return table;
  }

  void boundary(Boundary& boundary, bool surface) {
    const int kind = *rc::gen::inRange(0, 4);
    if (kind == 0) boundary.material = Vacuum{};
    if (kind == 1) boundary.material = Rigid{};
    if (kind == 2) boundary.material = half_space(volume_loss_);
    if (kind == 3) boundary.material = reflection_table();
    if (coin()) return;
    std::vector<double> range =
        increasing(*rc::gen::inRange<std::size_t>(1, 7), decimal_between(-2.0, 1.0, 3), 0.1, 4);
    std::vector<double> depth;
    std::vector<BoundaryMaterial> materials;
    const bool is_long = kind == 2 && coin();
    const double top = depth_.front(), bottom = depth_.back();
    for (double& r : range) {
      r *= 1000.0;
      const double share = decimal_between(0.0, 0.3, 3);
      depth.push_back(surface ? std::lerp(top, bottom, share) : std::lerp(bottom, top, share));
      if (is_long) materials.push_back(half_space(0.0));
    }
    boundary.shape = BoundaryShape(
        range, depth,
        one_of({ShapeInterpolation::piecewise_linear, ShapeInterpolation::curvilinear}), materials);
    boundary.depth = boundary.shape->depth_at(0.0);
    if (is_long) boundary.material = materials.front();
  }

  /// Single precision, inside the water.
  std::vector<double> depths(std::size_t n) {
    std::vector<double> z;
    for (std::size_t i = 0; i < n; ++i)
      z.push_back(std::clamp(double(float(decimal_between(depth_.front(), depth_.back(), 2))),
                             depth_.front(), depth_.back()));
    std::sort(z.begin(), z.end());
    return z;
  }

  void receivers() {
    ReceiverGrid& grid = run_.receivers;
    run_.source_depths = depths(*rc::gen::inRange<std::size_t>(1, 4));
    grid.irregular = coin();
    for (const double km : increasing(*rc::gen::inRange<std::size_t>(1, 12), 0.0, 0.05, 3))
      grid.ranges.push_back(double(float(km) * 1000.0F));
    grid.depths =
        depths(grid.irregular ? grid.ranges.size() : *rc::gen::inRange<std::size_t>(1, 9));
  }

  void beams() {
    BeamSettings& beams = run_.beams;
    run_.task = one_of(
        {Task::rays, Task::eigenrays, Task::arrivals, Task::eigenrays_and_arrivals, Task::field});
    if (run_.task == Task::field)
      run_.field = one_of({FieldKind::coherent, FieldKind::incoherent, FieldKind::semi_coherent});
    beams.kind = one_of({BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat,
                         BeamKind::ray_centred_gaussian, BeamKind::simple_gaussian,
                         BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred});
    beams.source = one_of({SourceKind::point, SourceKind::line});
    beams.displacement = coin();
    if (coin()) pattern();
    fan();
    if (beams.kind == BeamKind::cerveny_cartesian || beams.kind == BeamKind::cerveny_ray_centred)
      cerveny();
    run_.literal.step = decimal_between(0.1, 500.0, 1);
    run_.box_depth = decimal_between(10.0, 6000.0, 1);
    run_.box_range = 1000.0 * decimal_between(0.1, 200.0, 2);
  }

  void pattern() {
    SourcePattern pattern;
    std::vector<double> angle = increasing(*rc::gen::inRange<std::size_t>(2, 9), -90.0, 3.0, 2);
    for (std::size_t i = angle.size(); i-- > 0;) {
      pattern.elevation.push_back(radians(-angle[i]));
      pattern.amplitude.push_back(coin() ? amplitude_from_db(decimal_between(-60.0, 10.0, 4))
                                         : 1.0);
    }
    run_.beams.pattern = pattern;
  }

  void fan() {
    BeamSettings& beams = run_.beams;
    if (coin()) {
      beams.lowest = radians(-decimal_between(1.0, 89.0, 3));
      beams.highest = radians(decimal_between(1.0, 89.0, 3));
      beams.count = *rc::gen::inRange(2, 20'000);
    } else {
      const auto n = one_of<std::size_t>({1, 3, 4, 17});
      std::vector<double> down = increasing(n, decimal_between(-80.0, 0.0, 2), 0.5, 2);
      for (std::size_t i = n; i-- > 0;) beams.elevations.push_back(radians(-down[i]));
      beams.lowest = beams.elevations.front();
      beams.highest = beams.elevations.back();
      beams.count = int(n);
    }
    run_.literal.beams = beams.count;
    if (coin()) run_.literal.single_beam = *rc::gen::inRange(1, beams.count + 1);
  }

  void cerveny() {
    using Width = CervenyBeams::Width;
    using Curvature = CervenyBeams::Curvature;
    using Component = CervenyBeams::Component;
    run_.beams.cerveny = CervenyBeams{
        .width = one_of({Width::space_filling, Width::minimum, Width::wkb, Width::cerveny}),
        .curvature = one_of({Curvature::standard, Curvature::doubled, Curvature::zero}),
        .width_multiplier = decimal_between(0.1, 3.0, 2),
        .loop_range = 1000.0 * decimal_between(0.0, 100.0, 2),
        .images = *rc::gen::inRange(1, 4),
        .window = *rc::gen::inRange(1, 10),
        .component = one_of({Component::pressure, Component::vertical, Component::horizontal})};
  }

  PropagationCase run_;
  std::vector<double> depth_;
  double volume_loss_ = 0.0;
};

RC_GTEST_PROP(BellhopCase, AnyCaseIsWrittenAndReadBackBitForBit, ()) {
  const PropagationCase run_case = RandomCase()();
  const bool binary = coin();
  const Written written = write_case(run_case, binary);
  const std::string first_note = written.notes.empty() ? "" : written.notes.front();
  RC_ASSERT(first_note == "");
  const Input read = read_case(written.texts, "case");
  const std::string difference = support::CaseComparison::difference(run_case, read.run_case);
  if (!difference.empty()) RC_LOG() << written.texts.env;
  RC_ASSERT(difference == "");
  const bool arrivals =
      run_case.task == Task::arrivals || run_case.task == Task::eigenrays_and_arrivals;
  RC_ASSERT(read.binary_arrivals == (binary && arrivals));
}

}  // namespace
}  // namespace asdic::detail::bellhop
