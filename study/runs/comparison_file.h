#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/output_file.h"
#include "io/ping/provenance.h"
#include "study/comparison/comparison.h"
#include "study/journal/fingerprint.h"

namespace asdic::detail::study {

/// A study of a comparison, as the file names it.
struct ComparedFile {
  std::string name;  ///< as columns have it
  std::string path;  ///< of its rows' file
  Fingerprint fingerprint{};
};

/// Writes the file of a comparison (docs/formats/study-results.md) and gives it its name when it is
/// whole. \param answers  what it says, for people \throws RunError
void write_comparison_file(OutputFile& output, const std::vector<ComparedFile>& studies,
                           const Comparison& comparison, const std::string& answers,
                           const Provenance& made, const std::string& stopped_by = "");

/// Compares every dataset of its summary with its SHA-256. \return what it says, for people
/// \throws InputError for what is no such file, or has changed
[[nodiscard]] std::string read_comparison(const std::filesystem::path& path);

}  // namespace asdic::detail::study
