// Part of case_writer_parts.h: the files beside an .env file.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "io/bellhop/attenuation.h"
#include "io/bellhop/case_writer_parts.h"
#include "io/bellhop/decimal.h"
#include "io/bellhop/list_reader.h"

namespace asdic::detail::bellhop {
namespace {

double from_thousands(double x) { return 1000.0 * x; }

/// Thousands of a number: km of metres, g/cm³ of kg/m³.
std::string thousands(double x) { return decimal_read_as(x, x / 1000.0, from_thousands); }

}  // namespace

char letter_of(const Boundary& boundary) noexcept {
  const BoundaryMaterial& material = boundary.material;
  if (std::holds_alternative<Vacuum>(material)) return 'V';
  if (std::holds_alternative<Rigid>(material)) return 'R';
  return std::holds_alternative<ReflectionTable>(material) ? 'F' : 'A';
}

std::string half_space_text(CaseWriting& writing, const BoundaryMaterial& material,
                            double volume_loss, const std::string& where) {
  const auto attenuation = [&](double value, double speed) {
    const double added =
        volume_loss == 0.0 ? 0.0 : volume_loss * db_per_neper * speed / writing.run_case.frequency;
    if (value < added) {
      writing.note(where +
                   ": BELLHOP adds the water's absorption to its attenuation, which is less");
      return std::string("0");
    }
    return decimal_read_as(value, value - added, [&](double x) { return x + added; });
  };
  // BELLHOP's speed, of which the reader makes ours
  const auto speed_text = [](double speed, double loss) {
    return decimal_read_as(speed, speed / true_speed(1.0, loss),
                           [&](double x) { return true_speed(x, loss); });
  };
  const auto wave = [&](double speed, double loss) {
    const std::string text = speed_text(speed, loss);
    return std::pair(text, attenuation(loss, *fortran_number(text)));
  };
  if (const auto* fluid = std::get_if<FluidHalfSpace>(&material)) {
    const auto [speed, loss] = wave(fluid->speed, fluid->attenuation_db_per_wavelength);
    return speed + " 0 " + thousands(fluid->density) + ' ' + loss + " 0";
  }
  if (const auto* solid = std::get_if<ElasticHalfSpace>(&material)) {
    const auto [speed, loss] = wave(solid->speed, solid->attenuation_db_per_wavelength);
    const auto [shear, shear_loss] =
        wave(solid->shear_speed, solid->shear_attenuation_db_per_wavelength);
    return speed + ' ' + shear + ' ' + thousands(solid->density) + ' ' + loss + ' ' + shear_loss;
  }
  const std::string name = std::visit([](const auto& m) { return std::string(m.name); }, material);
  throw InputError({.where = where,
                    .got = name,
                    .expected = "fluid or elastic: BELLHOP's files know no other half space"});
}

void write_section(CaseWriting& writing) {
  const SoundSpeedSection& section = *writing.run_case.environment.section;
  std::string text = std::to_string(section.ranges().size()) + '\n';
  for (const double range : section.ranges()) text += thousands(range) + ' ';
  text += '\n';
  const auto nodes = section.depths();
  for (const double z : writing.depths) {
    const auto node = std::lower_bound(nodes.begin(), nodes.end(), z);
    const bool at_node = node != nodes.end() && *node == z;
    for (std::size_t i = 0; i < section.ranges().size(); ++i)
      text +=
          decimal(at_node ? section.speeds()[i * nodes.size() + std::size_t(node - nodes.begin())]
                          : section.at(section.ranges()[i], z).c) +
          ' ';
    text += '\n';
  }
  writing.companion(".ssp", std::move(text));
}

void write_shape(CaseWriting& writing, const Boundary& boundary, bool surface) {
  const BoundaryShape& shape = *boundary.shape;
  const bool is_long = !shape.materials().empty();
  const bool linear = shape.interpolation() == ShapeInterpolation::piecewise_linear;
  const std::string extension = surface ? ".ati" : ".bty";
  if (shape.interpolation() == ShapeInterpolation::smooth)
    writing.note(extension + ": a smooth boundary becomes curvilinear, BELLHOP's way of it");
  std::string text = std::string("'") + (linear ? 'L' : 'C') + (is_long ? "L'\n" : "'\n");
  text += std::to_string(shape.ranges().size()) + '\n';
  for (std::size_t i = 0; i < shape.ranges().size(); ++i) {
    text += thousands(shape.ranges()[i]) + ' ' + decimal(shape.depths()[i]);
    if (is_long)
      text += ' ' + half_space_text(writing, shape.materials()[i], 0.0,
                                    std::string(surface ? "surface" : "bottom") + " material[" +
                                        std::to_string(i) + ']');
    text += '\n';
  }
  writing.companion(extension, std::move(text));
}

void write_reflection_table(CaseWriting& writing, const ReflectionTable& table, bool surface) {
  std::string text = std::to_string(table.grazing.size()) + '\n';
  for (std::size_t i = 0; i < table.grazing.size(); ++i)
    text += decimal_read_as(table.grazing[i], degrees(table.grazing[i]), radians) + ' ' +
            decimal(table.magnitude[i]) + ' ' +
            decimal_read_as(table.phase[i], degrees(table.phase[i]), radians) + '\n';
  writing.companion(surface ? ".trc" : ".brc", std::move(text));
}

void write_source_pattern(CaseWriting& writing, const SourcePattern& pattern) {
  constexpr double silent_db = -7000.0;  // reads as an amplitude of 0
  std::string text = std::to_string(pattern.elevation.size()) + '\n';
  for (std::size_t i = pattern.elevation.size(); i-- > 0;) {
    const double a = pattern.amplitude[i], level = a > 0.0 ? db_from_amplitude(a) : silent_db;
    text += decimal_read_as(pattern.elevation[i], -degrees(pattern.elevation[i]),
                            [](double x) { return radians(-x); }) +
            ' ' + decimal_read_as(a, level, amplitude_from_db) + '\n';
  }
  writing.companion(".sbp", std::move(text));
}

}  // namespace asdic::detail::bellhop
