#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/runs/assemble.h"

namespace asdic::detail::study {

struct MergeOptions {
  bool copy = false;        ///< all data in one file; else a catalogue that refers to the parts
  bool allow_gaps = false;  ///< indices may be missing; the file then says that it is not complete
  std::optional<std::string> text{};  ///< of the study, in place of the parts'
};

struct MergeReport {
  std::uint64_t rows = 0, realisations = 0;
  IndexSet missing{};                   ///< where gaps are allowed
  std::vector<std::string> warnings{};  ///< mixed builds or processors
};

/// The summary is made of what the first part tells of the study.
using SummariseFingerprint =
    std::function<Summary(const Fingerprint& fingerprint, const Table& table)>;

/// Puts parts of a study together, in the order of their indices whatever order they are given in.
/// \throws InputError for a part of another study, a part that is not what its manifest says, an
/// index in two parts, or one in none
MergeReport merge(const std::vector<std::filesystem::path>& parts, OutputFile& output,
                  const SummariseFingerprint& summarise, const MergeOptions& options = {});

/// The same into a file of this name, which may hold a result of asdic's.
MergeReport merge(const std::vector<std::filesystem::path>& parts,
                  const std::filesystem::path& output, const SummariseFingerprint& summarise,
                  const MergeOptions& options = {});

}  // namespace asdic::detail::study
