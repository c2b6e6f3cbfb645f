// Part of case_parts.h: a case in words.
#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "core/text.h"
#include "core/units.h"
#include "io/bellhop/case_parts.h"

namespace asdic::detail::bellhop {
namespace {

/// Lines of text, each as printf makes it.
class Lines {
 public:
  [[gnu::format(printf, 2, 3)]] void add(const char* format, ...) {
    std::va_list values;
    va_start(values, format);
    text_ += formatted_list(format, values) + '\n';
    va_end(values);
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

const char* words(FieldKind field) noexcept {
  switch (field) {
    case FieldKind::coherent:
      return "coherent field";
    case FieldKind::incoherent:
      return "incoherent field";
    case FieldKind::semi_coherent:
      return "semi-coherent field";
  }
  return "";
}

const char* words(const PropagationCase& run_case) noexcept {
  switch (run_case.task) {
    case Task::rays:
      return "rays";
    case Task::eigenrays:
      return "eigenrays";
    case Task::arrivals:
      return "arrivals";
    case Task::eigenrays_and_arrivals:
      return "eigenrays and arrivals";
    case Task::field:
      return words(run_case.field);
  }
  return "";
}

const char* words(BeamKind kind) noexcept {
  switch (kind) {
    case BeamKind::hat:
      return "geometric hat beams, Cartesian";
    case BeamKind::gaussian:
      return "geometric Gaussian beams, Cartesian";
    case BeamKind::ray_centred_hat:
      return "geometric hat beams, ray-centred";
    case BeamKind::ray_centred_gaussian:
      return "geometric Gaussian beams, ray-centred";
    case BeamKind::simple_gaussian:
      return "simple Gaussian beams";
    case BeamKind::cerveny_cartesian:
      return "Cerveny beams, Cartesian";
    case BeamKind::cerveny_ray_centred:
      return "Cerveny beams, ray-centred";
  }
  return "";
}

const char* profile_words(char letter) noexcept {
  switch (letter) {
    case 'C':
      return "c linear in depth";
    case 'N':
      return "1/c^2 linear in depth";
    case 'S':
      return "cubic spline";
    case 'P':
      return "monotone cubic";
    case 'Q':
      return "range-dependent, bilinear";
    case 'H':
      return "over map and depth";
    default:
      return "Munk's profile";
  }
}

void echo_boundary(Lines& lines, const char* who, const Boundary& boundary) {
  const BoundaryMaterial& material = boundary.material;
  if (const auto* fluid = std::get_if<FluidHalfSpace>(&material))
    lines.add("%-10s fluid: %g m/s, %g kg/m3, %g dB/wavelength", who, fluid->speed, fluid->density,
              fluid->attenuation_db_per_wavelength);
  else if (const auto* solid = std::get_if<ElasticHalfSpace>(&material))
    lines.add("%-10s elastic: %g and %g m/s, %g kg/m3, %g and %g dB/wavelength", who, solid->speed,
              solid->shear_speed, solid->density, solid->attenuation_db_per_wavelength,
              solid->shear_attenuation_db_per_wavelength);
  else if (const auto* table = std::get_if<ReflectionTable>(&material))
    lines.add("%-10s reflection table of %zu rows", who, table->grazing.size());
  else
    lines.add("%-10s %s", who, std::holds_alternative<Rigid>(material) ? "rigid" : "vacuum");
  if (boundary.shape)
    lines.add("%-10s %zu nodes from %g to %g km, %s%s, %g to %g m deep", "",
              boundary.shape->ranges().size(), boundary.shape->ranges().front() / 1000.0,
              boundary.shape->ranges().back() / 1000.0,
              boundary.shape->interpolation() == ShapeInterpolation::piecewise_linear
                  ? "piecewise linear"
                  : "curvilinear",
              boundary.shape->materials().empty() ? "" : ", with materials",
              boundary.shape->shallowest(), boundary.shape->deepest());
}

/// The least and the greatest value of a quantity over depth.
std::pair<double, double> range_of(const DepthFunction& f) {
  if (f.is_constant()) return {f.at(0.0), f.at(0.0)};
  const auto [least, greatest] = std::minmax_element(f.values().begin(), f.values().end());
  return {*least, *greatest};
}

/// Of the water, where the profile's rows do not give 1 g/cm³.
void echo_density(Lines& lines, const DepthFunction& density) {
  const auto [least, greatest] = range_of(density);
  if (least != greatest)
    lines.add("%-10s %g to %g kg/m3", "", least, greatest);
  else if (least != 1000.0)
    lines.add("%-10s %g kg/m3", "", least);
}

/// What a wave loses in the water: the volume loss and what the profile's rows (and layers of fish)
/// give.
void echo_absorption(Lines& lines, double volume_loss, const DepthFunction& rows) {
  const auto [least, greatest] = range_of(rows);
  if (greatest == 0.0)
    lines.add("%-10s %g dB/km", "absorption", volume_loss);
  else if (least == greatest)
    lines.add("%-10s %g dB/km, %g of it by the rows of the profile", "absorption",
              volume_loss + least, least);
  else
    lines.add("%-10s %g to %g dB/km, %g to %g of it by the rows of the profile", "absorption",
              volume_loss + least, volume_loss + greatest, least, greatest);
}

void echo_vector(Lines& lines, const char* who, const std::vector<double>& x, double unit,
                 const char* name) {
  if (x.size() == 1)
    lines.add("%-10s %g %s", who, x.front() / unit, name);
  else
    lines.add("%-10s %zu from %g to %g %s", who, x.size(), x.front() / unit, x.back() / unit, name);
}

}  // namespace

std::string echo(const CaseReading& reading) {
  const PropagationCase& run_case = reading.input.run_case;
  const Environment& ocean = run_case.environment;
  Lines lines;
  lines.add("%-10s %s", "title", run_case.title.c_str());
  lines.add("%-10s %s, %s, %s source%s", "run", words(run_case), words(run_case.beams.kind),
            run_case.beams.source == SourceKind::line ? "line" : "point",
            run_case.beams.pattern ? " with a pattern" : "");
  lines.add("%-10s %g Hz", "frequency", run_case.frequency);
  lines.add("%-10s %g to %g m, %s, %zu points", "water", reading.surface_depth,
            reading.bottom_depth, profile_words(reading.options.profile),
            ocean.water.depths().size());
  if (ocean.section)
    lines.add("%-10s %zu profiles from %g to %g km", "", ocean.section->ranges().size(),
              ocean.section->ranges().front() / 1000.0, ocean.section->ranges().back() / 1000.0);
  echo_density(lines, ocean.water_density);
  echo_absorption(lines, absorption_db_per_km(ocean.absorption, run_case.frequency),
                  ocean.attenuation_db_per_km);
  echo_boundary(lines, "surface", ocean.surface);
  echo_boundary(lines, "bottom", ocean.bottom);
  if (const auto& map = reading.input.map) {
    const auto grid = [&](const char* who, const std::optional<GridFile>& file, bool kind) {
      if (!file) return;
      const auto [least, greatest] = std::minmax_element(file->values.begin(), file->values.end());
      lines.add("%-10s grid of %zu x %zu%s%s: x %g to %g km, y %g to %g km; %g to %g %s", who,
                file->x.size(), file->y.size(),
                file->z.empty() ? "" : (" x " + std::to_string(file->z.size())).c_str(),
                !kind               ? ""
                : file->curvilinear ? ", bicubic"
                                    : ", facets",
                file->x.front() / 1000.0, file->x.back() / 1000.0, file->y.front() / 1000.0,
                file->y.back() / 1000.0, *least, *greatest, kind ? "m" : "m/s");
    };
    grid("altimetry", map->altimetry, true);
    grid("bathymetry", map->bathymetry, true);
    grid("speeds", map->water, false);
    echo_vector(lines, "source x", map->source_x, 1000.0, "km");
    echo_vector(lines, "source y", map->source_y, 1000.0, "km");
    echo_vector(lines, "azimuths", map->azimuths_deg, 1.0, "degrees, counter-clockwise from x");
  }
  echo_vector(lines, "sources", run_case.source_depths, 1.0, "m");
  echo_vector(lines, "receivers", run_case.receivers.depths, 1.0, "m");
  echo_vector(lines, run_case.receivers.irregular ? "irregular" : "", run_case.receivers.ranges,
              1000.0, "km");
  lines.add("%-10s %d beams from %g to %g degrees (positive down), step %g m", "fan",
            run_case.literal.beams, -degrees(run_case.beams.highest),
            -degrees(run_case.beams.lowest), run_case.literal.step);
  if (const auto& map = reading.input.map) {
    lines.add("%-10s %d beams in azimuth from %g to %g degrees", "", map->fan,
              map->lowest_azimuth_deg, map->highest_azimuth_deg);
    lines.add("%-10s %g m, %g km in x, %g km in y", "box", run_case.box_depth, map->box_x / 1000.0,
              map->box_y / 1000.0);
  } else {
    lines.add("%-10s %g m, %g km", "box", run_case.box_depth, run_case.box_range / 1000.0);
  }
  return std::move(lines).text();
}

}  // namespace asdic::detail::bellhop
