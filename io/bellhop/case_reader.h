#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail::bellhop {

/// A case as read, and what the reader did that the user should know (a source moved into the
/// water, a value left out and taken from the row before, letters that mean nothing …).
struct Input {
  PropagationCase run_case;
  bool binary_arrivals = false;
  std::vector<std::string> notes;
  /// Those of the notes that tell of values taken over from a line of another kind (of the ice into
  /// the water): they change the answer and are hardly ever meant.
  std::vector<std::string> leaks;
  std::string echo;       ///< the input in words, for the .prt file
  std::string file;       ///< "case.env"
  std::string fan_place;  ///< where the launch angles stand: "case.env:14: launch angles"
};

/// A fault that a run found in a case, told of the file: "beams.highest" is the place of its launch
/// angles, all else gets the file's name.
[[nodiscard]] InputError told_of_file(const InputError& error, const Input& input);

/// Reads ROOT.env and the companions it names (.bty .ati .ssp .brc .trc .sbp). No letter of the
/// file's options gets past this function. docs/formats/bellhop.md
/// \throws InputError "case.env:12: bottom half space, item 2" with what was found and expected
[[nodiscard]] Input read_case(const std::filesystem::path& root);

/// The same from text, for tests and fuzzing; companions are looked up by extension (".bty").
struct Texts {
  std::string env;
  std::vector<std::pair<std::string, std::string>> companions;
};
[[nodiscard]] Input read_case(const Texts& texts, const std::string& root_name);

}  // namespace asdic::detail::bellhop
