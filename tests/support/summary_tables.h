#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "study/summary/summary.h"

// Tables of a summary, and their columns, by name.
namespace asdic::detail::study {

inline const SummaryTable& named(const std::vector<SummaryTable>& tables, const std::string& name) {
  for (const SummaryTable& table : tables)
    if (table.name == name) return table;
  throw std::runtime_error("no table " + name);
}

inline const std::vector<double>& column(const SummaryTable& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name) return table.values[c];
  throw std::runtime_error("no column " + name);
}

}  // namespace asdic::detail::study
