#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/settings_words.h"

namespace asdic::detail {
namespace {

enum class Side { port, starboard };
constexpr std::string_view sides[] = {"port", "starboard"};
constexpr std::span<const std::string_view> words(Side) { return sides; }

struct One {
  static constexpr std::string_view name = "one";
  double a = 1.0;
  void describe(Fields& field) { field("a", a, Quantity{}, "a"); }
};
struct Two {
  static constexpr std::string_view name = "two";
  double b = 1.0;
  void describe(Fields& field) { field("b", b, Quantity{}, "b"); }
};
struct All {
  std::string text;
  double number = 1.0, angle = 2.0, worked_out = 3.0;
  std::optional<double> maybe;
  int whole = 4, friend_of = 0;
  bool flag = false;
  Side side = Side::port;
  Vec3 place = Vec3::Zero();
  std::vector<double> numbers, angles, column = {1.0}, other_column = {1.0};
  std::vector<Vec3> places;
  One inner;
  std::optional<One> perhaps;
  std::vector<One> several;
  std::variant<One, Two> either;

  void describe(Fields& field) {
    const AngleQuantity any_angle{"angle", -1e9, 1e9};
    field("text", text, "text");
    field("number", number, Quantity{}, "number");
    field("angle", angle, any_angle, "angle");
    field.derived(worked_out);
    field("maybe", maybe, Quantity{}, "maybe");
    field("whole", whole, 0, 9, "whole");
    field.reference("friend_of", friend_of, "ship", "friend");
    field("flag", flag, "flag");
    field("side", side, "side");
    field("place", place, Quantity{}, "place");
    field("numbers", numbers, Quantity{}, "numbers");
    field("angles", angles, any_angle, "angles");
    field.columns(
        {{"column", column, Quantity{}, "one"}, {"other", other_column, any_angle, "other"}}, {});
    field("places", places, Quantity{}, "places");
    field("inner", inner, "inner");
    field("perhaps", perhaps, "perhaps");
    field("several", several, "several");
    field.one_of("either", either, "either");
  }
};

// One way and another that hold the same numbers are resolved.
struct Place {
  bool by_range = false;
  double number = 1.0;
  void describe(Fields& field) {
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"range"}, by_range))
      field("range", number, Quantity{}, "range");
    if (const auto way = field.otherwise(ways, {"depth"}))
      field("depth", number, Quantity{}, "depth");
  }
};
TEST(SettingsWords, TellApartWaysToSayOneThing) {
  EXPECT_NE(settings_words(Place{.by_range = true}), settings_words(Place{.by_range = false}));
}

// Whatever changes a result changes the words; what does not (a name, a text) leaves them.
TEST(SettingsWords, TellApartWhatDiffersInAnySetting) {
  const std::vector<void (*)(All&)> changes = {
      [](All& all) { all.number = -1.0; },
      [](All& all) { all.angle = 0.0; },
      [](All& all) { all.worked_out = 0.0; },
      [](All& all) { all.maybe = 0.0; },
      [](All& all) { all.whole = 5; },
      [](All& all) { all.friend_of = 1; },
      [](All& all) { all.flag = true; },
      [](All& all) { all.side = Side::starboard; },
      [](All& all) { all.place.z() = 1.0; },
      [](All& all) { all.numbers = {0.0}; },
      [](All& all) { all.angles = {0.0}; },
      [](All& all) { all.column = {2.0}; },
      [](All& all) { all.other_column = {2.0}; },
      [](All& all) { all.places = {Vec3::Zero()}; },
      [](All& all) { all.inner.a = 0.0; },
      [](All& all) { all.perhaps = One{}; },
      [](All& all) { all.several = {One{}}; },
      [](All& all) { all.either = Two{}; },
      [](All& all) { std::get<One>(all.either).a = 0.0; },
  };
  std::vector<std::vector<std::uint64_t>> seen{settings_words(All{})};
  for (const auto& change : changes) {
    All all;
    change(all);
    for (const auto& other : seen) EXPECT_NE(settings_words(all), other) << seen.size();
    seen.push_back(settings_words(all));
  }
  EXPECT_EQ(settings_words(All{.text = "another"}), seen.front());
}

}  // namespace
}  // namespace asdic::detail
