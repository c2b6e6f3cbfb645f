#include "io/processing/results.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/scale.h"
#include "io/isolated/child.h"
#include "io/processing/table.h"

namespace asdic::detail {
namespace {

using processing::Table;

void write_table(Hdf5File& file, const std::string& name, const std::string& dimension,
                 const Table& table) {
  GrowingTable into(file, "processed/" + name, dimension, table.columns);
  for (const auto& row : table.rows) into.row(row);
  into.write();
}

std::vector<float> decibels(const std::vector<float>& ratios) {
  std::vector<float> result;
  for (const float x : ratios)
    result.push_back(x > 0.0F ? 10.0F * std::log10(x) : -std::numeric_limits<float>::infinity());
  return result;
}

/// Beam–time and Doppler–time maps of one array, all its pings.
void write_maps(Hdf5File& file, const ProcessedRun& run, int array) {
  const std::string group = "processed/maps/array_" + std::to_string(array);
  const auto of_array = [&](const ProcessedPing& p) { return p.array.array == array; };
  const auto first = std::find_if(run.pings.begin(), run.pings.end(), of_array);
  if (first == run.pings.end()) return;
  const DetectorResult& like = first->array.result;
  const std::size_t columns = like.maps.time.size(), beams = like.grid.looks.size(),
                    filters = like.dopplers.size();
  write_scale(file, group + "/time", "map_time", like.maps.time,
              "middle of the column, after the start of the ping", "s");
  if (const auto& range = first->map_range.of_time; range.size() == columns) {
    file.write<double>(group + "/range", range, {columns});
    describe(file, group + "/range", "of an echo at that time, by the sound paths", "m");
    file.attach_scales(group + "/range", {group + "/time"});
  }
  std::vector<std::int32_t> number;
  for (std::size_t b = 0; b < beams; ++b) number.push_back(static_cast<std::int32_t>(b));
  write_scale(file, group + "/beam", "beam", number, "number of the beam");
  std::vector<double> bearing, elevation;
  for (const Vec3& look : like.grid.looks) {
    bearing.push_back(compass_degrees(std::atan2(look.x(), look.y())));
    elevation.push_back(degrees(std::asin(std::clamp(-look.z(), -1.0, 1.0))));
  }
  const auto column = [&](const std::string& name, const std::vector<double>& values,
                          const std::string& what, const std::string& units) {
    file.write<double>(group + "/" + name, values, {values.size()});
    describe(file, group + "/" + name, what, units);
    file.attach_scales(group + "/" + name, {group + "/beam"});
  };
  column("beam_bearing_deg", bearing, "look bearing, true (clockwise from north)", "degree");
  column("beam_elevation_deg", elevation, "look elevation, positive up", "degree");
  if (!like.grid.cosine.empty())
    column("beam_cosine", like.grid.cosine, "of the angle between look and axis", "");
  write_scale(file, group + "/doppler_factor", "filter", like.dopplers,
              "that the filter is matched to");
  const auto surface = [&](const std::string& name, const std::vector<double>& values,
                           const std::string& what) {
    if (values.size() != beams * columns) return;
    file.write<double>(group + "/" + name, values, {beams, columns});
    describe(file, group + "/" + name, what, "m");
    file.attach_scales(group + "/" + name, {group + "/beam", group + "/time"});
  };
  surface("beam_range", first->map_range.of_beam,
          "of an echo at that time out of that beam, sender and array apart, by the sound paths");
  surface("mirror_range", first->map_range.of_mirror,
          "the same on the other side of the line, to its left");
  const ArrayShape& shape = first->array.shape;
  constexpr const char* kinds[] = {"point", "line", "plane", "volume"};
  file.set_attribute(group, "array_kind", kinds[static_cast<int>(shape.kind)]);
  if (shape.kind == ArrayKind::line) {
    file.set_attribute(group, "axis_bearing_deg",
                       compass_degrees(std::atan2(shape.axis.x(), shape.axis.y())));
    file.set_attribute(group, "axis_elevation_deg",
                       degrees(std::asin(std::clamp(-shape.axis.z(), -1.0, 1.0))));
  }
  file.set_attribute(group, "sound_speed_mps", first->array.sound_speed);
  file.set_attribute(group, "time_cell_s", like.time_cell);
  file.set_attribute(group, "doppler_cell", like.doppler_cell);
  file.set_attribute(group, "delay_per_doppler_s", like.delay_per_doppler);

  file.create_growing<std::int32_t>(group + "/ping", {}, std::size_t{64});
  describe(file, group + "/ping", "number of the ping");
  file.make_scale(group + "/ping", "map_ping");
  const auto map = [&](const std::string& name, std::size_t rows, const std::string& what) {
    file.create_growing<float>(group + "/" + name, {rows, columns}, Shape{1, rows, columns}, 4);
    describe(file, group + "/" + name, what, "dB");
  };
  map("beam_time_db", beams, "power over background, the largest of all Doppler filters");
  map("doppler_time_db", filters, "power over background, the largest of all beams");
  file.attach_scales(group + "/beam_time_db", {group + "/ping", group + "/beam", group + "/time"});
  file.attach_scales(group + "/doppler_time_db",
                     {group + "/ping", group + "/doppler_factor", group + "/time"});
  for (const ProcessedPing& p : run.pings) {
    if (!of_array(p)) continue;
    const DetectionMaps& maps = p.array.result.maps;
    // Arrays that change shape may change their beams: only maps like the first are kept.
    if (maps.beam_time.size() != beams * columns || maps.doppler_time.size() != filters * columns)
      continue;
    file.append<std::int32_t>(group + "/ping", std::vector<std::int32_t>{p.array.ping});
    file.append<float>(group + "/beam_time_db", decibels(maps.beam_time));
    file.append<float>(group + "/doppler_time_db", decibels(maps.doppler_time));
  }
}

/// The replica's ambiguity surface, out to the edges of its main ridge and, beside that, to six
/// cells of delay: so a sweep's, which is far narrower than the sweep is long, is resolved.
void write_ambiguity(Hdf5File& file, const Replica& replica) {
  std::vector<double> delays, dopplers;
  const double span =
      std::min(0.05, std::max(4.0 / (replica.centre_frequency() * replica.duration()),
                              2.0 * doppler_cell(replica)));
  for (int i = -60; i <= 60; ++i) dopplers.push_back(1.0 + span * i / 60.0);
  const double ridge = std::max(std::abs(doppler_answer(replica, dopplers.front()).delay),
                                std::abs(doppler_answer(replica, dopplers.back()).delay));
  const double reach = std::min(replica.duration(), ridge + 6.0 / replica.noise_bandwidth());
  for (int i = -120; i <= 120; ++i) delays.push_back(reach * i / 120.0);
  const std::vector<double> surface = ambiguity(replica, delays, dopplers);
  std::vector<float> values;
  for (const double x : surface) values.push_back(static_cast<float>(x));
  write_scale(file, "processed/ambiguity/delay", "ambiguity_delay", delays,
              "of the echo over the filter's", "s");
  write_scale(file, "processed/ambiguity/doppler_factor", "ambiguity_doppler", dopplers,
              "of the echo over the filter's");
  file.write<float>("processed/ambiguity/power", values, {dopplers.size(), delays.size()});
  describe(file, "processed/ambiguity/power", "of the filter's answer, 1 at its echo");
  file.attach_scales("processed/ambiguity/power",
                     {"processed/ambiguity/doppler_factor", "processed/ambiguity/delay"});
}

/// Writes /processed into a file, in place of one that is there.
void add_results(const std::filesystem::path& path, const ProcessedRun& run,
                 const Replica& replica) {
  Hdf5File file = Hdf5File::edit(path);
  file.remove("processed");
  file.make_group("processed");
  file.set_attribute("processed", "version", "2.2");
  file.set_attribute("processed", "program_version", run.program_version);
  if (!run.options.empty()) file.set_attribute("processed", "options", run.options);
  if (!run.warnings.empty()) file.set_attribute("processed", "warnings", run.warnings);
  if (!run.notes.empty()) file.set_attribute("processed", "notes", run.notes);
  write_table(file, "detections", "detection", processing::detections_table(run));
  write_table(file, "tracks", "point", processing::tracks_table(run));
  write_table(file, "targets", "row", processing::targets_table(run));
  if (run.maps) {
    int arrays = 0;
    for (const ProcessedPing& p : run.pings) arrays = std::max(arrays, p.array.array + 1);
    for (int a = 0; a < arrays; ++a) write_maps(file, run, a);
    write_ambiguity(file, replica);
  }
  file.close();
}

}  // namespace

void write_processed(const std::filesystem::path& input, OutputFile&& output,
                     const ProcessedRun& run, const Replica& replica) {
  std::error_code error;
  const std::filesystem::path& part = output.part();
  std::filesystem::copy_file(input, part, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw RunError(part.string() + ": " + error.message());
  isolated::run(
      part, "HDF5", [&] { add_results(part, run, replica); }, isolated::patience);
  output.finish();
}

}  // namespace asdic::detail
