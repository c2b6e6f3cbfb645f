#pragma once
#include <algorithm>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "reverb/pairs/doppler_span.h"
#include "sonar/paths/returns.h"

namespace asdic::detail {

/// Some returns, and what they are across the band.
struct ReturnBlock {
  Returns returns;
  /// [returns × responses] amplitude at each of the synthesizer's frequencies; empty: it has one,
  /// and that is Return::amplitude.
  std::vector<std::complex<float>> responses;

  void clear() noexcept {
    returns.clear();
    responses.clear();
  }
};

/// Returns that are made when they are gridded, block by block, and forgotten then: what memory
/// they take does not grow with their number. Blocks and their order belong to what is received,
/// not to threads.
class ReturnSource {
 public:
  virtual ~ReturnSource() = default;
  [[nodiscard]] virtual std::size_t blocks() const = 0;
  /// About how many returns a block has: thousands.
  [[nodiscard]] virtual std::size_t expected(std::size_t block) const = 0;
  /// Called by several threads at once. \param into  empty; its memory is used again
  virtual void make(std::size_t block, ReturnBlock& into) const = 0;
  /// Segments that hold every return's Doppler factor.
  [[nodiscard]] virtual std::vector<DopplerSpan> dopplers() const = 0;
};

/// Returns that exist already.
class ReturnList final : public ReturnSource {
 public:
  explicit ReturnList(std::span<const Return> returns) : returns_(returns) {}
  [[nodiscard]] std::size_t blocks() const override {
    return (returns_.size() + block_size - 1) / block_size;
  }
  [[nodiscard]] std::size_t expected(std::size_t /*block*/) const override { return block_size; }
  void make(std::size_t block, ReturnBlock& into) const override {
    const std::size_t first = block * block_size;
    const auto part = returns_.subspan(first, std::min(block_size, returns_.size() - first));
    into.returns.assign(part.begin(), part.end());
  }
  [[nodiscard]] std::vector<DopplerSpan> dopplers() const override {
    std::vector<DopplerSpan> found;
    for (const Return& r : returns_) found.push_back({r.doppler, r.doppler});
    return found;
  }

 private:
  static constexpr std::size_t block_size = 4096;
  std::span<const Return> returns_;
};

}  // namespace asdic::detail
