#include <fmt/format.h>

#include "app/settings_sections.h"

namespace asdic::detail::app {
namespace {

std::string in_code(const std::string& text) { return text.empty() ? "" : '`' + text + '`'; }

/// A table's cell: a bar in it would end it.
std::string cell(const std::string& text) {
  std::string made;
  for (const char c : text) made += c == '|' ? std::string("\\|") : std::string(1, c);
  return made;
}

/// Values in code, words as such.
std::string default_cell(const SettingRecord& record) {
  return record.required || !record.otherwise.empty() ? default_of(record)
                                                      : in_code(default_of(record));
}

}  // namespace

std::string default_of(const SettingRecord& record) {
  if (record.required) return "required";
  if (!record.otherwise.empty()) return record.otherwise;
  return record.inherits.empty() ? record.standard : record.inherits;
}

std::string meaning_of(const SettingRecord& record, std::string_view quote) {
  std::string text = record.help;
  if (!record.condition.empty()) text += fmt::format(" ({}{}{})", quote, record.condition, quote);
  if (record.live) text += "; a running server takes changes";
  return text;
}

std::string settings_markdown(std::span<const SettingRecord> records) {
  std::string text = "| key | | default | |\n|---|---|---|---|\n";
  for (const SettingRecord& r : records)
    text += fmt::format("| `{}` | {} | {} | {} |\n", r.path, cell(domain_of(r)),
                        cell(default_cell(r)), cell(meaning_of(r, "`")));
  return text;
}

std::string settings_text(const SettingsSection& section) {
  std::string text = fmt::format("[{}] of {}: {}\n", section.path, section.document, section.title);
  for (const SettingRecord& r : section.shown()) {
    const std::string standard = default_of(r);
    text += fmt::format("  {}: {}{}\n      {}\n", r.path, domain_of(r),
                        standard.empty() ? "" : fmt::format(" [{}]", standard), meaning_of(r, ""));
  }
  return text;
}

}  // namespace asdic::detail::app
