#include "serve/stream/stream_receiver.h"

#include <cstring>

namespace asdic::detail::serve {

void StreamReceiver::take(std::string_view packet, const Give& give) {
  const Assembler::Give put = [&](Assembler::Message&& message) {
    if (message.kind == PacketKind::descriptor)
      described(message, put);
    else if (auto block = block_of(message))
      give(std::move(*block));
  };
  assembler_.take(packet, put);
}

void StreamReceiver::described(const Assembler::Message& message, const Assembler::Give& give) {
  auto said = read_descriptor(message.content);
  if (!said) return;
  const bool same = about_ && about_->stream == said->stream;
  if (said->ended) {
    if (!same || ended_) return;
    assembler_.finish(said->block, give);
    ended_ = true;
    return;
  }
  if (!same) {
    assembler_.join(message, said->block, said->block_bytes());
    ended_ = false;
  }
  about_ = std::move(said);
}

std::optional<StreamReceiver::Block> StreamReceiver::block_of(
    const Assembler::Message& message) const {
  const std::size_t row = about_->channels * about_->components() * sizeof(float);
  if (message.content.size() % row != 0 || message.content.size() > about_->block_bytes())
    return std::nullopt;
  const auto after =
      static_cast<double>((message.block - about_->block) * std::int64_t(about_->block_samples));
  Block block{.number = message.block,
              .time = about_->time + after / about_->sample_rate,
              .lost = message.lost,
              .samples = message.content.size() / row,
              .pressure = std::vector<float>(message.content.size() / sizeof(float))};
  std::memcpy(block.pressure.data(), message.content.data(), message.content.size());
  return block;
}

}  // namespace asdic::detail::serve
