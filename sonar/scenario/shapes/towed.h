#pragma once
#include "core/fields.h"
#include "core/quantities.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {

/// kind = "towed": phones on the path of the tow point, which its platform lays.
struct TowedShape {
  static constexpr std::string_view name = "towed";
  TowedLine line = {};

  void describe(Fields& field) {
    field(live(required("behind")), line.behind,
          {.noun = "distance", .unit = "m", .low = 0.0, .high = 1e5},
          "of each phone behind the tow point, along its path");
    field(live("heading"), line.heading, quantity::heading,
          "true, of a tow point that never moves");
  }
  void build(ReceiverArray& array) const {
    array.towed = line;
    array.phones.resize(line.behind.size());  // placed when the platforms are known
  }
};

}  // namespace asdic::detail
