#include "io/bellhop/number_stream.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "io/bellhop/list_reader.h"

namespace asdic::detail::bellhop {
namespace {

bool parts(char c) noexcept { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ','; }

}  // namespace

// All repeats together may stand for this many numbers, lest a small file fill the memory.
NumberStream::NumberStream(std::string_view text, std::string file)
    : text_(text),
      file_(std::move(file)),
      most_repeats_(100'000 + static_cast<std::int64_t>(text.size())) {}

void NumberStream::fail(const char* item, std::string got, std::string expected) const {
  throw InputError({.where = file_ + ':' + std::to_string(line_) + ": " + item,
                    .got = std::move(got),
                    .expected = std::move(expected)});
}

void NumberStream::skip_blanks() noexcept {
  for (; position_ < text_.size() && parts(text_[position_]); ++position_)
    if (text_[position_] == '\n') ++line_;
}

std::string_view NumberStream::token() noexcept {
  skip_blanks();
  const std::size_t start = position_;
  while (position_ < text_.size() && !parts(text_[position_])) ++position_;
  return text_.substr(start, position_ - start);
}

bool NumberStream::at_end() {
  skip_blanks();
  return repeats_ == 0 && position_ == text_.size();
}

double NumberStream::real(const char* item) {
  if (repeats_ > 0) {
    --repeats_;
    return repeated_;
  }
  std::string_view word = token();
  if (word.empty()) fail(item, "the end of the file", "a number");
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc{} && end == word.data() + word.size() && std::isfinite(value))
    return value;

  const std::string_view whole = word;
  std::int64_t count = 1;
  if (const auto star = word.find('*'); star != std::string_view::npos) {
    const auto [stop, wrong] = std::from_chars(word.data(), word.data() + star, count);
    if (wrong != std::errc{} || stop != word.data() + star || count < 1 || count > most_repeats_)
      fail(item, shown(whole),
           "a number, repeated at most " + std::to_string(most_repeats_) + " times");
    word.remove_prefix(star + 1);
  }
  const auto number = fortran_number(word);
  if (!number) fail(item, shown(whole), "a number");
  repeated_ = *number;
  repeats_ = count - 1;
  most_repeats_ -= repeats_;
  return repeated_;
}

std::int64_t NumberStream::integer(const char* item, std::int64_t least, std::int64_t most) {
  const double value = real(item);
  if (!(value == std::trunc(value) && value >= double(least) && value <= double(most)))
    fail(item, shown(value),
         "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<std::int64_t>(value);
}

std::string_view unquoted(std::string_view word) noexcept {
  const auto quote = [](char c) { return c == '\'' || c == '"'; };
  while (!word.empty() && quote(word.front())) word.remove_prefix(1);
  while (!word.empty() && quote(word.back())) word.remove_suffix(1);
  return word;
}

std::string_view NumberStream::rest_of_line() {
  const std::size_t start = position_, end = std::min(text_.find('\n', start), text_.size());
  position_ = std::min(end + 1, text_.size());
  ++line_;
  return text_.substr(start, end - start);
}

}  // namespace asdic::detail::bellhop
