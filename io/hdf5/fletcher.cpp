#include "io/hdf5/fletcher.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace asdic::detail::hdf5 {
namespace {

/// A sum modulo 65535 in 16 bits: 2¹⁶ is 1. Of a sum of anything but zeros it is never 0.
constexpr std::uint64_t fold(std::uint64_t sum) {
  while (sum > 0xffffU) sum = (sum & 0xffffU) + (sum >> 16U);
  return sum;
}

constexpr std::size_t lanes = 8;

/// Sums of words as they stand in memory, in lanes side by side: word l of each row of eight goes
/// to lane l.
struct SimdSums {
  static constexpr std::size_t most_rows = 256;  // 256 · 257 / 2 · 65535 < 2³²
  std::uint32_t first[lanes];                    ///< Σ w_k, of the rows k
  std::uint32_t second[lanes];  ///< Σ (rows − k) w_k: of the sums so far, after every row
};

SimdSums sums_of(const std::byte* bytes, std::size_t rows) {
  using Words [[gnu::vector_size(8)]] = std::uint16_t;
  using Sums [[gnu::vector_size(16)]] = std::uint32_t;
  Sums first[2] = {}, second[2] = {};
  for (std::size_t k = 0; k < rows; ++k) {
    Words words[2];
    std::memcpy(words, bytes + k * sizeof words, sizeof words);
    first[0] += __builtin_convertvector(words[0], Sums);
    first[1] += __builtin_convertvector(words[1], Sums);
    second[0] += first[0];
    second[1] += first[1];
  }
  SimdSums sums;
  std::memcpy(sums.first, first, sizeof first);
  std::memcpy(sums.second, second, sizeof second);
  return sums;
}

constexpr std::uint64_t swapped(std::uint64_t word) { return (word << 8U | word >> 8U) & 0xffffU; }

}  // namespace

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  assert(bytes.size() % 2 == 0);
  // Swapping the bytes of a word multiplies it by 2⁸ modulo 2¹⁶ − 1, and so it does a sum of them:
  // words are summed as they are, and the two sums swapped at the end.
  std::uint64_t first = 0, second = 0;
  const std::size_t all = bytes.size() / 2;
  std::size_t at = 0;
  while (all - at >= lanes) {
    const std::size_t rows = std::min((all - at) / lanes, SimdSums::most_rows);
    const SimdSums sums = sums_of(bytes.data() + 2 * at, rows);
    const std::size_t n = rows * lanes;
    // Of the n words the i-th counts n − i times, and i = 8k + l: 8(rows − k) − l.
    second += n * first;
    for (std::size_t l = 0; l < lanes; ++l) {
      second += lanes * sums.second[l] - l * std::uint64_t{sums.first[l]};
      first += sums.first[l];
    }
    first = fold(first);
    second = fold(second);
    at += n;
  }
  for (; at < all; ++at) {
    std::uint16_t word = 0;
    std::memcpy(&word, bytes.data() + 2 * at, sizeof word);
    first = fold(first + word);
    second = fold(second + first);
  }
  return static_cast<std::uint32_t>(swapped(second) << 16U | swapped(first));
}

}  // namespace asdic::detail::hdf5
