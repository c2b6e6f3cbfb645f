#include "io/scenario/writer.h"

#include <algorithm>

#include "io/scenario/ocean.h"
#include "io/scenario/propagation.h"
#include "io/text/toml_writer.h"

namespace asdic {
namespace {

void write_figures(TomlWriter& out, const Vacuum& /*vacuum*/) { out.text("kind", Vacuum::name); }
void write_figures(TomlWriter& out, const Rigid& /*rigid*/) { out.text("kind", Rigid::name); }

void write_figures(TomlWriter& out, const FluidHalfSpace& fluid) {
  out.text("kind", FluidHalfSpace::name);
  out.number("speed", fluid.speed);
  out.number("density", fluid.density);
  out.number("attenuation_db_per_wavelength", fluid.attenuation_db_per_wavelength);
}

void write_figures(TomlWriter& out, const ElasticHalfSpace& solid) {
  out.text("kind", ElasticHalfSpace::name);
  out.number("speed", solid.speed);
  out.number("shear_speed", solid.shear_speed);
  out.number("density", solid.density);
  out.number("attenuation_db_per_wavelength", solid.attenuation_db_per_wavelength);
  out.number("shear_attenuation_db_per_wavelength", solid.shear_attenuation_db_per_wavelength);
}

void write_rows(TomlWriter& out, const ReflectionTable& table) {
  out.angles("grazing", table.grazing);
  out.numbers("magnitude", table.magnitude);
  out.angles("phase", table.phase);
}

void write_figures(TomlWriter& out, const ReflectionTable& table) {
  out.text("kind", ReflectionTable::name);
  write_rows(out, table);
}

void write_figures(TomlWriter& out, const ReflectionCurves& /*curves*/) {
  out.text("kind", ReflectionTable::name);
}

void write_layer(TomlWriter& out, const FloorLayer& layer) {
  out.number("speed", layer.speed);
  out.number("density", layer.density);
  out.number("attenuation_db_per_wavelength", layer.attenuation_db_per_wavelength);
  out.number("shear_speed", layer.shear_speed);
  out.number("shear_attenuation_db_per_wavelength", layer.shear_attenuation_db_per_wavelength);
}

void write_figures(TomlWriter& out, const LayeredFloor& floor) {
  out.text("kind", LayeredFloor::name);
  write_layer(out, floor.below);
}

/// What stands in tables of its own, below the keys of the boundary itself.
void write_parts(TomlWriter& out, const std::string& path, const BoundaryMaterial& material) {
  if (const auto* curves = std::get_if<ReflectionCurves>(&material))
    for (std::size_t i = 0; i < curves->curve.size(); ++i) {
      out.array_table(path + ".curve");
      out.number("frequency", curves->frequency[i]);
      write_rows(out, curves->curve[i]);
    }
  if (const auto* floor = std::get_if<LayeredFloor>(&material))
    for (const FloorLayer& layer : floor->layers) {
      out.array_table(path + ".layer");
      out.number("thickness", layer.thickness);
      write_layer(out, layer);
    }
}

void write_material(TomlWriter& out, const BoundaryMaterial& material) {
  std::visit([&](const auto& m) { write_figures(out, m); }, material);
}

void write_boundary(TomlWriter& out, const std::string& path, const Boundary& boundary) {
  out.table(path);
  if (!boundary.shape) out.number("depth", boundary.depth);
  write_material(out, boundary.material);
  const Roughness& rough = boundary.roughness;
  if (rough.rms_height > 0.0) {
    out.number("roughness", rough.rms_height);
    if (rough.sea_wind > 0.0) out.number("roughness_wind", rough.sea_wind);
    out.number("roughness_floor_db", rough.floor_db);
  }
  if (rough.bubble_wind > 0.0) {
    out.text("bubbles", "apl-uw");
    out.number("bubbles_wind", rough.bubble_wind);
  }
  write_parts(out, path, boundary.material);
  if (!boundary.shape) return;
  out.table(path + ".shape");
  out.text("interpolation", name(boundary.shape->interpolation()));
  out.numbers("range", boundary.shape->ranges());
  out.numbers("depth", boundary.shape->depths());
  for (const BoundaryMaterial& material : boundary.shape->materials()) {
    out.array_table(path + ".shape.material");
    write_material(out, material);
    write_parts(out, path + ".shape.material", material);
  }
}

void write_sound_speed(TomlWriter& out, const Environment& ocean) {
  out.table("environment.sound_speed");
  if (ocean.section) {
    out.text("kind", "section");
    out.numbers("range", ocean.section->ranges());
    out.numbers("depth", ocean.section->depths());
    out.rows("speed", ocean.section->speeds(), ocean.section->depths().size());
    return;
  }
  const SoundSpeedProfile& water = ocean.water;
  if (const auto& munk = water.munk_parameters()) {
    out.text("kind", "munk");
    out.number("axis_speed", munk->axis_speed);
    out.number("axis_depth", munk->axis_depth);
    out.number("scale_depth", munk->scale_depth);
    out.number("perturbation", munk->perturbation);
    return;
  }
  out.text("kind", "table");
  out.text("interpolation", name(water.interpolation()));
  out.numbers("depth", water.depths());
  out.numbers("speed", water.speeds());
}

void write_depth_function(TomlWriter& out, const std::string& path, const std::string& key,
                          const DepthFunction& function) {
  out.table(path);
  out.numbers("depth", function.depths());
  out.numbers(key, function.values());
}

void write_absorption(TomlWriter& out, const Absorption& absorption) {
  out.table("environment.absorption");
  out.text("kind", std::visit([](const auto& law) { return law.name; }, absorption));
  for_each_water_property(absorption, [&](std::string_view name, double value) {
    out.number(name == "pH" ? "ph" : std::string(name), value);
  });
}

void write_environment(TomlWriter& out, const Environment& ocean) {
  out.table("environment");
  if (varies_with_range(ocean)) out.text("spreading", name(ocean.spreading));
  if (ocean.water_density.is_constant())
    out.number("water_density", ocean.water_density.at(0.0));
  else
    write_depth_function(out, "environment.water_density", "density", ocean.water_density);
  write_sound_speed(out, ocean);
  write_absorption(out, ocean.absorption);
  for (const BiologicalLayer& layer : ocean.biology) {
    out.array_table("environment.biology");
    out.number("top", layer.top);
    out.number("bottom", layer.bottom);
    out.number("resonance", layer.resonance);
    out.number("quality_factor", layer.quality);
    out.number("strength_db_per_km", layer.strength);
  }
  const DepthFunction& loss = ocean.attenuation_db_per_km;
  if (!loss.is_constant()) {
    write_depth_function(out, "environment.attenuation", "db_per_km", loss);
  } else if (loss.at(0.0) != 0.0) {
    out.table("environment.attenuation");
    out.number("db_per_km", loss.at(0.0));
  }
  write_boundary(out, "environment.surface", ocean.surface);
  write_boundary(out, "environment.bottom", ocean.bottom);
}

/// { first, last, count } where that says the same, bit for bit.
void write_axis(TomlWriter& out, const std::string& key, std::span<const double> values) {
  const bool even = values.size() > 3 && [&](const std::vector<double>& same) {
    return std::equal(same.begin(), same.end(), values.begin());
  }(scenario::evenly_spaced(values.front(), values.back(), values.size()));
  if (even)
    out.line(key, "{ first = " + toml_number(values.front()) +
                      ", last = " + toml_number(values.back()) +
                      ", count = " + std::to_string(values.size()) + " }");
  else
    out.numbers(key, values);
}

void write_source(TomlWriter& out, const PropagationCase& run) {
  out.table("run.source");
  write_axis(out, "depth", run.source_depths);
  out.text("kind", name(run.beams.source));
  if (!run.beams.pattern) return;
  out.table("run.source.pattern");
  out.angles("elevation", run.beams.pattern->elevation);
  out.numbers("amplitude", run.beams.pattern->amplitude);
}

void write_receivers(TomlWriter& out, const ReceiverGrid& receivers) {
  if (receivers.depths.empty() && receivers.ranges.empty()) return;
  out.table("run.receivers");
  if (receivers.irregular) out.flag("irregular", true);
  write_axis(out, "depth", receivers.depths);
  write_axis(out, "range", receivers.ranges);
}

void write_beams(TomlWriter& out, const BeamSettings& beams) {
  out.table("run.fan");
  if (!beams.elevations.empty()) out.angles("elevations", beams.elevations);
  out.angle("lowest", beams.lowest);
  out.angle("highest", beams.highest);
  out.integer("count", beams.count);
  out.table("run.beams");
  out.text("kind", name(beams.kind));
  if (beams.displacement) out.flag("displacement", true);
  if (!beams.cerveny) return;
  out.table("run.beams.cerveny");
  out.text("width", name(beams.cerveny->width));
  out.text("curvature", name(beams.cerveny->curvature));
  out.text("component", name(beams.cerveny->component));
  out.number("width_multiplier", beams.cerveny->width_multiplier);
  out.number("loop_range", beams.cerveny->loop_range);
  out.integer("images", beams.cerveny->images);
  out.integer("window", beams.cerveny->window);
}

}  // namespace

std::string to_toml(const Environment& environment) {
  TomlWriter out;
  write_environment(out, environment);
  return out.str();
}

std::string to_toml(const PropagationCase& run) {
  TomlWriter out;
  if (!run.title.empty()) out.text("title", run.title);
  write_environment(out, run.environment);
  out.table("run");
  out.text("task", name(run.task));
  out.text("field", name(run.field));
  out.text("solver", name(run.solver));
  out.number("frequency", run.frequency);
  out.number("box_range", run.box_range);
  out.number("box_depth", run.box_depth);
  write_source(out, run);
  write_receivers(out, run.receivers);
  write_beams(out, run.beams);
  const LiteralSettings& literal = run.literal;
  out.table("run.literal");
  out.comment("obeyed by --like-bellhop alone");
  out.number("step", literal.step);
  out.integer("beams", literal.beams);
  if (literal.single_beam) out.integer("single_beam", *literal.single_beam);
  return out.str();
}

}  // namespace asdic
