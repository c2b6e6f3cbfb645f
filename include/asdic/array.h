#pragma once

/// \file
/// What receives. Channels are the phones of all arrays, one array after the other.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.add("array", asdic::LineArray{.name = "bow", .phones = 32, .spacing = 0.2})
///     .add("array", asdic::PhonePositions{.name = "tetrahedron",
///                                         .positions = {{0.0, 0.0, 0.0},
///                                                       {1.0, 0.0, 0.0},
///                                                       {0.0, 1.0, 0.0},
///                                                       {0.0, 0.0, 1.0}}});
/// std::cout << scenario.get("array").size() << " arrays\n";
/// ```

#include <string>
#include <vector>

#include "asdic/units.h"
#include "asdic/value.h"

namespace asdic {

/// Phones on a straight line.
struct ASDIC_API LineArray {
  std::string name = {};
  std::string platform = {};  ///< its name; the first
  Vector offset{};            ///< of the middle from the platform [m]
  int phones = 1;
  double spacing = 1.0;      ///< from phone to phone [m]
  double heading_deg = 0.0;  ///< true, of the line; broadside is 90 degrees clockwise of it
  double pitch_deg = 0.0;    ///< of the line, positive up; 90: a vertical line
  operator Value() const;
};

/// Phones anywhere.
struct ASDIC_API PhonePositions {
  std::string name = {};
  std::string platform = {};
  Vector offset{};                  ///< [m]
  std::vector<Vector> positions{};  ///< [phones] from where the array is fixed [m]
  operator Value() const;
};

/// A line that is towed along the way its platform has come.
struct ASDIC_API TowedArray {
  std::string name = {};
  std::string platform = {};
  Vector offset{};               ///< of the tow point from the platform [m]
  std::vector<double> behind{};  ///< [phones] along the way, from the tow point [m]
  double heading_deg = 0.0;      ///< true, of a platform that never moves
  operator Value() const;
};

}  // namespace asdic
