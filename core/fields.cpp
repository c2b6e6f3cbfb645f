#include "core/fields.h"

namespace asdic::detail {

Fields::~Fields() = default;  // here and not in every file: the table of virtual functions with it

void Fields::operator()(SettingKey key, std::optional<double>& value, const Quantity& q,
                        std::string_view help) {
  bool given = value.has_value();
  double one = value.value_or(0.0);
  number({key, help}, q, one, &given);
  if (reads()) value = given ? std::optional(one) : std::nullopt;
}

void Fields::operator()(SettingKey key, std::optional<double>& radians, const AngleQuantity& q,
                        std::string_view help) {
  bool given = radians.has_value();
  double one = radians.value_or(0.0);
  angle({key, help}, q, one, &given);
  if (reads()) radians = given ? std::optional(one) : std::nullopt;
}

Only Fields::way(Ways& ways, std::initializer_list<std::string_view> keys, bool is) {
  return Only(*this, takes(ways, {keys.begin(), keys.size()}, is, false), {.key = *keys.begin()});
}

Only Fields::otherwise(Ways& ways, std::initializer_list<std::string_view> keys) {
  return Only(*this, takes(ways, {keys.begin(), keys.size()}, true, true), {.key = *keys.begin()});
}

Only Fields::unless(std::string_view key, std::string_view is, std::string_view unwanted) {
  return Only(*this, is != unwanted || exhaustive(),
              {.key = key, .words = {&unwanted, 1}, .other = true});
}

bool Fields::takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool /*last*/) {
  if (exhaustive()) return true;
  if (!is || !ways.chosen.empty()) return false;
  ways.chosen.assign(keys.begin(), keys.end());
  return true;
}

}  // namespace asdic::detail
