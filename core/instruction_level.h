#pragma once
#include <cstddef>
#include <string_view>

namespace asdic::detail {

/// x86-64's micro-architecture levels: v2 has SSE4.2, v3 AVX2 and FMA, v4 AVX-512. Hot functions
/// are compiled for each (cmake/AsdicLevels.cmake); which of them run is chosen when the program
/// starts. docs/develop/instruction-levels.md
enum class InstructionLevel { v2 = 2, v3 = 3, v4 = 4 };

/// The highest level of this processor, or a lower one that the environment variable ASDIC_LEVEL
/// names. A name that cannot be obeyed is left aside: see check_instruction_level.
[[nodiscard]] InstructionLevel instruction_level() noexcept;

/// "x86-64-v3"; "native" or "portable" of a build of one level.
[[nodiscard]] std::string_view instruction_level_name() noexcept;

/// \throws InputError if ASDIC_LEVEL names no level, or one that this processor does not have
void check_instruction_level();

}  // namespace asdic::detail

/// What the jump table of a library calls before main (cmake/level_objects.cmake): every slot gets
/// the address of its function at the level that runs. \param alternatives  [3 × count], v2 first
extern "C" void asdic_choose_level(void** slots, void* const* alternatives,
                                   std::size_t count) noexcept;
