#pragma once
#include <span>
#include <vector>

#include "study/sampling/design.h"
#include "study/summary/clustered_mean.h"

// Indices out of the blocks of Saltelli's design: docs/theory/studies.md
namespace asdic::detail::study {

/// What the rows of each block measured, NaN where nothing is known. [blocks][rows of a block]
using BlockValues = std::vector<std::vector<double>>;

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
