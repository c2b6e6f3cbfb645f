#pragma once
#include <cstdint>

namespace asdic::detail::study {

/// Which realisations are not independent of one another. Rows of different clusters are, or nearly
/// so: intervals are of the scatter between clusters then, not between rows.
struct Clusters {
  enum class Kind {
    rows,       ///< each row is by itself
    blocks,     ///< `size` rows with indices in a row: a block of Saltelli's design
    replicates  ///< index i belongs to i mod `size`: independently scrambled nets that take turns
  };
  Kind kind = Kind::rows;
  std::uint64_t size = 1;

  [[nodiscard]] std::uint64_t of(std::uint64_t index) const noexcept {
    return kind == Kind::blocks ? index / size : kind == Kind::replicates ? index % size : index;
  }
};

}  // namespace asdic::detail::study
