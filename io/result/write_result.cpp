#include "io/result/write_result.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/error.h"
#include "io/bellhop/results.h"
#include "io/ping/provenance.h"

namespace asdic::detail {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

void write_result(OutputFile&& to, PropagationFile&& result, const BellhopWriting& how,
                  const EarthLine& earth) {
  const std::string ending = ending_of(to.target());
  const auto dialect = [&](bellhop::Dialect as_it_is) {
    if (!how.wide) return as_it_is;
    return *how.wide ? bellhop::Dialect::wide : bellhop::Dialect::fortran;
  };
  if (ending == ".h5" || ending == ".hdf5" || ending == ".nc") {
    Hdf5Output output(std::move(to));
    output.file().set_attribute("", "program_version", provenance(1).program_version);
    write_hdf5_result(output.file(), result, earth);
    output.finish();
  } else if (auto* field = std::get_if<bellhop::ShadeFile>(&result); field && ending == ".shd") {
    field->dialect = dialect(field->dialect);
    write_shade_file(std::move(to), *field);
  } else if (auto* arrivals = std::get_if<bellhop::ArrivalsFile>(&result);
             arrivals && ending == ".arr") {
    arrivals->dialect = dialect(arrivals->dialect);
    arrivals->binary = how.binary.value_or(arrivals->binary);
    write_arrivals_file(std::move(to), *arrivals);
  } else if (const auto* rays = std::get_if<bellhop::RayFile>(&result); rays && ending == ".ray") {
    write_ray_file(std::move(to), *rays);
  } else {
    throw InputError({.where = "output",
                      .got = '"' + to.target().string() + "\" for " + std::string(kind_of(result)),
                      .expected = std::string(kind_of(result)) +
                                  " into .h5 or into their own kind of file (.shd, .arr, .ray)"});
  }
}

PropagationFile propagation_file(const PropagationCase& run_case, PropagationResult&& found) {
  if (run_case.task == Task::field) return bellhop::shade_file(run_case, std::move(found));
  if (run_case.task == Task::arrivals) return bellhop::arrivals_file(run_case, found, false);
  return bellhop::ray_file(run_case, found);
}

}  // namespace asdic::detail
