#pragma once
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/measures/realisation.h"

// Rows as a journal keeps them: bytes, and checksums that find damage.
namespace asdic::detail::study {

template <class T>
[[nodiscard]] std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span<const T>(values));
}

template <class T>
[[nodiscard]] std::vector<T> vector_of(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// How many things a row keeps beside its columns: 1 for a time series, 2 for each of its arrays.
[[nodiscard]] std::int64_t kept_number(const Row& row) noexcept;
/// Of a row without what it keeps. \param kept  the kept_number() of it
[[nodiscard]] std::string checksum(const Row& row, std::int64_t kept);
/// Of one of its arrays. \param shape, head  as shape_text() and numbers_text() write them
[[nodiscard]] std::string checksum_of_array(std::uint64_t index, const std::string& name,
                                            const std::string& shape, const std::string& head,
                                            std::span<const std::byte> values);
/// Of sums of cells.
[[nodiscard]] std::string checksum_of_cells(const std::vector<std::uint8_t>& bytes);
/// Of the time series alone. \param shape, timing  as shape_text() and timing_text() write them
[[nodiscard]] std::string checksum_of_series(std::uint64_t index, const std::string& shape,
                                             const std::string& timing,
                                             std::span<const std::byte> pressure);

/// Numbers with a blank behind each.
[[nodiscard]] std::string shape_text(const std::vector<std::size_t>& shape);
[[nodiscard]] std::vector<std::size_t> shape_of(const std::string& text);
/// Exactly, with a blank behind each.
[[nodiscard]] std::string numbers_text(std::span<const double> numbers);
[[nodiscard]] std::vector<double> numbers_of(const std::string& text);
/// The same of its four numbers.
[[nodiscard]] std::string timing_text(const SeriesTiming& timing);
[[nodiscard]] SeriesTiming timing_of(const std::string& text);

/// A missing number has the same bits however it came about.
void one_kind_of_nan(std::vector<double>& values);

}  // namespace asdic::detail::study
