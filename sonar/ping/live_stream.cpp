#include "sonar/ping/live_stream.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

constexpr double seconds_at_once = 1.0;  // of the surroundings: nodes and blocks are shared

}  // namespace

LiveStream::LiveStream(std::shared_ptr<const PingSimulator> simulator, std::int64_t first)
    : rate_(recorded_rate(simulator->scenario())),
      channels_(channels_of(simulator->scenario())),
      width_(recording_of(simulator->scenario()).components()),
      piece_(std::max<std::int64_t>(1, std::llround(seconds_at_once * rate_))),
      position_(first) {
  stages_.push_back({.from = first, .simulator = std::move(simulator)});
}

std::int64_t LiveStream::sample_at(double time) const noexcept {
  const std::int64_t nearest = nearest_sample(time);  // a sample's own time is its own again
  return time_of(nearest) >= time ? nearest : nearest + 1;
}

std::int64_t LiveStream::nearest_sample(double time) const noexcept {
  return std::llround(time * rate_);
}

void LiveStream::add(PingRecord& sound, const Transmission& sent, double pulse) {
  const std::int64_t first = nearest_sample(sent.time);
  if (first < position_ || (!pings_.empty() && sound.ping <= pings_.back().about.ping))
    throw std::logic_error("pings of a stream out of order");
  const auto& transmitter = stages_.back().simulator->scenario().transmitters;
  pings_.push_back(
      {.about = {.ping = sound.ping,
                 .sent = sent,
                 .first = first,
                 .end = first + static_cast<std::int64_t>(sound.recording.samples),
                 .platform = transmitter[static_cast<std::size_t>(sent.transmitter)].platform,
                 .over = first + static_cast<std::int64_t>(std::ceil(pulse * rate_))},
       .pressure = std::move(sound.pressure)});
  const auto& arrays = stages_.back().simulator->scenario().arrays;
  const bool shaped = std::any_of(arrays.begin(), arrays.end(),
                                  [](const ReceiverArray& one) { return !one.shapes.empty(); });
  if (shaped)
    begin_stage({.from = first, .simulator = stages_.back().simulator, .ping = sound.ping});
}

void LiveStream::replace(int ping, const PingRecord& sound, std::int64_t from, std::int64_t to) {
  const auto found = std::find_if(pings_.begin(), pings_.end(),
                                  [&](const Ping& one) { return one.about.ping == ping; });
  if (found == pings_.end()) return;
  const Sounding& about = found->about;
  if (from < position_ ||
      about.end - about.first != static_cast<std::int64_t>(sound.recording.samples))
    throw std::logic_error("what is past, or of another length, is not replaced");
  from = std::max(from, about.first);
  to = std::min(to, about.end);
  if (from >= to) return;
  const std::size_t row = sound.recording.samples * width_;
  const std::size_t begin = static_cast<std::size_t>(from - about.first) * width_,
                    count = static_cast<std::size_t>(to - from) * width_;
  for (std::size_t channel = 0; channel < channels_; ++channel)
    std::copy_n(sound.pressure.begin() + static_cast<std::ptrdiff_t>(channel * row + begin), count,
                found->pressure.begin() + static_cast<std::ptrdiff_t>(channel * row + begin));
}

void LiveStream::surround(std::shared_ptr<const PingSimulator> simulator, std::int64_t from) {
  for (Stage& later : stages_)
    if (later.from > from) later = {.from = later.from, .simulator = simulator, .ping = later.ping};
  const int ping = stage_at(from).ping;
  begin_stage({.from = from, .simulator = std::move(simulator), .ping = ping});
}

void LiveStream::begin_stage(Stage stage) {
  if (stage.from < position_) throw std::logic_error("what is past is not surrounded anew");
  const auto place =
      std::lower_bound(stages_.begin(), stages_.end(), stage.from,
                       [](const Stage& one, std::int64_t from) { return one.from < from; });
  if (place != stages_.end() && place->from == stage.from)
    *place = std::move(stage);
  else
    stages_.insert(place, std::move(stage));
}

LiveStream::Stage& LiveStream::stage_at(std::int64_t sample) {
  return *std::prev(
      std::upper_bound(std::next(stages_.begin()), stages_.end(), sample,
                       [](std::int64_t at, const Stage& one) { return at < one.from; }));
}

LiveStream::Place LiveStream::place() const {
  const auto after =
      std::upper_bound(std::next(stages_.begin()), stages_.end(), position_,
                       [](std::int64_t at, const Stage& one) { return at < one.from; });
  return {.simulator = std::prev(after)->simulator, .ping = std::prev(after)->ping};
}

/// Pieces lie on a grid of absolute time, and are made whole: so they do not depend on what is
/// taken, nor on when it is.
void LiveStream::make_piece(Stage& stage, std::int64_t number) const {
  if (stage.piece == number) return;
  ReceiverElectronics::Carried carried;
  if (stage.piece >= 0 && stage.piece + 1 == number) carried = stage.carried;
  stage.around = stage.simulator->surroundings(
      {.ping = stage.ping, .first = number * piece_, .samples = static_cast<std::size_t>(piece_)},
      carried);
  stage.carried = std::move(carried);
  stage.piece = number;
}

/// Pings that are over, and stages.
void LiveStream::forget() {
  std::erase_if(pings_, [&](const Ping& one) {
    return std::max(one.about.end, one.about.over) <= position_;
  });
  stages_.erase(stages_.begin(), stages_.begin() + (&stage_at(position_) - stages_.data()));
}

void LiveStream::skip_to(std::int64_t sample) {
  if (sample < position_) throw std::logic_error("a stream does not go back");
  position_ = sample;
  forget();
}

std::vector<float> LiveStream::take(std::size_t samples) {
  std::vector<float> rows(channels_ * samples * width_, 0.0F);
  const std::int64_t begin = position_, end = begin + static_cast<std::int64_t>(samples);
  for (std::int64_t at = begin; at < end;) {
    Stage& stage = stage_at(at);
    const std::int64_t number = at / piece_;
    std::int64_t until = std::min(end, (number + 1) * piece_);
    if (&stage != &stages_.back()) until = std::min(until, (&stage + 1)->from);
    make_piece(stage, number);
    take_part(stage, at, until, rows, samples, static_cast<std::size_t>(at - begin));
    at = until;
  }
  position_ = end;  // what is interrupted has taken nothing
  forget();
  return rows;
}

void LiveStream::take_part(const Stage& stage, std::int64_t begin, std::int64_t end,
                           std::span<float> rows, std::size_t row, std::size_t at) const {
  const PingSimulator& simulator = *stage.simulator;
  const auto count = static_cast<std::size_t>(end - begin);
  std::vector<float> part(channels_ * count * width_, 0.0F);
  const auto add = [&](const std::vector<float>& from, std::int64_t first, std::int64_t last) {
    const std::int64_t a = std::max(begin, first), b = std::min(end, last);
    if (a >= b) return;
    const std::size_t length = static_cast<std::size_t>(last - first) * width_,
                      skipped = static_cast<std::size_t>(a - first) * width_,
                      to = static_cast<std::size_t>(a - begin) * width_,
                      n = static_cast<std::size_t>(b - a) * width_;
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      const float* source = from.data() + channel * length + skipped;
      float* target = part.data() + channel * count * width_ + to;
      for (std::size_t i = 0; i < n; ++i) target[i] += source[i];
    }
  };
  for (const Ping& one : pings_) add(one.pressure, one.about.first, one.about.end);
  add(stage.around, stage.piece * piece_, (stage.piece + 1) * piece_);
  if (simulator.scenario().pings.blanking)
    for (const Ping& one : pings_) {
      const std::int64_t a = std::max(begin, one.about.first), b = std::min(end, one.about.over);
      if (a < b)
        simulator.blank(one.about.platform, part, static_cast<std::size_t>(a - begin),
                        static_cast<std::size_t>(b - begin));
    }
  simulator.convert(part, count);
  for (std::size_t channel = 0; channel < channels_; ++channel)
    std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(channel * count * width_),
                count * width_,
                rows.begin() + static_cast<std::ptrdiff_t>((channel * row + at) * width_));
}

std::vector<LiveStream::Sounding> LiveStream::sounding() const {
  std::vector<Sounding> all;
  for (const Ping& one : pings_)
    if (one.about.end > position_) all.push_back(one.about);
  return all;
}

std::size_t LiveStream::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Stage& one : stages_)
    bytes += (one.around.size() + one.carried.size()) * sizeof(float);
  for (const Ping& one : pings_) bytes += one.pressure.size() * sizeof(float);
  return bytes;
}

}  // namespace asdic::detail
