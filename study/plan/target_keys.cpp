#include "study/plan/target_keys.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/geometry.h"
#include "io/scenario/scenario_reader.h"

namespace asdic::detail::study {
namespace {

/// "target.2.range" → 2 and "range"; "target.2" → 2 and "".
struct TargetKey {
  std::size_t target = 0;
  std::string key;
};

std::optional<TargetKey> target_key(std::string_view path) {
  constexpr std::string_view head = "target.";
  if (!path.starts_with(head)) return std::nullopt;
  path.remove_prefix(head.size());
  TargetKey found;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), found.target);
  if (error != std::errc{}) return std::nullopt;
  path.remove_prefix(static_cast<std::size_t>(end - path.data()));
  if (!path.empty() && path.front() == '.') found.key = path.substr(1, path.find('.', 1) - 1);
  return found;
}

void remove(TomlValue& table, std::initializer_list<std::string_view> keys) {
  if (TomlValue::Table* entries = table.table())
    std::erase_if(*entries, [&](const TomlEntry& entry) {
      return std::find(keys.begin(), keys.end(), entry.key) != keys.end();
    });
}

/// position → range, bearing_deg, depth.
void to_polar(TomlValue& table, const Vec3& from, const Vec3& place) {
  const std::string origin = table.find("position")->origin;
  const Separation apart = separation(from, place);
  remove(table, {"position"});
  for (const auto& [key, value] : {std::pair<const char*, double>{"range", apart.range},
                                   {"bearing_deg", compass_degrees(apart.bearing)},
                                   {"depth", place.z()}})
    value_at(table, key, origin) = {.data = value, .origin = origin};
}

}  // namespace

void make_room(const std::vector<Variable>& variables, const std::filesystem::path& path,
               TomlValue& scenario) {
  TomlValue* targets = scenario.find("target");
  auto* list = targets == nullptr ? nullptr : std::get_if<TomlValue::Array>(&targets->data);
  if (list == nullptr) return;
  std::set<std::size_t> polar;
  for (const Variable& variable : variables)
    for (const std::string& key : variable.keys) {
      const std::optional<TargetKey> found = target_key(key);
      if (!found || found->target >= list->size()) continue;
      TomlValue& target = (*list)[found->target];
      const bool is_track = places(variable.law);
      if (found->key == "range" || found->key == "bearing_deg" || found->key == "depth")
        polar.insert(found->target);
      else if (found->key == "position" || is_track)
        remove(target, {"range", "bearing_deg", "depth", "waypoints"});
      else if (found->key == "waypoints")
        remove(target, {"position", "velocity", "range", "bearing_deg", "depth"});
    }
  if (std::none_of(polar.begin(), polar.end(),
                   [&](std::size_t t) { return (*list)[t].find("position") != nullptr; }))
    return;
  const Scenario as_it_stands = scenario_of(scenario, path);
  for (const std::size_t t : polar)
    if ((*list)[t].find("position") != nullptr)
      to_polar((*list)[t], as_it_stands.platforms[0].track.start.position,
               as_it_stands.targets[t].track.start.position);
}

}  // namespace asdic::detail::study
