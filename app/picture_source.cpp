#include "app/picture_source.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "io/bellhop/case_reader.h"
#include "io/hdf5/environment_group.h"
#include "io/result/result_file.h"

namespace asdic::detail::app {
namespace {

/// The segment that a result covers [m].
std::pair<double, double> extent(const PropagationFile& file) {
  double first = 0.0, last = 0.0;
  const auto include = [&](const std::vector<double>& ranges) {
    for (const double r : ranges) {
      first = std::min(first, r);
      last = std::max(last, r);
    }
  };
  if (const auto* field = std::get_if<bellhop::ShadeFile>(&file)) include(field->receiver_ranges);
  if (const auto* arrivals = std::get_if<bellhop::ArrivalsFile>(&file))
    include(arrivals->receiver_ranges);
  if (const auto* rays = std::get_if<bellhop::RayFile>(&file))
    for (const auto& ray : rays->rays) include(ray.range);
  return {first, last};
}

/// The sea of ROOT.env, if there is one that can be read: a picture does without it.
void add_sea(Hdf5File& file, const std::filesystem::path& result, const PropagationFile& content) {
  std::filesystem::path root = result;
  root.replace_extension();
  std::error_code ignored;
  if (!std::filesystem::exists(root.string() + ".env", ignored)) return;
  try {
    const auto [first, last] = extent(content);
    write_environment_group(file, bellhop::read_case(root).run_case.environment, first, last);
  } catch (const InputError&) {
    // an .env of another case, or a later edit of it
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "asdic-XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr)
    throw RunError(name + ": " + (error ? error.message() : std::strerror(errno)));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path picture_source(const std::filesystem::path& result,
                                     const TemporaryFolder& folder, const std::string& name) {
  if (is_hdf5(result)) return result;
  const PropagationFile content = read_result(result);
  std::filesystem::path path = folder.path() / (name + ".h5");
  Hdf5File file = Hdf5File::create(path);
  write_hdf5_result(file, content);
  add_sea(file, result, content);
  file.close();
  return path;
}

}  // namespace asdic::detail::app
