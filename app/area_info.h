#pragma once
#include <filesystem>
#include <string>

#include "app/output.h"
#include "io/result/coverage_file.h"

namespace asdic::detail::app {

/// A few lines for people.
[[nodiscard]] std::string area_text(const CoverageSummary& summary);
[[nodiscard]] std::string area_json(const CoverageSummary& summary, const ResultOrigin& origin,
                                    const std::filesystem::path& output);

/// Whether it is a file of `asdic area`.
[[nodiscard]] bool is_area_file(const std::string& path);
/// Says what one holds. \return exit status
int area_info(const std::string& path);

}  // namespace asdic::detail::app
