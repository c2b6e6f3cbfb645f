#pragma once
#include <cassert>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "study/journal/rows_in_hand.h"
#include "study/runs/assemble.h"
#include "study/runs/run.h"
#include "study/summary/until.h"

namespace asdic::detail::study {

/// A study as the machinery sees it: what it is, how a row is made, what is made of rows.
struct Work {
  Fingerprint fingerprint{};
  Realise realise{};
  Summarise summarise{};
  std::function<RunningEstimate()> estimate{};  ///< without a row
  bool skips = true;          ///< rows that were skipped count as made (on_error = "skip")
  std::size_t in_flight = 0;  ///< rows that exist at a time; 0: four for each thread
  std::function<Row(std::uint64_t index, const std::string& fault)> skipped{};  ///< a row that is
};

/// Its rows are the study's columns and then reuse_columns(). \param study  outlives the work
[[nodiscard]] Work work_of(const Study& study, const Realise& realise);
/// The same of a realiser, which outlives the work as well.
[[nodiscard]] Work work_of(const Study& study, const Realiser& realiser);

/// How far a run is.
struct Progress {
  std::uint64_t done = 0;    ///< rows of the range that are there
  std::uint64_t before = 0;  ///< of them, those that were there at the start
  std::uint64_t total = 0;
  std::optional<Estimate> estimate{};
};

struct StudyRun {
  std::filesystem::path output{};
  IndexRange range{};
  Until until{};               ///< what has to be known how well, to stop
  bool fresh = false;          ///< begins anew, whatever results are there
  bool force = false;          ///< even over a file that asdic did not write
  bool assemble_only = false;  ///< makes no rows: a file of those that are there
  bool retry = false;          ///< makes rows again that were skipped, or given up
  std::chrono::duration<double> silence{
      120.0};  ///< of a rank of MPI or a worker that is then taken for dead
  Session session{};
  std::stop_token stop{};                           ///< leaves the realisations in hand
  std::function<void(const Progress&)> progress{};  ///< a few times a second
  std::function<void(const std::string&)> note{};   ///< what the user should know at once
};

struct StudyOutcome {
  std::uint64_t made = 0, before = 0, total = 0;
  std::uint64_t skipped = 0;   ///< of all that are there, those whose values made no scenario
  std::uint64_t left_out = 0;  ///< rows in which the answer to the first question is not known
  std::string unknown{};       ///< reason in the first of them; "": none was given
  std::string question{};      ///< its name, "pd"
  std::uint64_t damaged = 0;   ///< rows of journals that had to be made again
  bool written = false;        ///< the output is there
  bool complete = false;       ///< and holds all of its range
  bool was_complete = false;   ///< already: nothing was done
  bool by_another = false;     ///< another process of a crew has made the output
  IndexRange range{};          ///< of the output; shorter than asked for after --until
  bool stopped_early = false;  ///< by --until
  std::optional<Estimate> estimate{};
  std::vector<Known> known{};        ///< how well is known what --until asks for
  std::string warning{};             ///< mixed builds
  std::vector<std::string> notes{};  ///< what the user should know of the summary
  std::vector<std::string> found{};  ///< warnings of what came out: the summary's
};

/// The output of a run: while it lives, nobody else makes this file or its journals.
/// \throws InputError, RunError as OutputFile
[[nodiscard]] OutputFile output_of(const StudyRun& run);

/// Makes the rows of a range that are not in the output's journals yet, and the file of them.
/// Interrupted, it leaves the journal; the same call continues.
/// \throws InputError for an output or a journal of another study; whatever a realisation throws;
/// RunError
StudyOutcome run_study(const Work& work, const StudyRun& run);

/// The journals beside an output: of earlier runs, of whatever number of processes.
class Journals {
 public:
  /// \param own  that this process writes to; made if it is not there. "": none
  /// \param work  of which study; unless it skips, skipped rows are thrown away, to be made again
  /// \param retry  skipped rows are thrown away in any case
  Journals(const std::filesystem::path& output, const Work& work, const std::filesystem::path& own,
           bool retry = false);

  /// Only where a path for it was given.
  [[nodiscard]] Journal& own() noexcept {
    assert(own_ != nullptr);
    return *own_;
  }
  [[nodiscard]] IndexSet done() const;
  [[nodiscard]] std::uint64_t damaged() const noexcept;
  [[nodiscard]] std::vector<const Journal*> all() const;
  /// Rows of a range in order, without their time series.
  void rows(IndexRange range, const std::function<void(Row&&)>& take) const;
  /// Closes them and takes them away.
  void remove();
  void close();

 private:
  std::vector<std::unique_ptr<Journal>> journals_;
  Journal* own_ = nullptr;
};

/// Rows that processes died with, as deaths_of() tells: each is made before all others, alone, so
/// that a second death is its own. One that two processes died with is given up: skipped, or, where
/// a fault is to stop the study, told of. \param take  gets what was made
/// \throws InputError naming the row that stops it; whatever a realisation throws
void settle_suspects(const Work& work, const StudyRun& run, RowsInHand& hand, Journal& journal,
                     const std::function<void(Row&&)>& take);
/// Indices that are missing, one after the other.
class Remaining {
 public:
  explicit Remaining(IndexSet missing) : missing_(std::move(missing)) {}
  std::optional<std::uint64_t> next();

 private:
  IndexSet missing_;
  std::size_t at_ = 0;
  std::uint64_t offset_ = 0;
};
/// realise(), with the row marked while it is in hand. \param hand  outlives it
[[nodiscard]] Realise marked(const Realise& realise, RowsInHand& hand);
/// A work's realise() that also calls `note` once, with the reason, if the answer to the first
/// question is not known in any of the first ten valid rows. Thread-safe.
[[nodiscard]] Realise watched(const Work& work,
                              const std::function<void(const std::string& text)>& note);
/// The suspects of a range that are not made: what a run begins with.
[[nodiscard]] Deaths suspects_of(const StudyRun& run, const IndexSet& done);

/// What an output that is there already means for a run.
enum class Existing {
  none,      ///< nothing there
  complete,  ///< it is what the run would make
  partial    ///< rows of this study, from which the run can go on
};
/// \throws InputError if it is not this study's, so that nobody's results are written over
[[nodiscard]] Existing look_at(const std::filesystem::path& output, const Work& work,
                               IndexRange range, bool until);
/// The same before a run, which --fresh and --force let pass by what is there.
[[nodiscard]] Existing look_at(const Work& work, const StudyRun& run);
/// Makes the file of what the journals hold, and takes them away once it is complete.
void write_output(const Work& work, const StudyRun& run, const OrderedEstimate& estimate,
                  Journals& journals, OutputFile& output, StudyOutcome& outcome);
/// Puts the rows of a file into a journal, as if they had just been made.
/// \param skipped  those that were skipped, too
void import_rows(const std::filesystem::path& file, IndexRange range, bool skipped,
                 Journal& journal);

}  // namespace asdic::detail::study
