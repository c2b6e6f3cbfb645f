#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/fields_viewer.h"

namespace asdic::detail {
namespace {

enum class Colour { red, green, blue };
constexpr std::string_view colours[] = {"red", "green", "blue"};
constexpr std::span<const std::string_view> words(Colour) { return colours; }

struct Point {
  static constexpr std::string_view name = "point";
  double x = 1.0;
  void describe(Fields& field) { field("x", x, Quantity{}, "place"); }
};
struct Disc {
  static constexpr std::string_view name = "disc";
  double radius = 2.0, sector = 3.0;
  void describe(Fields& field) {
    field("radius", radius, Quantity{}, "of its rim");
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"sector"}, sector > 0.0))
      field("sector", sector, Quantity{}, "of it");
    if (const auto way = field.otherwise(ways, {"whole"})) {
      bool whole = true;
      field("whole", whole, "all of it");
    }
  }
};
struct Picture {
  Colour colour = Colour::green;
  double depth_of_green = 4.0;
  Point inside;
  std::optional<Point> perhaps;
  std::vector<Point> several = {{5.0}, {6.0}};
  std::variant<Point, Disc> shape = Disc{};
  void describe(Fields& field) {
    field("colour", colour, "of it");
    if (const auto only = field.only("colour", colour, Colour::green))
      field("depth", depth_of_green, Quantity{}, "of the green");
    if (const auto only = field.only("colour", colour, Colour::red))
      field("never", depth_of_green, Quantity{}, "of the red");
    field("inside", inside, "within");
    field("perhaps", perhaps, "maybe within");
    field("several", several, "around");
    field.one_of("kind", shape, "its shape");
  }
};
static_assert(Described<Picture> && !Described<Colour> && Worded<Colour> && !Worded<std::byte>);

/// The numbers and flags in the order in which they are shown.
class Seen final : public FieldsViewer {
 public:
  explicit Seen(bool all = false) : all_(all) {}
  [[nodiscard]] bool exhaustive() const override { return all_; }
  std::vector<std::string> seen;

 private:
  void number(const Setting& s, const Quantity&, double& value, bool*) override {
    seen.push_back(std::string(s.key.name) + "=" + std::to_string(static_cast<int>(value)));
  }
  void flag(const Setting& s, bool&) override { seen.emplace_back(s.key.name); }
  void begin(const Condition& condition) override {
    seen.push_back("if " + std::string(condition.key) + (condition.other ? " not" : ""));
    for (const std::string_view word : condition.words) seen.back() += " " + std::string(word);
  }
  void end() override { seen.emplace_back("end"); }
  bool all_;
};

TEST(Fields, WordsHaveTheOrderOfTheirEnumeration) {
  static_assert(word_of(Colour::blue) == "blue");
  EXPECT_EQ(word_of(Colour::red), "red");
}

TEST(Fields, AViewerSeesWhatThereIsInOrder) {
  Seen walker;
  look(Picture{}, walker);
  EXPECT_THAT(walker.seen, testing::ElementsAre("if colour green", "depth=4", "end", "x=1", "x=5",
                                                "x=6", "radius=2", "if sector", "sector=3", "end"));
}

TEST(Fields, OfSeveralWaysAStructHasTheOneThatItIs) {
  Seen walker;
  look(Disc{.radius = 1.0, .sector = 0.0}, walker);
  EXPECT_THAT(walker.seen, testing::ElementsAre("radius=1", "if whole", "whole", "end"));
}

TEST(Fields, AnExhaustiveWalkSeesWhatMayBe) {
  Seen walker(true);
  look(Disc{}, walker);
  look(Picture{.several = {}, .shape = Point{}}, walker);
  EXPECT_THAT(walker.seen,
              testing::ElementsAre("radius=2", "if sector", "sector=3", "end", "if whole", "whole",
                                   "end", "if colour green", "depth=4", "end", "if colour red",
                                   "never=4", "end", "x=1", "x=1"));
}

}  // namespace
}  // namespace asdic::detail
