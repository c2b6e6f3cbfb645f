#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Cells of a record in which there is no echo, counted by how far they rise over their background.
namespace asdic::detail::study {

/// Levels u = −ln P at which cells are counted, P the probability of at least as much in even
/// Rayleigh noise: ten to a decade of P down to 10⁻²⁰, and the one that is set. A level holds what
/// lies from it to the next; the first is 0, the last has no end. \return [levels] rising
[[nodiscard]] std::vector<double> cell_levels(double false_alarm_probability);

/// How many cells of one realisation lie in each level of each bin of time, of each target's
/// filter. \param counts  [targets × times × levels]   \return bytes: zeros take next to nothing
[[nodiscard]] std::vector<std::uint8_t> packed_counts(std::span<const std::uint32_t> counts);
/// \param size  of what was packed; what does not fit is left out
[[nodiscard]] std::vector<std::uint32_t> unpacked_counts(std::span<const std::uint8_t> bytes,
                                                         std::size_t size);

/// What is counted. No targets: nothing is.
struct CellShape {
  std::size_t targets = 0;
  std::vector<double> edges{};   ///< of the bins of time [s]
  std::vector<double> levels{};  ///< cell_levels()

  [[nodiscard]] std::size_t times() const noexcept { return edges.empty() ? 0 : edges.size() - 1; }
  [[nodiscard]] bool operator==(const CellShape&) const = default;
};

/// Sums over realisations, whole numbers alone: in any order the same. Cells of one realisation may
/// depend on each other (they share reference cells, and the sea's texture), those of two do not:
/// with the sums of squares the scatter of a rate is known however they do.
struct CellSums {
  CellShape shape{};
  // [targets × (times + 1) × levels]; in a target's first place all times together
  std::vector<std::int64_t> count{};     ///< cells in the level
  std::vector<std::int64_t> squares{};   ///< Σ over realisations of (cells at or above it)²
  std::vector<std::int64_t> with_all{};  ///< Σ of (cells at or above it)·(cells of all levels)
  std::vector<std::int64_t> realisations{};  ///< [targets × (times + 1)] that have a cell there

  [[nodiscard]] bool empty() const noexcept { return count.empty(); }
  /// Of one realisation. \param bytes  packed_counts()
  void add(std::span<const std::uint8_t> bytes);
  /// Of others of the same study; nothing where there are none.
  void add(const CellSums& others);
};
/// Zeros.
[[nodiscard]] CellSums cell_sums(const CellShape& shape);

/// As bytes, for a journal.
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const CellSums& sums);
[[nodiscard]] CellSums cell_sums_of(std::span<const std::uint8_t> bytes);

}  // namespace asdic::detail::study
