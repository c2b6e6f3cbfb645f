#include "fuzz/bellhop_case.h"

// .brc and .trc, tables of reflection coefficients: the same text for both boundaries.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  asdic::detail::bellhop::Texts texts = asdic::detail::fuzz::small_case("CFW", "F", "CG");
  const std::string half_space = "100 1700 0 1.8 0.5 /\n";  // which a table has not
  texts.env.erase(texts.env.find(half_space), half_space.size());
  texts.companions.emplace_back(".brc", asdic::detail::fuzz::text(data, size));
  texts.companions.emplace_back(".trc", asdic::detail::fuzz::text(data, size));
  asdic::detail::fuzz::read_and_write(texts);
  return 0;
}
