#include "asdic/settings.h"
#include "core/settings_catalogue.h"
#include "core/unit_text.h"
#include "io/scenario/catalogue.h"

namespace asdic {
namespace {

Setting::Kind shown(detail::SettingRecord::Type type) {
  using Type = detail::SettingRecord::Type;
  switch (type) {
    case Type::number:
      return Setting::Kind::number;
    case Type::whole_number:
      return Setting::Kind::whole;
    case Type::flag:
      return Setting::Kind::flag;
    case Type::text:
      return Setting::Kind::text;
    case Type::word:
      return Setting::Kind::word;
    case Type::numbers:
      return Setting::Kind::numbers;
    case Type::rows:
      return Setting::Kind::rows;
    case Type::axis:
      return Setting::Kind::axis;
    case Type::vector:
      return Setting::Kind::vector;
    case Type::vectors:
      return Setting::Kind::vectors;
    case Type::reference:
      return Setting::Kind::name;
  }
  return Setting::Kind::text;
}

Setting shown(const detail::SettingRecord& record) {
  return {.path = record.path,
          .kind = shown(record.type),
          .unit = detail::unit_of(record.quantity),
          .lowest = record.quantity.low,
          .highest = record.quantity.high,
          .or_zero = record.quantity.or_zero,
          .words = record.words,
          .length = record.length,
          .standard = record.standard,
          .otherwise = record.inherits.empty() ? record.otherwise : record.inherits,
          .help = record.help,
          .condition = record.condition,
          .required = record.required};
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = [] {
    std::vector<Setting> made;
    for (const detail::SettingRecord& record : detail::scenario::catalogue().settings)
      made.push_back(shown(record));
    return made;
  }();
  return all;
}

const std::vector<SettingTable>& setting_tables() {
  static const std::vector<SettingTable> all = [] {
    std::vector<SettingTable> made;
    for (const detail::TableRecord& table : detail::scenario::catalogue().tables)
      made.push_back({.path = table.path,
                      .help = table.help,
                      .list = table.list,
                      .one_or_more = table.one_or_more});
    return made;
  }();
  return all;
}

}  // namespace asdic
