#pragma once
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/units.h"

namespace asdic::detail {

/// What is kept: the first word of its keys. One kind, one type.
enum class Kept : std::uint64_t {
  slice,
  legs,
  followed_legs,
  pulse_moments,
  boundary_fan,
  path_groups,
  synthesis,
  waveform,
  expected_reverberation,
  patch_rows,
  reverberation_covariance,
  covariance_spectra,
  reverberation_streams,
  noise_factors
};

/// All the numbers that decide a result, bit for bit.
class ExactKey {
 public:
  explicit ExactKey(Kept kind, std::uint64_t ocean) {
    constexpr std::size_t usual = 24;  // words of a key of paths
    words_.reserve(usual);
    words_.push_back(static_cast<std::uint64_t>(kind));
    words_.push_back(ocean);
  }

  template <std::integral T>
  ExactKey& add(T value) {
    words_.push_back(static_cast<std::uint64_t>(value));
    return *this;
  }
  ExactKey& add(double value) { return add(std::bit_cast<std::uint64_t>(value)); }
  ExactKey& add(const Vec2& value) { return add_all(value.x(), value.y()); }
  ExactKey& add(const Vec3& value) { return add_all(value.x(), value.y(), value.z()); }
  ExactKey& add(const std::vector<double>& values) {
    add(values.size());
    for (const double value : values) add(value);
    return *this;
  }
  template <class... Values>
  ExactKey& add_all(const Values&... values) {
    (add(values), ...);
    return *this;
  }

  [[nodiscard]] bool operator==(const ExactKey&) const = default;
  [[nodiscard]] std::size_t hash() const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return words_.capacity() * 8; }

 private:
  std::vector<std::uint64_t> words_;
};

/// What propagation has found, by exact key, within a bound on bytes: what was used longest ago is
/// forgotten first. Shared by threads.
class PropagationMemory {
 public:
  static constexpr std::uint64_t for_ever = std::numeric_limits<std::uint64_t>::max();

  /// \param most_pings  that something is kept without being used. In a sequence in which something
  /// moves each ping finds paths and waveforms that none asks for again
  explicit PropagationMemory(std::size_t most_bytes, std::uint64_t most_pings = for_ever)
      : most_bytes_(most_bytes), most_pings_(most_pings) {}

  void next_ping();

  /// What a pure function of the key's numbers gives: as it is kept, or made now and kept. Of two
  /// that are made at once the first stays.
  /// \param key   whose kind says the type   \param make  → std::shared_ptr<T>
  /// \param bytes  that a T takes   \param known  is told whether it was there; null: nobody is
  template <class Make, class Bytes>
  auto remember(const ExactKey& key, const Make& make, const Bytes& bytes, bool* known = nullptr) {
    using T = typename decltype(make())::element_type;
    auto kept = std::static_pointer_cast<T>(recall(key));
    if (known != nullptr) *known = kept != nullptr;
    if (kept) return kept;
    auto made = make();
    const std::size_t size = bytes(*made);
    return std::static_pointer_cast<T>(store(key, std::move(made), size));
  }
  /// The same of what tells how many bytes() it takes.
  template <class Make>
  auto remember(const ExactKey& key, const Make& make) {
    return remember(key, make, [](const auto& value) { return value.bytes(); });
  }
  /// Corrects what a value takes, where that was not known when it was kept.
  void charge(const ExactKey& key, std::size_t bytes);

  [[nodiscard]] std::size_t bytes() const;  ///< of all that is kept

 private:
  using Value = std::shared_ptr<void>;
  struct Entry {
    ExactKey key;
    Value value;
    std::size_t bytes;
    std::uint64_t ping;  // that used it last
  };
  struct Hash {
    std::size_t operator()(const ExactKey& key) const noexcept { return key.hash(); }
  };
  [[nodiscard]] Value recall(const ExactKey& key);
  Value store(const ExactKey& key, Value value, std::size_t bytes);
  void forget();

  const std::size_t most_bytes_;
  const std::uint64_t most_pings_;
  mutable std::mutex lock_;
  std::list<Entry> used_;  // the latest first
  std::unordered_map<ExactKey, std::list<Entry>::iterator, Hash> places_;
  std::size_t bytes_ = 0;
  std::uint64_t ping_ = 0;
};

}  // namespace asdic::detail
