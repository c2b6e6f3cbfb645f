#include "study/measures/row_bytes.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "io/files/digest.h"

namespace asdic::detail::study {
namespace {

std::string_view view(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// 64 bits of SHA-256: damage is found, malice is not looked for.
std::string checksum(std::string_view text) { return sha256(text).substr(0, 16); }

}  // namespace

std::int64_t kept_number(const Row& row) noexcept {
  return (row.pressure.empty() ? 0 : 1) + 2 * static_cast<std::int64_t>(row.kept.size());
}

std::string checksum(const Row& row, std::int64_t kept) {
  // Of rows without arrays as journals have always had it.
  const std::string arrays = kept < 2 ? "" : std::to_string(kept / 2) + "a";
  std::string text = std::to_string(row.index) + (row.valid ? "v" : "-") +
                     (kept % 2 != 0 ? "k" : "-") + arrays + std::to_string(row.fault.size()) +
                     row.fault;
  text += view(bytes_of(row.values));
  text += view(bytes_of(row.cells));
  return checksum(text);
}

std::string checksum_of_cells(const std::vector<std::uint8_t>& bytes) {
  return checksum(view(bytes_of(bytes)));
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t n : shape) text += std::to_string(n) + " ";
  return text;
}

std::vector<std::size_t> shape_of(const std::string& text) {
  std::vector<std::size_t> shape;
  for (const char* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    shape.push_back(std::strtoull(at, &end, 10));
    if (end == at) break;
    at = *end == ' ' ? end + 1 : end;
  }
  return shape;
}

std::string numbers_text(std::span<const double> numbers) {
  std::string text;
  for (const double x : numbers) {
    std::array<char, 40> digits{};
    static_cast<void>(std::snprintf(digits.data(), digits.size(), "%a ", x));  // no digit is lost
    text += digits.data();
  }
  return text;
}

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const char* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    if (end == at) break;
    at = *end == ' ' ? end + 1 : end;
  }
  return numbers;
}

std::string timing_text(const SeriesTiming& timing) {
  return numbers_text(std::array{timing.sample_rate, timing.start, timing.carrier, timing.epoch});
}

SeriesTiming timing_of(const std::string& text) {
  std::vector<double> x = numbers_of(text);
  x.resize(4, 0.0);
  return {.sample_rate = x[0], .start = x[1], .carrier = x[2], .epoch = x[3]};
}

std::string checksum_of_series(std::uint64_t index, const std::string& shape,
                               const std::string& timing, std::span<const std::byte> pressure) {
  return checksum(std::to_string(index) + ":" + shape + ":" + timing + sha256(view(pressure)));
}

std::string checksum_of_array(std::uint64_t index, const std::string& name,
                              const std::string& shape, const std::string& head,
                              std::span<const std::byte> values) {
  return checksum(std::to_string(index) + ":" + name + ":" + shape + ":" + head +
                  sha256(view(values)));
}

void one_kind_of_nan(std::vector<double>& values) {
  for (double& value : values)
    if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace asdic::detail::study
