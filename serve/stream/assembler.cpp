#include "serve/stream/assembler.h"

#include <algorithm>
#include <utility>

namespace asdic::detail::serve {
namespace {

constexpr std::size_t longest_descriptor = 4096;  // fragments
constexpr std::size_t most_descriptors = 4;       // that are not whole
constexpr std::int64_t longest_gap = 65536;       // blocks or packets; more is told by descriptors
constexpr std::int64_t longest_delay = 4096;      // packets by which one may come late

/// How far a number that wraps lies after another.
std::int64_t ahead(std::uint32_t number, std::uint32_t of) {
  return static_cast<std::int32_t>(number - of);
}

/// Of a server that began anew, or of nobody.
bool is_far(std::int64_t step) { return step > longest_gap || step <= -longest_delay; }

}  // namespace

std::string Assembler::Partial::content() const {
  std::string all;
  for (const auto& [fragment, piece] : pieces) all += piece;
  return all;
}

bool Assembler::may_join(const Message& descriptor) const noexcept {
  if (!joined() || over_ || descriptor.time > heard_ + silence) return true;
  const std::int64_t step = ahead(descriptor.sequence, latest_);
  return descriptor.sender == sender_ && (step > 0 || is_far(step));
}

void Assembler::join(const Message& descriptor, std::int64_t block, const Sizes& sizes) {
  if (!joined() || descriptor.sender != sender_ || is_far(ahead(descriptor.sequence, latest_)))
    latest_ = descriptor.sequence - 1;
  begin_at(descriptor);
  blocks_.clear();
  own_.clear();
  others_.clear();
  lost_ = 0;
  next_ = known_block_ = block;
  sizes_ = sizes;
  sender_ = descriptor.sender;
  stream_ = descriptor.stream;
  heard_ = descriptor.time;
  over_ = false;
}

/// Counts packets from this descriptor's on. Those that are missing before it count as lost.
void Assembler::begin_at(const Message& descriptor) {
  counts_.lost += static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, ahead(descriptor.sequence, latest_) - 1));
  begin_ = descriptor.sequence;
  seen_.reset();
  for (std::uint32_t i = 0; i < descriptor.packets; ++i) {
    latest_ = begin_ + i;
    seen_.set(latest_ % remembered);
  }
  counts_.packets += descriptor.packets;
  known_after_ = latest_ + 1;
}

void Assembler::go_on(const Message& descriptor, std::int64_t block, const Give& give) {
  const std::uint32_t after = descriptor.sequence + descriptor.packets;
  if (is_far(ahead(after - 1, latest_))) {
    if (block < next_) return;
    begin_at(descriptor);
    pass_to(block, give);
  }
  known_block_ = block;
  known_after_ = after;
}

void Assembler::take(const Datagram& datagram, const Give& give) {
  const auto packet = read_packet(datagram.bytes);
  if (!packet) {
    ++counts_.foreign;
    return;
  }
  const bool describes = packet->kind == PacketKind::descriptor;
  const bool senders = joined() && datagram.sender == sender_;
  if (!senders || packet->stream != stream_) {
    if (joined() && !over_) ++(senders ? counts_.foreign : counts_.others);
    if (describes) take_descriptor(*packet, datagram, others_, give);
    return;
  }
  heard_ = datagram.time;
  const bool far = is_far(ahead(packet->sequence, latest_));  // a descriptor has to come first
  if (!far && !is_new(*packet)) return;
  if (describes)
    take_descriptor(*packet, datagram, own_, give);
  else if (far)
    ++counts_.foreign;
  else
    take_block(*packet, give);
}

/// By its number; the numbers between it and the latest one are missing, until they come.
bool Assembler::is_new(const Packet& packet) {
  const std::int64_t step = ahead(packet.sequence, latest_);
  const auto bit = [](std::uint32_t sequence) { return sequence % remembered; };
  if (step > 0) {
    static_assert(longest_delay == remembered);
    if (step >= longest_delay)
      seen_.reset();
    else
      for (std::uint32_t s = latest_ + 1; s != packet.sequence; ++s) seen_.reset(bit(s));
    counts_.lost += static_cast<std::uint64_t>(step - 1);
    latest_ = packet.sequence;
  } else if (ahead(packet.sequence, begin_) < 0) {
    ++counts_.foreign;
    return false;
  } else if (seen_[bit(packet.sequence)]) {
    ++counts_.duplicates;
    return false;
  } else {
    ++counts_.reordered;
    if (counts_.lost > 0) --counts_.lost;
  }
  seen_.set(bit(packet.sequence));
  ++counts_.packets;
  return true;
}

void Assembler::take_descriptor(const Packet& packet, const Datagram& datagram,
                                Descriptors& waiting, const Give& give) {
  if (packet.fragments > longest_descriptor) {
    ++counts_.foreign;
    return;
  }
  const auto place =
      waiting.try_emplace({std::string(datagram.sender), packet.stream, packet.first()},
                          Partial{.first = packet.first(), .fragments = packet.fragments});
  Partial& partial = place.first->second;
  if (partial.fragments != packet.fragments) {
    ++counts_.foreign;
    return;
  }
  partial.pieces.try_emplace(packet.fragment, packet.payload);
  if (!partial.whole()) {
    if (waiting.size() > most_descriptors)
      waiting.erase(waiting.begin() == place.first ? std::next(waiting.begin()) : waiting.begin());
    return;
  }
  Message message{.kind = PacketKind::descriptor,
                  .block = joined() ? next_ + ahead(packet.block, std::uint32_t(next_))
                                    : std::int64_t{packet.block},
                  .sequence = packet.first(),
                  .packets = packet.fragments,
                  .stream = packet.stream,
                  .sender = std::string(datagram.sender),
                  .time = datagram.time,
                  .content = partial.content()};
  waiting.erase(place.first);
  give(std::move(message));
}

void Assembler::take_block(const Packet& packet, const Give& give) {
  const std::int64_t number = next_ + ahead(packet.block, std::uint32_t(next_));
  const bool last = packet.fragment + 1 == packet.fragments;
  const std::size_t size = (packet.fragments - std::size_t{1}) * most_payload +
                           (last ? packet.payload.size() : std::size_t{1});
  // Least number of packets that were sent between the latest descriptor and this one.
  const auto between =
      (number - known_block_) *
      static_cast<std::int64_t>((sizes_.longest + most_payload - 1) / most_payload);
  if (number < next_ || number > next_ + longest_gap || ahead(packet.first(), begin_) < 0 ||
      between > std::max<std::int64_t>(0, ahead(packet.first(), known_after_)) ||
      size > sizes_.longest || (last && size % sizes_.sample != 0)) {
    ++counts_.foreign;
    return;
  }
  if (number >= next_ + window) pass_to(number - window + 1, give);
  const auto place =
      blocks_.try_emplace(number, Partial{.first = packet.first(), .fragments = packet.fragments});
  Partial& partial = place.first->second;
  if (partial.first != packet.first() || partial.fragments != packet.fragments) {
    ++counts_.foreign;
    return;
  }
  partial.pieces.try_emplace(packet.fragment, packet.payload);
  if (number == next_ && partial.whole()) give_whole(give);
}

/// Blocks that are whole, one after the other, up to the first that is not.
void Assembler::give_whole(const Give& give) {
  while (!blocks_.empty() && blocks_.begin()->first == next_ && blocks_.begin()->second.whole()) {
    const Partial whole = std::move(blocks_.begin()->second);
    blocks_.erase(blocks_.begin());
    Message message{.kind = PacketKind::block,
                    .block = next_++,
                    .sequence = whole.first,
                    .packets = whole.fragments,
                    .stream = stream_,
                    .sender = {},
                    .time = heard_,
                    .content = whole.content(),
                    .lost = std::exchange(lost_, 0)};
    ++counts_.blocks;
    give(std::move(message));
  }
}

/// Whatever comes before a block is given, or lost.
void Assembler::pass_to(std::int64_t block, const Give& give) {
  while (next_ < block) {
    // The next that there is, or the end of it: gaps may be long.
    const std::int64_t known = blocks_.empty() ? block : std::min(block, blocks_.begin()->first);
    if (known == next_ && !blocks_.empty() && blocks_.begin()->second.whole()) {
      give_whole(give);
      continue;
    }
    const std::int64_t passed = std::max(known, next_ + 1) - next_;
    if (known == next_) blocks_.erase(blocks_.begin());
    lost_ += static_cast<std::uint64_t>(passed);
    counts_.lost_blocks += static_cast<std::uint64_t>(passed);
    next_ += passed;
  }
  give_whole(give);
}

void Assembler::finish(std::int64_t next, const Give& give) {
  pass_to(next, give);
  blocks_.clear();
  over_ = true;
}

}  // namespace asdic::detail::serve
