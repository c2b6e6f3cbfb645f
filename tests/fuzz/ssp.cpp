#include "fuzz/bellhop_case.h"

// .ssp, range-dependent water, and over a map.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  asdic::detail::bellhop::Texts texts = asdic::detail::fuzz::small_case("QVW", "A", "CG");
  texts.companions.emplace_back(".ssp", asdic::detail::fuzz::text(data, size));
  asdic::detail::fuzz::read_and_write(texts);
  asdic::detail::bellhop::Texts map = asdic::detail::fuzz::small_map("HVW", "A");
  map.companions = texts.companions;
  asdic::detail::fuzz::read_and_write(map);
  return 0;
}
