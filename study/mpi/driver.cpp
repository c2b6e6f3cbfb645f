#include "study/mpi/driver.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>
#include <thread>

#include "core/error.h"
#include "study/mpi/messages.h"
#include "study/mpi/worker.h"

namespace asdic::study::mpi {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto pause = std::chrono::milliseconds(1);
constexpr auto tell_every = std::chrono::milliseconds(200);
constexpr auto silent_too_long = std::chrono::seconds(120);
constexpr std::uint64_t largest_block = 256;

}  // namespace

Session::Session(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (level < MPI_THREAD_FUNNELED)
    throw RunError(
        "this MPI allows one thread a process only; asdic-mpi needs MPI_THREAD_FUNNELED");
}

Session::~Session() {
  int over = 0;
  MPI_Finalized(&over);
  if (over == 0) MPI_Finalize();
}

int Session::first_with(bool here) const {
  int mine = here ? rank_ : size_, lowest = size_;
  MPI_Allreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return lowest == size_ ? -1 : lowest;
}

std::string Session::shared(const std::string& text) const {
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  std::string all = text;
  all.resize(size);
  MPI_Bcast(all.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD);
  return all;
}

void Session::abort(int status) const {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::abort();
}

namespace {

/// A rank other than 0: asks for indices, tells of rows, ends when it is told to.
StudyOutcome follow(const Work& work, const StudyRun& run, const Session& session) {
  StudyOutcome outcome;
  try {
    Worker worker(work, run, session.rank());
    bool asked = false, closed = false;
    auto told = Clock::now();
    while (true) {
      const bool over = worker.over();  // before new_rows(): then those are the last
      if (over || Clock::now() - told > tell_every) {
        send(0, Tag::rows, packed(worker.new_rows()));
        told = Clock::now();
      }
      if (over) break;
      if (run.stop.stop_requested() && !closed) {
        worker.stop();
        closed = true;
      }
      if (!asked && !closed && worker.hungry()) {
        send(0, Tag::more);
        asked = true;
      }
      while (const std::optional<Message> message = receive()) {
        asked = asked && message->tag != Tag::block;
        if (message->tag == Tag::block) worker.queue().push(range_of(message->bytes));
        if (message->tag == Tag::no_more) worker.queue().close();
        if (message->tag == Tag::stop) worker.stop();
        closed = closed || message->tag == Tag::no_more || message->tag == Tag::stop;
      }
      std::this_thread::sleep_for(pause);
    }
    outcome.made = worker.made();
  } catch (const InputError& error) {
    const InputFault& fault = error.fault();
    send(0, Tag::fault, packed('i' + fault.where + '\0' + fault.got + '\0' + fault.expected));
    return outcome;
  } catch (const std::exception& error) {
    send(0, Tag::fault, packed("r" + std::string(error.what())));
    return outcome;
  }
  send(0, Tag::bye);
  return outcome;
}

/// Rank 0: deals the indices, hears of the rows, works too.
class Dealer {
 public:
  Dealer(const Work& work, const StudyRun& run, const Session& session, IndexSet missing,
         OrderedEstimate& estimate, Progress progress)
      : work_(work),
        run_(run),
        session_(session),
        missing_(std::move(missing)),
        left_(missing_.size()),
        estimate_(estimate),
        progress_(std::move(progress)),
        heard_(static_cast<std::size_t>(session.size()), Clock::now()) {}

  /// \return rows that all ranks made \throws what any of them threw
  std::uint64_t deal();

 private:
  std::optional<IndexRange> next_block();
  void hear(const Message& message);
  void take(std::vector<Row>&& rows);
  void stop_all();
  void check_silence() const;
  [[noreturn]] void throw_fault() const;

  const Work& work_;
  const StudyRun& run_;
  const Session& session_;
  IndexSet missing_;
  std::uint64_t left_;
  std::size_t at_ = 0;
  std::uint64_t offset_ = 0;
  OrderedEstimate& estimate_;
  Progress progress_;
  std::vector<Clock::time_point> heard_;
  std::set<int> gone_, told_no_more_;
  bool stopping_ = false;
  std::uint64_t made_ = 0;
  std::string fault_;  // the first, with a letter for its kind before it
  int faulty_ = 0;
};

/// Large blocks first, small ones at the end: so that all ranks end together.
std::optional<IndexRange> Dealer::next_block() {
  if (stopping_ || at_ >= missing_.ranges().size()) return {};
  const auto ranks = static_cast<std::uint64_t>(session_.size());
  const IndexRange& range = missing_.ranges()[at_];
  const std::uint64_t wanted = std::clamp<std::uint64_t>(left_ / (8 * ranks), 1, largest_block);
  const std::uint64_t first = range.first + offset_;
  const std::uint64_t size = std::min(wanted, range.end - first);
  offset_ += size;
  left_ -= size;
  if (range.first + offset_ == range.end) {
    ++at_;
    offset_ = 0;
  }
  return IndexRange{first, first + size};
}

void Dealer::take(std::vector<Row>&& rows) {
  for (Row& row : rows) {
    ++made_;
    ++progress_.done;
    estimate_.add(std::move(row));
  }
}

void Dealer::hear(const Message& message) {
  heard_[static_cast<std::size_t>(message.rank)] = Clock::now();
  switch (message.tag) {
    case Tag::more:
      if (const auto block = next_block())
        send(message.rank, Tag::block, packed(*block));
      else if (told_no_more_.insert(message.rank).second)
        send(message.rank, Tag::no_more);
      break;
    case Tag::rows:
      take(rows_of(message.bytes));
      break;
    case Tag::fault:
      if (fault_.empty()) {
        fault_ = text_of(message.bytes);
        faulty_ = message.rank;
      }
      gone_.insert(message.rank);
      break;
    case Tag::bye:
      gone_.insert(message.rank);
      break;
    default:
      break;
  }
}

void Dealer::stop_all() {
  if (std::exchange(stopping_, true)) return;
  for (int rank = 1; rank < session_.size(); ++rank)
    if (!gone_.contains(rank)) send(rank, Tag::stop);
}

void Dealer::check_silence() const {
  for (int rank = 1; rank < session_.size(); ++rank)
    if (!gone_.contains(rank) &&
        Clock::now() - heard_[static_cast<std::size_t>(rank)] > silent_too_long)
      throw RunError(
          "rank " + std::to_string(rank) +
          " has not been heard of for two minutes: it is "
          "taken for dead; the journals hold what was made, and the same command goes on");
}

std::uint64_t Dealer::deal() {
  Worker worker(work_, run_, 0);
  auto told = Clock::now();
  bool closed = false;
  while (true) {
    const bool over = worker.over();  // before new_rows(): then those are the last
    take(worker.new_rows());
    while (const std::optional<Message> message = receive()) hear(*message);
    if (run_.stop.stop_requested() || estimate_.enough() || !fault_.empty()) stop_all();
    if (stopping_) worker.stop();
    if (over && static_cast<int>(gone_.size()) + 1 == session_.size()) break;
    if (over && !stopping_ && !closed) stop_all();  // its journal or a realisation failed
    if (!closed && !stopping_ && worker.hungry()) {
      if (const auto block = next_block()) {
        worker.queue().push(*block);
      } else {
        worker.queue().close();
        closed = true;
      }
    }
    check_silence();
    if (run_.progress && Clock::now() - told > tell_every) {
      told = Clock::now();
      progress_.estimate = estimate_.estimate();
      run_.progress(progress_);
    }
    std::this_thread::sleep_for(pause);
  }
  static_cast<void>(worker.made());  // throws what went wrong here
  if (!fault_.empty()) throw_fault();
  return made_;
}

/// What another rank threw, with its kind: the exit status depends on it.
void Dealer::throw_fault() const {
  const std::string text = fault_.substr(1), rank = " (rank " + std::to_string(faulty_) + ")";
  if (fault_.front() == 'r') throw RunError(text + rank);
  const auto first = text.find('\0'), second = text.find('\0', first + 1);
  throw InputError({.where = text.substr(0, first),
                    .got = text.substr(first + 1, second - first - 1),
                    .expected = text.substr(second + 1) + rank});
}

/// What rank 0 finds before anybody works.
struct Start {
  IndexSet done;
  bool complete = false;
};

Start look_around(const Work& work, const StudyRun& run, OrderedEstimate& estimate,
                  StudyOutcome& outcome) {
  if (run.fresh)
    for (const auto& path : journals_of(run.output)) remove_journal(path);
  const Existing existing =
      run.fresh ? Existing::none : look_at(run.output, work, run.range, run.until.has_value());
  const bool no_journals = journals_of(run.output).empty();
  if (existing == Existing::complete && no_journals) return {.complete = true};
  Journals journals(run.output, work, journal_of(run.output, 0));
  if (existing == Existing::partial && no_journals)
    import_rows(run.output, run.range, work.skips, journals.own());
  journals.rows(run.range, [&](Row&& row) { estimate.add(std::move(row)); });
  outcome.damaged = journals.damaged();
  const IndexSet done = journals.done().within(run.range);
  journals.close();  // each rank opens its own
  return {.done = done};
}

StudyOutcome lead(const Work& work, const StudyRun& run, const Session& session) {
  StudyOutcome outcome{.total = run.range.size(), .range = run.range};
  OrderedEstimate estimate(work.estimate(), run.range.first, run.until);
  Start start;
  std::exception_ptr fault;
  try {
    start = look_around(work, run, estimate, outcome);
  } catch (...) {
    fault = std::current_exception();
  }
  const bool go = !fault && !start.complete;
  static_cast<void>(session.shared(go ? "go" : "stay"));
  if (fault) std::rethrow_exception(fault);
  if (start.complete) {
    outcome.was_complete = outcome.written = outcome.complete = true;
    outcome.before = outcome.total;
    return outcome;
  }
  outcome.before = start.done.size();
  IndexSet missing = estimate.enough() ? IndexSet() : start.done.missing(run.range);
  Dealer dealer(work, run, session, std::move(missing), estimate,
                {.done = outcome.before, .before = outcome.before, .total = outcome.total});
  outcome.made = dealer.deal();
  outcome.estimate = estimate.estimate();
  if (outcome.before + outcome.made == outcome.total || estimate.enough()) {
    Journals journals(run.output, work, {});
    write_output(work, run, estimate, journals, outcome);
  }
  return outcome;
}

}  // namespace

StudyOutcome run_study(const Work& work, const StudyRun& run, const Session& session) {
  if (session.rank() == 0) return lead(work, run, session);
  if (session.shared("") != "go") return {};
  return follow(work, run, session);
}

}  // namespace asdic::study::mpi
