#pragma once

/// \file
/// Monte Carlo studies: what nature or the enemy decides is drawn, each draw is simulated, and
/// probabilities come with their intervals (docs/formats/study.md).
///
/// ```cpp
/// const asdic::StudyResult pd =
///     asdic::study("studies/known_answer.toml", "pd.h5", {.changes = {"study.realisations=100"}});
/// std::cout << pd.rows() << " rows, " << pd.question << " is " << pd.value << " (" << pd.low
///           << " to " << pd.high << ")\n";
/// std::cout << pd.columns.front() << " of the first: " << pd.values.front().front() << '\n';
/// ```

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/ping.h"
#include "asdic/watch.h"

namespace asdic {

/// A measure of one's own: one more column of the table.
struct StudyMeasure {
  std::string name{};     ///< of its column: small letters, digits and _
  std::string unit{};     ///< "dB"; "": none
  std::string meaning{};  ///< in a few words
  /// What it computes, in a word or a number. Rows of another version are not taken over.
  std::string version{};
  bool samples = true;  ///< false: levels and echoes are enough, which are had much faster
  /// \return the number, NaN where there is none. Called from many threads at once; what it throws
  /// ends the study   \param ping  whose scenario() has what was drawn
  std::function<double(const Ping& ping)> of{};
};

struct StudyResult;

struct StudyOptions {
  std::vector<std::string> changes = {};    ///< "key.path=value" each, as of --set
  std::vector<StudyMeasure> measures = {};  ///< after those of the file
  std::stop_token stop = {};  ///< rows that are there stay, and the same call goes on from them
  bool fresh = false;         ///< begins anew, whatever results are there
  /// Told now and then how many rows are done, and of how many.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = {};
  /// Ends before the last row where each is known: "0.05", "pd_by_range=0.1", "pd: low > 0.9", as
  /// of --until. Empty: what the study file says.
  std::vector<std::string> until = {};
  /// A rule of one's own besides, asked after 100, 200, … 1000, 2000, … rows: whether these are
  /// enough. Of the rows it has columns, units and values. Called by one thread at a time; what it
  /// throws ends the study.
  std::function<bool(const StudyResult& rows)> enough = {};
};

/// The table of a study: a row a realisation.
struct ASDIC_API StudyResult {
  std::vector<std::string> columns{};         ///< what varies, then what is measured
  std::vector<std::string> units{};           ///< [columns] "" of what has none
  std::vector<std::vector<double>> values{};  ///< [columns][rows]; NaN: not known
  bool complete = false;                      ///< all rows are there
  std::string question{};                     ///< that the study answers first: "pd"; "": none
  double value = 0.0, low = 0.0, high = 0.0;  ///< the answer, and its confidence interval
  std::vector<std::string> warnings{};

  [[nodiscard]] std::size_t rows() const noexcept;
  /// \throws InputError if there is no such column
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const;
};

/// Runs a study into a file, as `asdic study` does: rows that are there are not made again, so a
/// study that was stopped goes on. \throws InputError, RunError, Stopped
[[nodiscard]] ASDIC_API StudyResult study(const std::filesystem::path& file,
                                          const std::filesystem::path& output,
                                          const StudyOptions& options = {});
/// The table of a study's file.
[[nodiscard]] ASDIC_API StudyResult read_study(const std::filesystem::path& output);

/// Says where sensors are best put, into a file, as `asdic place` does (docs/formats/placement.md).
/// A file that is there is replaced. \return warnings   \throws InputError, RunError, Stopped
///
/// \param plan  a file   \param changes  "key.path=value" each, as of --set
ASDIC_API std::vector<std::string> write_placement(const std::filesystem::path& output,
                                                   const std::filesystem::path& plan,
                                                   const std::vector<std::string>& changes = {},
                                                   const Watch& watch = {});

}  // namespace asdic
