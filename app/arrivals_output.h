#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/output.h"
#include "raytrace/area/earth_places.h"
#include "sonar/ping/ping_record.h"

namespace asdic::detail::app {

/// Eigenrays that were found, and for what.
struct ArrivalsResult {
  ResultOrigin origin;
  std::vector<std::string> targets;  ///< their names
  int ping = 1;
  double frequency = 0.0;                           ///< [Hz]
  bool to_receiver = false;                         ///< one leg, from a source to a free receiver
  double source_depth = 0.0, receiver_depth = 0.0;  ///< of that leg [m]
  std::vector<Leg> legs;
  EarthPlaces earth{};  ///< where their map is
};

[[nodiscard]] std::string arrivals_table(const ArrivalsResult& result);
/// docs/formats/arrivals.md
[[nodiscard]] std::string arrivals_json(const ArrivalsResult& result);
/// docs/formats/arrivals.md \throws RunError
void write_arrivals_file(OutputFile&& to, const ArrivalsResult& result);

/// The parts of these for one list of paths.
[[nodiscard]] std::string paths_table(const Arrivals& arrivals);
[[nodiscard]] std::string paths_json(const Arrivals& arrivals);
/// What the columns mean, under the tables.
[[nodiscard]] std::string arrivals_legend(double frequency);

}  // namespace asdic::detail::app
