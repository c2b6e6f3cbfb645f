#pragma once
#include <span>
#include <string>

namespace asdic::detail {

/// What is known of the number of beams of a field, in words: "more beams would change no more than
/// 0.4 dB at 95 % of the receivers". \param error_db  as PropagationResult has it; ∞: no bound can
/// be given [dB]   \param bounded  it is a bound, else an estimate
[[nodiscard]] std::string beam_error_text(double error_db, bool bounded);

/// A receiver is sure of its number of beams where more of them would change no more than this
/// [dB].
inline constexpr double sure_db = 0.5;

/// The share of the receivers that are sure, of those of which it is known; NaN where of none.
/// \param errors  PropagationResult::beam_errors [dB]
[[nodiscard]] double share_sure(std::span<const float> errors);

/// The same in words: "to 0.5 dB at 28 % of the receivers"; shares are rounded down.
[[nodiscard]] std::string certainty_text(double share);

}  // namespace asdic::detail
