#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "study/measures/realisation.h"

namespace asdic::detail::study {

/// Makes the row of an index: thread-safe, a pure function.
using Realise = std::function<Row(std::uint64_t index)>;
/// The next index to do; none: no more. May wait for one. Called by one thread at a time.
using NextIndex = std::function<std::optional<std::uint64_t>()>;
/// Takes the rows in the order of the indices. Called by one thread at a time. \return false: no
/// more are wanted (those in hand still come)
using RowSink = std::function<bool(Row&& row)>;

struct RunOptions {
  std::stop_token stop{};     ///< calls off the realisations in hand: they have no row
  std::size_t in_flight = 0;  ///< at most at a time; 0: four for each thread
};

/// Indices → rows → sink, as a bounded pipeline: at most `in_flight` rows exist at a time, however
/// many there are to make. A realisation that throws ends the run when its turn comes, after the
/// rows before it: so the fault that is told does not depend on scheduling.
/// \return rows that went to the sink
/// \throws whatever a realisation or the sink throws
std::uint64_t run(const Realise& realise, const NextIndex& next, const RowSink& sink,
                  const RunOptions& options = {});

}  // namespace asdic::detail::study
