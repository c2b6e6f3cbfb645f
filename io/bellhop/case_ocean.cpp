// Part of case_parts.h: the profile, and what is behind the boundaries.
#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/units.h"
#include "io/bellhop/case_parts.h"
#include "io/scenario/sections.h"

namespace asdic::detail::bellhop {
namespace {

constexpr std::size_t most_rows = 100'001;
const std::string the_profile = "the profile";

/// α [Np/m] that the case's volume loss adds to a wave of a speed, in dB per wavelength.
double per_wavelength(double nepers_per_m, double speed, double frequency) noexcept {
  return nepers_per_m * db_per_neper * speed / frequency;
}

/// The attenuation of the water at a node [dB/km]: its own and that of the layers of fish there.
double attenuation_at_node(const CaseReading& reading) {
  const MaterialRow& row = reading.row;
  const double frequency = reading.input.run_case.frequency;
  double db_per_km = 1000.0 * db_per_neper *
                     nepers_per_m(reading.options.unit, row.attenuation, row.speed, frequency);
  for (const BiologicalLayer& layer : reading.input.run_case.environment.biology)
    if (row.depth >= layer.top && row.depth <= layer.bottom) {
      const double ratio = layer.resonance / frequency;
      const double detuning = 1.0 - ratio * ratio;
      db_per_km += layer.strength / (detuning * detuning + 1.0 / (layer.quality * layer.quality));
    }
  return db_per_km;
}

void check_water(const CaseReading& reading) {
  const ListReader& env = reading.env;
  const MaterialRow& row = reading.row;
  if (!quantity::sound_speed.holds(row.speed))
    env.fail("speed", shown(row.speed) + " m/s", quantity::sound_speed.expected());
  if (!(row.density > 0.0))
    env.fail("density", shown(row.density) + " g/cm^3", "a density above 0 g/cm^3");
  if (row.attenuation < 0.0)
    env.fail("attenuation", shown(row.attenuation), "an attenuation of at least 0");
  const double alpha = nepers_per_m(reading.options.unit, row.attenuation, row.speed,
                                    reading.input.run_case.frequency);
  // the imaginary part of the speed, αc²/ω, must stay below the real one
  if (!(alpha * row.speed < 2.0 * pi * reading.input.run_case.frequency))
    env.fail("attenuation", shown(row.attenuation), "less than one neper in a radian of the wave");
}

}  // namespace

void read_material_row(CaseReading& reading, ListReader& from, const std::string& purpose) {
  MaterialRow& row = reading.row;
  const MaterialRow initial;
  const bool water = purpose == the_profile;  // which knows no shear
  std::string taken;
  const auto read = [&](double& value, double usual, const char* item, const char* unit,
                        bool counts) {
    if (!from.real(value, item) && counts && value != usual)
      taken += (taken.empty() ? "" : ", ") + (item + (' ' + shown(value))) + unit;
  };
  from.real(row.depth, "depth");
  read(row.speed, initial.speed, "speed", " m/s", true);
  read(row.shear_speed, initial.shear_speed, "shear speed", " m/s", !water);
  read(row.density, initial.density, "density", " g/cm^3", true);
  read(row.attenuation, initial.attenuation, "attenuation", "", true);
  read(row.shear_attenuation, initial.shear_attenuation, "shear attenuation", "",
       !water && row.shear_speed != 0.0);
  if (!taken.empty() && !reading.row_of.empty() && reading.row_of != purpose)
    reading.leak(from.where("") + ": " + taken + ": left out there, so taken over from " +
                 reading.row_of + ", as BELLHOP does");
  reading.row_of = purpose;
}

BoundaryMaterial half_space(const CaseReading& reading, const ListReader& from,
                            const MaterialRow& row, AttenuationUnit unit, double volume_loss) {
  const double frequency = reading.input.run_case.frequency;
  const auto attenuation = [&](double value, double speed, const char* item) {
    if (value < 0.0) from.fail(item, shown(value), "an attenuation of at least 0");
    const double result = db_per_wavelength(unit, value, speed, frequency);
    const double total =
        volume_loss == 0.0 ? result : result + per_wavelength(volume_loss, speed, frequency);
    if (!(total < 2.0 * pi * db_per_neper))
      from.fail(item, shown(total) + " dB per wavelength",
                "less than one neper in a radian of the wave, 54.57 dB per wavelength");
    return total;
  };
  if (!(row.speed > 0.0)) from.fail("speed", shown(row.speed) + " m/s", "a speed above 0 m/s");
  if (row.shear_speed < 0.0)
    from.fail("shear speed", shown(row.shear_speed) + " m/s", "a speed of at least 0 m/s");
  if (!(row.density > 0.0))
    from.fail("density", shown(row.density) + " g/cm^3", "a density above 0 g/cm^3");
  const double compressional = attenuation(row.attenuation, row.speed, "attenuation");
  if (row.shear_speed == 0.0)
    return FluidHalfSpace{.speed = true_speed(row.speed, compressional),
                          .density = 1000.0 * row.density,
                          .attenuation_db_per_wavelength = compressional};
  const double shear = attenuation(row.shear_attenuation, row.shear_speed, "shear attenuation");
  return ElasticHalfSpace{.speed = true_speed(row.speed, compressional),
                          .shear_speed = true_speed(row.shear_speed, shear),
                          .density = 1000.0 * row.density,
                          .attenuation_db_per_wavelength = compressional,
                          .shear_attenuation_db_per_wavelength = shear};
}

BoundaryMaterial read_material(CaseReading& reading, char letter, bool surface) {
  ListReader& env = reading.env;
  const std::string field = surface ? "surface half space" : "bottom half space";
  switch (letter) {
    case 'R':
      return Rigid{};
    case 'F':
      return read_reflection_table(reading, surface);
    case 'A': {
      env.begin(field);
      read_material_row(reading, env, "the " + field);
      BoundaryMaterial result =
          half_space(reading, env, reading.row, reading.options.unit, reading.volume_loss);
      env.end();
      return result;
    }
    case 'G': {
      env.begin(field + " by grain size");
      double ignored = 0.0;
      env.real(ignored, "depth");
      const double phi = env.need_real("grain size");
      if (!(phi >= -1.0 && phi <= 9.0))
        env.fail("grain size", shown(phi),
                 "a mean grain size from -1 (coarse sand) to 9 phi (clay)");
      // beside water of 1500 m/s and 1 g/cm³, whatever the profile says; no volume loss is added
      FluidHalfSpace fluid = sediment_of_grain_size(phi, 1500.0, 1000.0);
      fluid.speed = true_speed(fluid.speed, fluid.attenuation_db_per_wavelength);
      env.end();
      return fluid;
    }
    default:
      return Vacuum{};
  }
}

void read_profile(CaseReading& reading) {
  ListReader& env = reading.env;
  Environment& ocean = reading.ocean();
  double ignored = 0.0;
  env.begin("profile: NPTS SIGMA DEPTH");
  env.real(ignored, "number of points");
  env.real(ignored, "roughness");
  reading.bottom_depth = env.need_real("bottom depth");
  env.end();

  if (reading.options.profile == 'A') {
    if (!(reading.bottom_depth > 0.0))
      env.fail("bottom depth", shown(reading.bottom_depth) + " m", "a depth below 0 m");
    ocean.water = SoundSpeedProfile::munk();
    ocean.water_density = 1000.0;
    ocean.biology.clear();
    ocean.surface.depth = 0.0;
    ocean.bottom.depth = reading.bottom_depth;
    return;
  }

  std::vector<double> depth, speed, density, attenuation;
  do {
    env.begin("profile row " + std::to_string(depth.size() + 1));
    if (depth.size() == most_rows)
      env.fail("depth", "more than " + std::to_string(most_rows) + " rows",
               "the last row at the bottom depth, " + shown(reading.bottom_depth) + " m");
    read_material_row(reading, env, the_profile);
    if (!depth.empty() && reading.row.depth <= depth.back())
      env.fail("depth", shown(reading.row.depth) + " m",
               "a depth below the one before, " + shown(depth.back()) + " m");
    if (reading.row.depth > reading.bottom_depth + 1e-5)
      env.fail("depth", shown(reading.row.depth) + " m",
               "the last row at the bottom depth, " + shown(reading.bottom_depth) + " m");
    check_water(reading);
    env.end();
    depth.push_back(reading.row.depth);
    speed.push_back(reading.row.speed);
    density.push_back(1000.0 * reading.row.density);
    attenuation.push_back(attenuation_at_node(reading));
  } while (std::abs(depth.back() - reading.bottom_depth) > 1e-5);
  if (depth.size() < 2)
    env.fail("depth", "a profile of one row", "at least two, from the surface to the bottom");

  const auto function = [&](const std::vector<double>& value) {
    for (const double v : value)
      if (v != value.front()) return DepthFunction::table(depth, value);
    return DepthFunction(value.front());
  };
  ocean.water_density = function(density);
  ocean.attenuation_db_per_km = function(attenuation);
  ocean.biology.clear();  // it is in the attenuation at the nodes
  reading.surface_depth = depth.front();
  ocean.surface.depth = depth.front();
  ocean.bottom.depth = reading.bottom_depth;
  if (reading.options.profile == 'Q') return read_section(reading, depth, speed);

  const Interpolation law = reading.options.profile == 'N'   ? Interpolation::n2_linear
                            : reading.options.profile == 'P' ? Interpolation::pchip_spline_slopes
                            : reading.options.profile == 'S' ? Interpolation::spline
                                                             : Interpolation::c_linear;
  try {
    ocean.water = SoundSpeedProfile::table(depth, speed, law);
  } catch (const InputError& error) {
    throw error.inside(env.file() + ": profile");
  }
}

}  // namespace asdic::detail::bellhop
