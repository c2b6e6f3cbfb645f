#include "study/reader/vary_data.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "core/text.h"
#include "io/climatology/calendar.h"
#include "io/climatology/netcdf_file.h"
#include "io/text/csv_table.h"
#include "study/expression/names.h"

namespace asdic::detail::study {
namespace {

/// Columns of a file, CSV or netCDF.
struct Data {
  std::filesystem::path path;
  std::vector<std::vector<double>> columns;      // as they were asked for
  std::vector<std::string> units;                // of netCDF; else ""
  std::vector<std::vector<std::string>> labels;  // of columns of text, which they count into
  std::vector<int> lines;                        // of CSV

  /// "wind.csv:17", "wind.nc: row 16"
  [[nodiscard]] std::string row(std::size_t i) const {
    return path.filename().string() +
           (i < lines.size() ? ":" + std::to_string(lines[i]) : ": row " + std::to_string(i));
  }
};

bool is_netcdf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[4] = {};
  file.read(head, sizeof head);
  const std::string_view text(head, sizeof head);
  return text.starts_with("CDF") || text == "\x89HDF";
}

/// A column of a CSV file: numbers, or texts in the order in which they first stand there.
void add_column(const CsvText& csv, const std::string& name, bool texts, Data& data) {
  const std::size_t at = csv.column(name);
  data.columns.emplace_back();
  data.labels.emplace_back();
  data.units.emplace_back();
  const std::vector<std::string>& cells = csv.cells[at];
  const auto is_text = [](const std::string& cell) { return !number_in(cell); };
  const bool all_texts = std::all_of(cells.begin(), cells.end(), is_text);
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const std::optional<double> number = number_in(cells[row]);
    const auto fault = [&](const std::string& expected) {
      return InputError({.where = csv.file + ":" + std::to_string(csv.lines[row]) + ": " + name,
                         .got = in_quotes(cells[row]),
                         .expected = expected});
    };
    if (!texts || !all_texts) {
      if (!number)
        throw fault(texts ? "a number, as in other rows; or texts in all of them"
                          : "a finite number");
      data.columns.back().push_back(*number);
      continue;
    }
    if (cells[row].empty()) throw fault("a text: rows must be whole");
    std::vector<std::string>& labels = data.labels.back();
    const auto it = std::find(labels.begin(), labels.end(), cells[row]);
    data.columns.back().push_back(static_cast<double>(it - labels.begin()));
    if (it == labels.end()) labels.push_back(cells[row]);
    if (labels.size() > 10'000) throw fault("at most 10000 different texts in a column");
  }
}

/// Dates as days since 1970, if the first one is a date and no number. \return whether they are
bool read_dates(const CsvText& csv, const std::string& name, Data& data) {
  const std::vector<std::string>& cells = csv.cells[csv.column(name)];
  if (number_in(cells.front()) || !parse_moment(cells.front())) return false;
  data.columns.emplace_back();
  data.labels.emplace_back();
  data.units.emplace_back("days since 1970-01-01");
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const std::optional<Moment> moment = parse_moment(cells[row]);
    if (!moment)
      throw InputError({.where = csv.file + ":" + std::to_string(csv.lines[row]) + ": " + name,
                        .got = in_quotes(cells[row]),
                        .expected = "a date such as 2024-01-31 or 2024-01-31T06:00Z, as in the "
                                    "first row"});
    data.columns.back().push_back(days(Calendar::standard, *moment));
  }
  return true;
}

/// \param texts  whether columns may be of text \param time  which of the names may be of dates
Data read_data(TomlTable& table, const Study& study, const std::vector<std::string>& names,
               bool texts, std::size_t time) {
  Data data{.path = study.path.parent_path() / table.text("file")};
  if (!std::filesystem::is_regular_file(data.path))
    throw table.fault("file", "a CSV or netCDF file",
                      "no such file " + in_quotes(data.path.string()));
  if (!is_netcdf(data.path)) {
    const CsvText csv = read_csv_text(data.path);
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::string name = names[i];
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));  // as csv.names are
      });
      if (i != time || !read_dates(csv, name, data)) add_column(csv, name, texts, data);
    }
    data.lines = csv.lines;
    return data;
  }
  const std::vector<NetcdfArray> arrays = read_netcdf_arrays(data.path, names);
  for (const std::string& name : names) {
    const auto it = std::find_if(arrays.begin(), arrays.end(),
                                 [&](const NetcdfArray& array) { return array.name == name; });
    if (it == arrays.end())
      throw InputError({.where = data.path.string(),
                        .got = "no variable " + in_quotes(name),
                        .expected = "one of " + list_of(netcdf_variables(data.path))});
    if (it->shape.size() != 1 || it->numbers.empty() ||
        (!data.columns.empty() && it->numbers.size() != data.columns[0].size()))
      throw InputError({.where = data.path.string() + ": " + name,
                        .got = "an array of " + std::to_string(it->shape.size()) +
                               " dimensions with " + std::to_string(it->numbers.size()) +
                               " numbers",
                        .expected = "one dimension of numbers, as long as those of the others"});
    for (std::size_t i = 0; i < it->numbers.size(); ++i)
      if (!std::isfinite(it->numbers[i]))
        throw InputError({.where = data.path.string() + ": " + name,
                          .got = "a missing value in row " + std::to_string(i) + ", from 0",
                          .expected = "a number in every row: leave such rows out of the file"});
    data.columns.push_back(it->numbers);
    data.units.push_back(it->units);
  }
  return data;
}

std::string last_name(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// An array of strings. \param fallback  where the key is not there
std::vector<std::string> read_names(TomlTable& table, const TomlValue& value,
                                    const std::string& key,
                                    const std::vector<std::string>& fallback) {
  if (!table.has(key)) return fallback;
  std::vector<std::string> names;
  if (const auto* items = std::get_if<TomlValue::Array>(&value.find(key)->data))
    for (const TomlValue& item : *items)
      if (const auto* name = std::get_if<std::string>(&item.data)) names.push_back(*name);
  if (names.empty()) throw table.fault(key, "an array of names of columns, each in quotes");
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      throw table.fault(key, "each column once");
  return names;
}

/// columns = [..], the first ones of the keys.
std::vector<std::string> read_columns(TomlTable& table, const TomlValue& value,
                                      const Variable& variable) {
  std::vector<std::string> own;
  for (const std::string& key : variable.keys) own.push_back(last_name(key));
  if (own.empty() && !table.has("columns"))
    throw table.fault("columns", "an array of names of columns, each in quotes");
  const std::vector<std::string> names = read_names(table, value, "columns", own);
  if (names.size() < variable.keys.size())
    throw table.fault("columns",
                      "a column for each of the " + std::to_string(variable.keys.size()) + " keys");
  return names;
}

/// What columns are called behind the input's name: the key's last word, or the column's own name.
std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      result += capital ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  return result;
}

std::vector<std::string> called(const std::vector<std::string>& columns, const Variable& variable) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < columns.size(); ++c)
    names.push_back(plain(c < variable.keys.size() ? last_name(variable.keys[c]) : columns[c]));
  return names;
}

struct TimeUnit {
  std::string name;
  double seconds = 1.0;
};

/// Of netCDF's "hours since 2020-01-01", or as the study says.
TimeUnit read_time_unit(TomlTable& table, const std::string& units) {
  const std::vector<std::pair<std::string, TimeUnit>> known{{"second", {"s", 1.0}},
                                                            {"minute", {"min", 60.0}},
                                                            {"hour", {"h", 3600.0}},
                                                            {"day", {"d", 86400.0}}};
  std::optional<std::string> own;
  for (const auto& [word, unit] : known)
    if (units.starts_with(word)) own = unit.name;
  const std::string name = table.choice("time_unit", {"s", "min", "h", "d"}, own.value_or("s"));
  for (const auto& [word, unit] : known)
    if (unit.name == name) return unit;
  return {"s", 1.0};
}

}  // namespace

TableLaw read_table_law(TomlTable& table, const TomlValue& value, const Variable& variable,
                        const Study& study, bool in_branch) {
  const std::vector<std::string> columns = read_columns(table, value, variable);
  std::vector<std::string> all = columns;
  const bool weighted = table.has("weight");
  if (weighted) all.push_back(table.text("weight"));
  Data data = read_data(table, study, all, !in_branch, all.size());
  data.labels.resize(data.columns.size());
  TableLaw law;
  if (weighted) {
    if (!data.labels.back().empty())
      throw table.fault("weight", "a column of numbers", in_quotes(all.back()) + ", which is text");
    data.labels.pop_back();
    const std::vector<double>& weights = data.columns.back();
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i] < 0.0)
        throw table.fault("weight", "weights of at least 0",
                          to_text(weights[i]) + " in " + data.row(i));
    law.cumulative.assign(weights.size(), 0.0);
    std::partial_sum(weights.begin(), weights.end(), law.cumulative.begin());
    const double sum = law.cumulative.back();
    if (!(sum > 0.0)) throw table.fault("weight", "a weight above 0", "none in the file");
    for (double& share : law.cumulative) share /= sum;
    law.cumulative.back() = 1.0;
    data.columns.pop_back();
  }
  law.data = std::make_shared<const DataRows>(DataRows{.names = called(columns, variable),
                                                       .columns = std::move(data.columns),
                                                       .labels = std::move(data.labels)});
  return law;
}

TimeSeriesLaw read_time_series(TomlTable& table, const TomlValue& value, const Variable& variable,
                               const Study& study) {
  TimeSeriesLaw law;
  law.track = table.has("track");
  std::vector<std::string> columns;
  if (law.track) {
    if (table.has("columns")) throw table.fault("columns", "no \"columns\" beside track");
    if (variable.keys.empty()) throw table.fault("keys", "the key of a target or a platform");
    columns = read_names(table, value, "track", {});
    if (columns.size() != 3)
      throw table.fault("track", "three names of columns: east, north and depth [m]");
  } else {
    columns = read_columns(table, value, variable);
  }
  std::vector<std::string> all = columns;
  all.push_back(table.text("time", "time"));
  Data data = read_data(table, study, all, false, all.size() - 1);
  const bool dates = data.units.back() == "days since 1970-01-01" && !data.lines.empty();
  if (dates && table.has("time_unit"))
    throw table.fault("time_unit", "no \"time_unit\": the file's times are dates");
  const TimeUnit unit =
      dates ? TimeUnit{data.units.back(), 86400.0} : read_time_unit(table, data.units.back());
  law.unit = unit.name;
  law.seconds = unit.seconds;
  law.time = std::move(data.columns.back());
  data.columns.pop_back();
  if (law.time.size() < 2) throw table.fault("file", "a series of at least two rows", "one row");
  for (std::size_t i = 1; i < law.time.size(); ++i)
    if (!(law.time[i] > law.time[i - 1]))
      throw table.fault("file", "times that rise from row to row",
                        (dates ? iso(moment_of(Calendar::standard, law.time[i])) + " after " +
                                     iso(moment_of(Calendar::standard, law.time[i - 1]))
                               : to_text(law.time[i]) + " after " + to_text(law.time[i - 1])) +
                            " in " + data.row(i));
  law.by_row = table.choice("interpolation", {"linear", "row"}, "linear") == "row";
  if (law.by_row && law.track)
    throw table.fault("interpolation", "\"linear\" for a track, which has a velocity");
  const double first = law.time.front(), last = law.time.back();
  // The last row holds as long as the others do on the average.
  const double end =
      law.by_row ? last + (last - first) / static_cast<double>(law.time.size() - 1) : last;
  const auto limit = [&](const char* key, double least, bool above, double otherwise) {
    if (!dates || !table.has(key))
      return table.number(key, {.low = least, .high = end, .above = above}, otherwise);
    const std::string text = table.text(key);
    const std::optional<Moment> moment = parse_moment(text);
    const double at = moment ? days(Calendar::standard, *moment) : std::nan("");
    if (!(at >= least && at <= end) || (above && at == least))
      throw table.fault(key, "a date from " + iso(moment_of(Calendar::standard, least)) + " to " +
                                 iso(moment_of(Calendar::standard, end)));
    return at;
  };
  law.span.low = limit("from", first, false, first);
  law.span.high = limit("until", law.span.low, true, end);
  std::vector<std::string> names;
  if (law.track) {
    names = {"east", "north", "depth"};
  } else {
    names = called(columns, variable);
  }
  for (std::size_t c = 0; c < columns.size(); ++c)
    law.angles.push_back(!law.track && names[c].ends_with("_deg"));
  law.data = std::make_shared<const DataRows>(
      DataRows{.names = std::move(names), .columns = std::move(data.columns)});
  return law;
}

}  // namespace asdic::detail::study
