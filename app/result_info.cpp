#include "app/result_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "app/console.h"
#include "app/field_output.h"
#include "io/hdf5/environment_group.h"
#include "io/result/result_file.h"
#include "io/wav/wav.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail::app {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least and the greatest of some numbers.
struct Extent {
  double least = infinity, greatest = -infinity;

  void add(double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  void add(const std::vector<double>& values) {
    for (const double x : values) add(x);
  }
  /// "12.5 to 2000 m"
  [[nodiscard]] std::string text(std::string_view unit) const {
    if (least > greatest) return "none";
    if (least == greatest) return fmt::format("{:g} {}", least, unit);
    return fmt::format("{:g} to {:g} {}", least, greatest, unit);
  }
};

Extent extent(const std::vector<double>& values) {
  Extent all;
  all.add(values);
  return all;
}

/// Nothing of a file that does not tell it.
std::string frequency_line(double frequency) {
  return frequency > 0.0 ? fmt::format("frequency  {:g} Hz\n", frequency) : "";
}

/// \param receivers  in words
std::string places(const std::vector<double>& sources, const std::string& receivers,
                   const std::vector<double>& depths, const std::vector<double>& ranges) {
  return fmt::format("sources    {}: {} deep\n", count_of(sources.size(), "depth"),
                     extent(sources).text("m")) +
         fmt::format("receivers  {}: {} deep, {} away\n", receivers, extent(depths).text("m"),
                     extent(ranges).text("m"));
}

/// Nothing of a file of one plane.
std::string map_line(const bellhop::MapPlaces& map) {
  if (!map.is_map()) return "";
  return fmt::format("map        {} of sources, receivers on {}: {}, counter-clockwise from x\n",
                     count_of(map.source_x.size() * map.source_y.size(), "place"),
                     count_of(map.azimuths_deg.size(), "azimuth"),
                     extent(map.azimuths_deg).text("deg"));
}

std::string content(const bellhop::ShadeFile& field) {
  const std::string receivers =
      field.irregular ? count_of(field.receiver_ranges.size(), "place")
                      : fmt::format("{} depths x {} ranges", field.receiver_depths.size(),
                                    field.receiver_ranges.size());
  return frequency_line(field.frequency) + map_line(field.map) +
         places(field.source_depths, receivers, field.receiver_depths, field.receiver_ranges) +
         loss_text(field.pressure);
}

std::string content(const bellhop::ArrivalsFile& file) {
  Extent delay, bounces;
  std::size_t count = 0;
  for (const auto& receiver : file.arrivals)
    for (const bellhop::ArrivalRow& row : receiver) {
      delay.add(row.delay);
      bounces.add(row.surface_bounces + row.bottom_bounces);
      ++count;
    }
  return frequency_line(file.frequency) + map_line(file.map) +
         places(file.source_depths, count_of(file.arrivals.size(), "receiver"),
                file.receiver_depths, file.receiver_ranges) +
         fmt::format("arrivals   {}, {} after the start, {}\n", count, delay.text("s"),
                     bounces.text("bounces"));
}

std::string content(const bellhop::RayFile& file) {
  Extent launch, range, depth;
  for (const bellhop::RayFile::Ray& ray : file.rays) {
    launch.add(-ray.launch_angle_deg);
    range.add(ray.range);
    depth.add(ray.depth);
  }
  return frequency_line(file.frequency) +
         fmt::format("rays       {}, launched at {}\n", file.rays.size(), launch.text("deg")) +
         fmt::format("reach      {} away, {} deep\n", range.text("m"), depth.text("m"));
}

std::string title_of(const PropagationFile& result) {
  if (const auto* field = std::get_if<bellhop::ShadeFile>(&result)) return field->title;
  if (const auto* rays = std::get_if<bellhop::RayFile>(&result)) return rays->title;
  return {};
}

/// Who made an HDF5 file, of what.
std::string origin(const Hdf5File& file) {
  const auto root = [&](const std::string& key) { return file.attribute_or("", key, "unknown"); };
  std::string text = fmt::format("by         asdic {}", root("program_version"));
  if (file.has_attribute("", "build")) text += ", " + root("build");
  text += '\n';
  if (file.has_attribute("", "scenario_sha256"))
    text += fmt::format("scenario   sha256 {}\n", root("scenario_sha256"));
  if (file.has_attribute("", "overrides"))
    text += fmt::format("changed by {}\n", root("overrides"));
  text += place_text(file, 11);
  return text;
}

/// How sure a field is of its beams; nothing of a file that does not tell it.
std::string certainty(const Hdf5File& file) {
  const auto number = [&](const char* key) { return file.attribute_number("", key); };
  std::string text;
  if (file.has_attribute("", "beams") && file.has_attribute("", "beam_error_db"))
    text += fmt::format(
        "beams      {:g}; {}\n", number("beams"),
        beam_error_text(number("beam_error_db"), file.has_attribute("", "beam_error_bounded") &&
                                                     number("beam_error_bounded") != 0.0));
  if (file.has_attribute("", "sure_pct"))
    text += "certain    " + certainty_text(number("sure_pct") / 100.0) + '\n';
  return text;
}

/// Of a .shd or .arr with the layout that asdic gives those of BELLHOP3D.
std::string layout_line(const PropagationFile& result) {
  const auto* field = std::get_if<bellhop::ShadeFile>(&result);
  const auto* arrivals = std::get_if<bellhop::ArrivalsFile>(&result);
  if (!(field != nullptr && field->map.is_map()) &&
      !(arrivals != nullptr && arrivals->three_dimensional))
    return "";
  return "layout     as asdic writes it; that BELLHOP3D's own files of many azimuths are alike is\n"
         "           not confirmed (docs/formats/bellhop3d.md)\n";
}

std::string file_line(const std::string& path, std::string_view kind) {
  return fmt::format("file       {}, {}, {}\n", path,
                     byte_count(static_cast<double>(std::filesystem::file_size(path))), kind);
}

}  // namespace

bool is_propagation_file(const std::string& path) {
  constexpr std::array<std::string_view, 3> endings{".shd", ".arr", ".ray"};
  constexpr std::array<std::string_view, 3> types{"asdic field", "asdic arrivals", "asdic rays"};
  if (const std::string type = filetype_of(path); !type.empty())
    return std::find(types.begin(), types.end(), type) != types.end();
  const std::string ending = std::filesystem::path(path).extension().string();
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

int propagation_info(const std::string& path) {
  const PropagationFile result = read_result(path);
  std::string title = title_of(result), about;
  if (is_hdf5(path)) {
    const Hdf5File file = Hdf5File::open(path);
    title = file.attribute_or("", "title", title);
    about = certainty(file) + origin(file);
  } else {
    about = layout_line(result);
  }
  print(emphasised(title.empty() ? path : title) + '\n');
  print(file_line(path, kind_of(result)));
  print(std::visit([](const auto& file) { return content(file); }, result) + about);
  return 0;
}

std::string result_file_line(const std::string& path, std::string_view kind) {
  return file_line(path, kind);
}

std::string result_origin(const std::string& path) { return origin(Hdf5File::open(path)); }

int wav_info(const std::string& path) {
  const WavContent wav = read_wav_content(path);
  const double rate = wav.scale.sample_rate;
  print(emphasised(path) + '\n' + file_line(path, "sound"));
  print(fmt::format("holds      {}, {} samples at {:g} Hz: {:g} s\n",
                    wav.carrier > 0.0 ? count_of(wav.channels / 2, "phone") +
                                            fmt::format(" as I and Q about {:g} Hz", wav.carrier)
                                      : count_of(wav.channels, "phone"),
                    wav.samples, rate, rate > 0.0 ? static_cast<double>(wav.samples) / rate : 0.0));
  print(wav.has_scale ? fmt::format("full scale {:.6g} Pa\n", wav.scale.pascal_per_unit)
                      : "full scale unknown: no " + path + ".json\n");
  return 0;
}

std::string place_text(const Hdf5File& file, int width) {
  const auto origin = read_origin_attributes(file);
  if (!origin) return "";
  const auto rounded = [](double degree) { return std::round(1e6 * degree) / 1e6; };
  std::string text = fmt::format("{:<{}}{} N {} E is the map's [0, 0]{}\n", "place", width,
                                 rounded(origin->latitude_deg), rounded(origin->longitude_deg),
                                 origin->time.empty() ? "" : "; its ocean: " + origin->time);
  for (const std::string& source : origin->sources)
    text += fmt::format("{:<{}}{}\n", "ocean", width, source);
  return text;
}

}  // namespace asdic::detail::app
