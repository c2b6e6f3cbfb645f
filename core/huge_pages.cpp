#include "core/huge_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace asdic::detail {

void prefer_huge_pages(void* begin, std::size_t bytes) noexcept {
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21U;
  const auto from = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (from + page - 1) & ~(page - 1), last = (from + bytes) & ~(page - 1);
  if (bytes < 2 * page || first >= last) return;
  // a hint: where it is refused the memory is what it was
  static_cast<void>(::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
}

}  // namespace asdic::detail
