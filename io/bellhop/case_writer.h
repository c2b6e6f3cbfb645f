#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/bellhop/case_reader.h"
#include "io/files/output_file.h"

namespace asdic::detail::bellhop {

/// A case as BELLHOP's files.
struct Written {
  Texts texts;
  std::vector<std::string> notes;  ///< what these files cannot hold, and what stands there instead
};

/// Writes a case so that read_case() makes the same case of it, number for number where the files
/// can hold it (depths and ranges of receivers are in single precision there; biology becomes
/// attenuation at the nodes of the profile). \throws InputError if there is no way to say it: a sea
/// floor that is rigid here and fluid there
[[nodiscard]] Written write_case(const PropagationCase& run_case, bool binary_arrivals = false);

/// The same of a case of BELLHOP3D that was read: its grids are written as they were.
[[nodiscard]] Written write_map_case(const Input& input);

/// ROOT.env and its companions: all may be written, or none is. \throws InputError, RunError
void write_case_files(const std::filesystem::path& root, const Texts& texts,
                      const OutputRules& rules = {});

}  // namespace asdic::detail::bellhop
