#include "study/runs/run_study.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <mutex>

#include "core/error.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::study {

Work work_of(const Study& study, const Realise& realise) {
  return {.fingerprint = fingerprint_of(study),
          .realise =
              [realise](std::uint64_t index) {
                Row row = realise(index);
                row.values.insert(row.values.end(), row.reuse.begin(), row.reuse.end());
                return row;
              },
          .summarise = [&study](const Table& table) { return summary_of(study, table); },
          .estimate = [&study] { return RunningEstimate(study); },
          .skips = study.on_error == OnError::skip,
          // With what they keep rows are large, also when they are made and wait for their turn.
          .in_flight = study.measure.keeps_any()
                           ? static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())
                           : 0};
}

Work work_of(const Study& study, const Realiser& realiser) {
  Work work = work_of(study, [&realiser](std::uint64_t index) { return realiser.realise(index); });
  work.skipped = [&realiser](std::uint64_t index, const std::string& fault) {
    Row row = realiser.skipped(index, fault);
    row.values.insert(row.values.end(), row.reuse.begin(), row.reuse.end());
    return row;
  };
  return work;
}

namespace {

/// As many files as the system lets this process open: thousands of ranks have a journal each.
void allow_many_files() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= files.rlim_max) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace

Journals::Journals(const std::filesystem::path& output, const Work& work,
                   const std::filesystem::path& own, bool retry) {
  allow_many_files();
  if (!own.empty()) {
    journals_.push_back(std::make_unique<Journal>(own, work.fingerprint));
    own_ = journals_.front().get();
  }
  for (const std::filesystem::path& path : journals_of(output))
    if (path != own) journals_.push_back(std::make_unique<Journal>(path, work.fingerprint));
  if (work.skips && !retry) return;
  for (const auto& journal : journals_) journal->drop_skipped();
}

IndexSet Journals::done() const {
  IndexSet all;
  for (const auto& journal : journals_) all.add(journal->done());
  return all;
}

std::uint64_t Journals::damaged() const noexcept {
  std::uint64_t total = 0;
  for (const auto& journal : journals_) total += journal->damaged();
  return total;
}

std::vector<const Journal*> Journals::all() const {
  std::vector<const Journal*> result;
  for (const auto& journal : journals_) result.push_back(journal.get());
  return result;
}

void Journals::rows(IndexRange range, const std::function<void(Row&&)>& take) const {
  for (const Segment& segment : segments(all(), range))
    journals_[segment.journal]->rows(segment.range, false, take);
}

void Journals::close() {
  for (const auto& journal : journals_) journal->close();
}

void Journals::remove() {
  close();
  for (const auto& journal : journals_) remove_journal(journal->path());
}

Existing look_at(const std::filesystem::path& output, const Work& work, IndexRange range,
                 bool until) {
  std::error_code error;
  if (!std::filesystem::exists(output, error)) return Existing::none;
  const auto refuse = [&](const std::string& got) {
    return InputError({.where = output.string(),
                       .got = got,
                       .expected = "no such file, or results of this study (identity " +
                                   work.fingerprint.identity +
                                   "); another output, or --fresh to write over it"});
  };
  try {
    const StudyFile file(output);
    if (file.fingerprint().identity != work.fingerprint.identity)
      throw refuse("results of another study" +
                   how_changed(file.fingerprint().text, work.fingerprint.text) + " (identity " +
                   file.fingerprint().identity + ")");
    const IndexRange there = file.range();
    const bool whole = file.complete() && file.stopped_by().empty();
    const std::string otherwise = "name another output, or --fresh to write over it";
    if (until && whole && there == range)
      throw InputError({.where = output.string(),
                        .got = "the whole study, realisations " + index_text(there) +
                               ", which tells no less than it would with --until",
                        .expected = "a file that may end earlier: leave --until (or study.until) "
                                    "out to keep this one, " +
                                    otherwise});
    if (until && whole)
      throw InputError(
          {.where = output.string(),
           .got = "realisations " + index_text(there) + ", all of them, made without an early end",
           .expected = "a file that may end earlier: leave --until (or study.until) "
                       "out to go on from these, " +
                       otherwise});
    if (there.first < range.first || there.end > range.end)
      throw InputError({.where = output.string(),
                        .got = "realisations " + index_text(there) + " of this study",
                        .expected = "none beyond the " + index_text(range) +
                                    " that are asked for, which would be all that is kept; another "
                                    "output, or --fresh to write over it"});
    const bool same = whole && there == range && file.fingerprint().text == work.fingerprint.text &&
                      file.fingerprint().overrides == work.fingerprint.overrides;
    return same ? Existing::complete : Existing::partial;
  } catch (const InputError& fault) {
    if (fault.fault().expected.ends_with("--fresh to write over it")) throw;
    throw refuse(fault.fault().got);
  }
}

Existing look_at(const Work& work, const StudyRun& run) {
  if (run.fresh || (run.force && !own::hdf5(run.output))) return Existing::none;
  return look_at(run.output, work, run.range, run.until.has_value());
}

void import_rows(const std::filesystem::path& path, IndexRange range, bool skipped,
                 Journal& journal) {
  const StudyFile file(path);
  file.verify();
  const Table table = file.table();
  const std::vector<std::uint64_t> kept = file.series_index();
  const Shape shape = file.series_shape();
  std::vector<std::int32_t> samples;
  if (!kept.empty()) samples = file.series_samples();
  const std::vector<SeriesTiming> timing = file.series_timing();
  const std::vector<std::string> faults = file.faults();
  struct Reading {
    KeptReader from;
    std::size_t next = 0;
  };
  std::vector<Reading> arrays;
  for (const KeptKind& kind : kept_kinds()) arrays.push_back({KeptReader(file, kind)});
  std::size_t series = 0, fault = 0;
  for (std::size_t i = 0; i < table.index.size(); ++i) {
    Row row{.index = table.index[i], .valid = table.valid[i] != 0};
    for (const ColumnValues& column : table.values) row.values.push_back(column[i]);
    if (!row.valid && fault < faults.size()) {
      const std::string& line = faults[fault++];
      row.fault = line.substr(std::min(line.size(), line.find(": ") + 2));
    }
    if (series < kept.size() && kept[series] == row.index) {
      row.pressure = file.series(series);
      row.pressure_shape.assign(shape.begin() + 1, shape.end());
      row.pressure_shape[sample_axis(row.pressure_shape)] =
          static_cast<std::size_t>(samples[series]);
      row.timing = timing[series];
      ++series;
    }
    for (Reading& one : arrays) {
      const std::vector<std::uint64_t>& index = one.from.told().index;
      if (one.next < index.size() && index[one.next] == row.index)
        row.kept.push_back(one.from.at(one.next++));
    }
    if (row.index >= range.first && row.index < range.end && (row.valid || skipped) &&
        !journal.done().contains(row.index))
      journal.append(row);
  }
  if (!table.cells.empty()) journal.import_cells(table.cells);
  journal.commit();
  for (const Session& session : file.sessions()) journal.add(session);
}

Deaths suspects_of(const StudyRun& run, const IndexSet& done) {
  Deaths suspects;
  if (!run.retry)
    for (const auto& [index, deaths] : deaths_of(run.output))
      if (index >= run.range.first && index < run.range.end && !done.contains(index))
        suspects[index] = deaths;
  return suspects;
}

Realise marked(const Realise& realise, RowsInHand& hand) {
  return [realise, &hand](std::uint64_t index) {
    const RowsInHand::Mark mark(hand, index);
    return realise(index);
  };
}

Realise watched(const Work& work, const std::function<void(const std::string& text)>& note) {
  struct Watch {
    explicit Watch(RunningEstimate of) : estimate(std::move(of)) {}
    std::mutex mutex{};
    RunningEstimate estimate;
    std::uint64_t rows = 0;
  };
  constexpr std::uint64_t enough = 10;
  const auto watch = std::make_shared<Watch>(work.estimate());
  return [realise = work.realise, note, watch](std::uint64_t index) {
    Row row = realise(index);
    const std::lock_guard lock(watch->mutex);
    if (!row.valid || watch->rows == enough) return row;
    watch->estimate.add(row);
    if (++watch->rows == enough && watch->estimate.left_out() == enough)
      note(watch->estimate.name() + " is not known in any of the first " + std::to_string(enough) +
           " realisations" +
           (watch->estimate.unknown().empty() ? "" : ": " + watch->estimate.unknown()));
    return row;
  };
}

void settle_suspects(const Work& work, const StudyRun& run, RowsInHand& hand, Journal& journal,
                     const std::function<void(Row&&)>& take) {
  constexpr int given_up_after = 2;  // deaths
  const auto note = [&](const std::string& text) {
    if (run.note) run.note(text);
  };
  const auto keep = [&](Row&& row) {
    journal.append(row);
    journal.commit();
    hand.clear(row.index);
    take(std::move(row));
  };
  for (const auto& [suspect, deaths] : hand.suspects()) {
    const std::uint64_t index = suspect;
    const std::string name = "realisation " + std::to_string(index);
    if (deaths >= given_up_after) {
      const std::string died = std::to_string(deaths) + " processes that died while they made it";
      if (!work.skips)
        throw InputError({.where = run.output.string() + ": " + name,
                          .got = died,
                          .expected = "one that lives: study.on_error = \"skip\" passes over it, "
                                      "--retry makes it again"});
      note(name + " is passed over: it was in hand when " + std::to_string(deaths) +
           " processes died; --retry makes it again");
      keep(work.skipped(index, name + ": found " + died + ", expected one that lives"));
      continue;
    }
    note(name + " was in hand when a process died: it is made again, alone");
    bool drawn = false;
    study::run(
        marked(work.realise, hand),
        [&]() -> std::optional<std::uint64_t> {
          if (std::exchange(drawn, true)) return {};
          return index;
        },
        [&](Row&& row) {
          keep(std::move(row));
          return true;
        },
        {.stop = run.stop});
    if (run.stop.stop_requested()) return;
  }
}

namespace {

/// Tells of progress, but not for every row.
class Teller {
 public:
  Teller(const StudyRun& run, std::uint64_t before, std::uint64_t total)
      : run_(run), progress_{.done = before, .before = before, .total = total, .estimate = {}} {}

  void row(const OrderedEstimate& estimate) {
    ++progress_.done;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    tell(estimate);
  }
  void tell(const OrderedEstimate& estimate) {
    if (!run_.progress) return;
    progress_.estimate = estimate.estimate();
    run_.progress(progress_);
  }

 private:
  const StudyRun& run_;
  Progress progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

InputError nothing_to_assemble(const std::filesystem::path& output) {
  return InputError({.where = output.string(),
                     .got = "no realisation of what is asked for, to assemble",
                     .expected = "rows in " + journal_of(output).string() +
                                 ": without --assemble they are made"});
}

}  // namespace

std::optional<std::uint64_t> Remaining::next() {
  if (at_ >= missing_.ranges().size()) return {};
  const IndexRange& range = missing_.ranges()[at_];
  const std::uint64_t index = range.first + offset_++;
  if (offset_ == range.size()) {
    offset_ = 0;
    ++at_;
  }
  return index;
}

void write_output(const Work& work, const StudyRun& run, const OrderedEstimate& estimate,
                  Journals& journals, OutputFile& output, StudyOutcome& outcome) {
  Fingerprint fingerprint = work.fingerprint;
  std::string stopped_by;
  if (run.until && estimate.enough() && *estimate.enough() < run.range.size()) {
    outcome.range.end = run.range.first + *estimate.enough();
    fingerprint.realisations = outcome.range.end;
    stopped_by = run.until.text();
    outcome.stopped_early = true;
  }
  outcome.skipped = estimate.skipped();
  outcome.left_out = estimate.left_out();
  outcome.unknown = estimate.unknown();
  outcome.question = estimate.name();
  outcome.known = estimate.known();
  const auto summarise = [&](const Table& table) {
    Summary summary = work.summarise(table);
    outcome.notes = summary.notes;
    return summary;
  };
  outcome.complete = assemble(output, fingerprint, outcome.range, journals.all(), summarise,
                              stopped_by, &outcome.found);
  outcome.written = true;
  std::vector<Session> sessions;
  for (const Journal* journal : journals.all())
    for (const Session& session : journal->sessions()) sessions.push_back(session);
  outcome.warning = mixed_builds(sessions);
  if (outcome.complete)
    journals.remove();
  else
    journals.close();
}

OutputFile output_of(const StudyRun& run) {
  return OutputFile(run.output,
                    {.own = own::hdf5, .worth = own::pings, .force = run.force, .renews = true});
}

StudyOutcome run_study(const Work& work, const StudyRun& run) {
  StudyOutcome outcome{.total = run.range.size(), .range = run.range};
  OutputFile output = output_of(run);
  if (run.fresh)
    for (const auto& path : journals_of(run.output)) remove_journal(path);
  const Existing existing = look_at(work, run);
  const bool no_journals = journals_of(run.output).empty();
  if (existing == Existing::complete && no_journals && !run.retry) {
    outcome.was_complete = outcome.written = outcome.complete = true;
    outcome.before = outcome.total;
    return outcome;
  }
  if (run.assemble_only && existing == Existing::none && no_journals)
    throw nothing_to_assemble(run.output);
  Journals journals(run.output, work, journal_of(run.output), run.retry);
  if (existing != Existing::none && no_journals)
    import_rows(run.output, run.range, work.skips && !run.retry, journals.own());
  journals.own().begin(run.session);
  const IndexSet done = journals.done().within(run.range);
  outcome.damaged = journals.damaged();
  outcome.before = done.size();
  if (run.assemble_only && done.empty()) {
    journals.close();
    throw nothing_to_assemble(run.output);
  }
  OrderedEstimate estimate(work.estimate(), run.range.first, run.until);
  journals.rows(run.range, [&](Row&& row) { estimate.add(std::move(row)); });

  if (!run.assemble_only && !estimate.enough()) {
    RowsInHand hand(journals.own().path(), suspects_of(run, done));
    forget_deaths(run.output, journals.own().path());
    const std::stop_callback call_off(run.stop, [&hand] { hand.call_off(); });
    settle_suspects(work, run, hand, journals.own(), [&](Row&& row) {
      estimate.add(std::move(row));
      ++outcome.made;
    });
    Remaining remaining(journals.done().within(run.range).missing(run.range));
    Teller teller(run, outcome.before + outcome.made, outcome.total);
    teller.tell(estimate);
    outcome.made += study::run(
        marked(work.realise, hand), [&] { return remaining.next(); },
        [&](Row&& row) {
          journals.own().append(row);
          estimate.add(std::move(row));
          teller.row(estimate);
          return !estimate.enough();
        },
        {.stop = run.stop, .in_flight = work.in_flight});
  }
  outcome.estimate = estimate.estimate();
  const bool all = outcome.before + outcome.made == outcome.total || estimate.enough();
  if (all || run.assemble_only)
    write_output(work, run, estimate, journals, output, outcome);
  else
    journals.close();
  return outcome;
}

}  // namespace asdic::detail::study
