#include <algorithm>
#include <cmath>

#include "core/fields_viewer.h"
#include "core/text.h"
#include "io/hdf5/scale.h"
#include "io/ping/sections.h"
#include "io/text/material_text.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail::ping_file {
namespace {

/// Writes the numbers of described structs as attributes of a group, as they are in the structs.
class NumberAttributes final : public FieldsViewer {
 public:
  NumberAttributes(Hdf5File& file, std::string group, std::string prefix)
      : file_(file), group_(std::move(group)), prefix_(std::move(prefix)) {}

 private:
  void number(const Setting& s, const Quantity&, double& value, bool*) override {
    file_.set_attribute(group_, prefix_ + std::string(s.key.name), value);
  }

  Hdf5File& file_;
  std::string group_, prefix_;
};

std::string text_of(const Absorption& absorption) {
  std::string text(std::visit([](const auto& law) { return law.name; }, absorption));
  for_each_water_property(absorption, [&](std::string_view name, double value) {
    if (name == "pH") text += ", pH " + to_text(value);
    if (name == "temperature") text += ", " + to_text(value) + " degC";
    if (name == "salinity") text += ", " + to_text(value) + " psu";
    if (name == "depth") text += ", " + to_text(value) + " m";
  });
  return text;
}

std::string interpolation_of(const Environment& ocean) {
  if (ocean.section) return "section";
  if (const auto& munk = ocean.water.munk_parameters())
    return "munk, axis " + to_text(munk->axis_speed) + " m/s at " + to_text(munk->axis_depth) +
           " m, scale " + to_text(munk->scale_depth) + " m, perturbation " +
           to_text(munk->perturbation);
  if (ocean.water.depths().size() == 1) return "isovelocity";
  return std::string(name(ocean.water.interpolation()));
}

template <class T>
std::vector<T> vector_of(std::span<const T> values) {
  return {values.begin(), values.end()};
}

/// The nodes of a boundary that is not flat. \param side  "surface" or "bottom"
void write_shape(Hdf5File& file, const std::string& side, const BoundaryShape& shape) {
  const std::string range = "environment/" + side + "_range",
                    depth = "environment/" + side + "_depth";
  write_scale(file, range, side + "_node", vector_of(shape.ranges()), "along the transect", "m",
              cf::range_axis);
  file.write<double>(depth, vector_of(shape.depths()), {shape.depths().size()});
  describe(file, depth, "of the " + side + " at its nodes, positive down", "m",
           cf::of_boundary(side));
  file.attach_scales(depth, {range});
  file.set_attribute(depth, "interpolation", name(shape.interpolation()));
  if (shape.materials().empty()) return;
  std::vector<std::string> materials;
  for (const BoundaryMaterial& material : shape.materials())
    materials.push_back(material_text(material));
  file.set_attribute(depth, "materials", materials);
}

void write_section(Hdf5File& file, const SoundSpeedSection& section) {
  write_scale(file, "environment/section_range", "section_range", vector_of(section.ranges()),
              "along the transect", "m", cf::range_axis);
  write_scale(file, "environment/section_depth", "section_depth", vector_of(section.depths()),
              "depth, positive down", "m", cf::depth_axis);
  file.write<double>("environment/section_sound_speed", vector_of(section.speeds()),
                     {section.ranges().size(), section.depths().size()});
  describe(file, "environment/section_sound_speed", "speed of sound", "m/s", cf::sound_speed);
  file.attach_scales("environment/section_sound_speed",
                     {"environment/section_range", "environment/section_depth"});
}

/// All that varies along the transect, and where that lies.
void write_transect(Hdf5File& file, const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  if (!varies_with_range(ocean)) return;
  file.set_attribute("environment", "transect_x_m", scenario.transect.x);
  file.set_attribute("environment", "transect_y_m", scenario.transect.y);
  file.set_attribute("environment", "transect_bearing_deg",
                     compass_degrees(scenario.transect.bearing));
  if (ocean.section) write_section(file, *ocean.section);
  if (ocean.surface.shape) write_shape(file, "surface", *ocean.surface.shape);
  if (ocean.bottom.shape) write_shape(file, "bottom", *ocean.bottom.shape);
}

}  // namespace

void write_environment(Hdf5File& file, const Scenario& scenario) {
  const Environment& ocean = scenario.environment;
  const PropagationPaths paths(ocean, scenario.transect);
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  const double surface = paths.surface_depth(place), bottom = paths.bottom_depth(place);
  constexpr std::size_t points = 501;
  std::vector<double> depth, speed;
  for (std::size_t i = 0; i < points; ++i) {
    depth.push_back(surface + (bottom - surface) * static_cast<double>(i) / (points - 1.0));
    speed.push_back(paths.speed_at({place.x(), place.y(), depth.back()}));
  }
  write_scale(file, "environment/depth", "depth", depth, "depth, positive down", "m",
              cf::depth_axis);
  file.write<double>("environment/sound_speed", speed, {points});
  describe(file, "environment/sound_speed", "speed of sound at the platform's first place", "m/s",
           cf::sound_speed);
  file.attach_scales("environment/sound_speed", {"environment/depth"});

  const std::string group = "environment";
  file.set_attribute(group, "surface", material_text(ocean.surface.material));
  file.set_attribute(group, "bottom", material_text(ocean.bottom.material));
  file.set_attribute(group, "bottom_depth_m", bottom);
  file.set_attribute(group, "wind_speed_mps", scenario.wind_speed);
  file.set_attribute(group, "absorption", text_of(ocean.absorption));
  file.set_attribute(group, "interpolation", interpolation_of(ocean));
  write_transect(file, scenario);
  const auto write_law = [&](const auto& law, const std::string& prefix) {
    file.set_attribute(group, prefix + "_model", std::string(name_of(law)));
    NumberAttributes attributes(file, group, prefix + "_");
    std::visit([&](const auto& one) { look(one, attributes); }, law);
  };
  write_law(scenario.reverberation.surface, "scattering");
  if (scenario.reverberation.bottom) write_law(*scenario.reverberation.bottom, "bottom_scattering");
  const double wavelength = paths.speed_at(place) / Pulse(scenario.pulse).centre_frequency();
  file.set_attribute(group, "transmitter_line_length_m",
                     BeamPattern(scenario.transmitters[0], wavelength).line_length());
}

}  // namespace asdic::detail::ping_file
