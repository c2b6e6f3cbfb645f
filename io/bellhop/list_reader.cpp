#include "io/bellhop/list_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/utf8.h"

namespace asdic::detail::bellhop {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }

/// The `n` of `n*value`, and what is repeated.
std::optional<std::int64_t> repeat_count(std::string_view& token) noexcept {
  std::size_t digits = 0;
  while (digits < token.size() && is_digit(token[digits])) ++digits;
  if (digits == 0 || digits == token.size() || token[digits] != '*') return std::nullopt;
  std::int64_t n = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + digits, n);
  if (error != std::errc{} || n < 1) return std::nullopt;
  token.remove_prefix(digits + 1);
  return n;
}

}  // namespace

std::optional<double> fortran_number(std::string_view text) noexcept {
  char plain[64] = {};  // the same number as from_chars reads it: the exponent's letter is e
  std::size_t n = 0;
  bool mantissa = false, exponent = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (n + 2 >= sizeof plain) return std::nullopt;
    const char c = text[i];
    if (is_digit(c)) {
      mantissa = true;
      plain[n++] = c;
    } else if (c == '.' && !exponent) {
      plain[n++] = c;
    } else if ((c == '+' || c == '-') && i == 0) {
      if (c == '-') plain[n++] = c;
    } else if (mantissa && !exponent && std::string_view("eEdDqQ+-").find(c) < 8) {
      exponent = true;
      plain[n++] = 'e';
      if (c == '+' || c == '-') {
        if (c == '-') plain[n++] = c;
      } else if (i + 1 < text.size() && (text[i + 1] == '+' || text[i + 1] == '-')) {
        ++i;
        if (text[i] == '-') plain[n++] = '-';
      }
    } else {
      return std::nullopt;
    }
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain, plain + n, value);
  if (end != plain + n || n == 0) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool small = std::string_view(plain, n).find("e-") != std::string_view::npos;
    return small ? std::optional<double>(0.0) : std::nullopt;
  }
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : cut_to_bytes(text, longest))
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return result + (text.size() > longest ? "...\"" : "\"");
}

std::string shown(double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  return {digits, end};
}

ListReader::ListReader(std::string_view text, std::string file)
    : text_(text), file_(std::move(file)) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // UTF-8's byte order mark
}

std::string ListReader::where(std::string_view item) const {
  std::string result = file_ + ':' + std::to_string(item_line_) + ": " + field_;
  if (!item.empty()) result.append(": ").append(item);
  return result;
}

void ListReader::fail(std::string_view item, std::string got, std::string expected) const {
  throw InputError({.where = where(item), .got = std::move(got), .expected = std::move(expected)});
}

void ListReader::begin(std::string field) {
  field_ = std::move(field);
  closed_ = false;
  separated_ = true;
  repeats_ = 0;
  item_line_ = line_;
}

void ListReader::end() {
  while (more() && text_[position_] != '\n') ++position_;
  if (more()) {
    ++position_;
    ++line_;
  }
}

std::string ListReader::number_left() const {
  if (repeats_ > 0) return repeated_ ? repeated_->text : "";
  if (closed_) return "";
  std::size_t i = position_;
  const auto skip = [&] {
    while (i < text_.size() && is_blank(text_[i])) ++i;
  };
  skip();
  if (!separated_ && i < text_.size() && text_[i] == ',') ++i;
  skip();
  const std::size_t start = i;
  while (i < text_.size() && !is_blank(text_[i]) && text_[i] != '\n' && text_[i] != ',' &&
         text_[i] != '/')
    ++i;
  std::string_view token = text_.substr(start, i - start);
  (void)repeat_count(token);
  return fortran_number(token) ? std::string(token) : "";
}

void ListReader::skip_blanks(bool lines) {
  for (; more() && (is_blank(text_[position_]) || (lines && text_[position_] == '\n')); ++position_)
    if (text_[position_] == '\n') ++line_;
}

bool ListReader::at_end() const noexcept {
  return std::all_of(text_.begin() + std::ptrdiff_t(position_), text_.end(),
                     [](char c) { return is_blank(c) || c == '\n'; });
}

ListReader::Item ListReader::quoted(std::string_view item) {
  const char quote = text_[position_++];
  Item result{.text = {}, .quoted = true};
  for (; more(); ++position_) {
    const char c = text_[position_];
    if (c == quote) {
      ++position_;
      if (!more() || text_[position_] != quote) return result;
      result.text += quote;  // doubled
    } else if (c == '\n') {
      ++line_;  // goes on in the next line
    } else if (c != '\r') {
      result.text += c;
    }
  }
  fail(item, "a quote that is never closed", std::string("a closing ") + quote);
}

std::optional<ListReader::Item> ListReader::next(std::string_view item, std::string_view expected) {
  if (closed_) return std::nullopt;
  if (repeats_ > 0) {
    --repeats_;
    return repeated_;
  }
  skip_blanks(true);
  if (!separated_ && more() && text_[position_] == ',') {
    ++position_;
    skip_blanks(true);
  }
  item_line_ = line_;
  if (!more()) fail(item, "the end of the file", std::string(expected));
  separated_ = false;
  const char first = text_[position_];
  if (first == ',') return std::nullopt;  // it parts this one, left out, from the next
  if (first == '/') {
    closed_ = true;
    return std::nullopt;
  }
  if (first == '\'' || first == '"') return quoted(item);

  const auto ends = [](char c) { return is_blank(c) || c == '\n' || c == ',' || c == '/'; };
  const std::size_t start = position_;
  while (more() && !ends(text_[position_]) && text_[position_] != '\'' && text_[position_] != '"')
    ++position_;
  std::string_view token = text_.substr(start, position_ - start);
  const auto n = repeat_count(token);
  if (n && token.empty() && more() && !ends(text_[position_])) {  // 3*'text'
    repeated_ = quoted(item);
    repeats_ = *n - 1;
    return repeated_;
  }
  while (more() && !ends(text_[position_])) ++position_;  // a quote within a word is part of it
  token = text_.substr(start, position_ - start);
  if (n) {
    (void)repeat_count(token);
    repeated_ = token.empty() ? std::nullopt : std::optional<Item>({std::string(token), false});
    repeats_ = *n - 1;
    return repeated_;
  }
  return Item{std::string(token), false};
}

bool ListReader::real(double& value, std::string_view item) {
  const auto found = next(item, "a number");
  if (!found) return false;
  const auto number = found->quoted ? std::nullopt : fortran_number(found->text);
  if (!number) fail(item, shown(found->text), "a number");
  if (!(std::abs(*number) < 1e30)) fail(item, shown(found->text), "a number below 1e30");
  value = *number;
  return true;
}

bool ListReader::integer(std::int64_t& value, std::string_view item) {
  const auto found = next(item, "a whole number");
  if (!found) return false;
  const auto number = found->quoted ? std::nullopt : fortran_number(found->text);
  if (!number || *number != std::trunc(*number) || std::abs(*number) > 9e15)
    fail(item, shown(found->text), "a whole number");
  value = static_cast<std::int64_t>(*number);
  return true;
}

bool ListReader::text(std::string& value, std::string_view item) {
  const auto found = next(item, "a text in quotes");
  if (!found) return false;
  value = found->text;
  return true;
}

double ListReader::need_real(std::string_view item) {
  double value = 0.0;
  if (!real(value, item)) fail(item, "no value", "a number");
  return value;
}

std::int64_t ListReader::need_integer(std::string_view item, std::int64_t least,
                                      std::int64_t most) {
  std::int64_t value = 0;
  const std::string range =
      "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  if (!integer(value, item)) fail(item, "no value", range);
  if (value < least || value > most) fail(item, std::to_string(value), range);
  return value;
}

}  // namespace asdic::detail::bellhop
