#include "app/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/printable.h"

namespace asdic::detail::app {
namespace {

/// How many columns UTF-8 text takes: one a code point, which is right for all that we print.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

constexpr std::string_view bold = "\x1b[1m", plain = "\x1b[0m";

RunError cannot_write() {
  return RunError(std::string("standard output: ") + std::strerror(errno));
}

}  // namespace

bool stdout_is_terminal() noexcept { return isatty(STDOUT_FILENO) == 1; }
bool stderr_is_terminal() noexcept { return isatty(STDERR_FILENO) == 1; }

void print(std::string_view text) {
  while (!text.empty()) {
    const auto end = std::min(text.find(bold), text.find(plain));
    const std::string safe = printable_lines(text.substr(0, end));
    if (std::fwrite(safe.data(), 1, safe.size(), stdout) != safe.size()) throw cannot_write();
    if (end == std::string_view::npos) return;
    const std::string_view style = text.substr(end).starts_with(bold) ? bold : plain;
    if (std::fwrite(style.data(), 1, style.size(), stdout) != style.size()) throw cannot_write();
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
    std::size_t widest = std::max(width(columns_[i].name), width(columns_[i].unit));
    for (const auto& row : rows_) widest = std::max(widest, width(row[i]));
    widths.push_back(widest);
    units = units || !columns_[i].unit.empty();
  }
  const auto line = [&](const auto& cell) {
    std::string result;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& content = cell(i);
      const std::string space(widths[i] - width(content), ' ');
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
