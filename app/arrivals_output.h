#pragma once
#include <filesystem>
#include <string>

#include "app/output.h"
#include "io/result/result_json.h"

namespace asdic::detail::app {

[[nodiscard]] std::string arrivals_table(const ArrivalsResult& result);
/// docs/formats/arrivals.md \throws RunError
void write_arrivals_file(OutputFile&& to, const ArrivalsResult& result);

/// The parts of these for one list of paths.
[[nodiscard]] std::string paths_table(const Arrivals& arrivals);
/// What the columns mean, under the tables.
[[nodiscard]] std::string arrivals_legend(double frequency);

}  // namespace asdic::detail::app
