#include <algorithm>

#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/binary.h"
#include "io/bellhop/fortran_format.h"
#include "io/output/own_files.h"

namespace asdic::bellhop {
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

}  // namespace asdic::bellhop
