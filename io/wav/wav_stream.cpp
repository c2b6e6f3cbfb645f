#include "io/wav/wav_stream.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace asdic::detail {
namespace {

template <class T>
void append(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

constexpr std::uint32_t without_end = 0xffffffff;

}  // namespace

WavStream::WavStream(int file, std::string name, const Form& form)
    : file_(file), name_(std::move(name)), form_(form) {
  const std::string begin = header(without_end);
  write(begin.data(), begin.size());
}

/// RIFF: the form, who wrote it (as libsndfile says it), and the samples.
std::string WavStream::header(std::uint32_t data) const {
  const bool real = form_.sample == Sample::float32;
  const auto bytes = static_cast<std::uint16_t>(real ? 4 : 2);
  const auto rate = static_cast<std::uint32_t>(std::lround(form_.sample_rate));
  std::string chunks = "WAVEfmt ";
  append(chunks, std::uint32_t{16});
  append(chunks, static_cast<std::uint16_t>(real ? 3 : 1));
  append(chunks, std::uint16_t{1});
  append(chunks, rate);
  append(chunks, static_cast<std::uint32_t>(rate * bytes));
  append(chunks, bytes);
  append(chunks, static_cast<std::uint16_t>(8 * bytes));
  if (real) {
    chunks += "fact";
    append(chunks, std::uint32_t{4});
    append(chunks, data == without_end ? without_end : data / bytes);
  }
  chunks += "LIST";
  append(chunks, std::uint32_t{18});
  chunks += "INFOISFT";
  append(chunks, std::uint32_t{6});
  chunks.append("asdic\0", 6);
  chunks += "data";
  append(chunks, data);
  std::string all = "RIFF";
  append(all, data == without_end ? without_end : static_cast<std::uint32_t>(chunks.size() + data));
  return all + chunks;
}

void WavStream::put(std::span<const float> pressure) {
  const bool real = form_.sample == Sample::float32;
  bytes_.clear();
  for (const float p : pressure) {
    const double value = static_cast<double>(p) / form_.full_scale;
    if (std::abs(value) > 1.0) ++clipped_;
    const auto store = [&](auto number) {
      const auto* const first = reinterpret_cast<const char*>(&number);
      bytes_.insert(bytes_.end(), first, first + sizeof number);
    };
    if (real)
      store(static_cast<float>(value));
    else
      store(static_cast<std::int16_t>(std::lround(32767.0 * std::clamp(value, -1.0, 1.0))));
  }
  write(bytes_.data(), bytes_.size());
  samples_ += pressure.size();
}

void WavStream::write(const void* bytes, std::size_t count) {
  const char* at = static_cast<const char*>(bytes);
  while (count > 0 && !closed_) {
    const ssize_t n = ::write(file_, at, count);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EPIPE) {
      closed_ = true;
      return;
    }
    if (n < 0) throw RunError(name_ + ": cannot be written: " + std::strerror(errno));
    at += n;
    count -= static_cast<std::size_t>(n);
  }
}

void WavStream::finish() {
  const std::uint64_t data = samples_ * (form_.sample == Sample::float32 ? 4U : 2U);
  if (data > std::numeric_limits<std::uint32_t>::max() - 1024 || ::lseek(file_, 0, SEEK_SET) != 0)
    return;  // a pipe, or longer than a WAV file can say
  const std::string begin = header(static_cast<std::uint32_t>(data));
  write(begin.data(), begin.size());
}

}  // namespace asdic::detail
