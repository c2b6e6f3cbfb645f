#pragma once
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/error.h"

namespace asdic::detail::bellhop {

/// Little-endian numbers in a file's bytes; every look is checked.
class BinaryView {
 public:
  BinaryView(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }

  /// A number at a byte. \throws InputError if the file ends before
  template <class T>
  [[nodiscard]] T at(std::size_t byte, const char* item) const {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    std::memcpy(&value, view(byte, sizeof(T), item).data(), sizeof(T));
    return value;
  }
  [[nodiscard]] std::string_view view(std::size_t byte, std::size_t n, const char* item) const {
    if (byte > size() || n > size() - byte)
      fail(byte, item, "the end of the file at byte " + std::to_string(size()),
           std::to_string(n) + " more bytes");
    return bytes_.substr(byte, n);
  }
  [[noreturn]] void fail(std::size_t byte, const char* item, std::string got,
                         std::string expected) const {
    throw InputError({.where = name_ + ": byte " + std::to_string(byte) + ": " + item,
                      .got = std::move(got),
                      .expected = std::move(expected)});
  }

 private:
  std::string_view bytes_;
  std::string name_;
};

template <class T>
void put(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace asdic::detail::bellhop
