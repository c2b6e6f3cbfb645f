#include "study/sampling/index_set.h"

#include <algorithm>
#include <iterator>

namespace asdic::detail::study {

std::string index_text(const IndexRange& range) {
  return std::to_string(range.first) + ":" + std::to_string(range.end);
}

void IndexSet::add(IndexRange range) {
  if (range.empty()) return;
  if (!ranges_.empty() && ranges_.back().end == range.first) {  // rows mostly come in a row
    ranges_.back().end = range.end;
    return;
  }
  // All that touch it melt into it.
  const auto first =
      std::lower_bound(ranges_.begin(), ranges_.end(), range.first,
                       [](const IndexRange& r, std::uint64_t at) { return r.end < at; });
  auto last = first;
  for (; last != ranges_.end() && last->first <= range.end; ++last) {
    range.first = std::min(range.first, last->first);
    range.end = std::max(range.end, last->end);
  }
  ranges_.insert(ranges_.erase(first, last), range);
}

void IndexSet::add(const IndexSet& others) {
  std::vector<IndexRange> both;
  both.reserve(ranges_.size() + others.ranges_.size());
  std::merge(ranges_.begin(), ranges_.end(), others.ranges_.begin(), others.ranges_.end(),
             std::back_inserter(both));
  ranges_.clear();
  for (const IndexRange& range : both) {
    if (ranges_.empty() || ranges_.back().end < range.first)
      ranges_.push_back(range);
    else
      ranges_.back().end = std::max(ranges_.back().end, range.end);
  }
}

std::vector<IndexRange>::const_iterator IndexSet::first_after(std::uint64_t index) const noexcept {
  return std::upper_bound(ranges_.begin(), ranges_.end(), index,
                          [](std::uint64_t at, const IndexRange& r) { return at < r.end; });
}

bool IndexSet::contains(std::uint64_t index) const noexcept {
  const auto after = first_after(index);
  return after != ranges_.end() && after->first <= index;
}

std::uint64_t IndexSet::size() const noexcept {
  std::uint64_t total = 0;
  for (const IndexRange& range : ranges_) total += range.size();
  return total;
}

IndexSet IndexSet::missing(IndexRange range) const {
  IndexSet result;
  std::uint64_t at = range.first;
  for (auto i = first_after(range.first); i != ranges_.end(); ++i) {
    const IndexRange& here = *i;
    if (here.first >= range.end) break;
    result.add({at, std::min(here.first, range.end)});
    at = here.end;
  }
  result.add({at, range.end});
  return result;
}

IndexSet IndexSet::within(IndexRange range) const {
  IndexSet result;
  for (auto i = first_after(range.first); i != ranges_.end() && i->first < range.end; ++i)
    result.add({std::max(i->first, range.first), std::min(i->end, range.end)});
  return result;
}

std::string index_text(const IndexSet& set) {
  constexpr std::size_t most = 4;
  if (set.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < std::min(most, set.ranges().size()); ++i)
    text += (i > 0 ? ", " : "") + index_text(set.ranges()[i]);
  if (set.ranges().size() > most)
    text += " and " + std::to_string(set.ranges().size() - most) + " more";
  return text;
}

}  // namespace asdic::detail::study
