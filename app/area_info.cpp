#include "app/area_info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/result_info.h"
#include "io/result/result_file.h"

namespace asdic::detail::app {

std::string area_text(const CoverageSummary& summary) {
  std::string text =
      emphasised(summary.title.empty() ? "an area" : summary.title) +
      fmt::format("\narea       {} bearings x {} ranges to {:g} km around {}, {} sends, {:g} Hz\n",
                  summary.bearings, summary.ranges, 1e-3 * summary.reach, summary.array,
                  summary.transmitter, summary.frequency);
  for (const CoverageSummary::Layer& layer : summary.layers)
    text += !layer.in_water ? fmt::format("depth      {:g} m: in the water nowhere\n", layer.depth)
                            : fmt::format(
                                  "depth      {:g} m: detected half of the time and more in {:.3g} "
                                  "% of the water, half of "
                                  "all round to {:.3g} km; no ray comes to {:.3g} %\n",
                                  layer.depth, 100.0 * layer.detected_share, 1e-3 * layer.farthest,
                                  100.0 * layer.no_path_share);
  return text;
}

std::string area_json(const CoverageSummary& summary, const ResultOrigin& origin,
                      const std::filesystem::path& output) {
  using nlohmann::ordered_json;
  ordered_json depths = ordered_json::array();
  for (const CoverageSummary::Layer& layer : summary.layers)
    depths.push_back({{"depth", layer.depth},
                      {"detected_pct", 100.0 * layer.detected_share},
                      {"half_of_bearings_to", layer.farthest},
                      {"no_path_pct", 100.0 * layer.no_path_share}});
  const ordered_json all = {{"filetype", "asdic area summary"},
                            {"version", "1.0"},
                            {"title", summary.title},
                            {"scenario", origin.path},
                            {"output", output.string()},
                            {"frequency_hz", summary.frequency},
                            {"transmitter", summary.transmitter},
                            {"array", summary.array},
                            {"bearings", summary.bearings},
                            {"ranges", summary.ranges},
                            {"reach", summary.reach},
                            {"depths", depths},
                            {"warnings", origin.warnings}};
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

bool is_area_file(const std::string& path) { return filetype_of(path) == "asdic area"; }

int area_info(const std::string& path) {
  const CoverageSummary summary = read_coverage_summary(path);
  std::string text = area_text(summary);
  const std::size_t first = text.find('\n') + 1;
  text.insert(first, result_file_line(path, "area"));
  print(text + result_origin(path));
  return 0;
}

}  // namespace asdic::detail::app
