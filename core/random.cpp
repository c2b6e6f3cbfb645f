#include "core/random.h"

#include <Random123/philox.h>

#include <cmath>

#include "core/units.h"

namespace asdic::detail {

std::array<std::uint32_t, 2> random_key(std::uint64_t seed, Draw purpose) noexcept {
  // The 64-bit seed is folded with the purpose into the 64-bit key by one bijective multiply-xor,
  // so seeds differing in any bit and purposes differing at all give different keys.
  std::uint64_t mixed = seed + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(purpose);
  mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9ULL;
  mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBULL;
  mixed ^= mixed >> 31;
  return {static_cast<std::uint32_t>(mixed), static_cast<std::uint32_t>(mixed >> 32)};
}

RandomStream::RandomStream(std::uint64_t seed, Draw purpose, std::uint32_t realisation,
                           std::uint64_t entity)
    : key_(random_key(seed, purpose)),
      counter_{realisation, static_cast<std::uint32_t>(entity),
               static_cast<std::uint32_t>(entity >> 32)} {}

std::array<std::uint32_t, 4> RandomStream::block(std::uint32_t block) const noexcept {
  const r123::Philox4x32::ctr_type counter = {{block, counter_[0], counter_[1], counter_[2]}};
  const r123::Philox4x32::key_type key = {{key_[0], key_[1]}};
  const auto words = r123::Philox4x32{}(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

std::uint32_t RandomStream::next() {
  if (used_ == 4) {
    words_ = block(next_block_++);
    used_ = 0;
  }
  return words_[static_cast<std::size_t>(used_++)];
}

double RandomStream::uniform() { return (next() + 0.5) * 0x1p-32; }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = 2.0 * pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::complex<double> RandomStream::complex_normal() {
  const double real = normal();
  return std::complex<double>(real, normal()) * std::numbers::sqrt2 * 0.5;
}

}  // namespace asdic::detail
