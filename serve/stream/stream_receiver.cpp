#include "serve/stream/stream_receiver.h"

#include <cstring>

namespace asdic::detail::serve {

void StreamReceiver::take(const Datagram& packet, const Give& give) {
  const Assembler::Give put = [&](Assembler::Message&& message) {
    if (message.kind == PacketKind::descriptor)
      described(message, put);
    else
      give(block_of(message));
  };
  assembler_.take(packet, put);
}

void StreamReceiver::described(const Assembler::Message& message, const Assembler::Give& give) {
  auto said = read_descriptor(message.content);
  if (!said || said->stream != message.stream) return;
  const bool own = assembler_.is_own(message);
  if (own && (ended_ || said->block < about_->block)) return;  // a late repetition
  if (own && said->ended) {
    assembler_.finish(said->block, give);
    ended_ = true;
    return;
  }
  if (said->ended || (!own && !assembler_.may_join(message))) return;
  if (own) {
    assembler_.go_on(message, said->block, give);
  } else {
    assembler_.join(message, said->block,
                    {.longest = said->block_bytes(), .sample = said->sample_bytes()});
    ended_ = false;
  }
  about_ = std::move(said);
}

StreamReceiver::Block StreamReceiver::block_of(const Assembler::Message& message) const {
  const auto after =
      static_cast<double>((message.block - about_->block) * std::int64_t(about_->block_samples));
  Block block{.number = message.block,
              .time = about_->time + after / about_->sample_rate,
              .lost = message.lost,
              .samples = message.content.size() / about_->sample_bytes(),
              .pressure = std::vector<float>(message.content.size() / sizeof(float))};
  std::memcpy(block.pressure.data(), message.content.data(), message.content.size());
  return block;
}

}  // namespace asdic::detail::serve
