#include <algorithm>
#include <map>

#include "core/error.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// Rows that fall into bins, or few enough of them to be taken value by value: both ways of naming
/// columns are seen.
Table made_up(const std::vector<Column>& columns, std::size_t rows) {
  Table table{.columns = columns};
  table.values.resize(columns.size());
  for (std::size_t row = 0; row < rows; ++row) {
    table.index.push_back(row);
    table.valid.push_back(1);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::size_t labels = columns[c].labels.size();
      const bool proportion = is_proportion(columns[c]);
      table.values[c].push_back(static_cast<double>(labels > 0   ? row % labels
                                                    : proportion ? row % 2
                                                                 : row));
    }
  }
  return table;
}

/// The first name that stands there twice, "" if none does.
std::string twice(const std::vector<Column>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (columns[i].name == columns[j].name) return columns[i].name;
  return "";
}

/// Where an entry of `by` stands: "study.toml:12: summary.by[1]".
std::string place_of(const Study& study, std::size_t entry) {
  const TomlValue* summary = study.document.find("summary");
  const TomlValue* by = summary == nullptr ? nullptr : summary->find("by");
  const auto* items = by == nullptr ? nullptr : std::get_if<TomlValue::Array>(&by->data);
  if (items == nullptr || entry >= items->size())
    return study.path.string() + ": summary.by (every input by itself)";
  return (*items)[entry].origin + ": summary.by[" + std::to_string(entry) + "]";
}

}  // namespace

void check_summary_names(const Study& study) {
  const std::vector<Column> all = columns(study);
  if (const std::string name = twice(all); !name.empty())
    throw InputError({.where = study.path.string() + ": [vary] and [measure]",
                      .got = "two columns \"" + name + "\"",
                      .expected = "names that differ (name = \"...\" of a variable or a target)"});
  std::map<std::string, std::size_t> made_by;  // table: entry of `by`
  for (std::size_t entry = 0; entry < study.summary.by.size(); ++entry) {
    std::vector<std::string> names;  // of this entry's tables
    for (const std::size_t rows : {std::size_t{2}, std::size_t{300}})
      for (const SummaryTable& table :
           tables_by(study, study.summary.by[entry], made_up(all, rows))) {
        if (const std::string name = twice(table.columns); !name.empty())
          throw InputError(
              {.where = place_of(study, entry),
               .got = "an axis that gives " + table.name + " two columns \"" + name + "\"",
               .expected = "axes that differ from one another and from the measures "
                           "along them"});
        if (std::find(names.begin(), names.end(), table.name) == names.end())
          names.push_back(table.name);
      }
    for (const std::string& name : names)
      if (const auto [at, is_new] = made_by.emplace(name, entry); !is_new)
        throw InputError(
            {.where = place_of(study, entry),
             .got = "a second table \"" + name + "\", as of by[" + std::to_string(at->second) + "]",
             .expected = "every axis, or pair of axes, once"});
  }
}

}  // namespace asdic::detail::study
