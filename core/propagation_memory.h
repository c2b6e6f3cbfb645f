#pragma once
#include <atomic>
#include <bit>
#include <complex>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <ranges>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "core/settings_words.h"
#include "core/units.h"

namespace asdic::detail {

/// What is kept: the first word of its keys. One kind, one type.
enum class Kept : std::uint64_t {
  slice,
  cycle_waves,
  water_column,
  layer_pair,
  waterborne_waves,
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
  noise_factors,
  mean_reverberation,
  branch_waves,
  caustics
};

/// All the numbers that decide a result, bit for bit: best made of what the function that finds it
/// takes, so that none is forgotten.
class ExactKey {
 public:
  /// \param ocean  or what else the numbers are about: its identity
  template <class... Values>
  explicit ExactKey(Kept kind, std::uint64_t ocean, const Values&... values) {
    constexpr std::size_t usual = 32;  // words of a key of paths
    words_.reserve(usual);
    words_.push_back(static_cast<std::uint64_t>(kind));
    words_.push_back(ocean);
    add_all(values...);
  }

  /// A number, a choice, a place; a struct that describes its settings (core/settings_words.h); one
  /// that has `add_to(ExactKey&, value)` beside it, which names every member; or several of these.
  template <class T>
  ExactKey& add(const T& value) {
    if constexpr (std::integral<T> || std::is_enum_v<T>) {
      words_.push_back(static_cast<std::uint64_t>(value));
    } else if constexpr (std::floating_point<T>) {
      words_.push_back(std::bit_cast<std::uint64_t>(static_cast<double>(value)));
    } else if constexpr (std::same_as<T, std::complex<double>>) {
      add_all(value.real(), value.imag());
    } else if constexpr (std::same_as<T, Vec2> || std::same_as<T, Vec3>) {
      for (const double coordinate : value) add(coordinate);
    } else if constexpr (Described<T>) {
      const std::vector<std::uint64_t> words = settings_words(value);
      words_.insert(words_.end(), words.begin(), words.end());
    } else if constexpr (requires { add_to(*this, value); }) {
      add_to(*this, value);
    } else {
      add(std::ranges::size(value));
      for (const auto& one : value) add(one);
    }
    return *this;
  }
  template <class T>
  ExactKey& add(const std::optional<T>& value) {
    add(value.has_value());
    return value ? add(*value) : *this;
  }
  template <class... T>
  ExactKey& add(const std::variant<T...>& value) {
    add(value.index());
    std::visit([this](const auto& one) { add(one); }, value);
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
  [[nodiscard]] Kept kind() const noexcept { return static_cast<Kept>(words_.front()); }

 private:
  std::vector<std::uint64_t> words_;
};

/// What propagation has found, by exact key, within a bound on bytes: what was used longest ago is
/// forgotten first. Legs have a third of the bytes at most, because ends that move leave
/// thousands of them behind, which would push out what every ping uses again. Shared by threads.
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

  /// A search was ended for its cost: what it found may be kept, and is not all.
  void count_ended_search() noexcept { ++ended_searches_; }
  /// Of all that were made with it.
  [[nodiscard]] std::size_t ended_searches() const noexcept { return ended_searches_; }

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
  struct Shelf {
    std::list<Entry> used = {};  // the latest first
    std::size_t bytes = 0;
  };
  [[nodiscard]] static bool is_leg(const ExactKey& key) noexcept {
    return key.kind() == Kept::legs || key.kind() == Kept::followed_legs;
  }
  [[nodiscard]] Shelf& shelf_of(const ExactKey& key) noexcept {
    return is_leg(key) ? legs_ : others_;
  }
  void forget();
  void forget(Shelf& shelf, std::size_t most_bytes);

  const std::size_t most_bytes_;
  const std::uint64_t most_pings_;
  mutable std::mutex lock_;
  Shelf legs_, others_;
  std::unordered_map<ExactKey, std::list<Entry>::iterator, Hash> places_;
  std::uint64_t ping_ = 0;
  std::atomic<std::size_t> ended_searches_ = 0;
};

}  // namespace asdic::detail
