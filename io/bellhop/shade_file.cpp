// Pressure fields of bellhop_files.h: .shd.
#include <algorithm>
#include <cmath>

#include "core/utf8.h"
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/binary.h"
#include "io/bellhop/finite_field.h"
#include "io/bellhop/list_reader.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::bellhop {
namespace {

std::string trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  return std::string(text);
}

template <class T>
std::vector<double> numbers(const BinaryView& file, std::size_t byte, std::size_t n,
                            const char* item) {
  std::vector<double> x(n);
  (void)file.view(byte, n * sizeof(T), item);
  for (std::size_t i = 0; i < n; ++i) x[i] = double(file.at<T>(byte + i * sizeof(T), item));
  return x;
}

/// Whether these could be ranges: finite, not tiny rubbish, increasing.
bool plausible(const std::vector<double>& x) noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || (i > 0 && x[i] <= x[i - 1])) return false;
    largest = std::max(largest, std::abs(x[i]));
  }
  return largest < 1e9 && (largest == 0.0 || largest > 1e-6);
}

bool any_byte(std::string_view bytes) noexcept {
  return std::any_of(bytes.begin(), bytes.end(), [](char c) { return c != '\0'; });
}

/// Fixed records: number k, from 1, begins at byte(k).
struct Records {
  std::size_t length = 0;  // [bytes]
  [[nodiscard]] std::size_t byte(std::size_t k) const noexcept { return length * (k - 1); }
};

/// Bearings or places of sources. What a file of one plane has there means nothing.
std::vector<double> places(const BinaryView& file, std::size_t byte, std::size_t n, bool wide,
                           bool one_plane, const char* item) {
  std::vector<double> x =
      wide ? numbers<double>(file, byte, n, item) : numbers<float>(file, byte, n, item);
  for (double& value : x) {
    if (std::isfinite(value)) continue;
    if (!one_plane) file.fail(byte, item, shown(value), "a number");
    value = 0.0;
  }
  return x;
}

/// Receiver ranges: float32 or float64, whichever reads like ranges.
std::vector<double> ranges(const BinaryView& file, const Records& record, std::size_t n,
                           bool& wide) {
  std::vector<double> narrow = numbers<float>(file, record.byte(10), n, "receiver ranges");
  if (8 * n > record.length) return narrow;
  std::vector<double> broad = numbers<double>(file, record.byte(10), n, "receiver ranges");
  const bool rest = any_byte(file.view(record.byte(10) + 4 * n, 4 * n, "receiver ranges"));
  if (!plausible(broad) || (plausible(narrow) && !rest)) return narrow;
  wide = true;
  return broad;
}

void put_record(std::string& bytes, std::size_t k, std::size_t length, std::string_view content) {
  bytes.resize(length * (k - 1), '\0');
  bytes.append(content);
}

template <class T>
std::string vector_bytes(const std::vector<double>& x) {
  std::string bytes;
  for (const double value : x) put(bytes, static_cast<T>(value));
  return bytes;
}

}  // namespace

ShadeFile parse_shade_file(std::string_view bytes, const std::string& name) {
  const BinaryView file(bytes, name);
  const auto words = file.at<std::int32_t>(0, "record length");
  if (words < 21 || std::size_t(words) > bytes.size() / 40)
    file.fail(
        0, "record length", std::to_string(words) + " words of 4 bytes",
        "21 or more, and ten records in the file's " + std::to_string(bytes.size()) + " bytes");
  const Records record{4 * std::size_t(words)};

  ShadeFile shade;
  shade.title = trimmed(file.view(4, 80, "title"));
  const std::string plot_type = trimmed(file.view(record.byte(2), 10, "plot type"));
  shade.irregular = plot_type.starts_with("irregular");
  if (!shade.irregular && !plot_type.starts_with("rectilin"))
    file.fail(record.byte(2), "plot type", shown(plot_type), "\"rectilin\" or \"irregular\"");

  constexpr const char* counts[] = {"number of frequencies",    "number of bearings",
                                    "number of source x",       "number of source y",
                                    "number of source depths",  "number of receiver depths",
                                    "number of receiver ranges"};
  std::size_t n[7] = {};
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t byte = record.byte(3) + 4 * i;
    const auto count = file.at<std::int32_t>(byte, counts[i]);
    const std::int64_t most = i == 0 ? 1 : std::int64_t(record.length) / (i == 6 ? 8 : 4);
    if (count < 1 || count > most)
      file.fail(byte, counts[i], std::to_string(count),
                i == 0 ? "1: a field of one frequency"
                       : "a number from 1 to " + std::to_string(most) +
                             ", which is what a record can hold");
    n[i] = std::size_t(count);
  }
  if (shade.irregular && n[5] != n[6])
    file.fail(record.byte(3) + 20, "number of receiver depths", std::to_string(n[5]),
              "as many as ranges on an irregular grid: " + std::to_string(n[6]));

  shade.frequency = file.at<double>(record.byte(4), "frequency");
  if (!(shade.frequency > 0.0 && std::isfinite(shade.frequency)))
    file.fail(record.byte(4), "frequency", shown(shade.frequency) + " Hz",
              "a frequency above 0 Hz");
  const double narrow = double(file.at<float>(record.byte(3) + 28, "frequency"));
  const double broad = file.at<double>(record.byte(3) + 28, "frequency");
  bool wide = std::abs(broad - shade.frequency) <= std::abs(narrow - shade.frequency);
  shade.source_depths = numbers<float>(file, record.byte(8), n[4], "source depths");
  shade.receiver_depths = numbers<float>(file, record.byte(9), n[5], "receiver depths");
  shade.receiver_ranges = ranges(file, record, n[6], wide);
  shade.dialect = wide ? Dialect::wide : Dialect::fortran;
  const bool one_plane = n[1] == 1 && n[2] == 1 && n[3] == 1;
  for (const std::size_t i : {1, 2, 3})
    if (wide && 8 * n[i] > record.length)
      file.fail(
          record.byte(3) + 4 * i, counts[i], std::to_string(n[i]),
          "at most " + std::to_string(record.length / 8) + ", which is what a record can hold");
  shade.map.azimuths_deg = places(file, record.byte(5), n[1], wide, one_plane, "bearings");
  shade.map.source_x = places(file, record.byte(6), n[2], wide, one_plane, "source x");
  shade.map.source_y = places(file, record.byte(7), n[3], wide, one_plane, "source y");

  // One record a row. A file may end where its last row has nothing but zeros left.
  const double all_rows =
      double(n[1]) * double(n[2]) * double(n[3]) * double(n[4]) * double(shade.rows());
  const std::size_t row_bytes = 8 * n[6];
  const std::size_t whole = (bytes.size() - record.byte(11)) / record.length;
  const std::size_t partial = (bytes.size() - record.byte(11)) % record.length;
  if (double(whole + (partial > 0 ? 1 : 0)) < all_rows)
    file.fail(bytes.size(), "pressure",
              "the end of the file after " + std::to_string(whole) + " rows",
              shown(all_rows) + " rows");
  const std::size_t rows = shade.map.planes() * n[4] * shade.rows();
  shade.pressure.resize(rows * n[6]);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t byte = record.byte(11 + i);
    const std::size_t there = std::min(row_bytes, bytes.size() - byte);
    std::memcpy(static_cast<void*>(&shade.pressure[i * n[6]]), bytes.data() + byte, there);
  }
  return shade;
}

std::string shade_file_bytes(const ShadeFile& shade) {
  const bool wide = shade.dialect == Dialect::wide;
  const MapPlaces& map = shade.map;
  const std::size_t words_of_place = wide ? 2 : 1;
  const std::size_t words =
      std::max({std::size_t(41), shade.source_depths.size(), shade.receiver_depths.size(),
                2 * shade.receiver_ranges.size(), words_of_place * map.azimuths_deg.size(),
                words_of_place * map.source_x.size(), words_of_place * map.source_y.size()});
  const std::size_t length = 4 * words, n_ranges = shade.receiver_ranges.size();
  const std::size_t rows = map.planes() * shade.source_depths.size() * shade.rows();

  std::string bytes;
  bytes.reserve(length * (10 + rows));
  put(bytes, static_cast<std::int32_t>(words));
  std::string title(cut_to_bytes(shade.title, 80));
  title.resize(80, ' ');
  bytes += title;
  put_record(bytes, 2, length, shade.irregular ? "irregular " : "rectilin  ");

  std::string sizes;
  for (const std::size_t n :
       {std::size_t(1), map.azimuths_deg.size(), map.source_x.size(), map.source_y.size(),
        shade.source_depths.size(), shade.receiver_depths.size(), n_ranges})
    put(sizes, static_cast<std::int32_t>(n));
  if (wide) {
    put(sizes, shade.frequency);
    put(sizes, 0.0);
  } else {
    put(sizes, static_cast<float>(shade.frequency));
    put(sizes, 0.0F);
  }
  put_record(bytes, 3, length, sizes);
  std::string frequency;
  put(frequency, shade.frequency);
  put_record(bytes, 4, length, frequency);
  const auto put_places = [&](std::size_t k, const std::vector<double>& x) {
    put_record(bytes, k, length, wide ? vector_bytes<double>(x) : vector_bytes<float>(x));
  };
  put_places(5, map.azimuths_deg);
  put_places(6, map.source_x);
  put_places(7, map.source_y);
  put_record(bytes, 8, length, vector_bytes<float>(shade.source_depths));
  put_record(bytes, 9, length, vector_bytes<float>(shade.receiver_depths));
  put_record(bytes, 10, length,
             wide ? vector_bytes<double>(shade.receiver_ranges)
                  : vector_bytes<float>(shade.receiver_ranges));
  for (std::size_t i = 0; i < rows; ++i) {
    bytes.resize(length * (10 + i), '\0');
    bytes.append(reinterpret_cast<const char*>(&shade.pressure[i * n_ranges]), 8 * n_ranges);
  }
  bytes.resize(length * (10 + rows), '\0');
  return bytes;
}

ShadeFile read_shade_file(const std::filesystem::path& path) {
  return parse_shade_file(read_input(path, "a pressure field (.shd)"), path.string());
}

void write_shade_file(const std::filesystem::path& path, const ShadeFile& file) {
  write_shade_file(OutputFile(path, {.own = own::shade_file}), file);
}

void write_shade_file(OutputFile&& output, const ShadeFile& file) {
  require_finite(file.pressure);
  output.write(shade_file_bytes(file));
}

}  // namespace asdic::detail::bellhop
