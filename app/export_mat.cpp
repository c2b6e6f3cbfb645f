#include "app/export_mat.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "app/console.h"
#include "core/error.h"
#include "io/mat/mat_file.h"

namespace asdic::detail::app {
namespace {

/// Tables of a ping file, and what they are called in a MAT-file.
constexpr std::array<std::pair<const char*, const char*>, 4> tables{
    {{"echoes", "echoes"},
     {"arrivals", "arrivals"},
     {"interference", "interference"},
     {"processed/detections", "detections"}}};
/// Columns that count rows of the whole file, which one ping does not have.
constexpr std::array<std::string_view, 5> left_out{"ping", "echo", "arrival", "first_bounce",
                                                   "bounce_count"};

/// Variables of one ping on their way into a file, and the unit of each.
class Variables {
 public:
  Variables(const Hdf5File& from, std::size_t ping) : from_(from), ping_(ping) {}

  void add(const std::string& name, MatValue value, const std::string& unit = "") {
    fields_.push_back({name, std::move(value)});
    if (!unit.empty()) units_.push_back({name, unit});
  }

  /// This ping's row of a dataset: a scalar, a row a target or a phone.
  void add_row(const std::string& name) {
    if (!from_.has(name)) return;
    const Shape shape = from_.info(name).shape;
    Shape start(shape.size(), 0), count = shape;
    start[0] = ping_;
    count[0] = 1;
    const std::vector<double> row = from_.read<double>(name, start, count);
    const std::size_t rows = shape.size() > 2 ? shape[1] : 1;
    add_values(name, row, rows, row.size() / std::max<std::size_t>(rows, 1));
  }

  /// A whole dataset of numbers, as a column.
  void add_column(const std::string& name) {
    if (!from_.has(name)) return;
    const std::vector<double> all = from_.read<double>(name);
    add_values(name, all, all.size(), 1);
  }

  /// The rows of a table that are of this ping.
  void add_table(const std::string& group, const std::string& name, int number) {
    if (!from_.has(group + "/ping")) return;
    const std::vector<double> of_ping = from_.read<double>(group + "/ping");
    MatStruct columns, units;
    for (const DatasetInfo& one : from_.datasets()) {
      const std::string before = "/" + group + "/";
      if (!one.path.starts_with(before) || one.shape.size() != 1 ||
          one.shape[0] != of_ping.size() || one.type == ElementType::text ||
          one.type == ElementType::other)
        continue;
      const std::string column = one.path.substr(before.size());
      if (std::find(left_out.begin(), left_out.end(), column) != left_out.end()) continue;
      const std::vector<double> all = from_.read<double>(one.path);
      MatMatrix kept{.rows = 0, .columns = 1};
      for (std::size_t i = 0; i < all.size(); ++i)
        if (of_ping[i] == number) kept.values.push_back(all[i]);
      kept.rows = kept.values.size();
      columns.push_back({column, std::move(kept)});
      const std::string unit = from_.attribute_or(one.path, "units", "");
      if (!unit.empty()) units.push_back({column, unit});
    }
    fields_.push_back({name, std::move(columns)});
    units_.push_back({name, std::move(units)});
  }

  void write_to(MatFile& file) const {
    for (const MatField& field : fields_) file.write(field.name, field.value);
    file.write("units", units_);
  }
  void set_unit(const std::string& name, const std::string& unit) {
    units_.push_back({name, unit});
  }

 private:
  /// \param values  [rows × columns], row by row as in HDF5
  void add_values(const std::string& name, const std::vector<double>& values, std::size_t rows,
                  std::size_t columns) {
    MatMatrix matrix{
        .rows = rows, .columns = columns, .values = std::vector<double>(values.size())};
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        matrix.values[k * rows + i] = values[i * columns + k];
    add(name, std::move(matrix), from_.attribute_or(name, "units", ""));
  }

  const Hdf5File& from_;
  std::size_t ping_;
  MatStruct fields_{}, units_{};
};

MatMatrix number(double value) { return {.rows = 1, .columns = 1, .values = {value}}; }

MatColumns pressure_of(const PingFile& file, std::size_t ping) {
  return {.rows = file.valid_samples(ping),
          .columns = file.channels(),
          .is_complex = file.is_complex(),
          .column = [&file, ping](std::size_t channel) { return file.pressure(ping, channel); }};
}

/// The pulses at the rate of the samples.
void write_replicas(MatFile& mat, const PingFile& file) {
  const Hdf5File& from = file.file();
  for (int k = 0;; ++k) {
    const std::string name = k == 0 ? "replica" : fmt::format("replica_{}", k);
    if (!from.has(name)) return;
    const std::vector<float> values = from.read<float>(name);
    mat.write(name, MatColumns{.rows = from.info(name).shape[0],
                               .columns = 1,
                               .is_complex = file.is_complex(),
                               .column = [&values](std::size_t) { return values; }});
  }
}

void write_ping(MatFile& mat, const PingFile& file, std::size_t ping, int number_of_ping) {
  const Hdf5File& from = file.file();
  Variables variables(from, ping);
  for (const char* key : {"title", "program_version"})
    variables.add(key, from.attribute_or("", key, ""));
  variables.add("scenario", file.scenario_text());
  if (from.has_attribute("", "warnings"))
    variables.add("warnings", from.attribute_texts("", "warnings"));
  variables.add("ping", number(number_of_ping));
  variables.add("sample_rate", number(file.sample_rate()), "Hz");
  variables.add("carrier", number(file.carrier()), "Hz");
  const double start = from.attribute_number("pressure", "time_start"),
               step = from.attribute_number("pressure", "time_step");
  MatMatrix time{.rows = file.valid_samples(ping), .columns = 1};
  time.values.resize(time.rows);
  for (std::size_t i = 0; i < time.rows; ++i)
    time.values[i] = start + static_cast<double>(i) * step;
  variables.add("time", std::move(time), "s");
  for (const char* name : {"ping_time", "elevation_deg", "platform_position", "platform_velocity",
                           "phone_position", "transmitter", "target_position", "target_velocity",
                           "target_strength_db", "target_present"})
    variables.add_row(name);
  variables.add_column("channel_array");
  variables.add("array_names", from.attribute_texts("channel_array", "names"));
  if (from.has("target_index"))
    variables.add("target_names", from.attribute_texts("target_index", "names"));
  variables.add("transmitter_names", from.attribute_texts("", "transmitters"));
  for (const auto& [group, name] : tables) variables.add_table(group, name, number_of_ping);
  variables.set_unit("pressure", from.attribute_or("pressure", "units", "Pa"));
  mat.write("pressure", pressure_of(file, ping));
  write_replicas(mat, file);
  variables.write_to(mat);
}

}  // namespace

void MatExport::check(const PingFile& file, const ExportChoice& choice) {
  for (std::size_t i = choice.first; i < choice.end; ++i) {
    const MatColumns pressure = pressure_of(file, i);
    const std::uint64_t bytes =
        std::max<std::uint64_t>(bytes_of(pressure), pressure.rows * sizeof(double));
    if (bytes > most_mat_bytes)
      throw InputError(
          {.where = choice.file.string(),
           .got = fmt::format("{:.1f} GB of pressure in a ping", static_cast<double>(bytes) / 1e9),
           .expected = "less than 2.1 GB, the most that a variable of a MAT-file "
                       "holds; Octave and MATLAB read the HDF5 file itself"});
  }
}

void MatExport::write(const PingFile& file, const ExportChoice& choice) {
  const std::string stem = choice.file.stem().string();
  const std::vector<int> numbers = file.numbers();
  for (std::size_t i = choice.first; i < choice.end; ++i) {
    const std::filesystem::path path =
        choice.folder / fmt::format("{}_ping{:03}.mat", stem, numbers[i]);
    MatFile mat(path, {.force = choice.force});
    write_ping(mat, file, i, numbers[i]);
    mat.finish();
    print(fmt::format("{}: {}, {} samples at {} Hz{}\n", path.string(),
                      count_of(file.channels(), "phone"), file.valid_samples(i), file.sample_rate(),
                      file.is_complex() ? ", complex" : ""));
  }
}

}  // namespace asdic::detail::app
