#include "io/ping/recovery.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "io/hdf5/file_check.h"
#include "io/isolated/child.h"
#include "io/ping/ping_file.h"

namespace asdic::detail {
namespace {

/// How many rows of a growing dataset belong to the whole pings. \param last  number of the last
std::size_t rows_of_pings(const Hdf5File& file, const std::string& dataset, std::size_t pings,
                          std::int32_t last) {
  const auto slash = dataset.rfind('/');
  const std::string of_row = dataset.substr(0, slash == dataset.npos ? 0 : slash) + "/ping";
  if (slash == dataset.npos || slash == 0 || !file.has(of_row)) return pings;  // a row a ping
  const auto number = file.read<std::int32_t>(of_row);  // of a table: the ping of each row
  return static_cast<std::size_t>(std::upper_bound(number.begin(), number.end(), last) -
                                  number.begin());
}

/// Leaves the whole pings and nothing else. \throws InputError if there are fewer rows than pings
void cut(const std::filesystem::path& path, const Recovery& found) {
  Hdf5File file = Hdf5File::edit(path);
  file.remove("processed");
  const std::int32_t last = file.read<std::int32_t>("ping", {found.pings - 1}, {1}).front();
  std::vector<std::pair<std::string, std::size_t>> rows;
  for (const DatasetInfo& dataset : file.datasets())
    if (file.grows(dataset.path))
      rows.emplace_back(dataset.path, rows_of_pings(file, dataset.path, found.pings, last));
  for (const auto& [dataset, count] : rows) {
    if (file.info(dataset).shape.front() < count)
      throw InputError({.where = path.string() + ": " + dataset,
                        .got = "fewer rows than whole pings",
                        .expected = std::to_string(count)});
    file.shrink(dataset, count);
  }
  file.set_attribute("", "recovered", std::int64_t{1});
  file.set_attribute("", "complete", std::int64_t{found.pings >= found.requested});
  file.close();
}

}  // namespace

Recovery recover_ping_file(const std::filesystem::path& part, OutputFile&& output) {
  Recovery found;
  {
    const PingFile file(part);
    found.pings = file.pings();
    found.requested = static_cast<std::size_t>(file.file().attribute_number("", "pings_requested"));
  }
  if (found.pings == 0)
    throw InputError({.where = part.string(), .got = "no whole ping", .expected = "at least one"});
  std::error_code error;
  std::filesystem::copy_file(part, output.part(), std::filesystem::copy_options::overwrite_existing,
                             error);
  if (error) throw RunError(output.part().string() + ": " + error.message());

  isolated::run(
      output.part(), "HDF5", [&] { cut(output.part(), found); }, isolated::patience);
  static_cast<void>(check_file(Hdf5File::peek(output.part())));
  output.finish();
  return found;
}

}  // namespace asdic::detail
