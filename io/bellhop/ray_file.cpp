// Rays of bellhop_files.h: .ray.
#include <cmath>

#include "core/utf8.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/fortran_format.h"
#include "io/bellhop/list_reader.h"
#include "io/bellhop/number_stream.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::bellhop {
namespace {

/// The first line without its quotes and the blanks around.
std::string title_of(std::string_view line) {
  const auto strip = [&](std::string_view these) {
    while (!line.empty() && these.find(line.front()) < these.size()) line.remove_prefix(1);
    while (!line.empty() && these.find(line.back()) < these.size()) line.remove_suffix(1);
  };
  strip(" \r");
  if (line.size() >= 2 && (line.front() == '\'' || line.front() == '"') &&
      line.back() == line.front())
    line = line.substr(1, line.size() - 2);
  strip(" ");
  return std::string(line);
}

}  // namespace

RayFile parse_ray_file(std::string_view bytes, const std::string& name) {
  NumberStream text(bytes, name);
  RayFile file;
  file.title = title_of(text.rest_of_line());
  file.frequency = text.real("frequency");
  if (!(file.frequency > 0.0))
    text.fail("frequency", shown(file.frequency) + " Hz", "a frequency above 0 Hz");
  file.sources_x = int(text.integer("number of source x", 0, most_of_a_count));
  file.sources_y = int(text.integer("number of source y", 0, most_of_a_count));
  file.sources_z = int(text.integer("number of source depths", 0, most_of_a_count));
  file.angles = int(text.integer("number of launch angles", 0, most_of_a_count));
  (void)text.integer("number of bearings", 0, most_of_a_count);
  file.surface_depth = text.real("surface depth");
  file.bottom_depth = text.real("bottom depth");
  if (const std::string_view word = unquoted(text.word()); word != "rz")
    text.fail("coordinates", shown(word), "'rz', rays in a plane");
  while (!text.at_end()) {
    RayFile::Ray& ray = file.rays.emplace_back();
    ray.launch_angle_deg = text.real("launch angle");
    const std::int64_t n = text.integer("number of points", 0, most_of_a_count);
    ray.surface_bounces = int(text.integer("surface bounces", 0, most_of_a_count));
    ray.bottom_bounces = int(text.integer("bottom bounces", 0, most_of_a_count));
    for (std::int64_t i = 0; i < n; ++i) {
      ray.range.push_back(text.real("range"));
      ray.depth.push_back(text.real("depth"));
    }
  }
  return file;
}

std::string ray_file_bytes(const RayFile& file) {
  std::string title(cut_to_bytes(file.title, 50));
  title.resize(50, ' ');
  std::string text = " '" + title + "'\n";
  const auto integers = [&](std::initializer_list<std::int64_t> values) {
    for (const std::int64_t value : values) append_integer(text, value);
    text += '\n';
  };
  const auto real = [&](double value) {
    append_real8(text, value);
    text += '\n';
  };
  real(file.frequency);
  integers({file.sources_x, file.sources_y, file.sources_z});
  integers({file.angles, 1});
  real(file.surface_depth);
  real(file.bottom_depth);
  text += " 'rz'\n";
  for (const RayFile::Ray& ray : file.rays) {
    real(ray.launch_angle_deg);
    integers({std::int64_t(ray.range.size()), ray.surface_bounces, ray.bottom_bounces});
    for (std::size_t i = 0; i < ray.range.size(); ++i) {
      append_real8(text, ray.range[i]);
      append_real8(text, ray.depth[i]);
      text += '\n';
    }
  }
  return text;
}

RayFile read_ray_file(const std::filesystem::path& path) {
  return parse_ray_file(read_input(path, "rays (.ray)"), path.string());
}

void write_ray_file(const std::filesystem::path& path, const RayFile& file) {
  write_ray_file(OutputFile(path, {.own = own::ray_file}), file);
}

void write_ray_file(OutputFile&& output, const RayFile& file) {
  output.write(ray_file_bytes(file));
}

}  // namespace asdic::detail::bellhop
