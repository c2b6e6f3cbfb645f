#include "study/summary/own_columns.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "study/plan/no_value.h"

namespace asdic::detail::study {

std::vector<Column> own_columns(const Study& study) {
  std::vector<Column> all;
  for (const OwnFormula& own : study.summary.own)
    all.push_back({.name = own.name,
                   .unit = own.unit,
                   .meaning = own.meaning,
                   .role = Column::Role::measure,
                   .labels = {},
                   .formula = own.expression.text(),
                   .event = own.event,
                   .least_best = own.least_best});
  return all;
}

std::vector<Column> answer_columns(const Study& study) {
  std::vector<Column> all = columns(study);
  for (Column& column : own_columns(study)) all.push_back(std::move(column));
  return all;
}

OwnValues::OwnValues(const Study& study) : formulae_(study.summary.own), own_(own_columns(study)) {
  if (!formulae_.empty()) columns_ = columns(study).size();
}

namespace {

/// \param values  [columns and formulae before it]
double value_of(const OwnFormula& own, std::span<const double> values, std::vector<double>& named) {
  named.clear();
  for (const std::size_t place : own.places) named.push_back(values[place]);
  // A comparison with what is not known would be false, as if it were known not to be so.
  if (std::any_of(named.begin(), named.end(), [](double x) { return std::isnan(x); }))
    return own.otherwise.value_or(no_value);
  const double value = own.expression.at(named);
  if (std::isnan(value)) return no_value;
  return own.event ? (value != 0.0 ? 1.0 : 0.0) : value;
}

}  // namespace

void OwnValues::append(std::vector<double>& values, bool valid) const {
  assert(values.size() >= columns_);
  values.resize(columns_);
  std::vector<double> named;
  for (const OwnFormula& own : formulae_)
    values.push_back(valid ? value_of(own, values, named) : no_value);
}

Table OwnValues::of(const Table& rows) const {
  Table made{.columns = own_, .index = {}, .valid = {}, .values = {}};
  made.values.resize(own_.size());
  if (empty()) return made;
  std::vector<double> values;
  for (std::size_t row = 0; row < rows.index.size(); ++row) {
    values.clear();
    for (std::size_t c = 0; c < columns_; ++c) values.push_back(rows.values[c][row]);
    append(values, rows.valid[row] != 0);
    for (std::size_t i = 0; i < own_.size(); ++i) made.values[i].push_back(values[columns_ + i]);
  }
  return made;
}

Table with_own(const Study& study, Table rows) {
  Table own = OwnValues(study).of(rows);
  for (std::size_t i = 0; i < own.columns.size(); ++i) {
    rows.columns.push_back(std::move(own.columns[i]));
    rows.values.push_back(std::move(own.values[i]));
  }
  return rows;
}

}  // namespace asdic::detail::study
