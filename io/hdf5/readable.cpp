#include "io/hdf5/readable.h"

#include <algorithm>
#include <set>

namespace asdic::detail {
namespace {

void read_attributes(const Hdf5File& file, const std::string& object) {
  for (const std::string& key : file.attributes(object))
    static_cast<void>(file.attribute_texts(object, key));
}

/// One row, or what is left of it after a thousand values along each other axis.
void read_row(const Hdf5File& file, const DatasetInfo& info, std::size_t row) {
  Shape start(info.shape.size(), 0), count(info.shape);
  for (std::size_t& n : count) n = std::min<std::size_t>(n, 1000);
  if (!count.empty()) {
    start.front() = row;
    count.front() = std::min<std::size_t>(count.front(), 1);
  }
  if (std::find(count.begin(), count.end(), 0U) == count.end())
    static_cast<void>(file.read<double>(info.path, start, count));
}

}  // namespace

void check_readable(const Hdf5File& file) {
  std::set<std::string> groups;
  for (const DatasetInfo& info : file.datasets()) {
    const auto group = info.path.substr(0, info.path.rfind('/'));
    if (groups.insert(group).second) read_attributes(file, group);
    read_attributes(file, info.path);
    if (info.type == ElementType::text && info.shape.empty())
      static_cast<void>(file.read_text(info.path));
    if (info.type == ElementType::text || info.type == ElementType::other) continue;
    read_row(file, info, 0);
    if (!info.shape.empty() && info.shape.front() > 1) read_row(file, info, info.shape.front() - 1);
  }
}

}  // namespace asdic::detail
