// Part of case_writer_parts.h: the last lines of an .env file.
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "io/bellhop/case_parts.h"
#include "io/bellhop/case_writer_parts.h"
#include "io/bellhop/decimal.h"

namespace asdic::detail::bellhop {
namespace {

/// A count and a vector: its ends if it is evenly spaced as the reader spaces it, else all of it.
std::string vector_text(CaseWriting& writing, const std::vector<double>& x, float factor,
                        double least, double most, const std::string& who) {
  const auto read = [&](double value) {
    return std::clamp(double(float(value) * factor), least, most);
  };
  const auto text_of = [&](double value) {
    return decimal_read_as(value, value / double(factor), read);
  };
  const std::string count = std::to_string(x.size()) + '\n';
  if (x.size() > 2) {
    const std::string first = text_of(x.front()), last = text_of(x.back());
    const GivenVector ends{.values = {*fortran_number(first), *fortran_number(last)},
                           .count = std::int64_t(x.size())};
    bool sorted = false;
    std::vector<double> even = single_precision(ends, factor, sorted);
    for (double& value : even) value = std::clamp(value, least, most);
    if (even == x) return count + first + ' ' + last + " /\n";
  }
  std::string text = count;
  bool exact = true;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::string value = text_of(x[i]);
    exact = exact && read(*fortran_number(value)) == x[i];
    text += value + (i % 8 == 7 || i + 1 == x.size() ? '\n' : ' ');
  }
  if (!exact) writing.note("the " + who + " are in single precision there");
  return text;
}

char task_letter(const PropagationCase& run_case, bool binary) noexcept {
  switch (run_case.task) {
    case Task::rays:
      return 'R';
    case Task::eigenrays:
      return 'E';
    case Task::arrivals:
      return binary ? 'a' : 'A';
    case Task::eigenrays_and_arrivals:
      return binary ? 'v' : 'V';
    case Task::field:
      break;
  }
  return run_case.field == FieldKind::coherent     ? 'C'
         : run_case.field == FieldKind::incoherent ? 'I'
                                                   : 'S';
}

char beam_letter(BeamKind kind) noexcept {
  switch (kind) {
    case BeamKind::hat:
      return 'G';
    case BeamKind::gaussian:
      return 'B';
    case BeamKind::ray_centred_hat:
      return 'g';
    case BeamKind::ray_centred_gaussian:
      return 'b';
    case BeamKind::simple_gaussian:
      return 'S';
    case BeamKind::cerveny_cartesian:
      return 'C';
    case BeamKind::cerveny_ray_centred:
      return 'R';
  }
  return 'G';
}

std::string declination_text(double elevation) {
  return decimal_read_as(elevation, 0.0 - degrees(elevation), [](double x) { return radians(-x); });
}

std::string fan_text(const PropagationCase& run_case) {
  const BeamSettings& beams = run_case.beams;
  const std::vector<double>& list = beams.elevations;
  const std::size_t n = list.size() > 1 ? list.size() : std::size_t(beams.count);
  std::string text = std::to_string(list.size() == 1 ? std::max<std::size_t>(n, 1) : n);
  if (run_case.literal.single_beam) text += ' ' + std::to_string(*run_case.literal.single_beam);
  text += '\n';
  if (list.empty()) {
    text += declination_text(beams.highest);
    if (n != 1) text += ' ' + declination_text(beams.lowest);
    return text + " /\n";
  }
  for (std::size_t i = list.size(); i-- > 0;)
    text += declination_text(list[i]) + (i % 8 == 0 && i > 0 ? '\n' : ' ');
  return text + "/\n";
}

std::string cerveny_text(const CervenyBeams& beams) {
  using Width = CervenyBeams::Width;
  using Curvature = CervenyBeams::Curvature;
  using Component = CervenyBeams::Component;
  const char width = beams.width == Width::space_filling ? 'F'
                     : beams.width == Width::minimum     ? 'M'
                     : beams.width == Width::wkb         ? 'W'
                                                         : 'C';
  const char curvature = beams.curvature == Curvature::standard  ? 'S'
                         : beams.curvature == Curvature::doubled ? 'D'
                                                                 : 'Z';
  const char component = beams.component == Component::pressure   ? 'P'
                         : beams.component == Component::vertical ? 'V'
                                                                  : 'H';
  return std::string("'") + width + curvature + "' " + decimal(beams.width_multiplier) + ' ' +
         decimal_read_as(beams.loop_range, beams.loop_range / 1000.0,
                         [](double x) { return 1000.0 * x; }) +
         '\n' + std::to_string(beams.images) + ' ' + std::to_string(beams.window) + " '" +
         component + "'\n";
}

}  // namespace

std::string run_text(CaseWriting& writing, bool binary_arrivals) {
  const PropagationCase& run_case = writing.run_case;
  const BeamSettings& beams = run_case.beams;
  const ReceiverGrid& grid = run_case.receivers;
  const double top = writing.depths.front(), bottom = writing.depths.back();
  const MapInput* map = writing.map;
  if (map == nullptr && run_case.dimension == 3)
    writing.note(
        "a run in three dimensions becomes one in its plane: the files are those of BELLHOP");
  const auto places = [&](const std::vector<double>& x, float factor, const char* who) {
    return vector_text(writing, x, factor, -infinity, infinity, who);
  };
  std::string text;
  if (map != nullptr)
    text = places(map->source_x, 1000.0F, "source x") + places(map->source_y, 1000.0F, "source y");
  text += vector_text(writing, run_case.source_depths, 1.0F, top, bottom, "source depths") +
          vector_text(writing, grid.depths, 1.0F, top, bottom, "receiver depths") +
          vector_text(writing, grid.ranges, 1000.0F, -infinity, infinity, "receiver ranges");

  if (map != nullptr) text += places(map->azimuths_deg, 1.0F, "receiver azimuths");

  std::string letters = {task_letter(run_case, binary_arrivals),
                         beam_letter(beams.kind),
                         beams.pattern ? '*' : ' ',
                         beams.source == SourceKind::line ? 'X' : 'R',
                         grid.irregular ? 'I' : 'R',
                         map != nullptr && run_case.dimension == 3 ? '3' : '2',
                         beams.displacement ? 'S' : ' '};
  while (letters.back() == ' ') letters.pop_back();
  text += '\'' + letters + "'\n";
  if (beams.pattern) write_source_pattern(writing, *beams.pattern);

  text += fan_text(run_case);
  const auto km = [](double x) { return 1000.0 * x; };
  if (map != nullptr) {
    const auto box = [&](double x) { return decimal_read_as(x, x / 1000.0, km) + ' '; };
    text += std::to_string(map->fan) + '\n' + decimal(map->lowest_azimuth_deg);
    if (map->fan != 1) text += ' ' + decimal(map->highest_azimuth_deg);
    return text + " /\n" + decimal(run_case.literal.step) + ' ' + box(map->box_x) +
           box(map->box_y) + decimal(run_case.box_depth) + '\n';
  }
  text += decimal(run_case.literal.step) + ' ' + decimal(run_case.box_depth) + ' ' +
          decimal_read_as(run_case.box_range, run_case.box_range / 1000.0, km) + '\n';
  if (beams.kind == BeamKind::cerveny_cartesian || beams.kind == BeamKind::cerveny_ray_centred)
    text += cerveny_text(beams.cerveny.value_or(CervenyBeams{}));
  return text;
}

}  // namespace asdic::detail::bellhop
