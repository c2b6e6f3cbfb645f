#include "study/mpi/dealer.h"

#include <algorithm>
#include <thread>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::study::mpi {
namespace {

constexpr std::uint64_t largest_block = 256;

}  // namespace

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

void Dealer::handle(const Message& message) {
  received_[static_cast<std::size_t>(message.rank)] = Clock::now();
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
  for (int rank = 1; rank < session_.size(); ++rank) {
    if (gone_.contains(rank)) continue;
    const auto silent = Clock::now() - received_[static_cast<std::size_t>(rank)];
    if (silent > run_.silence)
      throw RunError("rank " + std::to_string(rank) + " has not reported for " +
                     asdic::detail::to_text(run_.silence.count()) +
                     " s: it is taken for dead; the journals hold what was made, and the same "
                     "command goes on");
  }
}

std::uint64_t Dealer::deal() {
  Worker worker(work_, run_, 0);
  auto told = Clock::now(), looked = told;
  bool closed = false;
  while (true) {
    const bool over = worker.over();  // before new_rows(): then those are the last
    take(worker.new_rows());
    while (const std::optional<Message> message = receive()) handle(*message);
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
    if (Clock::now() - looked > tell_every) {  // it asks of every rank
      looked = Clock::now();
      check_silence();
    }
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

}  // namespace asdic::detail::study::mpi
