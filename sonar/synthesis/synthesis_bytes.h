#pragma once
#include <cstddef>

namespace asdic::detail {

class Synthesizer;

/// What Synthesizer::baseband() and add_samples() take [bytes].
struct SynthesisBytes {
  double row = 0.0;  ///< a phone's baseband
  double all = 0.0;  ///< at the peak, the phones' basebands included
};
[[nodiscard]] SynthesisBytes synthesis_bytes(const Synthesizer& synthesizer, std::size_t phones);

}  // namespace asdic::detail
