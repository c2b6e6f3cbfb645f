#include "fuzz/bellhop_case.h"

// .sbp, the pattern of a source.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  asdic::detail::bellhop::Texts texts = asdic::detail::fuzz::small_case("CVW", "A", "CG*");
  texts.companions.emplace_back(".sbp", asdic::detail::fuzz::text(data, size));
  asdic::detail::fuzz::read_and_write(texts);
  return 0;
}
