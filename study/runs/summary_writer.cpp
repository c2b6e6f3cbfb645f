#include "study/runs/summary_writer.h"

#include <algorithm>

#include "io/hdf5/scale.h"

namespace asdic::detail::study {
namespace {

/// The dimension of a table's rows: its axis or, where it has several, one without values.
/// \return the dataset that stands for it
std::string write_rows(Hdf5File& file, const SummaryTable& table, const std::string& group) {
  const auto has_column = [&](const std::string& name) {
    return std::any_of(table.columns.begin(), table.columns.end(),
                       [&](const Column& column) { return column.name == name; });
  };
  std::string name = table.axes.size() == 1 ? table.axes.front() : "cell";
  const std::string path = group + "/";
  if (table.axes.size() == 1) {
    const auto axis = std::find_if(table.columns.begin(), table.columns.end(),
                                   [&](const Column& column) { return column.name == name; });
    const auto& values = table.values[static_cast<std::size_t>(axis - table.columns.begin())];
    file.write<double>(path + name, values, {values.size()});
    file.make_scale(path + name, name);
    return path + name;
  }
  while (has_column(name)) name += '_';
  file.make_dimension(path + name, table.values.empty() ? 0 : table.values.front().size());
  describe(file, path + name, "no values: a row for each of the axes' combinations");
  return path + name;
}

/// CF's list of what else tells where a value belongs.
void write_coordinates(Hdf5File& file, const SummaryTable& table, const std::string& group) {
  std::vector<std::string> others = table.edges;
  if (table.axes.size() > 1) others.insert(others.begin(), table.axes.begin(), table.axes.end());
  std::string names;
  for (const std::string& name : others) names += (names.empty() ? "" : " ") + name;
  if (names.empty()) return;
  for (const Column& column : table.columns)
    if (std::find(others.begin(), others.end(), column.name) == others.end() &&
        std::find(table.axes.begin(), table.axes.end(), column.name) == table.axes.end())
      file.set_attribute(group + "/" + column.name, "coordinates", names);
}

}  // namespace

void write_summary(Hdf5File& file, const Summary& summary, const Noted& noted) {
  file.make_group("summary");
  file.set_attribute("summary", "confidence", summary.confidence);
  file.set_attribute("summary", "proportion_interval", summary.proportion_interval);
  file.set_attribute("summary", "intervals", summary.intervals);
  if (!summary.warnings.empty()) file.set_attribute("summary", "warnings", summary.warnings);
  if (!summary.left_out.empty()) file.set_attribute("summary", "left_out", summary.left_out);
  for (const SummaryTable& table : summary.tables) {
    const std::string group = "summary/" + table.name;
    file.make_group(group);
    file.set_attribute(group, "title", table.title);
    if (!table.intervals.empty()) file.set_attribute(group, "intervals", table.intervals);
    std::vector<std::string> order;
    const std::string rows = write_rows(file, table, group);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::string path = group + "/" + table.columns[i].name;
      if (path != rows) {
        file.write<double>(path, table.values[i], {table.values[i].size()});
        file.attach_scales(path, {rows});
      }
      describe_column(file, path, table.columns[i]);
      noted(path, table.values[i]);
      order.push_back(table.columns[i].name);
    }
    write_coordinates(file, table, group);
    if (!order.empty()) file.set_attribute(group, "columns", order);
  }
}

/// "dB re 1 µPa" is units "dB", reference "1 µPa": UDUNITS has no words for it.
void describe_column(Hdf5File& file, const std::string& dataset, const Column& column) {
  constexpr std::string_view re = " re ";
  const auto at = std::min(column.unit.find(re), column.unit.size());
  const std::string reference = column.unit.substr(std::min(at + re.size(), column.unit.size()));
  describe(file, dataset, column.meaning, column.unit.substr(0, at), {.reference = reference});
  if (!column.labels.empty()) file.set_attribute(dataset, "labels", column.labels);
}

}  // namespace asdic::detail::study
