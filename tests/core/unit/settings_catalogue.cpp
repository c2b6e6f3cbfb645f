#include "core/settings_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

namespace asdic::detail {
namespace {

enum class Edge { none, tukey };
constexpr std::string_view edge_words[] = {"none", "tukey"};
constexpr std::span<const std::string_view> words(Edge) { return edge_words; }

struct Ball {
  static constexpr std::string_view name = "ball";
  double radius = 2.0;
  void describe(Fields& field) {
    field(live(SettingKey("radius")), radius,
          {.noun = "radius", .unit = "m", .low = 0.0, .high = 5.0, .above = true}, "of its rim");
  }
};
struct Table {
  static constexpr std::string_view name = "table";
  std::vector<double> grazing, strength;
  void describe(Fields& field) {
    field.columns({{"grazing", grazing, AngleQuantity{"angle", 0.0, 90.0}},
                   {"strength_db", strength, Quantity{.noun = "strength", .unit = "dB"}}},
                  {.file = true}, "over angle");
  }
};
struct Place {
  Vec3 position = Vec3(1.0, 2.0, 3.0);
  std::optional<double> heading;
  void describe(Fields& field) {
    field("position", position, Quantity{.noun = "coordinate", .unit = "m"}, "of it");
    field("heading", heading, AngleQuantity{"heading", -360.0, 360.0}, "where it looks");
  }
};
struct Everything {
  Edge edge = Edge::none;
  double share = 0.5;
  int count = 3;
  bool on = true;
  double inherited_wind = 0.0;
  std::variant<Table, Ball> body = Ball{4.0};
  std::optional<Place> perhaps;
  std::vector<Place> several;
  void describe(Fields& field) {
    field("edge", edge, "how it ends");
    if (const auto only = field.only("edge", edge, Edge::tukey))
      field("share", share, {.noun = "share", .low = 0.0, .high = 1.0}, "of the ends");
    field(required("count"), count, 1, 4096, "how many");
    field("on", on, "whether it is");
    field(inherited("wind", "environment.wind_speed"), inherited_wind,
          {.noun = "wind", .unit = "m/s", .low = 0.0}, "over it");
    field.one_of("kind", body, "what it is");
    field("perhaps", perhaps, "may be there");
    field("layer", several, "of them");
  }
};

const SettingRecord& find(const std::vector<SettingRecord>& all, std::string_view path) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.path == path; });
  if (found == all.end()) throw std::runtime_error("no record " + std::string(path));
  return *found;
}

TEST(SettingsCatalogue, HasEverySettingOfEveryChoice) {
  const std::vector<SettingRecord> all = catalogue_of<Everything>();
  std::vector<std::string> paths;
  for (const SettingRecord& one : all) paths.push_back(one.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"edge", "share", "count", "on", "wind", "kind",
                                             "grazing_deg", "strength_db", "file", "radius",
                                             "perhaps.position", "perhaps.heading_deg",
                                             "layer[].position", "layer[].heading_deg"}));
}

TEST(SettingsCatalogue, SaysWhatEachTakes) {
  const std::vector<SettingRecord> all = catalogue_of<Everything>();
  EXPECT_EQ(domain_of(find(all, "edge")), "`none`, `tukey`");
  EXPECT_EQ(find(all, "edge").standard, "\"none\"");
  EXPECT_EQ(find(all, "share").condition, "edge = \"tukey\"");
  EXPECT_EQ(domain_of(find(all, "share")), "0 to 1");
  EXPECT_TRUE(find(all, "count").required);
  EXPECT_EQ(find(all, "count").standard, "");
  EXPECT_EQ(domain_of(find(all, "count")), "whole, 1 to 4096");
  EXPECT_EQ(find(all, "on").standard, "true");
  EXPECT_EQ(find(all, "wind").inherits, "environment.wind_speed");
  EXPECT_EQ(domain_of(find(all, "wind")), "at least 0 m/s");
  EXPECT_EQ(domain_of(find(all, "grazing_deg")), "numbers, 0 to 90 degrees");
  EXPECT_EQ(find(all, "grazing_deg").condition, "kind = \"table\"");
  EXPECT_EQ(domain_of(find(all, "radius")), "above 0, to 5 m");
  EXPECT_TRUE(find(all, "radius").live);
  EXPECT_EQ(find(all, "perhaps.position").standard, "[1, 2, 3]");
  EXPECT_EQ(find(all, "perhaps.heading_deg").standard, "");
  EXPECT_EQ(domain_of(find(all, "perhaps.heading_deg")), "-360 to 360 degrees");
}

// A choice that is not the usual one has its own defaults; what is shown is put back.
TEST(SettingsCatalogue, PutsBackWhatItIsShown) {
  Everything shown;
  SettingsCatalogue walker;
  shown.describe(walker);
  EXPECT_TRUE(std::holds_alternative<Ball>(shown.body));
  EXPECT_FALSE(shown.perhaps);
  EXPECT_TRUE(shown.several.empty());
}

}  // namespace
}  // namespace asdic::detail
