#pragma once
#include <string>

namespace asdic {

/// What is known of the number of beams of a field, in words: "more beams would change no more than
/// 0.4 dB at 95 % of the receivers". \param error_db  as PropagationResult has it; ∞: no bound can
/// be given [dB]   \param bounded  it is a bound, else an estimate
[[nodiscard]] std::string beam_error_text(double error_db, bool bounded);

}  // namespace asdic
