#include "io/mat/mat_file.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says that it is");

constexpr std::string_view first_words = "MATLAB 5.0 MAT-file, written by asdic";

enum DataType : std::uint32_t { int8 = 1, uint16 = 4, int32 = 5, uint32 = 6, single = 7, real = 9 };
constexpr std::uint32_t matrix_type = 14;
enum ArrayClass : std::uint32_t { cell = 1, structure = 2, text = 4, doubles = 6, singles = 7 };
constexpr std::uint32_t complex_flag = 0x0800;

template <class T>
std::string raw(const T* values, std::size_t count) {
  std::string bytes(count * sizeof(T), '\0');
  if (count > 0) std::memcpy(bytes.data(), values, bytes.size());
  return bytes;
}
std::string word(std::uint32_t value) { return raw(&value, 1); }

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 7) / 8 * 8; }

/// Type and length stand before an element's bytes; four bytes or less share a word with them.
std::string element(DataType type, const std::string& bytes) {
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::string all = length > 0 && length <= 4 ? word(length << 16U | type) + bytes
                                              : word(type) + word(length) + bytes;
  all.resize(padded(all.size()), '\0');
  return all;
}

/// What stands before the numbers of an array: its class, its shape, its name.
std::string head(std::uint32_t flags, std::size_t rows, std::size_t columns,
                 std::string_view name) {
  const std::uint32_t class_and_none[] = {flags, 0};
  const std::int32_t shape[] = {static_cast<std::int32_t>(rows),
                                static_cast<std::int32_t>(columns)};
  return element(uint32, raw(class_and_none, 2)) + element(int32, raw(shape, 2)) +
         element(int8, std::string(name));
}

std::string array(const std::string& content) {
  return word(matrix_type) + word(static_cast<std::uint32_t>(content.size())) + content;
}

/// UTF-8 as UTF-16; what is no UTF-8 becomes "?".
std::u16string utf16(std::string_view utf8) {
  std::u16string units;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i++]);
    const int more = lead < 0x80        ? 0
                     : lead >> 5U == 6  ? 1
                     : lead >> 4U == 14 ? 2
                     : lead >> 3U == 30 ? 3
                                        : -1;
    char32_t point = more <= 0 ? lead : lead & (0x3FU >> static_cast<unsigned>(more));
    bool good = more >= 0;
    for (int k = 0; good && k < more; ++k) {
      good = i < utf8.size() && (static_cast<unsigned char>(utf8[i]) & 0xC0U) == 0x80U;
      if (good) point = point << 6U | (static_cast<unsigned char>(utf8[i++]) & 0x3FU);
    }
    if (!good) {
      units += u'?';
    } else if (point < 0x10000) {
      units += static_cast<char16_t>(point);
    } else {
      units += static_cast<char16_t>(0xD7C0 + (point >> 10U));
      units += static_cast<char16_t>(0xDC00 + (point & 0x3FFU));
    }
  }
  return units;
}

std::string array_of(std::string_view name, const MatValue& value);

std::string array_of(std::string_view name, const MatMatrix& matrix) {
  assert(matrix.values.size() == matrix.rows * matrix.columns);
  return array(head(doubles, matrix.rows, matrix.columns, name) +
               element(real, raw(matrix.values.data(), matrix.values.size())));
}

std::string array_of(std::string_view name, const std::string& words) {
  const std::u16string units = utf16(words);
  return array(head(text, units.empty() ? 0 : 1, units.size(), name) +
               element(uint16, raw(units.data(), units.size())));
}

std::string array_of(std::string_view name, const std::vector<std::string>& texts) {
  std::string content = head(cell, texts.size(), 1, name);
  for (const std::string& one : texts) content += array_of("", one);
  return array(content);
}

std::string array_of(std::string_view name, const MatStruct& fields) {
  constexpr std::size_t length = 32;  // of a field's name, with the zero at its end
  std::string names, values;
  for (const MatField& field : fields) {
    assert(field.name.size() < length);
    names += field.name + std::string(length - field.name.size(), '\0');
    values += array_of("", field.value);
  }
  return array(head(structure, 1, 1, name) + element(int32, word(length)) + element(int8, names) +
               values);
}

std::string array_of(std::string_view name, const MatValue& value) {
  return std::visit([&](const auto& one) { return array_of(name, one); }, value);
}

}  // namespace

bool own::mat(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string words(first_words.size(), '\0');
  return file.read(words.data(), static_cast<std::streamsize>(words.size())) &&
         words == first_words;
}

std::uint64_t bytes_of(const MatColumns& matrix) noexcept {
  return std::uint64_t{matrix.rows} * matrix.columns * sizeof(float) * (matrix.is_complex ? 2 : 1);
}

MatFile::MatFile(const std::filesystem::path& path, OutputRules rules)
    : output_(path,
              [&] {
                rules.own = own::mat;
                return std::move(rules);
              }()),
      file_(output_.part(), std::ios::binary) {
  std::string start(first_words);
  start.resize(116, ' ');
  start += std::string(8, '\0') + '\0' + '\1' + "IM";  // no subsystem; version 1.0, little-endian
  put(start);
}

void MatFile::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw RunError(output_.target().string() + ": cannot be written");
}

void MatFile::check_size(std::string_view name, std::uint64_t bytes) const {
  if (bytes > most_mat_bytes)
    throw InputError({.where = output_.target().string() + ": " + std::string(name),
                      .got = std::to_string(bytes) + " bytes",
                      .expected = "less than 2 GiB, the most that a variable of a MAT-file holds"});
}

void MatFile::write(std::string_view name, const MatValue& value) {
  const std::string bytes = array_of(name, value);
  check_size(name, bytes.size());
  put(bytes);
}

void MatFile::write(std::string_view name, const MatColumns& matrix) {
  check_size(name, bytes_of(matrix));
  const std::string before =
      head(singles | (matrix.is_complex ? complex_flag : 0), matrix.rows, matrix.columns, name);
  const std::uint64_t part = std::uint64_t{matrix.rows} * matrix.columns * sizeof(float);
  const int parts = matrix.is_complex ? 2 : 1;
  const auto stride = static_cast<std::size_t>(parts);
  const std::uint64_t whole = before.size() + stride * (8 + padded(part));
  put(word(matrix_type) + word(static_cast<std::uint32_t>(whole)) + before);
  for (std::size_t which = 0; which < stride; ++which) {
    put(word(single) + word(static_cast<std::uint32_t>(part)));
    std::vector<float> of_part(matrix.rows);
    for (std::size_t column = 0; column < matrix.columns; ++column) {
      const std::vector<float> values = matrix.column(column);
      assert(values.size() == matrix.rows * stride);
      for (std::size_t i = 0; i < matrix.rows; ++i) of_part[i] = values[i * stride + which];
      put(raw(of_part.data(), of_part.size()));
    }
    put(std::string(padded(part) - part, '\0'));
  }
}

void MatFile::finish() {
  file_.close();
  if (!file_) throw RunError(output_.target().string() + ": cannot be written");
  output_.finish();
}

}  // namespace asdic::detail
