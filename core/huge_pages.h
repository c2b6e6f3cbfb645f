#pragma once
#include <cstddef>

namespace asdic::detail {

/// Tells the system that this memory will be used whole, before it is: it may then give it in pages
/// of 2 MB instead of 512 times as many, each of which the first to touch it waits for. Only worth
/// it for many megabytes; nothing is done where these pages are not to be had, and for less than
/// two of them. The memory's contents stay as they are.
void prefer_huge_pages(void* begin, std::size_t bytes) noexcept;

}  // namespace asdic::detail
