#include "io/bellhop/case_writer.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/bellhop/attenuation.h"
#include "io/bellhop/case_writer_parts.h"
#include "io/bellhop/decimal.h"
#include "io/bellhop/grid_file.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::bellhop {
namespace {

std::string quoted(std::string text) {
  text.resize(std::min<std::size_t>(text.size(), 80));
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += c;
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '\'';
}

bool is_plain_munk(const Environment& ocean) {
  const auto& munk = ocean.water.munk_parameters();
  const MunkParameters standard;
  return munk && munk->axis_speed == standard.axis_speed &&
         munk->axis_depth == standard.axis_depth && munk->scale_depth == standard.scale_depth &&
         munk->perturbation == standard.perturbation && ocean.surface.depth == 0.0 &&
         !ocean.surface.shape && !ocean.section;
}

/// The depths of the profile's rows: the nodes there are, cut or lengthened to reach from boundary
/// to boundary.
std::vector<double> profile_depths(const Environment& ocean) {
  std::span<const double> nodes = ocean.section ? ocean.section->depths() : ocean.water.depths();
  double top = ocean.surface.depth, bottom = ocean.bottom.depth;
  if (ocean.surface.shape) {
    top = ocean.surface.shape->shallowest();
    if (!nodes.empty()) top = std::min(top, nodes.front());
  }
  if (ocean.bottom.shape) {
    bottom = ocean.bottom.shape->deepest();
    if (!nodes.empty()) bottom = std::max(bottom, nodes.back());
  }
  std::vector<double> depths = {top};
  for (const double z : nodes)
    if (z > top && z < bottom) depths.push_back(z);
  if (ocean.water.munk_parameters() && !ocean.section) {
    constexpr int rows = 201;
    for (int i = 1; i + 1 < rows; ++i) depths.push_back(std::lerp(top, bottom, i / (rows - 1.0)));
  }
  depths.push_back(bottom);
  return depths;
}

char profile_letter(CaseWriting& writing) {
  const Environment& ocean = writing.run_case.environment;
  if (writing.map != nullptr && writing.map->water) return 'H';
  if (ocean.section) return 'Q';
  if (is_plain_munk(ocean)) return 'A';
  if (ocean.water.munk_parameters()) {
    writing.note("Munk's profile with other numbers than BELLHOP's: a spline through 201 points");
    return 'S';
  }
  switch (ocean.water.interpolation()) {
    case Interpolation::c_linear:
      return 'C';
    case Interpolation::n2_linear:
      return 'N';
    case Interpolation::spline:
      return 'S';
    case Interpolation::pchip:
      writing.note("pchip becomes P, whose slopes are not quite the same");
      return 'P';
    case Interpolation::pchip_spline_slopes:
      return 'P';
  }
  return 'C';
}

char volume_letter(const Environment& ocean) noexcept {
  if (std::holds_alternative<Thorp>(ocean.absorption)) return 'T';
  return std::holds_alternative<FrancoisGarrison>(ocean.absorption) ? 'F' : ' ';
}

std::string top_options(CaseWriting& writing) {
  const Environment& ocean = writing.run_case.environment;
  std::string letters = {
      profile_letter(writing),
      letter_of(ocean.surface),
      'W',
      volume_letter(ocean),
      ocean.surface.shape || (writing.map != nullptr && writing.map->altimetry) ? '~' : ' ',
      writing.run_case.literal.single_beam ? 'I' : ' '};
  while (letters.back() == ' ') letters.pop_back();
  return quoted(letters) + '\n';
}

/// What the water takes at a node [dB/km], biology included.
double attenuation_at(const PropagationCase& run_case, double depth) {
  const Environment& ocean = run_case.environment;
  double sum = ocean.attenuation_db_per_km.at(depth);
  for (const BiologicalLayer& layer : ocean.biology)
    if (depth >= layer.top && depth <= layer.bottom)
      sum += absorption_db_per_km(layer, run_case.frequency);
  return sum;
}

/// The speed of a row: the node's own number where the profile has a node.
double speed_at(const Environment& ocean, double depth) {
  const auto nodes = ocean.water.depths();
  const auto node = std::lower_bound(nodes.begin(), nodes.end(), depth);
  return node != nodes.end() && *node == depth
             ? ocean.water.speeds()[std::size_t(node - nodes.begin())]
             : ocean.water.at(depth).c;
}

/// The speed that is written in a row. Beside a section it only tells the wavelength of the
/// attenuation, of which a row can hold less than a neper in a radian.
double row_speed(const PropagationCase& run_case, double depth, double db_per_km) {
  const double c = speed_at(run_case.environment, depth);
  const double alpha = db_per_km / (1000.0 * db_per_neper);
  const bool too_much = !(alpha * c < 0.9 * 2.0 * pi * run_case.frequency);
  return run_case.environment.section && too_much ? pi * run_case.frequency / alpha : c;
}

std::string profile_text(CaseWriting& writing) {
  const PropagationCase& run_case = writing.run_case;
  const Environment& ocean = run_case.environment;
  const std::vector<double>& depths = writing.depths;
  std::string text = std::to_string(depths.size()) + " 0 " + decimal(depths.back()) + '\n';
  if (is_plain_munk(ocean)) return text;
  std::string before;  // what a short row would take over
  for (const double z : depths) {
    const double density = ocean.water_density.at(z), loss = attenuation_at(run_case, z);
    const double c = row_speed(run_case, z, loss);
    const auto per_km = [&](double x) {
      return 1000.0 * db_per_neper *
             nepers_per_m(AttenuationUnit::db_per_wavelength, x, c, run_case.frequency);
    };
    const std::string rest =
        " 0 " + decimal_read_as(density, density / 1000.0, [](double x) { return 1000.0 * x; }) +
        ' ' + decimal_read_as(loss, loss / per_km(1.0), per_km) + " 0";
    text += decimal(z) + ' ' + decimal(c) + (rest == before ? "" : rest) + " /\n";
    before = rest;
  }
  return text;
}

std::string boundary_text(CaseWriting& writing, const Boundary& boundary, bool surface) {
  if (const auto* table = std::get_if<ReflectionTable>(&boundary.material))
    write_reflection_table(writing, *table, surface);
  if (boundary.shape) write_shape(writing, boundary, surface);
  if (letter_of(boundary) != 'A') return {};
  // materials per facet take its place, and have no volume loss added
  const bool overruled = boundary.shape && !boundary.shape->materials().empty();
  return decimal(boundary.depth) + ' ' +
         half_space_text(writing, boundary.material, overruled ? 0.0 : writing.volume_loss,
                         surface ? "surface" : "bottom") +
         " /\n";
}

}  // namespace

namespace {

Written write(const PropagationCase& run_case, bool binary_arrivals, const MapInput* map) {
  const Environment& ocean = run_case.environment;
  CaseWriting writing{.run_case = run_case, .depths = profile_depths(ocean)};
  writing.map = map;
  writing.volume_loss =
      absorption_db_per_km(ocean.absorption, run_case.frequency) / (1000.0 * db_per_neper);
  if (!ocean.biology.empty())
    writing.note("layers of fish become attenuation at the nodes of the profile");
  if (map == nullptr && run_case.beams.source == SourceKind::point &&
      spreading_across(ocean) == Spreading::plane)
    writing.note(
        "the sea is the same across the plane (environment.spreading), and BELLHOP takes it for "
        "the same "
        "all around the source: levels differ where boundaries slope or the speed varies with "
        "range");

  std::string& env = writing.out.texts.env;
  env = quoted(run_case.title) + '\n' + decimal(run_case.frequency) + "\n1\n";
  env += top_options(writing);
  if (const auto* law = std::get_if<FrancoisGarrison>(&ocean.absorption))
    env += decimal(law->temperature) + ' ' + decimal(law->salinity) + ' ' + decimal(law->ph) + ' ' +
           decimal(law->depth) + '\n';
  env += boundary_text(writing, ocean.surface, true);
  env += profile_text(writing);
  if (ocean.section) write_section(writing);
  const bool shaped = ocean.bottom.shape || (map != nullptr && map->bathymetry);
  env += std::string("'") + letter_of(ocean.bottom) + (shaped ? "~" : "") + "' 0\n";
  env += boundary_text(writing, ocean.bottom, false);
  env += run_text(writing, binary_arrivals);
  env += std::string("! ") + own::remark + '\n';
  if (map != nullptr)
    for (const auto& [grid, ending] :
         {std::pair{&map->bathymetry, ".bty"}, {&map->altimetry, ".ati"}, {&map->water, ".ssp"}})
      if (*grid) writing.companion(ending, grid_file_text(**grid));
  return std::move(writing.out);
}

}  // namespace

Written write_case(const PropagationCase& run_case, bool binary_arrivals) {
  return write(run_case, binary_arrivals, nullptr);
}

Written write_map_case(const Input& input) {
  PropagationCase run_case = input.run_case;
  if (input.map && input.map->area) run_case.environment = input.map->area->everywhere();
  if (input.map) run_case.environment.bottom.depth = input.map->profile_depth;
  if (input.map) run_case.environment.surface.depth = input.map->profile_top;
  return write(run_case, input.binary_arrivals, input.map ? &*input.map : nullptr);
}

void write_case_files(const std::filesystem::path& root, const Texts& texts,
                      const OutputRules& rules) {
  OutputRules these = rules;
  these.own = own::case_companion;
  std::vector<std::pair<OutputFile, const std::string*>> files;
  for (const auto& [extension, text] : texts.companions)
    files.emplace_back(OutputFile(root.string() + extension, these), &text);
  these.own = own::case_file;
  files.emplace_back(OutputFile(root.string() + ".env", these), &texts.env);
  for (auto& [file, text] : files) file.write(*text);
}

}  // namespace asdic::detail::bellhop
