#include "serve/listening.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "serve/places.h"
#include "serve/session_state.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

/// To which moment of a ping's sound a section of the scenario belongs.
enum class Acts { sent, struck, received };
Acts acts(const std::string& section) {
  if (section == "array" || section == "noise" || section == "platform") return Acts::received;
  if (section == "target" || section == "environment.wind_speed") return Acts::struck;
  return Acts::sent;
}

const std::string* value_of(const LiveScenario::Changes& changes, const std::string& section) {
  const auto found = std::find_if(changes.begin(), changes.end(),
                                  [&](const auto& one) { return one.first == section; });
  return found == changes.end() ? nullptr : &found->second;
}

/// What a ping is received by: each section as it was when that acts, its own before all.
LiveScenario::Changes composed(const LiveScenario::Changes& sent,
                               const LiveScenario::Changes& struck,
                               const LiveScenario::Changes& received,
                               const LiveScenario::Changes& own) {
  LiveScenario::Changes all;
  std::set<std::string> known;
  const auto add = [&](const std::string& section) {
    if (!known.insert(section).second) return;
    const Acts when = acts(section);
    const std::string* value = value_of(own, section);
    if (value == nullptr)
      value = value_of(when == Acts::sent     ? sent
                       : when == Acts::struck ? struck
                                              : received,
                       section);
    if (value != nullptr) all.emplace_back(section, *value);
  };
  for (const auto* list : {&received, &struck, &sent, &own})
    for (const auto& [section, value] : *list) add(section);
  return all;
}

}  // namespace

double tow_memory(const Scenario& scenario) {
  constexpr double slowest_tow = 0.5;  // [m/s]
  double longest = 0.0;
  for (const ReceiverArray& array : scenario.arrays)
    if (array.towed)
      for (const double behind : array.towed->behind) longest = std::max(longest, behind);
  return longest / slowest_tow;
}

Listening::Listening(std::shared_ptr<const PingSimulator> simulator, LiveScenario::Changes changes,
                     double begin)
    : rate_(recorded_rate(simulator->scenario())),
      stream_(std::move(simulator), static_cast<std::int64_t>(std::ceil(begin * rate_ - 1e-6))) {
  changes_.push_back({.time = -std::numeric_limits<double>::infinity(),
                      .changes = std::move(changes),
                      .strikes = false});
}

std::int64_t Listening::position() const {
  const std::lock_guard lock(mutex_);
  return stream_.position();
}

double Listening::time() const { return static_cast<double>(position()) / rate_; }

Listening::Heard Listening::heard() const {
  const std::lock_guard lock(mutex_);
  Heard heard{.position = stream_.position(), .time = stream_.time_of(stream_.position())};
  heard.oldest = heard.time;
  for (const LiveStream::Sounding& one : stream_.sounding())
    heard.oldest = std::min(heard.oldest, one.sent.time);
  return heard;
}

double Listening::whole_samples(double time) const { return std::round(time * rate_) / rate_; }

void Listening::begin(const Blocks& blocks, double from) {
  const std::lock_guard lock(mutex_);
  const auto first = static_cast<std::int64_t>(std::ceil(from * rate_ - 1e-6));
  stream_.skip_to(std::max(first, stream_.position()));
  blocks_ = blocks;
  if (blocks.end) *blocks_.end += stream_.position();
  active_ = true;
}

std::int64_t Listening::end() {
  const std::lock_guard lock(mutex_);
  active_ = false;
  blocks_.sink.reset();
  return stream_.position();
}

std::optional<Listening::Blocks> Listening::blocks() const {
  const std::lock_guard lock(mutex_);
  if (!active_) return std::nullopt;
  return blocks_;
}

std::int64_t Listening::end_of_next() const {
  const std::int64_t end = stream_.position() + blocks_.samples;
  return blocks_.end ? std::min(end, *blocks_.end) : end;
}

double Listening::next_end() const {
  const std::lock_guard lock(mutex_);
  return stream_.time_of(end_of_next());
}

bool Listening::is_over() const {
  const std::lock_guard lock(mutex_);
  return !active_ || end_of_next() <= stream_.position();
}

void Listening::scheduled_until(double time) {
  const std::lock_guard lock(mutex_);
  scheduled_until_ = time;
}

bool Listening::is_prepared() const {
  const double end = next_end();
  const std::lock_guard lock(mutex_);
  return stream_.time_of(sounded_until_) >= end && (!blocks_.scheduled || scheduled_until_ >= end);
}

std::optional<Listening::Block> Listening::next(const std::function<bool(double end)>& may) {
  const std::lock_guard lock(mutex_);
  if (!active_) return std::nullopt;
  const std::int64_t samples = end_of_next() - stream_.position();
  if (!may(stream_.time_of(end_of_next()))) return std::nullopt;
  if (samples <= 0) {
    active_ = false;
    blocks_.sink.reset();
    return std::nullopt;
  }
  Block block{.number = number_,
              .time = stream_.time_of(stream_.position()),
              .channels = stream_.channels(),
              .samples = static_cast<std::size_t>(samples),
              .components = stream_.components(),
              .pressure = {},
              .place = stream_.place(),
              .sink = blocks_.sink};
  block.pressure = stream_.take(block.samples);
  ++number_;
  return block;
}

const Listening::Change& Listening::change_at(double time) const {
  const auto after = std::upper_bound(changes_.begin() + 1, changes_.end(), time,
                                      [](double t, const Change& one) { return t < one.time; });
  return *std::prev(after);
}

/// The scenario by which a ping is received at a time, but for what was struck before.
LiveScenario::Changes Listening::composed_for(const Sent& ping, double time) const {
  const LiveScenario::Changes& now = change_at(time).changes;
  return composed(change_at(ping.sent.time).changes, now, now, ping.own);
}

/// By which scenarios a ping is received from a sample on.
std::vector<Listening::Window> Listening::windows(const Sent& ping, std::int64_t from,
                                                  std::int64_t end) const {
  const double left = ping.sent.time;
  const auto struck_at = [&](double received) { return left + 0.5 * (received - left); };
  std::set<std::int64_t> cuts{from, end};
  for (const Change& one : changes_) {
    const auto cut = [&](double time) {
      const std::int64_t sample = stream_.sample_at(time);
      if (sample > from && sample < end) cuts.insert(sample);
    };
    if (!std::isfinite(one.time)) continue;
    cut(one.time);
    if (one.strikes) cut(2.0 * one.time - left);
  }
  std::vector<Window> all;
  for (auto begin = cuts.begin(); std::next(begin) != cuts.end(); ++begin) {
    const double received = stream_.time_of(*begin);
    // A change of where targets are is on their tracks: it is taken at once.
    const Change* struck = &change_at(received);
    for (const Change* one = struck; one > changes_.data(); --one)
      if (one->strikes && struck_at(received) < one->time) struck = one - 1;
    Window window{.from = *begin,
                  .to = *std::next(begin),
                  .changes = composed(change_at(left).changes, struck->changes,
                                      change_at(received).changes, ping.own)};
    if (!all.empty() && all.back().changes == window.changes)
      all.back().to = window.to;
    else
      all.push_back(std::move(window));
  }
  return all;
}

PingRecord Listening::send(SessionState& session, int number, const Transmission& sent,
                           const LiveScenario::State& state) {
  forget();
  Sent ping{.ping = number, .sent = sent, .own = {}};
  for (const auto& one : state.changes) {
    const std::string* live = value_of(session.live.state().changes, one.first);
    if (live == nullptr || *live != one.second) ping.own.push_back(one);
  }
  const LiveScenario::Changes& then = change_at(sent.time).changes;
  const LiveScenario::Changes as_sent = composed(then, then, then, ping.own);
  const auto simulator = session.simulator_of(session.live.of(as_sent));
  check_places(simulator->scenario(), number, sent.transmitter, sent.time);
  PingRecord record = simulator->sound(number, sent);
  const std::int64_t first = stream_.nearest_sample(sent.time),
                     end = first + static_cast<std::int64_t>(record.recording.samples);
  for (Window& window : windows(ping, first, end))  // of changes that are known beforehand
    if (window.changes != as_sent) ping.pending.push_back(std::move(window));
  {
    const std::lock_guard lock(mutex_);
    stream_.add(record, sent, simulator->pulse(sent.transmitter).duration());
  }
  sent_.push_back(std::move(ping));
  see_to_pending();
  return record;
}

/// The same in steps of a second, two, four, … from a sample on: of what is changed again before
/// long, the rest is never made. They depend on nothing but the change.
std::vector<Listening::Window> Listening::steps(const std::vector<Window>& windows,
                                                std::int64_t from) const {
  std::vector<Window> all;
  for (const Window& window : windows) {
    std::int64_t begin = window.from;
    for (double seconds = 1.0; begin < window.to; seconds *= 2.0) {
      const std::int64_t until = from + std::llround((2.0 * seconds - 1.0) * rate_);
      if (until <= begin) continue;
      all.push_back({.from = begin, .to = std::min(window.to, until), .changes = window.changes});
      begin = all.back().to;
    }
  }
  return all;
}

/// How far everything sounds as it should.
void Listening::see_to_pending() {
  const std::lock_guard lock(mutex_);
  sounded_until_ = std::numeric_limits<std::int64_t>::max();
  for (const Sent& one : sent_)
    if (!one.pending.empty()) sounded_until_ = std::min(sounded_until_, one.pending.front().from);
}

bool Listening::lacks(double until) const {
  const std::lock_guard lock(mutex_);
  return stream_.time_of(sounded_until_) < until;
}

PingRecord Listening::sound_in(SessionState& session, const Sent& ping,
                               const Window& window) const {
  const auto simulator = session.simulator_of(session.live.of(window.changes));
  const std::int64_t first = stream_.nearest_sample(ping.sent.time);
  return simulator->sound(ping.ping, ping.sent, {},
                          {.from = static_cast<double>(window.from - first) / rate_,
                           .to = static_cast<double>(window.to - first) / rate_});
}

void Listening::prepare(SessionState& session, double until) {
  for (Sent& ping : sent_)
    while (!ping.pending.empty() && stream_.time_of(ping.pending.front().from) < until) {
      const PingRecord sound = sound_in(session, ping, ping.pending.front());
      follow(ping, sound);
    }
  see_to_pending();
}

/// From now on a ping sounds as its first pending window has it.
void Listening::follow(Sent& ping, const PingRecord& sound) {
  const Window& window = ping.pending.front();
  {
    const std::lock_guard lock(mutex_);
    stream_.replace(ping.ping, sound, std::max(window.from, stream_.position()), window.to);
  }
  ping.pending.erase(ping.pending.begin());
}

void Listening::change(SessionState& session, double time, bool strikes) {
  forget();
  const std::vector<Sent> before = sent_;
  changes_.push_back({.time = time, .changes = session.live.state().changes, .strikes = strikes});
  std::shared_ptr<const PingSimulator> around;
  const std::int64_t from = stream_.sample_at(time);
  try {
    around = session.simulator_of(session.live.state());
    for (const LiveStream::Sounding& one : sounding()) {
      if (one.end <= from) continue;
      const auto ping = std::find_if(sent_.begin(), sent_.end(),
                                     [&](const Sent& sent) { return sent.ping == one.ping; });
      check_places(session.live.of(composed_for(*ping, time)).scenario, one.ping,
                   one.sent.transmitter, one.sent.time);
      // One that begins before stays as long as it is: so its bits are those that it has where
      // nobody knew of this change. What follows takes its place from here on.
      std::erase_if(ping->pending, [&](const Window& window) { return window.from >= from; });
      for (Window& step :
           steps(windows(*ping, std::max(from, one.first), one.end), std::max(from, one.first)))
        ping->pending.push_back(std::move(step));
    }
    // What is heard next, or it is refused; if it is called off, nothing has changed.
    std::vector<std::pair<Sent*, PingRecord>> made;
    for (Sent& ping : sent_)
      for (const Window& window : ping.pending)
        if (window.from <= from) made.emplace_back(&ping, sound_in(session, ping, window));
    for (const auto& [ping, sound] : made) follow(*ping, sound);
    see_to_pending();
  } catch (...) {
    changes_.pop_back();
    sent_ = before;
    see_to_pending();
    throw;
  }
  const std::lock_guard lock(mutex_);
  stream_.surround(around, from);
}

std::vector<LiveStream::Sounding> Listening::sounding() const {
  const std::lock_guard lock(mutex_);
  return stream_.sounding();
}

/// What no sound asks for any more.
void Listening::forget() {
  const std::vector<LiveStream::Sounding> still = sounding();
  std::erase_if(sent_, [&](const Sent& one) {
    return std::none_of(still.begin(), still.end(),
                        [&](const auto& other) { return other.ping == one.ping; });
  });
  const double before = heard().oldest;
  while (changes_.size() > 1 && changes_[1].time <= before) changes_.erase(changes_.begin());
}

}  // namespace asdic::detail::serve
