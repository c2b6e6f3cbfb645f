#pragma once
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "study/plan/study.h"
#include "study/sampling/cross_entropy.h"

namespace asdic::detail::study {

/// A level as it is told.
struct AdaptedLevel {
  int number = 0;           ///< from 1
  std::uint64_t made = 0;   ///< rows
  std::uint64_t known = 0;  ///< of them, those in which the event's columns are
  Level level{};
};

/// From where the event of [rare] is reached: levels of rows, each drawn from what was fitted to
/// the one before, until one is worth enough rows of the event. Their rows serve nothing else: the
/// study is made of fresh ones. A function of the study alone.
/// \param tell  of each level
/// \return components of the mixture: weights of any sum, scores of coordinates
/// \throws InputError for a study without an event, or with components of its own, or where the
/// levels do not reach the event; whatever a realisation throws; RunError where it was stopped
[[nodiscard]] std::vector<ProposalPart> adapt(const Study& study,
                                              const std::function<void(const AdaptedLevel&)>& tell,
                                              const std::stop_token& stop = {});

/// The text of a study file with these components at its end. \param note  a comment above them
[[nodiscard]] std::string with_components(const Study& study,
                                          const std::vector<ProposalPart>& components,
                                          const std::string& note);

}  // namespace asdic::detail::study
