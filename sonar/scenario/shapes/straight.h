#pragma once
#include "core/fields.h"
#include "core/quantities.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {

/// Phones of a straight line, evenly spaced around its centre.
struct StraightLine {
  int phones = 1;
  double spacing = 1.0;  ///< from phone to phone [m]

  void describe(Fields& field) {
    field(required("phones"), phones, 1, 4096, "how many");
    const SettingKey key = live(by_default("spacing", "required of more than one phone"));
    field(phones == 1 ? key : required(key), spacing,
          {.noun = "spacing", .unit = "m", .low = 1e-5, .high = 1e4}, "from phone to phone");
  }
  /// \param heading, pitch  of the line [rad], line_array()
  void build(ReceiverArray& array, double heading, double pitch) const {
    array.phones = line_array(phones, spacing, heading, pitch).phones;
  }
};

/// kind = "horizontal".
struct HorizontalShape {
  static constexpr std::string_view name = "horizontal";
  StraightLine line = {};
  double heading = 0.0;  ///< clockwise from north; broadside is a right angle further [rad]

  void describe(Fields& field) {
    line.describe(field);
    field(live("heading"), heading, quantity::heading,
          "true, of the line; broadside is 90 degrees clockwise of it");
  }
  void build(ReceiverArray& array) const { line.build(array, heading, 0.0); }
};

/// kind = "vertical": the first phone is the deepest.
struct VerticalShape {
  static constexpr std::string_view name = "vertical";
  StraightLine line = {};

  void describe(Fields& field) { line.describe(field); }
  void build(ReceiverArray& array) const { line.build(array, 0.0, pi / 2.0); }
};

/// kind = "line".
struct LineShape {
  static constexpr std::string_view name = "line";
  StraightLine line = {};
  double heading = 0.0;  ///< clockwise from north; broadside is a right angle further [rad]
  double pitch = 0.0;    ///< above the horizontal, positive up [rad]

  void describe(Fields& field) {
    line.describe(field);
    field(live("heading"), heading, quantity::heading,
          "true, of the line; broadside is 90 degrees clockwise of it");
    field(live("pitch"), pitch, AngleQuantity{"pitch", -90.0, 90.0}, "of the line, positive up");
  }
  void build(ReceiverArray& array) const { line.build(array, heading, pitch); }
};

}  // namespace asdic::detail
