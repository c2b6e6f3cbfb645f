// Arrivals of bellhop_files.h: .arr, ASCII or binary.
#include <cmath>
#include <limits>

#include <algorithm>
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/binary.h"
#include "io/bellhop/fortran_format.h"
#include "io/bellhop/list_reader.h"
#include "io/bellhop/number_stream.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::bellhop {

namespace {

/// Where the items of an arrivals file come from, one after another.
class AsciiSource {
 public:
  AsciiSource(std::string_view bytes, const std::string& name) : text_(bytes, name) {}

  void dimension() {
    const std::string_view word = text_.word();
    if (unquoted(word) != "2D") text_.fail("dimension", shown(word), "'2D'");
    wide_ = word == "2D";  // bare: the C++ port
  }
  double frequency() { return text_.real("frequency"); }
  std::vector<double> vector(const char* item) {
    const std::int64_t n = text_.integer(item, 1, most_of_a_count);
    std::vector<double> x;
    for (std::int64_t i = 0; i < n; ++i) x.push_back(single(item));
    return x;
  }
  std::int64_t count(const char* item) { return text_.integer(item, 0, most_of_a_count); }
  ArrivalRow row() {
    ArrivalRow a;
    a.amplitude = single("amplitude");
    a.phase_deg = single("phase");
    a.delay = single("delay");
    a.delay_imaginary = single("imaginary delay");
    a.launch_angle_deg = single("launch angle");
    a.arrival_angle_deg = single("arrival angle");
    a.surface_bounces = int(text_.integer("surface bounces", 0, most_of_a_count));
    a.bottom_bounces = int(text_.integer("bottom bounces", 0, most_of_a_count));
    return a;
  }
  bool at_end() { return text_.at_end(); }
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

  void dimension() {
    const std::string_view word = record("dimension");
    if (word.find("2D") == std::string_view::npos) fail("dimension", shown(word), "\"'2D'\"");
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
  ArrivalRow row() {
    const std::string_view content = record("arrival");
    if (content.size() != 32)
      fail("arrival", "a record of " + std::to_string(content.size()) + " bytes",
           "8 numbers of 4 bytes");
    double x[8];
    for (std::size_t i = 0; i < 8; ++i) x[i] = number(content, 4 * i, false, "arrival");
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
            .bottom_bounces = int(std::lround(x[7]))};
  }
  [[nodiscard]] bool at_end() const noexcept { return position_ == file_.size(); }
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

/// Nothing in the file says whether the grid is irregular: one row then instead of one a depth.
template <class Source>
ArrivalsFile parse(Source source, bool binary, bool irregular) {
  ArrivalsFile file{.binary = binary, .irregular = irregular};
  source.dimension();
  file.frequency = source.frequency();
  if (!(file.frequency > 0.0))
    source.fail("frequency", shown(file.frequency) + " Hz", "a frequency above 0 Hz");
  file.source_depths = source.vector("source depths");
  file.receiver_depths = source.vector("receiver depths");
  file.receiver_ranges = source.vector("receiver ranges");
  file.dialect = source.dialect();
  const std::size_t rows = irregular ? 1 : file.receiver_depths.size();
  for (std::size_t s = 0; s < file.source_depths.size(); ++s) {
    (void)source.count("largest number of arrivals");
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < file.receiver_ranges.size(); ++j) {
        const std::int64_t n = source.count("number of arrivals");
        std::vector<ArrivalRow>& rows_here = file.arrivals.emplace_back();
        for (std::int64_t k = 0; k < n; ++k) rows_here.push_back(source.row());
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

std::int64_t largest(const ArrivalsFile& file, std::size_t source, std::size_t receivers) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < receivers; ++i)
    n = std::max(n, file.arrivals[source * receivers + i].size());
  return std::int64_t(n);
}

std::string ascii_bytes(const ArrivalsFile& file) {
  const bool wide_ranges = file.dialect == Dialect::wide;
  std::string text = wide_ranges ? "2D\n" : " '2D'\n";
  append_real8(text, file.frequency);
  text += '\n';
  const auto append_vector = [&](const std::vector<double>& x, bool wide) {
    append_integer(text, std::int64_t(x.size()));
    for (const double value : x)
      wide ? append_real8(text, value) : append_real4(text, static_cast<float>(value));
    text += '\n';
  };
  append_vector(file.source_depths, false);
  append_vector(file.receiver_depths, false);
  append_vector(file.receiver_ranges, wide_ranges);
  const std::size_t receivers = file.arrivals.size() / file.source_depths.size();
  for (std::size_t s = 0; s < file.source_depths.size(); ++s) {
    append_integer(text, largest(file, s, receivers));
    text += '\n';
    for (std::size_t i = 0; i < receivers; ++i) {
      const auto& rows = file.arrivals[s * receivers + i];
      append_integer(text, std::int64_t(rows.size()));
      text += '\n';
      for (const ArrivalRow& a : rows) {
        for (const double value : {a.amplitude, a.phase_deg, a.delay, a.delay_imaginary,
                                   a.launch_angle_deg, a.arrival_angle_deg})
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
  put_record("'2D'");
  std::string frequency;
  put_real(frequency, file.frequency, wide);
  put_record(frequency);
  put_vector(file.source_depths, false);
  put_vector(file.receiver_depths, false);
  put_vector(file.receiver_ranges, wide);
  const std::size_t receivers = file.arrivals.size() / file.source_depths.size();
  for (std::size_t s = 0; s < file.source_depths.size(); ++s) {
    put_count(largest(file, s, receivers));
    for (std::size_t i = 0; i < receivers; ++i) {
      const auto& rows = file.arrivals[s * receivers + i];
      put_count(std::int64_t(rows.size()));
      for (const ArrivalRow& a : rows) {
        std::string content;
        for (const double value :
             {a.amplitude, a.phase_deg, a.delay, a.delay_imaginary, a.launch_angle_deg,
              a.arrival_angle_deg, double(a.surface_bounces), double(a.bottom_bounces)})
          put_real(content, value, false);
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
