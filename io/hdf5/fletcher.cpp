#include "io/hdf5/fletcher.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace asdic::hdf5 {
namespace {

constexpr std::uint32_t fold(std::uint32_t sum) { return (sum & 0xffffU) + (sum >> 16U); }

}  // namespace

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  assert(bytes.size() % 2 == 0);
  // Within a block the second sum is Σ (n − i) w_i: no step waits for the one before, so the loop
  // becomes vector instructions. 256 words: 256 · 257 / 2 · 65535 < 2³².
  constexpr std::size_t block = 256;
  std::uint32_t first = 0, second = 0;
  std::uint16_t words[block];
  for (std::size_t at = 0, all = bytes.size() / 2; at < all; at += block) {
    const std::size_t n = std::min(block, all - at);
    std::memcpy(words, bytes.data() + 2 * at, 2 * n);
    std::uint32_t sum = 0, weighted = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t word = static_cast<std::uint16_t>((words[i] << 8U) | (words[i] >> 8U));
      sum += word;
      weighted += static_cast<std::uint32_t>(n - i) * word;
    }
    second = fold(fold(second + static_cast<std::uint32_t>(n) * first)) + fold(weighted);
    second = fold(second);
    first = fold(fold(first + sum));
  }
  return (fold(second) << 16U) | fold(first);
}

}  // namespace asdic::hdf5
