#include "app/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/printable.h"

namespace asdic::detail::app {
namespace {

constexpr std::string_view bold = "\x1b[1m", plain = "\x1b[0m";

RunError cannot_write() {
  return RunError(std::string("standard output: ") + std::strerror(errno));
}

constexpr std::size_t usual_width = 80, least_width = 20;

/// What the variable COLUMNS says.
std::optional<std::size_t> columns_told() {
  const char* const text = std::getenv("COLUMNS");
  if (text == nullptr) return std::nullopt;
  std::size_t value = 0;
  const char* const end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, value);
  if (error != std::errc{} || rest != end || value == 0) return std::nullopt;
  return value;
}

std::optional<std::size_t> columns_of_terminal(int stream) {
  winsize size{};
  if (ioctl(stream, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return std::nullopt;
  return size.ws_col;
}

/// The line of progress that stands on standard error.
std::mutex standing_mutex;
bool standing = false;

}  // namespace

bool stdout_is_terminal() noexcept { return isatty(STDOUT_FILENO) == 1; }
bool stderr_is_terminal() noexcept { return isatty(STDERR_FILENO) == 1; }

std::size_t terminal_width(int stream) {
  auto width = columns_of_terminal(stream);
  if (!width) width = columns_told();
  return std::max(width.value_or(usual_width), least_width);
}

std::size_t help_width() {
  return std::max(columns_told().value_or(terminal_width(STDOUT_FILENO)), least_width);
}

std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string cut_to(std::string_view text, std::size_t columns) {
  if (columns_of(text) <= columns) return std::string(text);
  std::size_t end = 0;
  for (std::size_t seen = 0; end < text.size(); ++end)
    if ((static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U && seen++ == columns - 1) break;
  return std::string(text.substr(0, end)) + "…";
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent,
                    std::string_view mark) {
  std::string all;
  std::string line(text.substr(0, std::min(text.find_first_not_of(' '), text.size())));
  bool empty = true;  // no word is in the line
  for (std::size_t at = line.size(); at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    // more than one space between words stays, unless a line ends there
    const std::size_t next = std::min(text.find_first_not_of(' ', end), text.size());
    const std::string_view word = text.substr(at, end - at);
    const std::size_t room = width - (next < text.size() ? columns_of(mark) : 0);
    if (!empty && columns_of(line) + columns_of(word) > room) {
      line.erase(line.find_last_not_of(' ') + 1);
      all += line + std::string(mark) + '\n';
      line.assign(indent, ' ');
    }
    line += word;
    line.append(text.substr(end, next - end));
    empty = false;
    at = next;
  }
  return all + line + '\n';
}

void tell(const std::string& line) {
  const std::lock_guard lock(standing_mutex);
  std::fputs(((standing ? "\r\x1b[K" : "") + line + '\n').c_str(), stderr);
  std::fflush(stderr);
  standing = false;
}

void draw_progress(const std::string& line) {
  const std::lock_guard lock(standing_mutex);
  if (line.empty() && !standing) return;
  std::fputs(("\r\x1b[K" + line).c_str(), stderr);
  std::fflush(stderr);
  standing = !line.empty();
}

void write_output(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size()) throw cannot_write();
}

void print(std::string_view text) {
  while (!text.empty()) {
    const auto end = std::min(text.find(bold), text.find(plain));
    write_output(printable_lines(text.substr(0, end)));
    if (end == std::string_view::npos) return;
    const std::string_view style = text.substr(end).starts_with(bold) ? bold : plain;
    write_output(style);
    text.remove_prefix(end + style.size());
  }
}

void flush_output() {
  if (std::fflush(stdout) != 0) throw cannot_write();
}

std::string emphasised(std::string_view text) {
  const char* no_colour = std::getenv("NO_COLOR");
  if (!stdout_is_terminal() || (no_colour != nullptr && *no_colour != '\0'))
    return std::string(text);
  return fmt::format("{}{}{}", bold, text, plain);
}

void Table::row(std::vector<std::string> cells) {
  assert(cells.size() == columns_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> widths;
  bool units = false;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t widest = std::max(columns_of(columns_[i].name), columns_of(columns_[i].unit));
    for (const auto& row : rows_) widest = std::max(widest, columns_of(row[i]));
    widths.push_back(widest);
    units = units || !columns_[i].unit.empty();
  }
  const auto line = [&](const auto& cell) {
    std::string result;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& content = cell(i);
      const std::string space(widths[i] - columns_of(content), ' ');
      if (i > 0) result += "  ";
      result += columns_[i].left ? content + space : space + content;
    }
    result.erase(result.find_last_not_of(' ') + 1);
    return result;
  };
  std::string result =
      emphasised(line([&](std::size_t i) -> const std::string& { return columns_[i].name; })) +
      '\n';
  if (units)
    result += line([&](std::size_t i) -> const std::string& { return columns_[i].unit; }) + '\n';
  for (const auto& row : rows_)
    result += line([&](std::size_t i) -> const std::string& { return row[i]; }) + '\n';
  return result;
}

std::string number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos)
    text.erase(0, 1);  // no minus zero
  return text;
}

std::string duration(double seconds) {
  if (seconds >= 60.0) {
    const long whole = std::lround(seconds);
    return fmt::format("{} min {} s", whole / 60, whole % 60);
  }
  return seconds < 0.1 ? fmt::format("{:.4f} s", seconds) : fmt::format("{:.2f} s", seconds);
}

std::string byte_count(double bytes) { return bytes_text(bytes); }

}  // namespace asdic::detail::app
