#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "study/sampling/design.h"
#include "study/summary/clustered_mean.h"

// Indices out of the blocks of Saltelli's design: docs/theory/studies.md
namespace asdic::detail::study {

/// What the rows of each block measured, NaN where nothing is known: values of a table, which lie
/// where they lie.
class BlockValues {
 public:
  /// Where the rows of blocks lie in a table. Of a few bytes a block.
  class Places {
   public:
    Places() = default;
    /// \param index  of the table's rows, rising \param rows  of a block
    Places(std::span<const std::uint64_t> index, std::size_t rows);
    [[nodiscard]] std::size_t blocks() const noexcept { return first_.size(); }
    /// None: it is not in the table.
    [[nodiscard]] std::optional<std::size_t> row(std::size_t block, std::size_t in_block) const;

   private:
    std::span<const std::uint64_t> index_;
    std::size_t rows_ = 1;
    std::vector<std::size_t> first_;  // [blocks] its first row in the table
  };

  /// \param values  [rows of the table] \param valid  the same. All outlive this
  BlockValues(const Places& places, std::span<const double> values,
              std::span<const std::uint8_t> valid)
      : places_(places), values_(values), valid_(valid) {}

  [[nodiscard]] std::size_t size() const noexcept { return places_.blocks(); }
  /// NaN where it is not known.
  [[nodiscard]] double at(std::size_t block, std::size_t row) const;

 private:
  const Places& places_;
  std::span<const double> values_;
  std::span<const std::uint8_t> valid_;
};

/// An index with its interval, out of those blocks in which all that it takes is known.
struct Index {
  double blocks = 0.0;
  double value = 0.0;
  Interval interval{};
  double error = 0.0;  ///< standard
};

/// Var(E[Y|X_i])/Var(Y): E[f(B)(f(A_B^i) − f(A))]/V (Saltelli et al., Comput. Phys. Commun. 181,
/// 259, 2010), and the mean of it and of E[f(A)(f(B_A^i) − f(B))]/V where B_A^i is known.
[[nodiscard]] Index first_order_index(const SaltelliBlocks& blocks, const BlockValues& values,
                                      std::size_t group, double confidence);
/// E[Var(Y|all but X_i)]/Var(Y): E[(f(A) − f(A_B^i))²]/2V (Jansen, Comput. Phys. Commun. 117, 35,
/// 1999). \param proportion  the values are 0 or 1
[[nodiscard]] Index total_order_index(const SaltelliBlocks& blocks, const BlockValues& values,
                                      std::size_t group, bool proportion, ProportionInterval kind,
                                      double confidence);
/// What two of them do together beyond what each does: (E[f(B_A^i)f(A_B^j)] − E[f(A)f(B)])/V less
/// the two first orders (Saltelli 2002), i and j also the other way round.
[[nodiscard]] Index second_order_index(const SaltelliBlocks& blocks, const BlockValues& values,
                                       std::size_t one, std::size_t other, double confidence);
/// 1 − Σ of the first orders: interactions, and chance where it is no group.
[[nodiscard]] Index unexplained_share(const SaltelliBlocks& blocks, const BlockValues& values,
                                      double confidence);

}  // namespace asdic::detail::study
