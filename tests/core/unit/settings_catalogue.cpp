#include "core/settings_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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
    field.columns(
        {{"grazing", grazing, AngleQuantity{"angle", 0.0, 90.0}, "rising"},
         {"strength_db", strength, Quantity{.noun = "strength", .unit = "dB"}, "at each"}},
        {.file = true});
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

/// What depends on something else.
struct Dependent {
  enum class Sea { calm, rough, icy };
  static constexpr std::string_view sea_words[] = {"calm", "rough", "icy"};
  friend constexpr std::span<const std::string_view> words(Sea) { return sea_words; }

  Sea sea = Sea::calm;
  double wind = 3.0, ice = 1.0, range = 0.0, slope = 0.0, level = 100.0;
  int last = std::numeric_limits<int>::max();
  std::vector<double> depth, speed, grazing;
  std::string file;
  void describe(Fields& field) {
    field("sea", sea, "how it is");
    if (const auto only = field.only("sea", sea, {Sea::rough, Sea::icy}))
      field(required("wind"), wind, Quantity{.noun = "wind"}, "over it");
    if (const auto ice_free = field.unless("sea", word_of(sea), "icy")) {
      field.excludes("no ice", {"ice"});
      field(by_default("slope", "of the wind"), slope, AngleQuantity{"slope", 0.0, 90.0}, "of it");
    }
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"range"}, true))
      field(required("range"), range, Quantity{.noun = "range"}, "of it");
    if (const auto way = field.otherwise(ways, {"depth"}))
      field.columns(
          {{"depth", depth, Quantity{}, "of samples"}, {"speed", speed, Quantity{}, "at each"}},
          {.file = true});
    field(by_default("last", "no end"), last, 1, std::numeric_limits<int>::max(), "of all");
    field("level_db", level,
          {.noun = "level", .unit = "dB", .low = 0.0, .high = 300.0, .reference = "1 µPa"},
          "of it");
  }
};

const SettingRecord& find(const std::vector<SettingRecord>& all, std::string_view path) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.path == path; });
  if (found == all.end()) throw std::runtime_error("no record " + std::string(path));
  return *found;
}

TEST(SettingsCatalogue, HasEverySettingOfEveryChoice) {
  const std::vector<SettingRecord> all = catalogue_of<Everything>().settings;
  std::vector<std::string> paths;
  for (const SettingRecord& one : all) paths.push_back(one.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"edge", "share", "count", "on", "wind", "kind",
                                             "grazing_deg", "strength_db", "file", "radius",
                                             "perhaps.position", "perhaps.heading_deg",
                                             "layer[].position", "layer[].heading_deg"}));
}

TEST(SettingsCatalogue, SaysWhatEachTakes) {
  const std::vector<SettingRecord> all = catalogue_of<Everything>().settings;
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

TEST(SettingsCatalogue, SaysUnderWhichConditionsAndWhatHoldsWithout) {
  const SettingsList list = catalogue_of<Dependent>();
  const std::vector<SettingRecord>& all = list.settings;
  EXPECT_EQ(find(all, "wind").condition, "sea = \"rough\" or \"icy\"");
  EXPECT_EQ(find(all, "wind").conditions.front().words, (std::vector<std::string>{"rough", "icy"}));
  EXPECT_EQ(find(all, "slope_deg").condition, "sea other than \"icy\"");
  EXPECT_TRUE(find(all, "slope_deg").conditions.front().other);
  EXPECT_TRUE(find(all, "slope_deg").angle);
  EXPECT_EQ(find(all, "slope_deg").standard, "");
  EXPECT_EQ(find(all, "slope_deg").otherwise, "of the wind");
  ASSERT_EQ(list.excluded.size(), 1U);
  EXPECT_EQ(list.excluded[0].keys, std::vector<std::string>{"ice"});
  EXPECT_EQ(list.excluded[0].conditions, find(all, "slope_deg").conditions);
  // Of two ways, the first is told by its key, the other by the first one's not being there.
  EXPECT_EQ(find(all, "range").condition, "");
  EXPECT_TRUE(find(all, "range").conditions.front().there);
  EXPECT_EQ(find(all, "depth").condition, "without range");
  EXPECT_EQ(find(all, "depth").help, "of samples");
  EXPECT_EQ(find(all, "speed").help, "at each");
  ASSERT_EQ(find(all, "speed").conditions.size(), 2U);  // and without a file
  EXPECT_EQ(find(all, "speed").conditions.back().absent, std::vector<std::string>{"file"});
  EXPECT_EQ(find(all, "file").conditions.size(), 1U);
  EXPECT_EQ(domain_of(find(all, "last")), "whole, at least 1");
  EXPECT_EQ(domain_of(find(all, "level_db")), "0 to 300 dB re 1 µPa");
}

TEST(SettingsCatalogue, HasTheTablesAndWhatIsBelowThem) {
  const SettingsList list = catalogue_of<Everything>();
  ASSERT_EQ(list.tables.size(), 2U);
  EXPECT_EQ(list.tables[0].path, "perhaps");
  EXPECT_TRUE(list.tables[0].may_be_absent);
  EXPECT_EQ(list.tables[1].path, "layer[]");
  EXPECT_TRUE(list.tables[1].list);
  const SettingsList layer = below(list, "layer");
  ASSERT_EQ(layer.settings.size(), 2U);
  EXPECT_EQ(layer.settings[0].path, "position");
  EXPECT_EQ(layer.settings[1].path, "heading_deg");
  EXPECT_TRUE(below(list, "lay").settings.empty());
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
