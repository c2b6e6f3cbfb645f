#include "fuzz/bellhop_case.h"

// .bty and .ati: the same text as the sea floor, then as the sea surface of a small case.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(asdic::fuzz::text(data, size));
  asdic::bellhop::Texts bottom = asdic::fuzz::small_case("CVW", "A~", "CG");
  bottom.companions.emplace_back(".bty", text);
  asdic::fuzz::read_and_write(bottom);
  asdic::bellhop::Texts surface = asdic::fuzz::small_case("CVW ~", "A", "CG");
  surface.companions.emplace_back(".ati", text);
  asdic::fuzz::read_and_write(surface);
  return 0;
}
