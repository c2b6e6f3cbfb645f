#include "study/reader/own_reader.h"

#include <algorithm>

#include "core/text.h"
#include "study/expression/names.h"

namespace asdic::detail::study {
namespace {

/// A formula as it is written, before it is known what may stand in it.
struct Written {
  std::string text, where, unit = "1", meaning;
  bool event = false;
  std::optional<double> otherwise{};
  std::optional<bool> least_best{};
};

bool is_name(const std::string& name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Written read_formula(TomlTable& table, const std::string& name) {
  Written made;
  if (!table.is_table(name)) {
    made.text = table.text(name);
    made.where = table.where(name);
    made.meaning = made.text;
    return made;
  }
  TomlTable own = table.table(name);
  made.text = own.text("value");
  made.where = own.where("value");
  made.event = own.flag("event", false);
  made.unit = own.text("unit", "1");
  if (made.event && made.unit != "1")
    throw own.fault("unit", "no unit of an event, which happens or does not");
  made.meaning = own.text("meaning", made.text);
  if (own.has("otherwise")) {
    made.otherwise = own.number("otherwise", {});
    if (made.event && *made.otherwise != 0.0 && *made.otherwise != 1.0)
      throw own.fault("otherwise", "of an event 0 or 1");
  }
  if (own.has("best")) made.least_best = own.choice("best", {"greatest", "least"}) == "least";
  own.finish();
  return made;
}

}  // namespace

std::vector<OwnFormula> read_own(TomlTable table, const TomlValue& value,
                                 const std::vector<Column>& columns) {
  std::vector<std::string> names, numbers;  // in the order of places; that may stand in formulae
  for (const Column& column : columns) {
    names.push_back(column.name);
    if (column.labels.empty()) numbers.push_back(column.name);
  }
  std::vector<std::pair<std::string, Written>> pending;
  if (const TomlValue::Table* entries = value.table())
    for (const TomlEntry& entry : *entries) {
      if (!is_name(entry.key))
        throw table.fault(entry.key, "a name of small letters, digits and _, a letter first",
                          in_quotes(entry.key));
      if (std::find(names.begin(), names.end(), entry.key) != names.end())
        throw table.fault(entry.key, "a name that no column of the rows has", in_quotes(entry.key));
      pending.emplace_back(entry.key, read_formula(table, entry.key));
    }
  table.finish();
  std::vector<OwnFormula> all;
  while (!pending.empty()) {  // each after those that it looks at
    const auto waits = [&](const auto& one) {
      const std::vector<std::string> looked_at = names_in(one.second.text);
      return std::any_of(pending.begin(), pending.end(), [&](const auto& other) {
        return std::find(looked_at.begin(), looked_at.end(), other.first) != looked_at.end();
      });
    };
    auto next = std::find_if_not(pending.begin(), pending.end(), waits);
    if (next == pending.end())
      throw InputError({.where = pending.front().second.where,
                        .got = in_quotes(pending.front().second.text) +
                               ", which looks at itself or waits for one that waits for it",
                        .expected = "formulae that can be computed one after the other"});
    const auto& [name, written] = *next;
    for (const std::string& looked_at : names_in(written.text))
      for (const Column& column : columns)
        if (column.name == looked_at && !column.labels.empty())
          throw InputError({.where = written.where,
                            .got = in_quotes(looked_at) + ", which is no number",
                            .expected = "a formula of numbers, " + list_of(numbers)});
    OwnFormula own{.name = name,
                   .unit = written.unit,
                   .meaning = written.meaning,
                   .event = written.event,
                   .least_best = written.least_best,
                   .otherwise = written.otherwise,
                   .expression = Expression(written.text, numbers, written.where)};
    for (const std::string& looked_at : own.expression.names())
      own.places.push_back(static_cast<std::size_t>(
          std::find(names.begin(), names.end(), looked_at) - names.begin()));
    names.push_back(name);
    numbers.push_back(name);
    all.push_back(std::move(own));
    pending.erase(next);
  }
  return all;
}

}  // namespace asdic::detail::study
