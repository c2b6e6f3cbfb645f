#include "io/scenario/angles.h"

#include "core/text.h"
#include "core/units.h"

namespace asdic::detail::scenario {
namespace {

bool is_in_radians(const std::string& key) { return key.ends_with("_rad"); }

}  // namespace

bool has_angle(TomlTable& table, const std::string& name) {
  const bool degrees = table.has(name + "_deg"), radians = table.has(name + "_rad");
  return degrees || radians;
}

std::string angle_key(TomlTable& table, const std::string& name) {
  const std::string degrees = name + "_deg", radians = name + "_rad";
  if (!table.has(radians)) return degrees;
  if (table.has(degrees))
    throw table.fault(radians, "no " + in_quotes(radians) + " beside " + degrees);
  return radians;
}

double read_angle(TomlTable& table, const std::string& name, const AngleQuantity& quantity,
                  std::optional<double> fallback_rad) {
  const std::string key = angle_key(table, name);
  if (fallback_rad && !table.has(key)) return *fallback_rad;
  if (is_in_radians(key)) return table.number(key, quantity.in_radians());
  return radians(table.number(key, quantity.in_degrees()));
}

std::vector<double> read_angles(TomlTable& table, const std::string& name,
                                const AngleQuantity& quantity) {
  const std::string key = angle_key(table, name);
  if (is_in_radians(key)) return table.numbers(key, quantity.in_radians());
  std::vector<double> angles = table.numbers(key, quantity.in_degrees());
  for (double& angle : angles) angle = radians(angle);
  return angles;
}

}  // namespace asdic::detail::scenario
