#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "raytrace/propagation_case.h"

namespace asdic::bellhop {

/// A case as read, and what the reader did that the user should know (a source moved into the
/// water, a value left out and taken from the row before, letters that mean nothing …).
struct Input {
  PropagationCase run_case;
  bool binary_arrivals = false;
  std::vector<std::string> notes;
  std::string echo;  ///< the input in words, for the .prt file
};

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

}  // namespace asdic::bellhop
