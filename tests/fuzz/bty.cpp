#include "fuzz/bellhop_case.h"

// .bty and .ati: the same text as the sea floor, then as the sea surface of a small case, and both
// over a map.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(asdic::detail::fuzz::text(data, size));
  asdic::detail::bellhop::Texts bottom = asdic::detail::fuzz::small_case("CVW", "A~", "CG");
  bottom.companions.emplace_back(".bty", text);
  asdic::detail::fuzz::read_and_write(bottom);
  asdic::detail::bellhop::Texts surface = asdic::detail::fuzz::small_case("CVW ~", "A", "CG");
  surface.companions.emplace_back(".ati", text);
  asdic::detail::fuzz::read_and_write(surface);
  asdic::detail::bellhop::Texts floor = asdic::detail::fuzz::small_map("CVW", "A~");
  floor.companions.emplace_back(".bty", text);
  asdic::detail::fuzz::read_and_write(floor);
  asdic::detail::bellhop::Texts waves = asdic::detail::fuzz::small_map("CVW ~", "A");
  waves.companions.emplace_back(".ati", text);
  asdic::detail::fuzz::read_and_write(waves);
  return 0;
}
