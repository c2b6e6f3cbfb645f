#include "raytrace/tracing/receiver_columns.h"

#include <algorithm>
#include <numeric>

namespace asdic::detail {

ReceiverColumn::Between ReceiverColumn::between(double low, double high) const noexcept {
  const auto first = std::lower_bound(depths.begin(), depths.end(), low);
  const auto last = std::upper_bound(first, depths.end(), high);
  return {static_cast<std::size_t>(first - depths.begin()),
          static_cast<std::size_t>(last - depths.begin())};
}

std::vector<ReceiverColumn> make_columns(std::span<const ReceiverPoint> receivers) {
  std::vector<std::uint32_t> order(receivers.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const ReceiverPoint &pa = receivers[a], &pb = receivers[b];
    return pa.range != pb.range ? pa.range < pb.range : pa.depth < pb.depth;
  });
  std::vector<ReceiverColumn> columns;
  for (const std::uint32_t i : order) {
    if (columns.empty() || columns.back().range != receivers[i].range)
      columns.push_back({.range = receivers[i].range});
    columns.back().depths.push_back(receivers[i].depth);
    columns.back().indices.push_back(i);
  }
  return columns;
}

}  // namespace asdic::detail
