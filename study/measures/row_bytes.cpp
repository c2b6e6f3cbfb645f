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

std::string checksum(const Row& row, bool kept) {
  std::string text = std::to_string(row.index) + (row.valid ? "v" : "-") + (kept ? "k" : "-") +
                     std::to_string(row.fault.size()) + row.fault;
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

std::string timing_text(const SeriesTiming& timing) {
  std::string text;
  for (const double x : {timing.sample_rate, timing.start, timing.carrier, timing.epoch}) {
    std::array<char, 40> digits{};
    static_cast<void>(std::snprintf(digits.data(), digits.size(), "%a ", x));  // no digit is lost
    text += digits.data();
  }
  return text;
}

SeriesTiming timing_of(const std::string& text) {
  std::array<double, 4> x{};
  const char* at = text.c_str();
  for (double& value : x) {
    char* end = nullptr;
    value = std::strtod(at, &end);
    at = end;
  }
  return {.sample_rate = x[0], .start = x[1], .carrier = x[2], .epoch = x[3]};
}

std::string checksum_of_series(std::uint64_t index, const std::string& shape,
                               const std::string& timing, std::span<const std::byte> pressure) {
  return checksum(std::to_string(index) + ":" + shape + ":" + timing + sha256(view(pressure)));
}

void one_kind_of_nan(std::vector<double>& values) {
  for (double& value : values)
    if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace asdic::detail::study
