#include "serve/client_value.h"

#include <cmath>
#include <limits>

#include "io/scenario/catalogue.h"

namespace asdic::detail::serve {
namespace {

void check(TomlTable& reader, const std::string& key, const SettingRecord& setting) {
  if (setting.type == SettingRecord::Type::number)
    static_cast<void>(reader.number(key, setting.quantity));
  if (setting.type != SettingRecord::Type::whole_number) return;
  constexpr auto most = std::numeric_limits<std::int64_t>::max() - 1;  // so that it is told
  const auto [low, high] = std::pair(setting.quantity.low, setting.quantity.high);
  static_cast<void>(reader.integer(key, static_cast<std::int64_t>(low),
                                   std::isfinite(high) ? static_cast<std::int64_t>(high) : most));
}

}  // namespace

std::optional<TomlValue> client_value(TomlTable& reader, const TomlValue& fields,
                                      const std::string& key, const ClientName& name,
                                      const DataFolder& data, const SessionLimits& limits) {
  if (!reader.has(key)) return std::nullopt;
  TomlValue value = *find_at(fields, name.name);
  if (name.is_table) {
    TomlTable table = reader.table(key);
    if (table.has("file")) {
      const auto file = data.file(table.text("file"), name.name + ".file", limits.file_bytes);
      set_key(value, "file", {.data = file.string(), .origin = ""});
    }
  } else if (name.name == key) {
    check(reader, key, scenario::setting_at(name.section));
  }
  return value;
}

}  // namespace asdic::detail::serve
