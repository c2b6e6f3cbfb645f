#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <variant>

#include "core/fields_viewer.h"
#include "core/settings_words.h"
#include "core/units.h"
#include "reverb/scattering/models.h"
#include "support/lommel_seeliger.h"
#include "support/member_count.h"

namespace asdic::detail {
namespace {

double between(double low, double high) {
  constexpr int steps = 1'000'000;
  return low + (high - low) * *rc::gen::inRange(0, steps + 1) / steps;
}

template <class Variant>
struct AlternativesOf;
template <class... Model>
struct AlternativesOf<std::variant<Model...>> {
  using Types = testing::Types<Model...>;
  using AndTheRecipe = testing::Types<Model..., LommelSeeliger>;  // docs/develop/recipes.md
};

/// Draws every parameter from its range, of a table four rows; strengths that send back more than
/// comes in are no law of nature, and are left out.
class Drawn final : public FieldsViewer {
 public:
  [[nodiscard]] bool reads() const override { return true; }
  void columns(std::initializer_list<Column> all, const ColumnRules&) override {
    constexpr int rows = 4;
    for (const Column& column : all) {
      const double low = std::max(column.quantity.low, -60.0);
      const double high = column.angle ? column.quantity.high : 0.0;
      column.values->clear();
      for (int i = 0; i < rows; ++i) {
        const double value = column.angle ? low + (high - low) * (i + between(0.01, 0.99)) / rows
                                          : between(low, high);
        column.values->push_back(column.angle ? radians(value) : value);
      }
    }
  }

 private:
  void number(const Setting&, const Quantity& q, double& value, bool*) override {
    value = between(q.low, q.high);
  }
};

/// A model with parameters anywhere in their ranges, under any sea.
template <class Model>
Model any() {
  Model model;
  Drawn drawn;
  model.describe(drawn);
  if constexpr (SurfaceScatteringModel<Model>) {
    model.wind_speed = between(0.0, 40.0);
    model.sound_speed = between(1400.0, 1600.0);
  }
  return model;
}

/// Expects of every setting a value within its range, and a word of help.
class Within final : public FieldsViewer {
 public:
  void columns(std::initializer_list<Column> all, const ColumnRules&) override {
    for (const Column& column : all) {
      EXPECT_FALSE(column.help.empty()) << column.key;
      for (const double value : *column.values)
        EXPECT_TRUE(column.quantity.holds(column.angle ? degrees(value) : value)) << column.key;
    }
  }

 private:
  void number(const Setting& s, const Quantity& q, double& value, bool*) override {
    EXPECT_TRUE(q.holds(value)) << s.key.name;
    EXPECT_FALSE(s.help.empty()) << s.key.name;
  }
};

/// Shows the members of a struct, and changes the one of a number.
class Changed final : public FieldsViewer {
 public:
  explicit Changed(int which) : which_(which) {}
  [[nodiscard]] bool reads() const override { return true; }
  [[nodiscard]] int members() const { return members_; }
  void columns(std::initializer_list<Column> all, const ColumnRules&) override {
    for (const Column& column : all) change(column.values->back());
  }
  void derived(double& value) override { change(value); }

 private:
  void number(const Setting&, const Quantity&, double& value, bool*) override { change(value); }
  void change(double& value) {
    if (members_++ == which_) value = std::nextafter(value, infinity);
  }
  int which_, members_ = 0;
};

// No member of a law is forgotten by what walks over it, and each distinguishes two laws.
template <class Model>
void expect_described() {
  const Model model;
  for (int i = 0; i < support::member_count<Model>(); ++i) {
    Model other = model;
    Changed changed(i);
    other.describe(changed);
    EXPECT_EQ(changed.members(), support::member_count<Model>());
    EXPECT_NE(settings_words(other), settings_words(model)) << i;
  }
  EXPECT_EQ(settings_words(Model(model)), settings_words(model));
}

ScatterGeometry any_geometry() {
  return {.grazing_in = between(0.0, pi / 2),
          .grazing_out = between(0.0, pi / 2),
          .azimuth = between(-pi, pi)};
}

double any_frequency() { return between(10.0, 50'000.0); }

// Run over AnySurfaceScattering and AnyBottomScattering: a new model is tested on arrival.
template <class Model>
class EverySurfaceScattering : public testing::Test {};
TYPED_TEST_SUITE(EverySurfaceScattering, AlternativesOf<AnySurfaceScattering>::Types);
template <class Model>
class EveryBottomScattering : public testing::Test {};
TYPED_TEST_SUITE(EveryBottomScattering, AlternativesOf<AnyBottomScattering>::AndTheRecipe);

// Source and receiver may change places; only the order of additions differs.
template <class Model>
void expect_reciprocal() {
  EXPECT_TRUE(rc::check([] {
    const Model model = any<Model>();
    const ScatterGeometry g = any_geometry();
    const double f = any_frequency();
    const ScatterGeometry back = {
        .grazing_in = g.grazing_out, .grazing_out = g.grazing_in, .azimuth = -g.azimuth};
    const double forth = model.cross_section(g, f);
    RC_ASSERT(std::abs(model.cross_section(back, f) - forth) <= 1e-12 * forth);
  }));
}
TYPED_TEST(EverySurfaceScattering, IsReciprocal) { expect_reciprocal<TypeParam>(); }
TYPED_TEST(EveryBottomScattering, IsReciprocal) { expect_reciprocal<TypeParam>(); }

TYPED_TEST(EverySurfaceScattering, IsFiniteAndNotNegative) {
  EXPECT_TRUE(rc::check([] {
    const double sigma = any<TypeParam>().cross_section(any_geometry(), any_frequency());
    RC_ASSERT(std::isfinite(sigma));
    RC_ASSERT(sigma >= 0.0);
  }));
}

// Each mechanism (interface, bubbles) scatters at most 1 /sr, wherever its law is driven to.
TYPED_TEST(EverySurfaceScattering, IsBounded) {
  EXPECT_TRUE(rc::check(
      [] { RC_ASSERT(any<TypeParam>().cross_section(any_geometry(), any_frequency()) <= 2.0); }));
}

TYPED_TEST(EveryBottomScattering, IsFiniteBoundedAndNotNegative) {
  EXPECT_TRUE(rc::check([] {
    const double sigma = any<TypeParam>().cross_section(any_geometry(), any_frequency());
    RC_ASSERT(std::isfinite(sigma));
    RC_ASSERT(sigma >= 0.0);
    RC_ASSERT(sigma <= 2.0);
  }));
}

TYPED_TEST(EveryBottomScattering, GrazingSoundScattersNothing) {
  EXPECT_TRUE(rc::check([] {
    ScatterGeometry g = any_geometry();
    g.grazing_in = 0.0;
    RC_ASSERT(any<TypeParam>().cross_section(g, any_frequency()) == 0.0);
  }));
}

TYPED_TEST(EveryBottomScattering, DefaultsAreWithinTheirRanges) {
  Within within;
  look(TypeParam{}, within);
}
TYPED_TEST(EveryBottomScattering, EveryMemberIsDescribed) { expect_described<TypeParam>(); }

TYPED_TEST(EverySurfaceScattering, CalmSeaScattersNothing) {
  EXPECT_TRUE(rc::check([] {
    TypeParam model = any<TypeParam>();
    if constexpr (SurfaceScatteringModel<TypeParam>) {
      model.wind_speed = 0.0;
      RC_ASSERT(model.cross_section(any_geometry(), any_frequency()) == 0.0);
    }
  }));
}

TYPED_TEST(EverySurfaceScattering, GrazingSoundScattersNothing) {
  EXPECT_TRUE(rc::check([] {
    ScatterGeometry g = any_geometry();
    g.grazing_in = 0.0;
    RC_ASSERT(any<TypeParam>().cross_section(g, any_frequency()) == 0.0);
  }));
}

// More wind never makes the sea smoother.
TYPED_TEST(EverySurfaceScattering, RisesWithWind) {
  EXPECT_TRUE(rc::check([] {
    TypeParam model = any<TypeParam>();
    const double grazing = between(0.0, radians(40.0));
    const ScatterGeometry g = {.grazing_in = grazing, .grazing_out = grazing};
    const double f = between(50.0, 6400.0);
    const double before = model.cross_section(g, f);
    if constexpr (SurfaceScatteringModel<TypeParam>) model.wind_speed += 0.5;
    RC_ASSERT(model.cross_section(g, f) >= before * (1.0 - 1e-12));
  }));
}

TEST(VolumeSheet, EveryMemberIsDescribed) { expect_described<VolumeSheet>(); }

// One law, asked by angles or by their sines: one is written with the other.
template <class Model>
void expect_one_law() {
  EXPECT_TRUE(rc::check([] {
    const Model model = any<Model>();
    const ScatterGeometry g = any_geometry();
    const double f = any_frequency();
    RC_ASSERT(model.at(f)(sines_of(g)) == model.cross_section(g, f));
  }));
}
TYPED_TEST(EverySurfaceScattering, AtOneFrequencyIsTheLaw) { expect_one_law<TypeParam>(); }
TYPED_TEST(EveryBottomScattering, AtOneFrequencyIsTheLaw) { expect_one_law<TypeParam>(); }

/// Q²/k² by angles: (cos θᵢ − cos θₛ)² in products, which nothing cancels in.
double across2_by_angles(const ScatterGeometry& g) {
  const double difference = 2.0 * std::sin(0.5 * (g.grazing_in + g.grazing_out)) *
                            std::sin(0.5 * (g.grazing_in - g.grazing_out));
  const double turn = std::sin(0.5 * g.azimuth);
  return difference * difference +
         4.0 * std::cos(g.grazing_in) * std::cos(g.grazing_out) * turn * turn;
}

/// What roundings of sines and cosines, ε = 2⁻⁵³, may leave of Q²/k², relative: sines of small
/// angles have a relative error, and so has Q² but for cos θᵢ − cos θₛ, of which ε·cos is left
/// where they are alike and nothing else turns the sound.
double across2_error(const ScatterGeometry& g) {
  constexpr double rounding = 1e-15;
  const double difference = std::abs(std::cos(g.grazing_in) - std::cos(g.grazing_out));
  const double q2 = across2_by_angles(g);
  return 1e-14 + (q2 > 0.0 ? 2.0 * difference * rounding / q2 : 0.0);
}

TEST(ScatterSines, ChangeOfDirectionIsThatOfTheAngles) {
  EXPECT_TRUE(rc::check([] {
    const ScatterGeometry g = any_geometry();
    const double exact = across2_by_angles(g);
    RC_ASSERT(std::abs(sines_of(g).across2() - exact) <= across2_error(g) * exact);
  }));
}

// Equations (2) to (4) of docs/theory/surface-scattering.md by angles, the bubbles' F as the sum of
// fractions that it is made from: where that does not cancel. Q² has the power γ₂/2 ≤ 3.
TEST(NrlSurface, IsItsEquations) {
  EXPECT_TRUE(rc::check([] {
    const auto law = any<NrlSurface>();
    const ScatterGeometry g = any_geometry();
    const double f = any_frequency();
    const double k = 2.0 * pi * f / law.sound_speed;
    const double sin_in = std::sin(g.grazing_in), sin_out = std::sin(g.grazing_out);
    const double q = k * std::sqrt(across2_by_angles(g));
    const double interface =
        law.A_s * law.wind_speed <= 0.0 || sin_in * sin_out <= 0.0
            ? 0.0
            : std::min(1.0, 4.0 * std::pow(k, 4) * std::pow(sin_in * sin_out, 2) * law.A_s *
                                law.wind_speed / std::pow(law.h0 * q, law.gamma2));
    RC_ASSERT(std::abs(law.interface_cross_section(g, f) - interface) <=
              (1e-12 + 3.0 * across2_error(g)) * interface);
    const double d = NrlSurface::bubble_depth(law.wind_speed);
    const double p = k * d * sin_in, r = k * d * sin_out;
    const auto line = [](double x) { return 1.0 / (1.0 + x * x); };
    const double directivity = 0.5 * (1.0 - line(p) - line(r) + 0.5 * (line(p - r) + line(p + r)));
    const double bubbles = d > 0.0 ? 0.0019 * std::pow(d, 1.15) * std::pow(k, -0.6) : 0.0;
    RC_ASSERT(std::abs(law.bubble_cross_section(g, f) - bubbles * directivity) <=
              bubbles * (1e-12 * directivity + 1e-14));
    RC_ASSERT(law.cross_section(g, f) ==
              law.interface_cross_section(g, f) + law.bubble_cross_section(g, f));
  }));
}

TYPED_TEST(EverySurfaceScattering, DefaultsAreWithinTheirRanges) {
  Within within;
  look(TypeParam{}, within);
}
TYPED_TEST(EverySurfaceScattering, EveryMemberIsDescribed) { expect_described<TypeParam>(); }

}  // namespace
}  // namespace asdic::detail
