#include "core/instruction_level.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>

#include "core/error.h"

namespace asdic::detail {
namespace {

constexpr std::string_view names[] = {"x86-64-v2", "x86-64-v3", "x86-64-v4"};

constexpr std::string_view name_of(InstructionLevel level) noexcept {
  return names[static_cast<int>(level) - 2];
}

/// Of the processor that this runs on.
InstructionLevel highest_level() noexcept {
#if defined(__x86_64__) && !defined(ASDIC_ONE_LEVEL)  // clang 14 knows no levels
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4") != 0) return InstructionLevel::v4;
  if (__builtin_cpu_supports("x86-64-v3") != 0) return InstructionLevel::v3;
#endif
  return InstructionLevel::v2;
}

/// What ASDIC_LEVEL says; empty if it is not set.
std::string_view wanted() noexcept {
  const char* text = std::getenv("ASDIC_LEVEL");
  return text != nullptr ? text : std::string_view();
}

std::optional<InstructionLevel> level_named(std::string_view name) noexcept {
  for (const InstructionLevel level :
       {InstructionLevel::v2, InstructionLevel::v3, InstructionLevel::v4})
    if (name_of(level) == name) return level;
  return std::nullopt;
}

}  // namespace

InstructionLevel instruction_level() noexcept {
  static const InstructionLevel level = [] {
    const InstructionLevel highest = highest_level();
    return std::min(highest, level_named(wanted()).value_or(highest));
  }();
  return level;
}

std::string_view instruction_level_name() noexcept {
#if defined(ASDIC_ONE_LEVEL)
  return ASDIC_ONE_LEVEL;
#else
  return name_of(instruction_level());
#endif
}

void check_instruction_level() {
  const std::string_view name = wanted();
  if (name.empty()) return;
  const auto refuse = [&](std::string expected) {
    throw InputError({.where = "environment variable ASDIC_LEVEL",
                      .got = '"' + std::string(name) + '"',
                      .expected = std::move(expected)});
  };
#if defined(ASDIC_ONE_LEVEL)
  if (name != ASDIC_ONE_LEVEL) refuse("nothing: this build has one level, " ASDIC_ONE_LEVEL);
#else
  const std::optional<InstructionLevel> level = level_named(name);
  const auto highest = highest_level();
  if (!level) refuse("x86-64-v2, x86-64-v3 or x86-64-v4");
  if (*level > highest) refuse("at most " + std::string(name_of(highest)) + " on this processor");
#endif
}

}  // namespace asdic::detail

extern "C" void asdic_choose_level(void** slots, void* const* alternatives,
                                   std::size_t count) noexcept {
  const auto level = static_cast<std::size_t>(asdic::detail::instruction_level());
  std::copy_n(alternatives + (level - 2) * count, count, slots);
}
