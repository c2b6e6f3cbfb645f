#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/fields.h"

namespace asdic::detail {

/// A file that an ocean was made of.
struct OceanSource {
  std::string quantity;  ///< "temperature"
  std::string name;      ///< of the file, without its folder
  std::string variable;  ///< "t_an"
  std::string digest;    ///< "sha256:…": which version of the file it was
  std::string time;      ///< what was averaged or interpolated in time

  void describe(Fields& field);
  [[nodiscard]] bool operator==(const OceanSource&) const = default;
};

/// Where on the Earth the map of a scenario lies, and what its ocean was made of:
/// [environment.origin]. Nothing is computed of it but latitudes and longitudes of results.
struct OceanOrigin {
  double latitude = 0.0, longitude = 0.0;  ///< of the map's [0, 0], north and east [rad]
  std::string time;                        ///< that was asked for: "2024-02-29", "month 3"
  std::vector<OceanSource> sources;

  void describe(Fields& field);
  /// "temperature: woa23_t03.nc, t_an, mean of … (sha256:…)": a line for each source.
  [[nodiscard]] std::vector<std::string> source_lines() const;
  [[nodiscard]] bool operator==(const OceanOrigin&) const = default;
};

}  // namespace asdic::detail
