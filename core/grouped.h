#pragma once
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace asdic::detail {

/// Elements by group: a counting sort.
struct Grouped {
  std::vector<std::size_t> first;  ///< [groups + 1] of each group in `order`
  std::vector<std::size_t> order;  ///< [elements] indices, group by group, in each as they came

  [[nodiscard]] std::span<const std::size_t> of(std::size_t group) const noexcept {
    return {order.data() + first[group], order.data() + first[group + 1]};
  }
};

/// \param group_of  [elements] each below `groups`
[[nodiscard]] inline Grouped grouped(std::span<const std::size_t> group_of, std::size_t groups) {
  Grouped made{.first = std::vector<std::size_t>(groups + 1, 0),
               .order = std::vector<std::size_t>(group_of.size())};
  for (const std::size_t group : group_of) ++made.first[group + 1];
  std::partial_sum(made.first.begin(), made.first.end(), made.first.begin());
  std::vector<std::size_t> next = made.first;
  for (std::size_t i = 0; i < group_of.size(); ++i) made.order[next[group_of[i]]++] = i;
  return made;
}

}  // namespace asdic::detail
