#pragma once
#include <algorithm>

#include "raytrace/bellhop_emulation/beam.h"

namespace asdic::detail::bellhop_emulation {

/// The column of receivers that moves along with a ray. It stops short of a segment's end, so that
/// a range at a joint belongs to the segment that begins there if the ray goes forwards, to none if
/// it goes backwards, and to the first backward one where it turns.
class ColumnWalk {
 public:
  ColumnWalk(const ReceiverBlock& block, double range) noexcept
      : range_(block.grid.ranges), begin_(block.column_begin), end_(block.column_end) {
    const auto at = std::lower_bound(range_.begin(), range_.end(), range) - range_.begin();
    column_ = std::min(static_cast<std::size_t>(at), range_.size() - 1);
  }

  /// Calls visit(column) for the block's columns between the ends of a segment.
  void over(double from, double to, auto&& visit) {
    const double low = std::min(from, to), high = std::max(from, to);
    for (;;) {
      const double here = range_[column_];
      if (here >= low && here < high && column_ >= begin_ && column_ < end_) visit(column_);
      if (here < to) {
        if (column_ + 1 >= range_.size() || range_[column_ + 1] >= to) return;
        ++column_;
      } else {
        if (column_ == 0 || range_[column_ - 1] <= to) return;
        --column_;
      }
    }
  }

 private:
  const std::vector<double>& range_;
  std::size_t begin_, end_, column_ = 0;
};

}  // namespace asdic::detail::bellhop_emulation
