#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "io/scenario/sections.h"

namespace asdic::scenario {

/// `waypoints`, an array of { time, position }: strictly later one by one, no faster than any
/// vessel.
std::vector<Waypoint> read_waypoints(TomlTable& table);

/// Keys that cannot stand beside another one. \throws InputError at the first that does
void exclude(TomlTable& table, const std::string& key, const std::vector<std::string>& others);

/// The index of the one in a list that a key names; without the key the first.
template <class Named>
int read_reference(TomlTable& table, const std::string& key, const std::vector<Named>& list) {
  if (!table.has(key)) return 0;
  std::vector<std::string> names;
  for (const Named& one : list) names.push_back(one.name);
  const std::string name = table.choice(key, names);
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// A name that no other of a list has; by default `what`, with its number where there are several.
template <class Named>
std::string read_name(TomlTable& table, const std::string& what, const std::vector<Named>& before,
                      std::size_t count) {
  std::string fallback = what;
  if (count > 1) fallback.append(" ").append(std::to_string(before.size() + 1));
  std::string name = table.text("name", fallback);
  for (const Named& other : before)
    if (other.name == name) throw table.fault("name", "a name that no other " + what + " has");
  return name;
}

}  // namespace asdic::scenario
