#include "io/settings/axis.h"

#include <algorithm>

namespace asdic::detail {

std::vector<double> evenly_spaced(double first, double last, std::size_t count) {
  std::vector<double> values(count, first);
  for (std::size_t i = 1; i < count; ++i)
    values[i] = i + 1 == count ? last
                               : first + (last - first) * static_cast<double>(i) /
                                             static_cast<double>(count - 1);
  return values;
}

bool are_evenly_spaced(std::span<const double> values) {
  if (values.size() <= 3) return false;
  const std::vector<double> same = evenly_spaced(values.front(), values.back(), values.size());
  return std::equal(same.begin(), same.end(), values.begin());
}

}  // namespace asdic::detail
