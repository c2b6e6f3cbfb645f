#pragma once
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/quantities.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {

/// Of every ping in turn: where the phones are. As many as in the first of the shapes.
struct PhonePlaces {
  static constexpr std::string_view phones_of_first = "phones of the first shape";
  std::vector<Vec3> positions = {};

  void describe(Fields& field) {
    field(required("positions"), positions, quantity::coordinate, "of the phones");
    if (!field.checks()) return;
    const auto phones = static_cast<double>(positions.size());
    const double first = field.known(phones_of_first);
    if (first == 0.0)
      field.know(phones_of_first, phones);
    else if (first != phones)
      field.fault("positions",
                  "as many phones as in the first shape, " +
                      std::to_string(static_cast<std::size_t>(first)),
                  std::to_string(positions.size()));
  }
};

/// kind = "positions": phones one by one, in one shape or in one for each ping in turn. Every array
/// that is not towed can be told so, bit for bit.
struct PositionsShape {
  static constexpr std::string_view name = "positions";
  std::vector<Vec3> positions = {};
  std::vector<PhonePlaces> shapes = {};

  void describe(Fields& field) {
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"shapes"}, !shapes.empty())) {
      field.know(PhonePlaces::phones_of_first, 0.0);
      field("shapes", shapes, "of each ping in turn, repeated as needed: { positions }");
      if (field.checks() && shapes.empty()) field.fault("shapes", "at least one { positions }");
    }
    if (const auto way = field.otherwise(ways, {"positions"}))
      field(required(live("positions")), positions, quantity::coordinate, "of the phones");
  }
  void build(ReceiverArray& array) const {
    for (const PhonePlaces& one : shapes) array.shapes.push_back(one.positions);
    array.phones = shapes.empty() ? positions : shapes.front().positions;
  }
};

}  // namespace asdic::detail
