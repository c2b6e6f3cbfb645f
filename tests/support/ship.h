#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/fields.h"
#include "core/quantities.h"

/// A struct with settings of every kind, for tests of what walks over settings.
namespace asdic::detail::support {

enum class Paint { none, matt, gloss };
constexpr std::string_view paint_words[] = {"none", "matt", "gloss"};
constexpr std::span<const std::string_view> words(Paint) { return paint_words; }

struct Mast {
  std::string name;
  double height = 10.0;
  void describe(Fields& field) {
    field.name(name, "of the mast");
    field(live("height"), height, {.noun = "height", .unit = "m", .low = 0.0}, "above deck");
  }
};
struct Sail {
  static constexpr std::string_view name = "sail";
  int mast = 0;
  double area = 50.0;
  void describe(Fields& field) {
    field.reference("on", mast, "mast", "that it hangs on");
    field("sailcloth", area, {.noun = "area", .unit = "m2", .low = 0.0, .high = 500.0}, "of cloth");
  }
};
struct Engine {
  static constexpr std::string_view name = "engine";
  std::vector<double> speed = {1.0, 2.0}, angle = {0.0, 0.1};
  void describe(Fields& field) {
    field.columns({{"depth", speed, quantity::depth, "of the screw"},
                   {"pitch", angle, quantity::elevation, "of its blades"}},
                  {.increasing = true, .file = true});
  }
};
struct Anchor {
  int links = 3;
  void describe(Fields& field) { field(required("links"), links, 1, 100, "of its chain"); }
};
struct Tanks {
  std::vector<double> depth, mass;
  void describe(Fields& field) {
    field.columns({{"depth", depth, quantity::depth, "from the deck down"},
                   {"mass", mass, Quantity{}, "of each tank"}},
                  {.steps = true});
  }
};
struct Ship {
  double length = 20.0;
  double heading = radians(90.0);
  double wind = 0.0;
  double derived_mass = 7.0;
  std::optional<double> draught, list;
  std::optional<int> crew;
  int decks = 1;
  bool armed = false;
  std::string flag = "white";
  Paint paint = Paint::matt;
  double shine = 0.5;
  Vec3 place = Vec3::Zero();
  Vec2 course = {1.0, 2.0};
  std::vector<double> gauges, bearings;
  std::vector<Vec3> lamps;
  std::vector<Mast> masts;
  std::variant<Sail, Engine> drive;
  Anchor anchor;
  std::optional<Anchor> spare;
  double range = 0.0, east = 0.0;
  std::optional<int> bounces = 7;
  std::optional<double> trim = 0.0;
  std::vector<double> portholes;
  std::string chart;
  std::vector<std::vector<double>> seats;
  double ballast = 5.0;
  std::optional<Tanks> tanks;
  bool leaks = false;
  std::string motto;

  void describe(Fields& field) {
    field(required("length"), length, {.noun = "length", .unit = "m", .low = 0.0, .above = true},
          "between perpendiculars");
    field.know("twice", 2.0 * length);
    field("heading", heading, quantity::heading, "of the bow");
    field(inherited("wind", "environment.wind_speed"), wind, quantity::wind_speed, "over deck");
    field.derived(derived_mass);
    field("draught", draught, quantity::depth, "of the keel");
    field("list", list, quantity::elevation, "to starboard");
    field("crew", crew, 1, 9, "on board");
    field("decks", decks, 1, 9, "in all");
    field("armed", armed, "whether there are guns");
    field("flag", flag, "that it flies");
    field("paint", paint, "of the hull");
    if (const auto only = field.only("paint", paint, Paint::gloss))
      field(required("shine"), shine, {.noun = "share", .low = 0.0, .high = 1.0}, "of the light");
    field("place", place, quantity::coordinate, "of the bow", "[fore, starboard, down]");
    field("course", course, quantity::velocity, "through the water");
    field("gauges", gauges, quantity::depth, "along the keel");
    field("bearings", bearings, quantity::bearing, "of its lights");
    field("lamps", lamps, quantity::coordinate, "around it");
    field("mast", masts, "from the bow", {.one_or_more = true, .named = "mast"});
    field(or_word("bounces", "auto"), bounces, 0, 9, "of the sounder");
    field(seldom(or_word("trim", "level")), trim, quantity::coordinate, "by the stern");
    field.axis("portholes", portholes, quantity::range, "from the bow");
    field.file("chart", chart, "a chart that is there", "of the harbour");
    field("seats", seats, quantity::range, "of the galley, bench by bench");
    field("ballast", ballast, {.noun = "mass", .unit = "t", .low = 0.0}, tanks, "in the hold");
    field.remark("for the owner");
    field(seldom("leaks"), leaks, "whether it does");
    field(seldom("motto"), motto, "of the crew");
    field.one_of("kind", drive, "what moves it");
    field(required("anchor"), anchor, "at the bow");
    field("spare", spare, "below deck");
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"range", "east"}, range > 0.0)) {
      field("range", range, quantity::range, "from the origin");
      field("east", east, quantity::range, "of it");
    }
    if (const auto way = field.otherwise(ways, {"north", "east"}))
      field("east", east, quantity::range, "of the origin");
    if (field.checks() && field.known("twice") > 1000.0)
      field.fault("length", "a ship that fits the harbour");
  }
};

}  // namespace asdic::detail::support
