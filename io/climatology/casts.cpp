#include "io/climatology/casts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/netcdf_file.h"
#include "io/climatology/words.h"
#include "io/files/input_file.h"
#include "io/text/csv_table.h"
#include "raytrace/ocean/seawater.h"

namespace asdic::detail {
namespace {

using climatology::lower;
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

enum class Measured { depth, pressure, temperature, salinity, speed, latitude, longitude, flag };

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\"");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\"") - begin + 1));
}

/// What a column is, by its name in lower case.
std::optional<Measured> measured_of(const std::string& name) {
  const auto begins = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return name.rfind(word, 0) == 0; });
  };
  if (begins({"depth", "dep", "tiefe"}) || name == "z") return Measured::depth;
  if (begins({"pres", "prdm", "prsm", "prm", "pr:", "druck"}) || name == "p")
    return Measured::pressure;
  if (begins({"potential temp", "potemp", "theta"})) return std::nullopt;
  if (begins({"temp", "t090", "t190", "t068", "t168", "tv29", "tnc", "ctdtmp", "sea_water_temp"}) ||
      name == "t")
    return Measured::temperature;
  if (begins({"sal", "psal", "ctdsal", "practical sal", "sea_water_prac"}) || name == "s")
    return Measured::salinity;
  if (begins({"sound", "sv", "svel", "speed of sound", "speed_of_sound"}) || name == "c")
    return Measured::speed;
  if (begins({"lat"})) return Measured::latitude;
  if (begins({"lon"})) return Measured::longitude;
  if (name == "flag") return Measured::flag;
  return std::nullopt;
}

/// One column of a cast: what it is, and how it becomes ours: value·scale + offset.
struct CastColumn {
  std::string name{};
  std::optional<Measured> kind{};
  double scale = 1.0, offset = 0.0;
};

/// \param where  "file:line: column"   \throws InputError for a unit that is none of the kind's
void set_unit(CastColumn& column, const std::string& unit_as_written, const std::string& where) {
  const std::string unit = lower(trimmed(unit_as_written));
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), unit) != names.end();
  };
  const auto wrong = [&](const char* expected) {
    return InputError(
        {.where = where, .got = "the unit " + in_quotes(unit_as_written), .expected = expected});
  };
  if (!column.kind || unit.empty()) return;
  switch (*column.kind) {
    case Measured::depth:
      if (is({"km"}))
        column.scale = 1000.0;
      else if (!is({"m", "metre", "metres", "meter", "meters", "salt water, m", "m, salt water",
                    "fresh water, m"}))
        throw wrong("a depth in m or km");
      return;
    case Measured::pressure:  // to Pa
      if (is({"db", "dbar", "decibar", "decibars"}))
        column.scale = 1e4;
      else if (is({"bar"}))
        column.scale = 1e5;
      else if (is({"mpa"}))
        column.scale = 1e6;
      else if (is({"kpa"}))
        column.scale = 1e3;
      else if (is({"psi"}))
        column.scale = 6894.757;
      else
        throw wrong("a pressure in dbar, bar, kPa, MPa or psi");
      return;
    case Measured::temperature:
      if (is({"k", "kelvin"}))
        column.offset = -273.15;
      else if (unit.find("68") != std::string::npos && unit.find('f') == std::string::npos)
        column.scale = 1.0 / 1.00024;  // IPTS-68 to ITS-90
      else if (!is({"c", "degc", "deg c", "deg_c", "degrees c", "degrees_c", "celsius",
                    "degree celsius", "degrees celsius", "degree_celsius", "degrees_celsius",
                    "\u00b0c",
                    "\xb0"
                    "c",
                    "\u00b0", "its-90, deg c", "its-90", "deg c, its-90", "its90",
                    "degc (its-90)"}))
        throw wrong("a temperature in degC or K");
      return;
    case Measured::salinity:
      if (is({"g/kg", "g kg-1"}))
        column.scale = practical_salinity(1.0);
      else if (!is({"psu", "pss", "pss-78", "pss78", "ppt", "1", "1e-3", "practical", "-", "psal"}))
        throw wrong("a salinity in psu, or g/kg where it is absolute");
      return;
    case Measured::speed:
      if (!is({"m/s", "m s-1", "m s^-1", "chen-millero, m/s", "delgrosso, m/s", "wilson, m/s",
               "ms-1"}))
        throw wrong("a speed of sound in m/s");
      return;
    default:
      return;
  }
}

/// Rows of a cast as they were measured, with what is known of it.
struct CastRows {
  std::vector<CastColumn> columns{};
  std::vector<std::vector<double>> rows{};  ///< NaN where there is none
  Cast about{};
};

bool plausible(Measured kind, double value) {
  switch (kind) {
    case Measured::depth:
      return value > -10.0 && value < 12'000.0;
    case Measured::pressure:
      return value > -1e5 && value < 1.3e8;
    case Measured::temperature:
      return value > -3.0 && value < 45.0;
    case Measured::salinity:
      return value >= 0.0 && value < 50.0;
    case Measured::speed:
      return value > 1300.0 && value < 1700.0;
    default:
      return true;
  }
}

/// Levels of close-by samples are averaged: a cast of 24 Hz has more than any ray can tell.
void thin(Cast& cast) {
  constexpr std::size_t most = 400;
  if (cast.depth.size() <= most) return;
  const auto width = [](double z) { return z < 200.0 ? 2.0 : z < 1000.0 ? 5.0 : 20.0; };
  Cast thinned = cast;
  for (auto* values : {&thinned.depth, &thinned.temperature, &thinned.salinity, &thinned.speed})
    values->clear();
  for (std::size_t begin = 0; begin < cast.depth.size();) {
    std::size_t end = begin;
    while (end < cast.depth.size() &&
           cast.depth[end] < cast.depth[begin] + width(cast.depth[begin]))
      ++end;
    end = std::max(end, begin + 1);
    const auto add = [&](const std::vector<double>& from, std::vector<double>& to) {
      if (from.empty()) return;
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) sum += from[i];
      to.push_back(sum / static_cast<double>(end - begin));
    };
    add(cast.depth, thinned.depth);
    add(cast.temperature, thinned.temperature);
    add(cast.salinity, thinned.salinity);
    add(cast.speed, thinned.speed);
    begin = end;
  }
  thinned.notes.push_back("its " + std::to_string(cast.depth.size()) +
                          " samples are averaged over 2 m, below 200 m over 5 m, below 1000 m "
                          "over 20 m");
  cast = std::move(thinned);
}

/// A profile of what was measured. \param where  for messages
Cast made_cast(CastRows rows, const std::string& where, double latitude) {
  Cast cast = std::move(rows.about);
  const auto find = [&](Measured kind) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < rows.columns.size(); ++i)
      if (rows.columns[i].kind == kind) return i;
    return std::nullopt;
  };
  const auto depth = find(Measured::depth), pressure = find(Measured::pressure),
             temperature = find(Measured::temperature), salinity = find(Measured::salinity),
             speed = find(Measured::speed), lat = find(Measured::latitude),
             lon = find(Measured::longitude), flag = find(Measured::flag);
  std::string names;
  for (const CastColumn& column : rows.columns) names += (names.empty() ? "" : ", ") + column.name;
  if (!depth && !pressure)
    throw InputError({.where = where,
                      .got = "no column of depth or pressure among " + names,
                      .expected = "one"});
  if (!speed && !(temperature && salinity))
    throw InputError({.where = where,
                      .got = "no column of " +
                             std::string(temperature ? "salinity" : "temperature") + " among " +
                             names,
                      .expected = "temperature and salinity, or the speed of sound"});
  const auto value = [&](const std::vector<double>& row, std::size_t column) {
    if (column >= row.size()) return not_measured;
    const CastColumn& about = rows.columns[column];
    const double x = row[column] * about.scale + about.offset;
    return std::isnan(x) || !plausible(*about.kind, x) ? not_measured : x;
  };
  for (const auto& row : rows.rows) {
    if (lat && !cast.latitude && !std::isnan(value(row, *lat))) cast.latitude = value(row, *lat);
    if (lon && !cast.longitude && !std::isnan(value(row, *lon))) cast.longitude = value(row, *lon);
  }
  struct Level {
    double z, t, s, c;
  };
  std::vector<Level> levels;
  std::size_t left_out = 0;
  const double there = cast.latitude.value_or(latitude);
  for (const auto& row : rows.rows) {
    Level level{};
    level.z = depth ? value(row, *depth) : value(row, *pressure);
    if (!depth) level.z = std::isnan(level.z) ? level.z : depth_at_pressure(level.z, there);
    const bool with_speed = speed && !(temperature && salinity);
    level.t = temperature ? value(row, *temperature) : not_measured;
    level.s = salinity ? value(row, *salinity) : not_measured;
    level.c = speed ? value(row, *speed) : not_measured;
    const bool flagged = flag && *flag < row.size() && !(row[*flag] == 0.0);
    if (std::isnan(level.z) || flagged ||
        (with_speed ? std::isnan(level.c) : std::isnan(level.t) || std::isnan(level.s)))
      ++left_out;
    else
      levels.push_back({std::max(0.0, level.z), level.t, level.s, level.c});
  }
  if (levels.empty())
    throw InputError({.where = where,
                      .got = count_of(rows.rows.size(), "line") + ", of which none is good",
                      .expected = "one level or more"});
  // The way down; a cast that begins at its deepest was recorded on the way up alone.
  const auto deepest = std::max_element(levels.begin(), levels.end(),
                                        [](const Level& a, const Level& b) { return a.z < b.z; });
  if (deepest == levels.begin())
    std::reverse(levels.begin(), levels.end());
  else
    levels.erase(deepest + 1, levels.end());
  const bool speeds = std::all_of(levels.begin(), levels.end(),
                                  [](const Level& level) { return !std::isnan(level.c); });
  for (const Level& level : levels) {
    constexpr double apart = 0.15;  // files have depths to 0.1 m
    if (!cast.depth.empty() && level.z < cast.depth.back() + apart) continue;
    cast.depth.push_back(level.z);
    if (temperature && salinity) {
      cast.temperature.push_back(level.t);
      cast.salinity.push_back(level.s);
    }
    if (speeds && speed) cast.speed.push_back(level.c);
  }
  if (left_out > 0)
    cast.notes.push_back(count_of(left_out, "level") + " without good values " +
                         (left_out == 1 ? "was" : "were") + " left out");
  if (!depth)
    cast.notes.push_back("its pressures became depths by Leroy and Parthiot at " + to_text(there) +
                         " N");
  for (const auto kind : {depth ? depth : pressure, temperature, salinity, speed})
    if (kind) cast.variables.push_back(rows.columns[*kind].name);
  thin(cast);
  return cast;
}

// Text: CSV, and Sea-Bird's .cnv.

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    begin = end + 1;
  }
  if (!lines.empty() && lines[0].starts_with("\xef\xbb\xbf")) lines[0].erase(0, 3);
  return lines;
}

std::optional<double> number_of(std::string text, bool decimal_comma) {
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  const char* begin = text.data();
  if (*begin == '+') ++begin;
  double value = 0.0;
  const auto [end, fault] = std::from_chars(begin, text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string> fields_of(const std::string& line, char mark) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(mark, begin), line.size());
    fields.push_back(trimmed(std::string_view(line).substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

/// "Temperature [degC]" and "Temperature (degC)" in two.
std::pair<std::string, std::string> name_and_unit(const std::string& heading) {
  const std::size_t open = heading.find_first_of("[(");
  if (open == std::string::npos) return {trimmed(heading), ""};
  const std::size_t close = heading.find_last_of("])");
  if (close == std::string::npos || close < open) return {trimmed(heading), ""};
  return {trimmed(heading.substr(0, open)), heading.substr(open + 1, close - open - 1)};
}

/// "30.5", "30 30.00 N", "30.5 S": degrees, and minutes after a space.
std::optional<double> degrees_of(const std::string& text) {
  double sum = 0.0, unit = 1.0, sign = 1.0;
  bool some = false;
  for (const std::string& word : fields_of(text, ' ')) {
    if (word.empty()) continue;
    const std::string mark = lower(word);
    if (mark == "n" || mark == "e" || mark == "deg") continue;
    if (mark == "s" || mark == "w") {
      sign = -1.0;
      continue;
    }
    const auto number = number_of(word, false);
    if (!number || unit < 1e-4) return some ? std::optional(sign * sum) : std::nullopt;
    if (*number < 0.0) sign = -1.0;
    sum += std::abs(*number) * unit;
    unit /= 60.0;
    some = true;
  }
  return some ? std::optional(sign * sum) : std::nullopt;
}

/// "Jan 02 2024 12:00:00", or as ISO has it.
std::optional<Moment> moment_of_words(const std::string& text) {
  if (const auto iso_time = parse_moment(trimmed(text))) return iso_time;
  const auto words = fields_of(trimmed(text), ' ');
  if (words.size() < 3) return std::nullopt;
  const std::string months = "janfebmaraprmayjunjulaugsepoctnovdec";
  const std::size_t month = months.find(lower(words[0]).substr(0, 3));
  if (words[0].size() < 3 || month == std::string::npos || month % 3 != 0) return std::nullopt;
  return parse_moment(words[2] + "-" + std::to_string(month / 3 + 1) + "-" + words[1] +
                      (words.size() > 3 ? " " + words[3] : ""));
}

/// "# latitude = 30.5" and its like.
void read_comment(const std::string& line, Cast& cast) {
  const std::size_t mark = line.find_first_of("=:");
  if (mark == std::string::npos) return;
  const std::string key = lower(line.substr(0, mark)), value = line.substr(mark + 1);
  const auto has = [&](const char* word) { return key.find(word) != std::string::npos; };
  if (has("latitude")) {
    if (const auto degrees = degrees_of(value)) cast.latitude = degrees;
  } else if (has("longitude")) {
    if (const auto degrees = degrees_of(value)) cast.longitude = degrees;
  } else if (has("start_time") || has("utc") || key.ends_with("time") || key.ends_with("time ") ||
             has("date")) {
    if (const auto moment = moment_of_words(value.substr(0, value.find('[')))) cast.time = moment;
  }
}

CastRows read_sea_bird(const std::filesystem::path& path, const std::vector<std::string>& lines) {
  CastRows rows;
  double bad = -9.99e-29;
  std::size_t i = 0;
  for (; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (lower(line).starts_with("*end*")) break;
    if (line.empty() || (line[0] != '*' && line[0] != '#')) continue;
    const std::string word = lower(line);
    if (word.starts_with("# name ")) {  // "# name 0 = prDM: Pressure, Digiquartz [db]"
      const std::size_t equals = line.find('=');
      if (equals == std::string::npos) continue;
      const std::string about = trimmed(line.substr(equals + 1));
      const auto [name, unit] = name_and_unit(about);
      CastColumn column{.name = about.substr(0, about.find(':'))};
      column.kind = measured_of(lower(about.substr(0, about.find(':'))));
      const std::string where = path.string() + ":" + std::to_string(i + 1) + ": " + column.name;
      set_unit(column,
               about.find('[') == std::string::npos
                   ? ""
                   : about.substr(about.find('[') + 1, about.find(']') - about.find('[') - 1),
               where);
      rows.columns.push_back(column);
    } else if (word.starts_with("# bad_flag")) {
      if (const auto flag = number_of(trimmed(line.substr(line.find('=') + 1)), false)) bad = *flag;
    } else {
      read_comment(line, rows.about);
    }
  }
  if (i == lines.size() || rows.columns.empty())
    throw InputError({.where = path.string(),
                      .got = "no \"# name\" lines, or no \"*END*\"",
                      .expected = "the head of a Sea-Bird .cnv"});
  for (++i; i < lines.size(); ++i) {
    std::vector<double> row;
    for (const std::string& word : fields_of(lines[i], ' ')) {
      if (word.empty()) continue;
      const auto number = number_of(word, false);
      if (!number)
        throw InputError({.where = path.string() + ":" + std::to_string(i + 1),
                          .got = in_quotes(word),
                          .expected = "numbers"});
      row.push_back(*number == bad ? not_measured : *number);
    }
    if (!row.empty()) rows.rows.push_back(std::move(row));
  }
  return rows;
}

CastRows read_columns(const std::filesystem::path& path, const std::vector<std::string>& lines) {
  CastRows rows;
  char mark = ',';
  std::vector<std::string> headings;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = trimmed(lines[i]);
    const std::string where = path.string() + ":" + std::to_string(i + 1);
    if (line.empty()) continue;
    if (line[0] == '#' || line.starts_with("//")) {
      read_comment(line.substr(1), rows.about);
      continue;
    }
    if (headings.empty()) {
      mark = line.find(';') != std::string::npos    ? ';'
             : line.find('\t') != std::string::npos ? '\t'
                                                    : ',';
      headings = fields_of(lines[i], mark);
      for (const std::string& heading : headings) {
        const auto [name, unit] = name_and_unit(heading);
        CastColumn column{.name = name, .kind = measured_of(lower(name))};
        set_unit(column, unit, where + ": " + name);
        if (column.kind == Measured::pressure && unit.empty()) column.scale = 1e4;
        rows.columns.push_back(column);
      }
      const bool some =
          std::any_of(rows.columns.begin(), rows.columns.end(),
                      [](const CastColumn& column) { return column.kind.has_value(); });
      if (!some)
        throw InputError({.where = where,
                          .got = in_quotes(line),
                          .expected =
                              "a header that names columns: depth or pressure, temperature, "
                              "salinity or sound speed"});
      continue;
    }
    const auto fields = fields_of(lines[i], mark);
    std::vector<double> row;
    std::size_t numbers = 0, words = 0;
    for (const std::string& field : fields) {
      const auto number = number_of(field, mark != ',');
      row.push_back(number.value_or(not_measured));
      (number ? numbers : words) += field.empty() ? 0 : 1;
    }
    if (rows.rows.empty() && numbers == 0 && words > 0) {  // a line of units
      for (std::size_t k = 0; k < std::min(fields.size(), rows.columns.size()); ++k) {
        rows.columns[k].scale = 1.0;
        const auto [name, unit] = name_and_unit(fields[k]);
        set_unit(rows.columns[k], unit.empty() ? name : unit, where + ": " + rows.columns[k].name);
      }
      continue;
    }
    for (std::size_t k = 0; k < std::min(fields.size(), rows.columns.size()); ++k) {
      const auto kind = rows.columns[k].kind;
      const std::string word = lower(fields[k]);
      if (!kind || !std::isnan(row[k]) || word.empty() || word == "nan" || word == "na" ||
          word == "-" || kind == Measured::flag)
        continue;
      throw InputError({.where = where + ": " + rows.columns[k].name,
                        .got = in_quotes(fields[k]),
                        .expected = mark == ',' ? "a number; with decimal commas, columns part at "
                                                  "\";\""
                                                : "a number"});
    }
    rows.rows.push_back(std::move(row));
  }
  if (headings.empty())
    throw InputError({.where = path.string(), .got = "no line but comments", .expected = "a cast"});
  for (const CastColumn& column : rows.columns)
    if (column.kind == Measured::pressure && column.scale == 1.0)
      throw InputError({.where = path.string() + ": " + column.name,
                        .got = "no unit",
                        .expected = "one in the header: \"Pressure [dbar]\""});
  return rows;
}

// Argo.

std::vector<Cast> read_argo(const std::filesystem::path& path, double latitude) {
  std::map<std::string, NetcdfArray> arrays;
  for (NetcdfArray& array : read_netcdf_arrays(
           path,
           {"PRES", "TEMP", "PSAL", "PRES_ADJUSTED", "TEMP_ADJUSTED", "PSAL_ADJUSTED", "PRES_QC",
            "TEMP_QC", "PSAL_QC", "PRES_ADJUSTED_QC", "TEMP_ADJUSTED_QC", "PSAL_ADJUSTED_QC",
            "DATA_MODE", "LATITUDE", "LONGITUDE", "JULD", "PLATFORM_NUMBER", "CYCLE_NUMBER"}))
    arrays[array.name] = std::move(array);
  const auto require = [&](const char* name, std::size_t rank) -> const NetcdfArray& {
    const auto found = arrays.find(name);
    if (found == arrays.end() || found->second.shape.size() != rank)
      throw InputError({.where = path.string() + ": " + name,
                        .got = found == arrays.end() ? "no such variable" : "another shape",
                        .expected = "PRES, TEMP and PSAL on profiles and levels, with LATITUDE, "
                                    "LONGITUDE and JULD of each profile, as Argo has them"});
    return found->second;
  };
  const NetcdfArray& pressure = require("PRES", 2);
  const std::size_t profiles = pressure.shape[0], levels = pressure.shape[1];
  for (const char* name : {"TEMP", "PSAL"})
    if (require(name, 2).shape != pressure.shape)
      throw InputError({.where = path.string() + ": " + name,
                        .got = "another shape than that of PRES",
                        .expected = "the same"});
  for (const auto& [name, unit] : {std::pair{"PRES", "d"}, {"TEMP", "deg"}})
    if (const std::string units = lower(require(name, 2).units);
        !units.empty() && !units.starts_with(unit))
      throw InputError({.where = path.string() + ": " + name,
                        .got = "units of " + in_quotes(require(name, 2).units),
                        .expected = std::string(name) == "PRES" ? "decibar" : "degree_Celsius"});
  for (const char* name : {"LATITUDE", "LONGITUDE"})
    if (require(name, 1).numbers.size() != profiles)
      throw InputError({.where = path.string() + ": " + name,
                        .got = "another length than the number of profiles",
                        .expected = std::to_string(profiles)});
  const auto text_of = [&](const char* name, std::size_t profile) -> std::string {
    const auto found = arrays.find(name);
    if (found == arrays.end() || found->second.characters.empty() || profiles == 0) return "";
    const std::size_t width = found->second.characters.size() / profiles;
    return trimmed(found->second.characters.substr(profile * width, width).c_str());
  };
  std::vector<Cast> casts;
  for (std::size_t p = 0; p < profiles; ++p) {
    CastRows rows;
    const std::string mode = text_of("DATA_MODE", p);
    const bool adjusted = mode == "A" || mode == "D";
    const std::string suffix = adjusted && arrays.count("PRES_ADJUSTED") != 0 ? "_ADJUSTED" : "";
    rows.columns = {{"PRES" + suffix, Measured::pressure, 1e4},
                    {"TEMP" + suffix, Measured::temperature},
                    {"PSAL" + suffix, Measured::salinity}};
    for (std::size_t level = 0; level < levels; ++level) {
      std::vector<double> row;
      bool padding = true;
      for (const CastColumn& column : rows.columns) {
        const auto values = arrays.find(column.name), flags = arrays.find(column.name + "_QC");
        const std::size_t at = p * levels + level;
        const bool there = values != arrays.end() && at < values->second.numbers.size();
        double value = there ? values->second.numbers[at] : not_measured;
        padding = padding && std::isnan(value);
        if (flags != arrays.end() && at < flags->second.characters.size() &&
            std::string_view("1258").find(flags->second.characters[at]) == std::string_view::npos)
          value = not_measured;
        row.push_back(value);
      }
      if (!padding) rows.rows.push_back(std::move(row));
    }
    if (rows.rows.empty()) continue;
    const double lat = arrays["LATITUDE"].numbers[p], lon = arrays["LONGITUDE"].numbers[p];
    if (!std::isnan(lat) && !std::isnan(lon)) {
      rows.about.latitude = lat;
      rows.about.longitude = lon;
    }
    const NetcdfArray& juld = arrays["JULD"];
    if (p < juld.numbers.size() && !std::isnan(juld.numbers[p]))
      if (const auto units =
              TimeUnits::parse(juld.units.empty() ? "days since 1950-01-01" : juld.units, ""))
        rows.about.time = units->at(juld.numbers[p]);
    rows.about.source = path.filename().string();
    if (const std::string name = text_of("PLATFORM_NUMBER", p); !name.empty())
      rows.about.source += ", float " + name;
    if (const auto& cycles = arrays["CYCLE_NUMBER"].numbers; p < cycles.size())
      rows.about.source += ", cycle " + to_text(cycles[p]);
    try {
      casts.push_back(
          made_cast(std::move(rows), path.string() + ": profile " + std::to_string(p), latitude));
    } catch (const InputError&) {
      if (p + 1 == profiles && casts.empty()) throw;  // one bad profile among others is passed over
    }
  }
  if (casts.empty())
    throw InputError({.where = path.string() + ": PRES, TEMP and PSAL",
                      .got = "no profile with good values (quality flags 1, 2, 5, 8)",
                      .expected = "one or more"});
  return casts;
}

bool is_text(const std::filesystem::path& path) {
  const std::string start = InputFile(path, "a file of data").read(4096);
  using namespace std::string_literals;
  return start.find('\0') == std::string::npos && !start.starts_with("CDF") &&
         !start.starts_with("\x89HDF") && !start.empty();
}

}  // namespace

bool is_cast_file(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return false;
  if (is_text(path))
    return lower(InputFile(path, "a file of data").read(5)) != "ncols" &&
           path.extension() != ".asc";
  const std::string start = InputFile(path, "a netCDF file").read(4);
  if (!start.starts_with("CDF") && !start.starts_with("\x89HDF")) return false;
  const auto arrays = read_netcdf_arrays(path, {"PLATFORM_NUMBER", "CYCLE_NUMBER"});
  return !arrays.empty();
}

std::vector<Cast> read_casts(const std::filesystem::path& path, double latitude) {
  if (!is_text(path)) return read_argo(path, latitude);
  const std::vector<std::string> lines = lines_of(read_text_file(path, "a cast"));
  const bool sea_bird = lower(path.extension().string()) == ".cnv" ||
                        (!lines.empty() && lines[0].starts_with("* Sea-Bird"));
  CastRows rows = sea_bird ? read_sea_bird(path, lines) : read_columns(path, lines);
  rows.about.source = path.filename().string();
  return {made_cast(std::move(rows), path.string(), latitude)};
}

}  // namespace asdic::detail
