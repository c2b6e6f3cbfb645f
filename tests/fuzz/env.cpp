#include "fuzz/bellhop_case.h"

// A whole case in one text: the .env file, then companions, each after a line "%%.bty" with its
// ending.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all = asdic::detail::fuzz::text(data, size);
  std::size_t end = std::min(all.find("%%."), all.size());
  asdic::detail::bellhop::Texts texts{.env = std::string(all.substr(0, end)), .companions = {}};
  while (end < all.size()) {
    const std::size_t next = std::min(all.find("%%.", end + 3), all.size());
    const std::string_view part = all.substr(end + 2, next - end - 2);
    texts.companions.emplace_back(part.substr(0, 4),
                                  part.substr(std::min<std::size_t>(5, part.size())));
    end = next;
  }
  asdic::detail::fuzz::read_and_write(texts);
  return 0;
}
