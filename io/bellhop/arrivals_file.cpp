// Arrivals of bellhop_files.h: .arr, ASCII or binary.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/binary.h"
#include "io/bellhop/fortran_format.h"
#include "io/bellhop/list_reader.h"
#include "io/bellhop/number_stream.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::bellhop {

namespace {

/// Clockwise from the line to the receiver, of an azimuth counter-clockwise from x; within ±180°.
double deflection(double receiver_deg, double azimuth_deg) noexcept {
  return std::remainder(receiver_deg - azimuth_deg, 360.0);
}
double azimuth(double receiver_deg, double deflection_deg) noexcept {
  return receiver_deg - deflection_deg;
}

/// Where the items of an arrivals file come from, one after another.
class AsciiSource {
 public:
  AsciiSource(std::string_view bytes, const std::string& name) : text_(bytes, name) {}

  /// \return 2 or 3
  int dimension() {
    const std::string_view word = text_.word(), plain = unquoted(word);
    if (plain != "2D" && plain != "3D") text_.fail("dimension", shown(word), "'2D' or '3D'");
    wide_ = word == plain;  // bare: the C++ port
    return plain == "3D" ? 3 : 2;
  }
  double frequency() { return text_.real("frequency"); }
  std::vector<double> vector(const char* item) {
    const std::int64_t n = text_.integer(item, 1, most_of_a_count);
    std::vector<double> x;
    for (std::int64_t i = 0; i < n; ++i) x.push_back(single(item));
    return x;
  }
  std::int64_t count(const char* item) { return text_.integer(item, 0, most_of_a_count); }
  /// \param azimuth_deg  of the receiver, where the rows tell azimuths
  ArrivalRow row(const std::optional<double>& azimuth_deg) {
    ArrivalRow a;
    a.amplitude = single("amplitude");
    a.phase_deg = single("phase");
    a.delay = single("delay");
    a.delay_imaginary = single("imaginary delay");
    a.launch_angle_deg = single("launch angle");
    if (azimuth_deg) a.launch_deflection_deg = deflection(*azimuth_deg, single("launch azimuth"));
    a.arrival_angle_deg = single("arrival angle");
    if (azimuth_deg) a.arrival_deflection_deg = deflection(*azimuth_deg, single("arrival azimuth"));
    a.surface_bounces = int(text_.integer("surface bounces", 0, most_of_a_count));
    a.bottom_bounces = int(text_.integer("bottom bounces", 0, most_of_a_count));
    return a;
  }
  bool at_end() { return text_.at_end(); }
  [[nodiscard]] std::size_t size() const noexcept { return text_.bytes_left(); }
  [[nodiscard]] Dialect dialect() const noexcept {
    return wide_ ? Dialect::wide : Dialect::fortran;
  }
  [[noreturn]] void fail(const char* item, const std::string& got, const std::string& expected) {
    text_.fail(item, got, expected);
  }

 private:
  /// A number that single precision holds, as all but the frequency are.
  double single(const char* item) {
    const double value = text_.real(item);
    if (!(std::abs(value) <= double(std::numeric_limits<float>::max())))
      text_.fail(item, shown(value), "a number that single precision holds");
    return value;
  }

  NumberStream text_;
  bool wide_ = false;
};

/// Fortran's sequential records: a length in bytes, the content, the length again.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, const std::string& name) : file_(bytes, name) {}

  int dimension() {
    const std::string_view word = record("dimension");
    if (word.find("3D") != std::string_view::npos) return 3;
    if (word.find("2D") == std::string_view::npos)
      fail("dimension", shown(word), "\"'2D'\" or \"'3D'\"");
    return 2;
  }
  double frequency() {
    const std::string_view content = record("frequency");
    wide_ = content.size() == 8;
    return number(content, 0, wide_, "frequency");
  }
  std::vector<double> vector(const char* item) {
    const std::string_view content = record(item);
    const std::int64_t n = whole(content, item);
    const bool broad = content.size() == 4 + 8 * std::size_t(n);
    if (n < 1 || (!broad && content.size() != 4 + 4 * std::size_t(n)))
      fail(item,
           std::to_string(n) + " numbers in a record of " + std::to_string(content.size()) +
               " bytes",
           "a number above 0 and as many values of 4 or 8 bytes");
    std::vector<double> x;
    for (std::size_t i = 0; i < std::size_t(n); ++i)
      x.push_back(number(content, 4 + i * (broad ? 8 : 4), broad, item));
    return x;
  }
  std::int64_t count(const char* item) {
    const std::int64_t n = whole(record(item), item);
    if (n < 0) fail(item, std::to_string(n), "a whole number of at least 0");
    return n;
  }
  ArrivalRow row(const std::optional<double>& azimuth_deg) {
    const std::string_view content = record("arrival");
    const std::size_t numbers = azimuth_deg ? 10 : 8;
    if (content.size() != 4 * numbers)
      fail("arrival", "a record of " + std::to_string(content.size()) + " bytes",
           std::to_string(numbers) + " numbers of 4 bytes");
    double y[10];
    for (std::size_t i = 0; i < numbers; ++i) y[i] = number(content, 4 * i, false, "arrival");
    const std::array<double, 8> x =
        azimuth_deg ? std::array{y[0], y[1], y[2], y[3], y[4], y[6], y[8], y[9]}
                    : std::array{y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7]};
    for (const double bounces : {x[6], x[7]})
      if (!(bounces >= 0.0 && bounces <= double(most_of_a_count)))
        fail("bounces", shown(bounces), "a number of at least 0");
    return {.amplitude = x[0],
            .phase_deg = x[1],
            .delay = x[2],
            .delay_imaginary = x[3],
            .launch_angle_deg = x[4],
            .arrival_angle_deg = x[5],
            .surface_bounces = int(std::lround(x[6])),
            .bottom_bounces = int(std::lround(x[7])),
            .launch_deflection_deg = azimuth_deg ? deflection(*azimuth_deg, y[5]) : 0.0,
            .arrival_deflection_deg = azimuth_deg ? deflection(*azimuth_deg, y[7]) : 0.0};
  }
  [[nodiscard]] bool at_end() const noexcept { return position_ == file_.size(); }
  [[nodiscard]] std::size_t size() const noexcept { return file_.size() - position_; }
  [[nodiscard]] Dialect dialect() const noexcept {
    return wide_ ? Dialect::wide : Dialect::fortran;
  }
  [[noreturn]] void fail(const char* item, const std::string& got, const std::string& expected) {
    file_.fail(record_, item, got, expected);
  }

 private:
  std::string_view record(const char* item) {
    record_ = position_;
    const auto length = file_.at<std::int32_t>(position_, item);
    if (length < 0) fail(item, "a record of " + std::to_string(length) + " bytes", "0 or more");
    const std::string_view content = file_.view(position_ + 4, std::size_t(length), item);
    if (file_.at<std::int32_t>(position_ + 4 + content.size(), item) != length)
      fail(item, "different lengths before and after the record", "the same");
    position_ += content.size() + 8;
    return content;
  }
  std::int64_t whole(std::string_view content, const char* item) {
    if (content.size() < 4)
      fail(item, "a record of " + std::to_string(content.size()) + " bytes", "4 bytes or more");
    std::int32_t n = 0;
    std::memcpy(&n, content.data(), 4);
    return n;
  }
  double number(std::string_view content, std::size_t byte, bool broad, const char* item) {
    double value = 0.0;
    if (content.size() < byte + (broad ? 8 : 4))
      fail(item, "a record of " + std::to_string(content.size()) + " bytes", "4 or 8 bytes");
    if (broad) {
      std::memcpy(&value, content.data() + byte, 8);
    } else {
      float narrow = 0.0F;
      std::memcpy(&narrow, content.data() + byte, 4);
      value = double(narrow);
    }
    if (!(std::abs(value) <= double(std::numeric_limits<float>::max())))
      fail(item, shown(value), "a number that single precision holds");
    return value;
  }

  BinaryView file_;
  std::size_t position_ = 0, record_ = 0;
  bool wide_ = false;
};

/// Where the receivers of one source stand in ArrivalsFile::arrivals, in the order of the file:
/// azimuth slowest, range fastest. \param source  x slowest, depth fastest
std::vector<std::size_t> receivers_of(const ArrivalsFile& file, std::size_t source) {
  const std::size_t depths = file.source_depths.size(), azimuths = file.map.azimuths_deg.size();
  const std::size_t here = file.rows() * file.receiver_ranges.size();
  std::vector<std::size_t> places;
  for (std::size_t a = 0; a < azimuths; ++a) {
    const std::size_t plane = source / depths * azimuths + a;
    for (std::size_t i = 0; i < here; ++i)
      places.push_back((plane * depths + source % depths) * here + i);
  }
  return places;
}

std::size_t sources_of(const ArrivalsFile& file) {
  return file.map.source_x.size() * file.map.source_y.size() * file.source_depths.size();
}

/// Of the receiver at a place of receivers_of(); none in a file without azimuths.
std::optional<double> azimuth_at(const ArrivalsFile& file, std::size_t i) {
  if (!file.three_dimensional) return std::nullopt;
  return file.map.azimuths_deg[i / (file.rows() * file.receiver_ranges.size())];
}

/// In a layout of three dimensions that no document tells, an azimuth may stand where a declination
/// is looked for.
template <class Source>
void check_declinations(Source& source, const ArrivalRow& a) {
  for (const auto& [item, angle] :
       {std::pair{"launch angle", a.launch_angle_deg}, {"arrival angle", a.arrival_angle_deg}})
    if (!(std::abs(angle) <= 180.0))
      source.fail(item, shown(angle) + " degrees", "a declination from -180 to 180 degrees");
}

/// Nothing in the file says whether the grid is irregular: one row then instead of one a depth.
template <class Source>
ArrivalsFile parse(Source source, bool binary, bool irregular) {
  ArrivalsFile file{.binary = binary, .irregular = irregular};
  file.three_dimensional = source.dimension() == 3;
  file.frequency = source.frequency();
  if (!(file.frequency > 0.0))
    source.fail("frequency", shown(file.frequency) + " Hz", "a frequency above 0 Hz");
  if (file.three_dimensional) {
    file.map.source_x = source.vector("source x");
    file.map.source_y = source.vector("source y");
  }
  file.source_depths = source.vector("source depths");
  file.receiver_depths = source.vector("receiver depths");
  file.receiver_ranges = source.vector("receiver ranges");
  if (file.three_dimensional) file.map.azimuths_deg = source.vector("receiver bearings");
  file.dialect = source.dialect();
  // every receiver takes two bytes at least: what a damaged count asks for is not taken at once
  const double receivers = double(file.map.planes()) * double(file.source_depths.size()) *
                           double(file.rows()) * double(file.receiver_ranges.size());
  if (file.three_dimensional) {
    if (receivers > double(source.size()))
      source.fail("receivers", shown(receivers), "as many as the file can hold");
    file.arrivals.resize(std::size_t(receivers));
  }
  for (std::size_t s = 0; s < sources_of(file); ++s) {
    const std::int64_t largest = source.count("largest number of arrivals");
    if (!file.three_dimensional) {
      for (std::size_t i = 0; i < file.rows(); ++i)
        for (std::size_t j = 0; j < file.receiver_ranges.size(); ++j) {
          const std::int64_t n = source.count("number of arrivals");
          std::vector<ArrivalRow>& rows_here = file.arrivals.emplace_back();
          for (std::int64_t k = 0; k < n; ++k) rows_here.push_back(source.row(std::nullopt));
        }
      continue;
    }
    const std::vector<std::size_t> places = receivers_of(file, s);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int64_t n = source.count("number of arrivals");
      if (n > largest)
        source.fail("number of arrivals", std::to_string(n),
                    "at most " + std::to_string(largest) +
                        ", the largest number that stands before its source's receivers");
      std::vector<ArrivalRow>& rows_here = file.arrivals[places[i]];
      for (std::int64_t k = 0; k < n; ++k) {
        rows_here.push_back(source.row(azimuth_at(file, i)));
        check_declinations(source, rows_here.back());
      }
    }
  }
  if (!source.at_end())
    source.fail("end", "something after the arrivals of the last receiver", "nothing");
  return file;
}

template <class Source>
ArrivalsFile parse_either(std::string_view bytes, const std::string& name, bool binary) {
  try {
    return parse(Source(bytes, name), binary, false);
  } catch (const InputError& error) {
    try {
      ArrivalsFile irregular = parse(Source(bytes, name), binary, true);
      if (irregular.receiver_depths.size() == irregular.receiver_ranges.size()) return irregular;
    } catch (const InputError&) {
      // what was wrong with the grid is what is told
    }
    throw error;
  }
}

}  // namespace

ArrivalsFile parse_arrivals_file(std::string_view bytes, const std::string& name) {
  // a binary one begins with the length of its first record
  const bool binary = bytes.substr(0, 4) == std::string_view("\4\0\0\0", 4);
  return binary ? parse_either<BinarySource>(bytes, name, true)
                : parse_either<AsciiSource>(bytes, name, false);
}

ArrivalsFile read_arrivals_file(const std::filesystem::path& path) {
  return parse_arrivals_file(read_input(path, "arrivals (.arr)"), path.string());
}

namespace {

std::int64_t largest(const ArrivalsFile& file, const std::vector<std::size_t>& places) {
  std::size_t n = 0;
  for (const std::size_t place : places) n = std::max(n, file.arrivals[place].size());
  return std::int64_t(n);
}

/// Declination at the source and at the receiver, each with its azimuth where the receiver has one.
std::vector<double> angles(const ArrivalRow& a, const std::optional<double>& azimuth_deg) {
  if (!azimuth_deg) return {a.launch_angle_deg, a.arrival_angle_deg};
  return {a.launch_angle_deg, azimuth(*azimuth_deg, a.launch_deflection_deg), a.arrival_angle_deg,
          azimuth(*azimuth_deg, a.arrival_deflection_deg)};
}

std::string ascii_bytes(const ArrivalsFile& file) {
  const bool wide_ranges = file.dialect == Dialect::wide;
  const bool map = file.three_dimensional;
  std::string text = wide_ranges ? (map ? "3D\n" : "2D\n") : (map ? " '3D'\n" : " '2D'\n");
  append_real8(text, file.frequency);
  text += '\n';
  const auto append_vector = [&](const std::vector<double>& x, bool wide) {
    append_integer(text, std::int64_t(x.size()));
    for (const double value : x)
      wide ? append_real8(text, value) : append_real4(text, static_cast<float>(value));
    text += '\n';
  };
  if (map) {
    append_vector(file.map.source_x, wide_ranges);
    append_vector(file.map.source_y, wide_ranges);
  }
  append_vector(file.source_depths, false);
  append_vector(file.receiver_depths, false);
  append_vector(file.receiver_ranges, wide_ranges);
  if (map) append_vector(file.map.azimuths_deg, wide_ranges);
  for (std::size_t s = 0; s < sources_of(file); ++s) {
    const std::vector<std::size_t> places = receivers_of(file, s);
    append_integer(text, largest(file, places));
    text += '\n';
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& rows = file.arrivals[places[i]];
      append_integer(text, std::int64_t(rows.size()));
      text += '\n';
      for (const ArrivalRow& a : rows) {
        for (const double value : {a.amplitude, a.phase_deg, a.delay, a.delay_imaginary})
          append_real4(text, static_cast<float>(value));
        for (const double value : angles(a, azimuth_at(file, i)))
          append_real4(text, static_cast<float>(value));
        append_integer(text, a.surface_bounces);
        append_integer(text, a.bottom_bounces);
        text += '\n';
      }
    }
  }
  return text;
}

std::string binary_bytes(const ArrivalsFile& file) {
  std::string bytes;
  const bool wide = file.dialect == Dialect::wide;
  const auto put_record = [&](std::string_view content) {
    put(bytes, static_cast<std::int32_t>(content.size()));
    bytes.append(content);
    put(bytes, static_cast<std::int32_t>(content.size()));
  };
  const auto put_count = [&](std::int64_t n) {
    std::string content;
    put(content, static_cast<std::int32_t>(n));
    put_record(content);
  };
  const auto put_real = [](std::string& content, double value, bool broad) {
    broad ? put(content, value) : put(content, static_cast<float>(value));
  };
  const auto put_vector = [&](const std::vector<double>& x, bool broad) {
    std::string content;
    put(content, static_cast<std::int32_t>(x.size()));
    for (const double value : x) put_real(content, value, broad);
    put_record(content);
  };
  put_record(file.three_dimensional ? "'3D'" : "'2D'");
  std::string frequency;
  put_real(frequency, file.frequency, wide);
  put_record(frequency);
  if (file.three_dimensional) {
    put_vector(file.map.source_x, wide);
    put_vector(file.map.source_y, wide);
  }
  put_vector(file.source_depths, false);
  put_vector(file.receiver_depths, false);
  put_vector(file.receiver_ranges, wide);
  if (file.three_dimensional) put_vector(file.map.azimuths_deg, wide);
  for (std::size_t s = 0; s < sources_of(file); ++s) {
    const std::vector<std::size_t> places = receivers_of(file, s);
    put_count(largest(file, places));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& rows = file.arrivals[places[i]];
      put_count(std::int64_t(rows.size()));
      for (const ArrivalRow& a : rows) {
        std::string content;
        for (const double value : {a.amplitude, a.phase_deg, a.delay, a.delay_imaginary})
          put_real(content, value, false);
        for (const double value : angles(a, azimuth_at(file, i))) put_real(content, value, false);
        for (const int bounces : {a.surface_bounces, a.bottom_bounces})
          put_real(content, double(bounces), false);
        put_record(content);
      }
    }
  }
  return bytes;
}

}  // namespace

std::string arrivals_file_bytes(const ArrivalsFile& file) {
  return file.binary ? binary_bytes(file) : ascii_bytes(file);
}

void write_arrivals_file(const std::filesystem::path& path, const ArrivalsFile& file) {
  write_arrivals_file(OutputFile(path, {.own = own::arrivals_file}), file);
}

void write_arrivals_file(OutputFile&& output, const ArrivalsFile& file) {
  output.write(arrivals_file_bytes(file));
}

}  // namespace asdic::detail::bellhop
