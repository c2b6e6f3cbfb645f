#include "io/hdf5/file_check.h"

#include <numeric>

#include "core/error.h"

namespace asdic::detail {
namespace {

/// "[3]", "[3, 0]": where a block begins.
std::string place(const Shape& start, std::size_t axes) {
  std::string text;
  for (std::size_t i = 0; i < axes; ++i)
    text += (text.empty() ? "[" : ", ") + std::to_string(start[i]);
  return text + "]";
}

/// Reads a dataset row by row; where a row is a table, line by line. \return how many numbers
std::size_t check_dataset(const Hdf5File& file, const DatasetInfo& dataset) {
  const Shape& shape = dataset.shape;
  const std::size_t axes = shape.size() > 2 ? 2 : 1;  // that are walked
  constexpr std::size_t together = 4096;              // rows of a column
  const std::size_t step = shape.size() == 1 ? together : 1;
  const std::size_t lines = axes == 2 ? shape[1] : 1;
  std::size_t values = 0;
  for (std::size_t row = 0; row < shape[0]; row += step)
    for (std::size_t line = 0; line < lines; ++line) {
      Shape start(shape.size(), 0), count = shape;
      start[0] = row;
      count[0] = std::min(step, shape[0] - row);
      if (axes == 2) {
        start[1] = line;
        count[1] = 1;
      }
      try {
        values += dataset.type == ElementType::float32
                      ? file.read<float>(dataset.path, start, count).size()
                      : file.read<double>(dataset.path, start, count).size();
      } catch (const RunError& error) {
        throw InputError({.where = file.path().string() + ": " + dataset.path + place(start, axes),
                          .got = "damaged data",
                          .expected = "what was written (" + std::string(error.what()) + ")"});
      }
    }
  return values;
}

}  // namespace

FileCheck check_file(const Hdf5File& file) {
  FileCheck found;
  for (const DatasetInfo& dataset : file.datasets()) {
    if (dataset.type == ElementType::text || dataset.type == ElementType::other ||
        !file.has_checksums(dataset.path)) {
      ++found.unchecked;
      continue;
    }
    ++found.checked;
    if (!dataset.shape.empty()) found.values += check_dataset(file, dataset);
  }
  return found;
}

}  // namespace asdic::detail
