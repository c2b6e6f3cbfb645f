#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace asdic::detail::study {

/// Indices first … end − 1 of realisations.
struct IndexRange {
  std::uint64_t first = 0, end = 0;

  [[nodiscard]] std::uint64_t size() const noexcept { return end > first ? end - first : 0; }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  auto operator<=>(const IndexRange&) const = default;
};

/// "17:42", as --realisations takes it.
[[nodiscard]] std::string index_text(const IndexRange& range);

/// A set of indices, as ranges: small where they are mostly in a row, however many there are.
class IndexSet {
 public:
  IndexSet() = default;
  explicit IndexSet(IndexRange range) { add(range); }

  void add(IndexRange range);
  /// In time that is linear in the ranges of both.
  void add(const IndexSet& others);
  void add(std::uint64_t index) { add({index, index + 1}); }
  [[nodiscard]] bool contains(std::uint64_t index) const noexcept;
  [[nodiscard]] std::uint64_t size() const noexcept;
  [[nodiscard]] bool empty() const noexcept { return ranges_.empty(); }
  bool operator==(const IndexSet&) const = default;
  /// Sorted, apart from one another.
  [[nodiscard]] const std::vector<IndexRange>& ranges() const noexcept { return ranges_; }

  /// What of `range` is not here.
  [[nodiscard]] IndexSet missing(IndexRange range) const;
  /// What is here and in `range`.
  [[nodiscard]] IndexSet within(IndexRange range) const;

 private:
  /// The first range that ends beyond an index.
  [[nodiscard]] std::vector<IndexRange>::const_iterator first_after(
      std::uint64_t index) const noexcept;

  std::vector<IndexRange> ranges_;
};

/// "0:100, 200:300 and 7 more"; "none".
[[nodiscard]] std::string index_text(const IndexSet& set);

}  // namespace asdic::detail::study
