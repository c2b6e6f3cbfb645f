#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "study/sampling/proposal.h"

// From where to draw for a rare event, found level by level: docs/theory/rare-events.md
namespace asdic::detail::study {

/// What a row of a level tells.
struct LevelRow {
  std::vector<double> scores;  ///< [coordinates] normal scores of what was drawn
  double log_weight = 0.0;     ///< of the row
  double excess = 0.0;         ///< how far it is beyond the event; above 0: it has happened
};

/// How far a level came.
struct Level {
  double reached = 0.0;      ///< least excess of the rows that were fitted; 0: the event itself
  double effective = 0.0;    ///< (Σw)²/Σw² of these rows
  std::size_t rows = 0;      ///< how many they are
  std::size_t hits = 0;      ///< rows of the event
  double probability = 0.0;  ///< Σw/n of them, a guide: the proposal was not fixed beforehand
  std::vector<ProposalPart> parts{};  ///< fitted to them: scores, each by itself

  [[nodiscard]] bool there() const noexcept { return reached >= 0.0; }
};

/// The next level: the rows of greatest excess that are worth `effective` rows of equal weight (of
/// the event, if so many have it), and the mixture of at most three normal laws, independent
/// coordinates each, that is likeliest for them by weight (de Boer et al., Ann. Oper. Res. 134, 19,
/// 2005), as many as Schwarz's criterion says. Deviations are at least √½: then no weight grows
/// without end along a tail. What differs from the standard law by chance alone is left as it is.
/// \param rows  of finite or infinite excess, at least one   \param count  rows that were made
/// \param seed  of where the search for several laws begins
[[nodiscard]] Level next_level(std::span<const LevelRow> rows, double count, double effective,
                               std::uint64_t seed);

}  // namespace asdic::detail::study
