#include "study/mpi/driver.h"

#include <chrono>
#include <optional>
#include <thread>

#include "core/error.h"
#include "study/mpi/dealer.h"

namespace asdic::detail::study::mpi {
namespace {

using Clock = std::chrono::steady_clock;

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

/// What rank 0 finds before anybody works.
struct Start {
  IndexSet done;
  bool complete = false;
};

Start look_around(const Work& work, const StudyRun& run, OrderedEstimate& estimate,
                  StudyOutcome& outcome) {
  if (run.fresh)
    for (const auto& path : journals_of(run.output)) remove_journal(path);
  const Existing existing = look_at(work, run);
  const bool no_journals = journals_of(run.output).empty();
  if (existing == Existing::complete && no_journals && !run.retry) return {.complete = true};
  Journals journals(run.output, work, journal_of(run.output, 0), run.retry);
  if (existing != Existing::none && no_journals)
    import_rows(run.output, run.range, work.skips && !run.retry, journals.own());
  journals.rows(run.range, [&](Row&& row) { estimate.add(std::move(row)); });
  outcome.damaged = journals.damaged();
  {  // while the other ranks wait: alone
    RowsInHand hand(journals.own().path(), suspects_of(run, journals.done()));
    forget_deaths(run.output, journals.own().path());
    const std::stop_callback call_off(run.stop, [&hand] { hand.call_off(); });
    journals.own().begin(run.session);
    settle_suspects(work, run, hand, journals.own(),
                    [&](Row&& row) { estimate.add(std::move(row)); });
  }
  const IndexSet done = journals.done().within(run.range);
  journals.close();  // each rank opens its own
  return {.done = done};
}

StudyOutcome lead(const Work& work, const StudyRun& run, const Session& session) {
  StudyOutcome outcome{.total = run.range.size(), .range = run.range};
  OrderedEstimate estimate(work.estimate(), run.range.first, run.until);
  Start start;
  std::exception_ptr fault;
  std::optional<OutputFile> output;
  try {
    output.emplace(output_of(run));
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
    write_output(work, run, estimate, journals, *output, outcome);
  }
  return outcome;
}

}  // namespace

StudyOutcome run_study(const Work& work, const StudyRun& run, const Session& session) {
  if (session.rank() == 0) return lead(work, run, session);
  if (session.shared("") != "go") return {};
  return follow(work, run, session);
}

}  // namespace asdic::detail::study::mpi
