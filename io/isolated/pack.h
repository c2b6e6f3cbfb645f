#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// Values as bytes and back, between a process and its child: the same program on both sides.
namespace asdic::detail::isolated {

/// A number, a truth value or an enumerator.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// A struct with a function fields(value, visit) beside it that visits all its members.
template <class T>
concept HasFields = requires(T& value) {
  fields(value, [](auto&) {});
};

class Packed {
 public:
  template <Plain T>
  void put(T value) {
    add(&value, sizeof value);
  }

  void put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    add(text.data(), text.size());
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  void put(const std::filesystem::path& path) { put(path.native()); }

  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    if constexpr (Plain<T>)
      add(values.data(), values.size() * sizeof(T));
    else
      for (const T& value : values) put(value);
  }
  template <HasFields T>
  void put(T value) {
    fields(value, [this](const auto& field) { put(field); });
  }

  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  void add(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

class Unpacked {
 public:
  explicit Unpacked(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  [[nodiscard]] T get() {
    T value{};
    get(value);
    return value;
  }

 private:
  template <Plain T>
  void get(T& value) {
    std::memcpy(&value, piece(sizeof value).data(), sizeof value);
  }

  void get(std::string& text) { text = std::string(piece(get<std::uint64_t>())); }
  void get(std::filesystem::path& path) { path = get<std::string>(); }

  template <class T>
  void get(std::vector<T>& values) {
    const auto count = get<std::uint64_t>();
    if constexpr (Plain<T>) {
      const std::string_view bytes = piece(count * sizeof(T));
      values.resize(count);
      if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    } else {
      for (std::uint64_t i = 0; i < count; ++i) values.push_back(get<T>());
    }
  }
  template <HasFields T>
  void get(T& value) {
    fields(value, [this](auto& field) { get(field); });
  }

  std::string_view piece(std::uint64_t size) {
    if (size > bytes_.size()) throw std::logic_error("a message between processes is too short");
    const std::string_view result = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return result;
  }
  std::string_view bytes_;
};

}  // namespace asdic::detail::isolated
