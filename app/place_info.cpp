#include "app/place_info.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/result_info.h"
#include "io/result/result_file.h"

namespace asdic::detail::app {
namespace {

using study::PlacementAnswer;

std::string percent(double share) { return fmt::format("{:.4g} %", 100.0 * share); }

/// "120", "4.6e+08": how many sets there are.
std::string number_text(double count) {
  return count < 1e7 ? fmt::format("{:.0f}", count) : fmt::format("{:.2g}", count);
}

std::string set_text(const std::vector<PlacementAnswer::Sensor>& set) {
  std::string text;
  for (const PlacementAnswer::Sensor& one : set)
    text += fmt::format("{}{} at [{:g}, {:g}] km", text.empty() ? "" : ", ", one.option,
                        1e-3 * one.east, 1e-3 * one.north);
  return text;
}

/// How sure it is that no other set is better on these maps.
std::string search_text(const PlacementAnswer& a) {
  std::string text =
      fmt::format("greedy {}, after {} {}", percent(a.greedy),
                  count_of(static_cast<std::size_t>(a.swaps), "swap"), percent(a.swapped));
  if (a.proved) return text + fmt::format("; no set of the {} is better", number_text(a.sets));
  return text + fmt::format("; best that was found {}, no set of the {} is above {}",
                            percent(a.value), number_text(a.sets), percent(a.upper_bound));
}

/// Whether the best set and the runner-up can be told apart.
std::string verdict(const PlacementAnswer& a) {
  if (a.runner_up.empty()) return "there is no other set\n";
  std::string text = fmt::format("{}\n", set_text(a.runner_up));
  if (a.judging == 0)
    return text + fmt::format(
                      "           {} less, on the same map: nothing was drawn that could "
                      "tell how sure that is\n",
                      percent(a.difference));
  text += fmt::format(
      "           the best has {} more ({} to {} at {:g} %), in {} of {} draws more, in {} less\n",
      percent(a.difference), percent(a.low), percent(a.high), 100.0 * a.confidence, a.better,
      a.judging, a.worse);
  if (!a.told_apart) return text + "           the two cannot be told apart by these draws\n";
  return text + (a.difference > 0.0 ? "           the best set is better\n"
                                    : "           the runner-up is better in fresh draws: more "
                                      "draws are needed to choose\n");
}

}  // namespace

std::string placement_text(const PlacementAnswer& a) {
  std::string text = emphasised(a.title.empty() ? "a placement" : a.title) + '\n';
  text += fmt::format(
      "placement  {}{} at {}{}{}\n", count_of(a.sensors, "sensor"),
      a.multistatic ? ", each hears the pings of all," : "", count_of(a.places, "place"),
      a.candidates > a.places ? fmt::format(", {} candidates", a.candidates) : "",
      a.at_least > 1 ? fmt::format("; {} detections count as one", a.at_least) : "");
  for (std::size_t m = 0; m < a.best.size(); ++m)
    text += fmt::format("{:<10} {}; without it {}\n", m == 0 ? "best set" : "",
                        set_text({a.best[m]}), percent(a.best[m].without));
  text += fmt::format("detected   {} of the area, weighted", percent(a.share));
  if (std::isfinite(a.deviation))
    text += fmt::format(", {} from draw to draw ({} that did not choose)", percent(a.deviation),
                        count_of(a.judging, "draw"));
  text += fmt::format("\nweakest    a cell with {}; {} has less than a half\n", percent(a.least),
                      percent(a.below_half));
  text += "search     " + search_text(a) + '\n';
  text += "runner-up  " + verdict(a);
  return text;
}

std::string placement_json(const PlacementAnswer& a, const std::filesystem::path& plan,
                           const std::filesystem::path& output) {
  using nlohmann::ordered_json;
  const auto set = [](const std::vector<PlacementAnswer::Sensor>& sensors, bool best) {
    ordered_json list = ordered_json::array();
    for (const PlacementAnswer::Sensor& one : sensors) {
      ordered_json entry = {{"east", one.east}, {"north", one.north}, {"option", one.option}};
      if (best) entry["share_without"] = one.without;
      list.push_back(entry);
    }
    return list;
  };
  const auto known = [](double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
  };
  const ordered_json all = {{"filetype", "asdic placement summary"},
                            {"version", "1.0"},
                            {"title", a.title},
                            {"plan", plan.string()},
                            {"output", output.string()},
                            {"sensors", a.sensors},
                            {"at_least", a.at_least},
                            {"multistatic", a.multistatic},
                            {"best", set(a.best, true)},
                            {"share", a.share},
                            {"share_deviation", known(a.deviation)},
                            {"least_probability", a.least},
                            {"below_half_share", a.below_half},
                            {"silent_share", a.silent},
                            {"sets", a.sets},
                            {"proved", a.proved},
                            {"share_of_choosing_draws", a.value},
                            {"greedy_share", a.greedy},
                            {"swapped_share", a.swapped},
                            {"upper_bound", a.upper_bound},
                            {"runner_up", set(a.runner_up, false)},
                            {"draws", a.draws},
                            {"judging_draws", a.judging},
                            {"confidence", a.confidence},
                            {"difference", known(a.difference)},
                            {"difference_low", known(a.low)},
                            {"difference_high", known(a.high)},
                            {"better_draws", a.better},
                            {"worse_draws", a.worse},
                            {"told_apart", a.told_apart},
                            {"warnings", a.warnings}};
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

bool is_placement_file(const std::string& path) { return filetype_of(path) == "asdic placement"; }

int placement_info(const std::string& path) {
  const PlacementAnswer answer = study::read_placement_answer(path);
  std::string text = placement_text(answer);
  text.insert(text.find('\n') + 1, result_file_line(path, "placement"));
  for (const std::string& one : answer.warnings) text += "warning    " + one + '\n';
  print(text);
  return 0;
}

}  // namespace asdic::detail::app
