#include "io/bellhop/case_reader.h"

#include "core/error.h"
#include "io/bellhop/case_parts.h"
#include "io/files/input_file.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail::bellhop {
namespace {

constexpr const char* companion_kinds[] = {".bty", ".ati", ".ssp", ".brc", ".trc", ".sbp"};

/// A companion, if there is one; what else bears its name is told of when it is asked for.
std::optional<std::string> text_of(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return std::nullopt;
  return read_input(path, "a file of the case");
}

void shape_of(CaseReading& reading, Boundary& boundary, bool surface) {
  boundary.shape = read_shape(reading, surface);
  boundary.depth = boundary.shape->depth_at(0.0);
  // behind the first facet, where there is only the long form
  if (!boundary.shape->materials().empty()) boundary.material = boundary.shape->materials().front();
}

}  // namespace

InputError told_of_file(const InputError& error, const Input& input) {
  InputFault fault = error.fault();
  fault.where =
      fault.where.starts_with("beams.") ? input.fan_place : input.file + ": " + fault.where;
  return InputError(std::move(fault));
}

void require_one_plane(const Input& input) {
  if (input.map)
    throw InputError({.where = input.file,
                      .got = "a case of BELLHOP3D, over a map",
                      .expected = "one of a single plane; \"asdic bellhop\" runs it"});
}

Input read_case(const Texts& texts, const std::string& root_name) {
  CaseReading reading{
      .env = ListReader(texts.env, root_name + ".env"), .root = root_name, .texts = texts};
  read_head(reading);
  read_profile(reading);
  if (is_over_map(reading)) {
    read_map_case(reading);
  } else {
    require_profile_of_a_plane(reading);
    if (reading.options.altimetry) shape_of(reading, reading.ocean().surface, true);
    read_bottom_options(reading);
    if (reading.options.bathymetry) shape_of(reading, reading.ocean().bottom, false);
    if (varies_with_range(reading.ocean())) reading.ocean().spreading = Spreading::cylindrical;
    read_receivers(reading);
    read_run(reading);
  }
  add_warnings(warnings(reading.run_case()), reading.input.notes);
  reading.input.echo = echo(reading);
  reading.input.file = reading.env.file();
  return std::move(reading.input);
}

Input read_case(const std::filesystem::path& root) {
  std::filesystem::path stem = root;
  if (stem.extension() == ".env") stem.replace_extension();
  const std::string env = stem.string() + ".env";
  Texts texts{.env = read_input(env, "the input of a BELLHOP case"), .companions = {}};
  for (const char* kind : companion_kinds)
    if (auto companion = text_of(stem.string() + kind))
      texts.companions.emplace_back(kind, std::move(*companion));
  return read_case(texts, stem.string());
}

}  // namespace asdic::detail::bellhop
