#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sonar/ping_record.h"
#include "sonar/scenario.h"

namespace asdic::app {

/// Eigenrays that were found, and for what.
struct ArrivalsResult {
  const Scenario* scenario = nullptr;
  int ping = 1;
  double frequency = 0.0;    ///< [Hz]
  bool to_receiver = false;  ///< one leg, from a source to a free receiver
  std::vector<Leg> legs;
};

[[nodiscard]] std::string arrivals_table(const ArrivalsResult& result);
/// docs/formats/arrivals.md
[[nodiscard]] std::string arrivals_json(const ArrivalsResult& result);
/// docs/formats/arrivals.md \throws RunError
void write_arrivals_file(const std::filesystem::path& path, const ArrivalsResult& result);

}  // namespace asdic::app
