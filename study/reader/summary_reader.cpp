#include "study/reader/summary_reader.h"

#include <algorithm>

#include "core/text.h"
#include "study/expression/names.h"
#include "study/reader/own_reader.h"

namespace asdic::detail::study {
namespace {

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

/// A column's name, as it stands in an array or alone. \param where  its key, for messages
std::string read_axis_name(const TomlValue& value, const std::string& where,
                           const std::vector<std::string>& names) {
  const auto* name = std::get_if<std::string>(&value.data);
  if (name != nullptr && std::find(names.begin(), names.end(), *name) != names.end()) return *name;
  const std::string nearest = name == nullptr ? "" : nearest_name(*name, names);
  throw InputError(
      {.where = value.origin + ": " + where,
       .got = value.describe(),
       .expected = "a column, " + list_of(names) +
                   (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)")});
}

/// { axis = "range", bins = 12 } or { axis = "range", edges = [..] }
/// \param column  that it is of where no axis is said; "": it has to be
SummaryAxis read_axis(TomlTable table, const TomlValue& value, const std::string& where,
                      const std::vector<std::string>& names, const std::string& column = "") {
  SummaryAxis axis{.column = column};
  if (table.has("axis") || column.empty()) {
    if (!table.has("axis")) throw table.fault("axis", "a column, " + list_of(names));
    axis.column = read_axis_name(*value.find("axis"), where + ".axis", names);
  }
  if (table.has("edges")) {
    if (table.has("bins")) throw table.fault("bins", "no \"bins\" beside edges");
    axis.edges = table.numbers("edges", {});
    if (axis.edges.size() < 2) throw table.fault("edges", "at least two edges");
    for (std::size_t i = 1; i < axis.edges.size(); ++i)
      if (!(axis.edges[i] > axis.edges[i - 1]))
        throw table.fault("edges[" + std::to_string(i) + "]",
                          "an edge above the one before it, " + to_text(axis.edges[i - 1]));
  }
  axis.bins = static_cast<int>(table.integer("bins", 1, 1000, 0));
  axis.equal_count = table.flag("equal_count", false);
  table.finish();
  return axis;
}

/// One of `by`: "range", { axis = .. }, or two of either in an array.
std::vector<SummaryAxis> read_by(const TomlValue& value, const std::string& where,
                                 const std::vector<std::string>& names) {
  const auto one = [&](const TomlValue& item, const std::string& at) {
    if (item.table() != nullptr) return read_axis(TomlTable(item, at), item, at, names);
    return SummaryAxis{.column = read_axis_name(item, at, names)};
  };
  const auto* pair = std::get_if<TomlValue::Array>(&value.data);
  if (pair == nullptr) return {one(value, where)};
  if (pair->size() != 2)
    throw InputError({.where = value.origin + ": " + where,
                      .got = value.describe(),
                      .expected = "a column, or an array of two"});
  return {one((*pair)[0], where + "[0]"), one((*pair)[1], where + "[1]")};
}

/// [summary.map]: true, or a table.
class MapReader {
 public:
  /// \param value  of the table; null: all of it is left out
  MapReader(TomlTable table, const TomlValue* value, const std::vector<Column>& columns)
      : table_(std::move(table)), value_(value), columns_(columns), names_(names_of(columns)) {}

  SummaryMap read() {
    SummaryMap map;
    map.polar =
        table_.choice("cells", {"east_north", "range_bearing"}, "east_north") == "range_bearing";
    const bool by_place = !map.polar && one_of("east") && one_of("north");
    if (map.polar) {
      map.across = axis("range", column("range"));
      map.up = axis("bearing", column("bearing"));
      refuse("east");
      refuse("north");
    } else {
      map.across = axis("east", by_place || says_axis("east") ? column("east") : "east");
      map.up = axis("north", by_place || says_axis("north") ? column("north") : "north");
      const bool told = by_place || (says_axis("east") && says_axis("north"));
      if (!told) {
        map.range = name("range");
        map.bearing = name("bearing");
      } else {
        refuse("range");
        refuse("bearing");
      }
    }
    if (table_.has_quietly("depth") && (table_.is_table("depth") || table_.flag("depth", false)))
      map.depth = axis("depth", column("depth"));
    table_.finish();
    return map;
  }

 private:
  /// What columns of a place are called: "range", "target_0_range".
  [[nodiscard]] static std::string word(const std::string& key) {
    return key == "bearing" ? "bearing_deg" : key;
  }
  [[nodiscard]] std::vector<std::string> possible(const std::string& key) const {
    const std::string end = word(key);
    std::vector<std::string> found;
    for (const Column& one : columns_) {
      if (one.name == "place_" + end && one.role == Column::Role::measure) return {one.name};
      if (one.role == Column::Role::input && (one.name == end || one.name.ends_with('_' + end)))
        found.push_back(one.name);
    }
    return found;
  }
  [[nodiscard]] bool one_of(const std::string& key) const { return possible(key).size() == 1; }
  [[nodiscard]] bool says_axis(const std::string& key) {
    return table_.is_table(key) && table_.table(key).has_quietly("axis");
  }
  /// The column that a key stands for where it does not say itself.
  std::string column(const std::string& key) {
    if (says_axis(key)) return "";
    const std::vector<std::string> found = possible(key);
    if (found.size() == 1) return found.front();
    throw table_.fault(
        key,
        "which column it is, axis = \"…\"" +
            std::string(found.empty() ? ", or measure.target_place = true, which has it" : ""),
        found.empty() ? "no column " + in_quotes(word(key)) : "several: " + list_of(found));
  }
  SummaryAxis axis(const std::string& key, const std::string& otherwise) {
    if (!table_.is_table(key)) return {.column = otherwise};
    return read_axis(table_.table(key), *value_->find(key), "summary.map." + key, names_,
                     otherwise);
  }
  /// A column's name by itself, of a map whose east and north are had from it.
  std::string name(const std::string& key) {
    if (table_.has(key)) return read_axis_name(*value_->find(key), "summary.map." + key, names_);
    return column(key);
  }
  void refuse(const std::string& key) {
    if (table_.has_quietly(key))
      throw table_.fault(key, "none beside these cells", "\"" + key + "\"");
  }

  TomlTable table_;
  const TomlValue* value_;
  const std::vector<Column>& columns_;
  std::vector<std::string> names_;
};

}  // namespace

SummaryPlan read_summary(TomlTable table, const TomlValue* value,
                         const std::vector<Column>& of_rows) {
  SummaryPlan plan;
  std::vector<Column> columns = of_rows;
  if (table.has("own")) {
    plan.own = read_own(table.table("own"), *value->find("own"), of_rows);
    for (const OwnFormula& own : plan.own) columns.push_back({.name = own.name, .unit = own.unit});
  }
  plan.confidence = table.number(
      "confidence", {.noun = "probability", .low = 0.5, .high = 0.999999}, plan.confidence);
  if (table.choice("interval", {"wilson", "clopper_pearson"}, "wilson") == "clopper_pearson")
    plan.interval = ProportionInterval::clopper_pearson;
  if (table.has("quantiles")) {
    plan.quantiles = table.numbers("quantiles", {.noun = "probability", .low = 0.0, .high = 1.0});
    for (std::size_t i = 1; i < plan.quantiles.size(); ++i)
      if (const auto at = plan.quantiles.begin() + static_cast<std::ptrdiff_t>(i);
          std::find(plan.quantiles.begin(), at, *at) != at)
        throw table.fault("quantiles[" + std::to_string(i) + "]", "every probability once");
  }
  if (table.has("by")) {
    const TomlValue& by = *value->find("by");
    const auto* items = std::get_if<TomlValue::Array>(&by.data);
    if (items == nullptr) throw table.fault("by", "an array of columns");
    for (std::size_t i = 0; i < items->size(); ++i)
      plan.by.push_back(
          read_by((*items)[i], "summary.by[" + std::to_string(i) + "]", names_of(columns)));
  } else {
    for (const Column& column : columns)
      if (column.role == Column::Role::input) plan.by.push_back({{.column = column.name}});
  }
  if (table.has("map")) {
    if (table.is_table("map")) {
      plan.map = MapReader(table.table("map"), value->find("map"), columns).read();
    } else if (table.flag("map", false)) {
      static const TomlValue nothing{.data = TomlValue::Table{}, .origin = value->origin};
      plan.map = MapReader(TomlTable(nothing, "summary.map"), &nothing, columns).read();
    }
  }
  plan.roc = table.flag("roc", plan.roc);
  plan.convergence = table.flag("convergence", plan.convergence);
  plan.sensitivity = table.flag("sensitivity", plan.sensitivity);
  table.finish();
  return plan;
}

}  // namespace asdic::detail::study
