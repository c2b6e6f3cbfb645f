#include "study/crew/crew_run.h"

#include <algorithm>
#include <condition_variable>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include "core/error.h"
#include "study/crew/block_board.h"

namespace asdic::detail::study {
namespace {

using Seconds = std::chrono::duration<double>;

/// Does something again and again, beside what else goes on, while it lives.
class Every {
 public:
  Every(Seconds pause, std::function<void()> what)
      : thread_([this, pause, what = std::move(what)](const std::stop_token& stop) {
          std::unique_lock lock(mutex_);
          while (!stop.stop_requested()) {
            what();
            changed_.wait_for(lock, stop, pause, [] { return false; });
          }
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::jthread thread_;
};

/// What a worker that is gone has left of a block. None where its journal cannot be had: then its
/// rows are made again.
struct Left {
  IndexSet done;
  Deaths suspects;
};
Left left_by(int worker, const Work& work, const StudyRun& run, IndexRange block) {
  Left left;
  const std::filesystem::path path = journal_of(run.output, worker);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return left;
  try {
    Journal journal(path, work.fingerprint);  // locked by whoever only seems to be gone
    if (!work.skips) journal.drop_skipped();
    left.done = journal.done().within(block);
    for (const auto& [index, deaths] : deaths_beside(path, true))
      if (index >= block.first && index < block.end && !left.done.contains(index))
        left.suspects[index] = deaths;
    journal.close();
  } catch (const std::exception&) {
    return {};
  }
  return left;
}

class Crew {
 public:
  Crew(const Work& work, const StudyRun& run)
      : work_(work),
        run_(run),
        board_(crew_of(run.output), work.fingerprint.identity, run.range, run.silence),
        alive_(run.silence / 8.0, [this] { board_.live(); }) {}

  StudyOutcome work() {
    StudyOutcome outcome{.total = run_.range.size(), .range = run_.range};
    outcome.before = board_.rows_done();
    std::error_code error;
    if (outcome.before == 0 && std::filesystem::exists(run_.output, error) &&
        look_at(work_, run_) == Existing::complete) {  // it was made while this one came
      board_.remove();
      outcome.before = outcome.total;
      outcome.was_complete = outcome.written = outcome.complete = true;
      return outcome;
    }
    make_rows(outcome);
    if (run_.stop.stop_requested()) return outcome;
    while (!board_.is_over()) {
      if (board_.assembles()) {
        assemble(outcome);
        return outcome;
      }
      if (run_.stop.stop_requested()) return outcome;
      std::this_thread::sleep_for(pause());
    }
    outcome.written = outcome.complete = outcome.by_another = true;
    return outcome;
  }

 private:
  [[nodiscard]] Seconds pause() const { return std::min(Seconds(1.0), run_.silence / 20.0); }

  /// Until every block is done, by this one or by others.
  void make_rows(StudyOutcome& outcome) {
    Journal journal(journal_of(run_.output, board_.worker()), work_.fingerprint);
    if (!journal.alone())
      throw RunError(journal.path().string() +
                     ": the file system there knows no locks, by which processes that --join keep "
                     "out of each other's journals: set another -o");
    journal.begin(run_.session);
    Seconds wait = pause();
    while (!run_.stop.stop_requested() && !board_.is_over()) {
      auto block = board_.take();
      if (!block) {
        if (board_.all_done()) break;
        tell(outcome);
        std::this_thread::sleep_for(wait);
        wait = std::min(2.0 * wait, run_.silence / 8.0);  // each look lists the folder
        continue;
      }
      wait = pause();
      while (block) block = make_blocks(*block, journal, outcome);
    }
    journal.close();
  }

  /// A block in work.
  struct InWork {
    BlockBoard::Block block;
    std::uint64_t left = 0;  // rows that are not in the journal
  };

  /// Block after block, in one row of threads, while there are any that nobody had before. What was
  /// somebody's who is gone comes first, with its suspects alone.
  /// \return one that is to come first
  std::optional<BlockBoard::Block> make_blocks(const BlockBoard::Block& first, Journal& journal,
                                               StudyOutcome& outcome) {
    const Left left = first.before ? left_by(*first.before, work_, run_, first.range) : Left();
    if (first.before && run_.note)
      run_.note("worker " + std::to_string(*first.before) + " is gone: its realisations " +
                index_text(first.range) + " go on here");
    RowsInHand hand(journal.path(), left.suspects);
    const std::stop_callback call_off(run_.stop, [&hand] { hand.call_off(); });
    IndexSet there = left.done;
    settle_suspects(work_, run_, hand, journal, [&](Row&& row) {
      there.add(row.index);
      ++outcome.made;
    });
    std::list<InWork> blocks;
    std::vector<BlockBoard::Block> finished;
    auto committed = BlockBoard::Clock::now();
    const auto commit = [&] {
      journal.commit();  // before anybody is told
      for (const BlockBoard::Block& block : finished) board_.done(block);
      finished.clear();
      committed = BlockBoard::Clock::now();
    };
    IndexSet missing = there.missing(first.range);
    const auto begin = [&](const BlockBoard::Block& block, std::uint64_t rows) {
      if (rows > 0)
        blocks.push_back({block, rows});
      else
        finished.push_back(block);
    };
    begin(first, missing.size());
    Remaining remaining(std::move(missing));
    std::optional<BlockBoard::Block> later;
    const auto next = [&]() -> std::optional<std::uint64_t> {
      if (const auto index = remaining.next()) return index;
      if (later || run_.stop.stop_requested()) return {};
      const std::lock_guard lock(mutex_);
      auto block = board_.take();
      if (block && block->before) later = block;
      if (!block || block->before) return {};
      begin(*block, block->range.size());
      remaining = Remaining(IndexSet(block->range));
      return remaining.next();
    };
    study::run(marked(work_.realise, hand), next,
               [&](Row&& row) {
                 const std::lock_guard lock(mutex_);
                 journal.append(row);
                 ++outcome.made;
                 ++in_hand_;
                 const auto of = std::find_if(blocks.begin(), blocks.end(), [&](const InWork& one) {
                   return one.block.range.first <= row.index && row.index < one.block.range.end;
                 });
                 if (--of->left == 0) {
                   finished.push_back(of->block);
                   blocks.erase(of);
                 }
                 if (BlockBoard::Clock::now() - committed > std::chrono::milliseconds(500)) {
                   commit();
                   in_hand_ = 0;
                 }
                 tell(outcome);
                 return true;
               },
               {.stop = run_.stop, .in_flight = work_.in_flight});
    commit();
    in_hand_ = 0;
    for (const InWork& one : blocks) board_.give_back(one.block);
    return later;
  }

  void tell(const StudyOutcome& outcome) const {
    if (!run_.progress) return;
    run_.progress({.done = std::min(outcome.total, board_.rows_done() + in_hand_),
                   .before = outcome.before,
                   .total = outcome.total,
                   .estimate = {}});
  }

  /// All blocks are done: the others close their journals.
  void assemble(StudyOutcome& outcome) {
    OutputFile output = output_of(run_);
    std::optional<Journals> journals;
    const auto begin = std::chrono::steady_clock::now();
    while (!journals) try {
        journals.emplace(run_.output, work_, std::filesystem::path());
      } catch (const RunError&) {  // somebody has one open
        if (std::chrono::steady_clock::now() - begin > 4.0 * run_.silence) throw;
        std::this_thread::sleep_for(pause());
      }
    OrderedEstimate estimate(work_.estimate(), run_.range.first);
    journals->rows(run_.range, [&](Row&& row) { estimate.add(std::move(row)); });
    outcome.estimate = estimate.estimate();
    write_output(work_, run_, estimate, *journals, output, outcome);
    if (outcome.complete) board_.remove();
  }

  const Work& work_;
  const StudyRun& run_;
  BlockBoard board_;
  Every alive_;
  std::mutex mutex_;           // of the board and the blocks in work
  std::uint64_t in_hand_ = 0;  // rows that are made, of blocks that are not done
};

}  // namespace

StudyOutcome run_crew(const Work& work, const StudyRun& run) {
  std::error_code error;
  const bool begun = std::filesystem::exists(crew_of(run.output), error);
  if (!begun || std::filesystem::exists(run.output, error)) {
    const Existing existing = look_at(work, run);
    if (existing == Existing::complete)
      return {.before = run.range.size(),
              .total = run.range.size(),
              .written = true,
              .complete = true,
              .was_complete = true,
              .range = run.range};
    if (existing == Existing::partial)
      throw InputError({.where = run.output.string(),
                        .got = "a part of this study's realisations",
                        .expected = "no file where several processes --join; without it the same "
                                    "command goes on with these"});
  }
  return Crew(work, run).work();
}

}  // namespace asdic::detail::study
