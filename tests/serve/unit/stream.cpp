#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "serve/stream/assembler.h"
#include "serve/stream/descriptor.h"
#include "serve/stream/stream_receiver.h"
#include "serve/stream/udp_outlet.h"
#include "support/deep.h"
#include "support/serve.h"

// The block stream in packets: cut, mixed up, put together. What goes over sockets is seen by
// tests/serve/validation/stream.py.

namespace asdic::detail {
namespace {

using serve::Assembler;
using serve::PacketKind;
using ::testing::HasSubstr;

/// A message of its own bytes for each number.
std::string message(std::int64_t number, std::size_t bytes) {
  std::string all(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i)
    all[i] = static_cast<char>((static_cast<std::size_t>(number) * 31 + i * 7 + i / 256) % 251);
  return all;
}

/// Packets of a descriptor and of blocks from `first` on.
struct Sent {
  explicit Sent(std::int64_t blocks, std::size_t bytes, std::uint32_t sequence = 0,
                std::int64_t first = 0) {
    serve::Packets cut(sequence);
    const auto keep = [&](std::string_view packet) { packets.emplace_back(packet); };
    cut.split(PacketKind::descriptor, 1, first, "about", keep);
    for (std::int64_t n = first; n < first + blocks; ++n)
      cut.split(PacketKind::block, 1, n, message(n, bytes), keep);
  }
  std::vector<std::string> packets;
};

/// What is made of packets; joins at the first descriptor.
class Received {
 public:
  explicit Received(std::size_t longest) : longest_(longest) {}
  void take(std::string_view packet) { assembler.take({.bytes = packet}, give); }
  void finish(std::int64_t next) { assembler.finish(next, give); }

  Assembler assembler;
  std::vector<Assembler::Message> blocks;
  std::size_t descriptors = 0;
  bool rejoins = false;

 private:
  std::size_t longest_;
  Assembler::Give give = [this](Assembler::Message&& one) {
    if (one.kind == PacketKind::block) {
      blocks.push_back(std::move(one));
      return;
    }
    ++descriptors;
    if (!assembler.joined() || rejoins) assembler.join(one, one.block, {.longest = longest_});
  };
};

TEST(Stream, HasTheBytesOfItsPage) {
  serve::Packets cut(0x01020304);
  std::vector<std::string> packets;
  cut.split(PacketKind::block, 0x1112131415161718, 0x05060708, message(0, 1409),
            [&](std::string_view packet) { packets.emplace_back(packet); });
  ASSERT_EQ(packets.size(), 2U);
  const auto is = [](const std::string& packet, std::initializer_list<int> bytes) {
    return std::equal(bytes.begin(), bytes.end(), packet.begin(),
                      [](int byte, char c) { return byte == static_cast<unsigned char>(c); });
  };
  EXPECT_TRUE(is(packets[0], {'A', 'S', 2, 1, 4,    3,    2,    1,    8,    7,    6,    5,
                              0,   0,   2, 0, 0x18, 0x17, 0x16, 0x15, 0x14, 0x13, 0x12, 0x11}));
  EXPECT_TRUE(is(packets[1], {'A', 'S', 2, 1, 5,    3,    2,    1,    8,    7,    6,    5,
                              1,   0,   2, 0, 0x18, 0x17, 0x16, 0x15, 0x14, 0x13, 0x12, 0x11}));
  EXPECT_EQ(packets[0].size(), 24U + 1408U);
  EXPECT_EQ(packets[1].size(), 24U + 1U);
}

TEST(Stream, IsPutTogetherAgain) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{1407}, std::size_t{1408},
                                  std::size_t{1409}, std::size_t{50000}})
    for (const std::uint32_t sequence : {0U, 0xfffffff0U}) {  // it wraps
      Received received(bytes);
      for (const std::string& packet : Sent(20, bytes, sequence).packets) received.take(packet);
      ASSERT_EQ(received.blocks.size(), 20U);
      for (std::int64_t n = 0; n < 20; ++n) {
        const auto& block = received.blocks[static_cast<std::size_t>(n)];
        EXPECT_EQ(block.block, n);
        EXPECT_EQ(block.content, message(n, bytes));
        EXPECT_EQ(block.lost, 0U);
      }
      const auto& counts = received.assembler.counts();
      EXPECT_EQ(counts.lost + counts.reordered + counts.duplicates + counts.foreign, 0U);
    }
}

// The largest message that there may be, and numbers of blocks that wrap.
TEST(Stream, GoesToItsBounds) {
  constexpr std::int64_t late = 0xfffffffeLL;
  Received received(3000);
  for (const std::string& packet : Sent(5, 3000, 7, late).packets) received.take(packet);
  ASSERT_EQ(received.blocks.size(), 5U);
  EXPECT_EQ(received.blocks.back().block, late + 4);
  EXPECT_EQ(received.blocks.back().content, message(late + 4, 3000));

  Received large(serve::longest_message);
  for (const std::string& packet : Sent(1, serve::longest_message).packets) large.take(packet);
  ASSERT_EQ(large.blocks.size(), 1U);
  EXPECT_EQ(large.blocks[0].content, message(0, serve::longest_message));
}

// The truth is counted while packets are thrown away, swapped and sent again.
TEST(Stream, TellsLossReorderingAndDuplicates) {
  constexpr std::size_t bytes = 4000;  // three packets a block
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    const Sent sent(300, bytes);
    std::vector<std::string> wire;
    std::vector<bool> broken(300, false);
    std::uint64_t dropped = 0, again = 0, swapped = 0;
    for (std::size_t i = 0; i < sent.packets.size(); ++i) {
      const std::uint32_t drawn = random() % 100;
      const bool in_the_middle = i > 0 && i + 4 < sent.packets.size();
      if (in_the_middle && drawn < 3) {
        ++dropped;
        broken[(i - 1) / 3] = true;
        continue;
      }
      wire.push_back(sent.packets[i]);
      if (in_the_middle && drawn > 95) {
        wire.push_back(sent.packets[i]);
        ++again;
      }
    }
    for (std::size_t i = 2; i + 3 < wire.size(); i += 5)
      if (wire[i] != wire[i + 1]) {
        std::swap(wire[i], wire[i + 1]);
        ++swapped;
      }
    Received received(bytes);
    for (const std::string& packet : wire) received.take(packet);
    received.finish(300);
    const auto& counts = received.assembler.counts();
    const auto lost_blocks =
        static_cast<std::uint64_t>(std::count(broken.begin(), broken.end(), true));
    EXPECT_EQ(counts.lost, dropped);
    EXPECT_EQ(counts.duplicates, again);
    EXPECT_LE(counts.reordered, swapped);
    EXPECT_GE(counts.reordered + again, swapped);
    EXPECT_EQ(counts.lost_blocks, lost_blocks);
    EXPECT_EQ(counts.blocks, 300 - lost_blocks);
    std::uint64_t told = 0;
    std::int64_t next = 0;
    for (const auto& block : received.blocks) {
      told += block.lost;
      EXPECT_EQ(block.block, next + static_cast<std::int64_t>(block.lost));
      EXPECT_FALSE(broken[static_cast<std::size_t>(block.block)]);
      EXPECT_EQ(block.content, message(block.block, bytes));
      next = block.block + 1;
    }
    EXPECT_EQ(told + static_cast<std::uint64_t>(300 - next), lost_blocks);
  }
}

// Whoever comes late has what follows the next descriptor, and no loss is told.
TEST(Stream, IsJoinedInTheMiddle) {
  serve::Packets cut;
  Received received(100);
  const auto take = [&](std::string_view packet) { received.take(packet); };
  const auto ignore = [](std::string_view) {};
  for (int n = 0; n < 50; ++n) {
    if (n % 20 == 0)
      cut.split(PacketKind::descriptor, 1, n, "about",
                n == 0 ? serve::Packets::Send(ignore) : serve::Packets::Send(take));
    cut.split(PacketKind::block, 1, n, message(n, 100), take);
  }
  ASSERT_EQ(received.blocks.size(), 30U);
  EXPECT_EQ(received.blocks.front().block, 20);
  EXPECT_EQ(received.blocks.front().lost, 0U);
  EXPECT_EQ(received.assembler.counts().lost, 0U);
}

// Bytes at random, and packets of which bits were turned over, among those of a stream. No block is
// longer than there may be, memory stays bounded, and a stream that begins afterwards is whole.
TEST(Stream, StandsHostilePackets) {
  const int count = support::deep() ? 1'000'000 : 100'000;
  constexpr std::size_t bytes = 4000;
  const Sent sent(200, bytes);
  std::mt19937 random(11);
  Received received(bytes);
  const std::string about = sent.packets.front();
  received.take(about);
  std::string packet;
  for (int i = 0; i < count; ++i) {
    packet = sent.packets[random() % sent.packets.size()];
    switch (random() % 4) {
      case 0:  // whatever
        packet.resize(random() % 1500);
        for (char& c : packet) c = static_cast<char>(random());
        break;
      case 1:  // another header
        for (std::size_t at = 3; at < 24; ++at)
          if (random() % 4 == 0) packet[at] = static_cast<char>(random());
        break;
      case 2:
        packet.resize(random() % (packet.size() + 1));
        break;
      default:
        packet[3 + random() % 21] ^= static_cast<char>(1u << (random() % 8));
    }
    received.take(packet);
  }
  received.finish(received.assembler.next());
  for (const auto& block : received.blocks) {
    EXPECT_LE(block.content.size(), bytes);
  }
  const auto& counts = received.assembler.counts();
  EXPECT_GT(counts.foreign, static_cast<std::uint64_t>(count) / 4);
  received.rejoins = true;
  received.blocks.clear();
  for (const std::string& one : Sent(20, bytes, 0x77777777).packets) received.take(one);
  ASSERT_EQ(received.blocks.size(), 20U);
  for (const auto& block : received.blocks) EXPECT_EQ(block.content, message(block.block, bytes));
}

// A stream belongs to its sender and has a number. Packets from another address, or without the
// number, change neither a block nor a count of the stream, even if all else in them is right.
// Packets with numbers that the descriptor does not allow are ignored. After a gap too long to
// count the receiver continues at a descriptor, and it joins another sender after a silence.
TEST(Stream, IsBoundToItsSender) {
  const serve::Descriptor about{.stream = 7,
                                .channels = 1,
                                .block_samples = 1000,
                                .arrays = {{"a", 1}},
                                .positions = {{0, 0, 0}}};
  serve::StreamReceiver receiver;
  std::vector<serve::StreamReceiver::Block> blocks;
  double now = 0.0;
  const auto send = [&](serve::Packets& cut, std::string_view sender, PacketKind kind,
                        std::uint64_t stream, std::int64_t block, const std::string& content) {
    cut.split(kind, stream, block, content, [&](std::string_view packet) {
      receiver.take({.bytes = packet, .sender = sender, .time = now},
                    [&](auto&& one) { blocks.push_back(std::move(one)); });
    });
  };
  const auto describe = [&](serve::Packets& cut, std::string_view sender, std::uint64_t stream,
                            std::int64_t block) {
    serve::Descriptor one = about;
    one.stream = stream;
    one.block = block;
    send(cut, sender, PacketKind::descriptor, stream, block, serve::descriptor_text(one));
  };
  const std::string quiet(4000, '\0'), loud(1000, '\x45');
  serve::Packets own;
  describe(own, "A", 7, 0);
  for (int n = 0; n < 40; ++n, now += 0.1) {
    send(own, "A", PacketKind::block, 7, n, quiet);
    for (std::uint32_t far = 0; far < 64; ++far) {
      serve::Packets guessed(far << 26U);
      send(guessed, "B", PacketKind::block, 7, n + 1, loud);
      send(guessed, "B", PacketKind::block, 8, n + 1, loud);
      send(guessed, "A", PacketKind::block, 8, n + 1, loud);
      describe(guessed, "B", 9, n);
    }
  }
  const auto& counts = receiver.counts();
  ASSERT_EQ(blocks.size(), 40U);
  for (const auto& block : blocks) {
    EXPECT_EQ(block.lost, 0U);
    EXPECT_EQ(block.pressure, std::vector<float>(1000, 0.0F));
  }
  EXPECT_EQ(counts.lost + counts.lost_blocks + counts.reordered, 0U);
  EXPECT_EQ(counts.others, 3U * 64U * 40U);
  // Two packets cannot hold sixty more blocks; a block has 4000 bytes, and whole samples.
  for (const auto& [block, content] : {std::pair(100, quiet), std::pair(41, std::string(4004, 'x')),
                                       std::pair(41, std::string(7, 'x'))}) {
    const std::uint64_t before = counts.foreign;
    send(own, "A", PacketKind::block, 7, block, content);
    EXPECT_GT(counts.foreign, before) << block << ' ' << content.size();
  }
  EXPECT_EQ(blocks.size(), 40U);
  serve::Packets later(200'000);
  send(later, "A", PacketKind::block, 7, 1000, quiet);
  EXPECT_EQ(blocks.size(), 40U);  // the next block is not known yet
  describe(later, "A", 7, 1001);
  send(later, "A", PacketKind::block, 7, 1001, quiet);
  ASSERT_EQ(blocks.size(), 41U);
  EXPECT_EQ(blocks.back().number, 1001);
  EXPECT_EQ(blocks.back().lost, 1001U - 40U);
  now += 4.9;
  serve::Packets other(5);
  describe(other, "B", 8, 0);
  EXPECT_EQ(receiver.about()->stream, 7U);
  now += 0.2;
  describe(other, "B", 8, 0);
  EXPECT_EQ(receiver.about()->stream, 8U);
  send(other, "B", PacketKind::block, 8, 0, quiet);
  EXPECT_EQ(blocks.size(), 42U);
}

bool is_told(const std::string& text) { return serve::read_descriptor(text).has_value(); }

TEST(Stream, DescriptorsAreReadBackAndCheckedFirst) {
  serve::Descriptor one{.stream = 0x0123456789abcdef,
                        .block = 1LL << 40,
                        .time = 12.5,
                        .sample_rate = 114.0,
                        .carrier = 4000.0,
                        .channels = 3,
                        .block_samples = 7,
                        .arrays = {{"bow", 1}, {"tail", 2}},
                        .positions = {{0.1, 2, 3}, {4, 5, 6}, {7, 8, 9.25}},
                        .ended = true};
  const std::string text = serve::descriptor_text(one);
  const auto back = serve::read_descriptor(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(serve::descriptor_text(*back), text);
  EXPECT_EQ(back->positions[0].x(), 0.1);
  EXPECT_EQ(back->block_bytes(), 3U * 7U * 2U * 4U);
  one.positions.pop_back();
  EXPECT_FALSE(is_told(serve::descriptor_text(one)));
  EXPECT_FALSE(is_told(""));
  EXPECT_FALSE(is_told(std::string(100000, '[')));
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {  // it throws for none
    std::string wrong = text.substr(0, text.size() - random() % 5);
    wrong[random() % wrong.size()] = static_cast<char>(random());
    static_cast<void>(is_told(wrong));
  }
}

/// An outlet that keeps what it is given.
class Kept : public serve::BlockOutlet {
 public:
  struct Sink : serve::BlockSink {
    Sink(Kept& kept, std::size_t samples) : kept_(kept), about_(samples) {}
    ~Sink() override {
      kept_.ends.push_back(about_.end().value_or(""));
      kept_.taken = false;
    }
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    void take(const serve::Listening::Block& block) override {
      if (const auto text = about_.before(block))
        kept_.told.push_back(serve::read_descriptor(*text).value());
      kept_.samples.insert(kept_.samples.end(), block.pressure.begin(), block.pressure.end());
    }
    Kept& kept_;
    serve::DescribedStream about_;
  };
  [[nodiscard]] std::size_t longest_block() const override { return 100'000; }
  [[nodiscard]] std::size_t most_channels() const override { return 2; }
  [[nodiscard]] std::shared_ptr<serve::BlockSink> open(const serve::BlockShape& shape) override {
    if (std::exchange(taken, true)) return nullptr;
    return std::make_shared<Sink>(*this, shape.samples);
  }
  bool taken = false;
  std::vector<serve::Descriptor> told;
  std::vector<std::string> ends;
  std::vector<float> samples;
};

// The line of a block has no bytes then; the samples are those that a client would have; where the
// phones are is told at the beginning, each second, and where a change acts.
TEST(Stream, TakesTheSamplesOfAListen) {
  const auto heard = [](const std::shared_ptr<Kept>& kept) {
    serve::SessionSettings settings;
    settings.udp = kept;
    support::Served served(support::served_scenario, settings);
    std::vector<float> samples;
    served.session().state().tell = [&](const serve::Answer& answer) {
      const auto line = nlohmann::json::parse(answer.line);
      if (line.contains("block")) {
        EXPECT_EQ(line["samples"].contains("bytes"), !kept) << line;
      }
      samples.insert(samples.end(), answer.samples.begin(), answer.samples.end());
      return true;
    };
    const std::string deliver = kept ? R"(, "deliver": "udp")" : "";
    const auto say = [&](const std::string& line) {
      EXPECT_EQ(served(line)["ok"], true) << served.last.line;
      if (served.last.then) served.last.then();
    };
    say(R"({"command": "listen", "seconds": 1.5, "block": 0.1)" + deliver + "}");
    say(R"({"command": "update", "platform": {"position": [10, 20, 210], "velocity": [3, 0, 0]}})");
    say(R"({"command": "ping"})");
    say(R"({"command": "listen", "seconds": 5, "block": 0.1)" + deliver + "}");
    return samples;
  };
  const auto kept = std::make_shared<Kept>();
  EXPECT_TRUE(heard(kept).empty());
  EXPECT_EQ(kept->samples, heard(nullptr));
  ASSERT_EQ(kept->told.size(), 2U + 5U);
  EXPECT_EQ(kept->told[0].time, 0.0);
  EXPECT_EQ(kept->told[0].block_samples, 20U);
  EXPECT_EQ(kept->told[0].carrier, 1000.0);
  // A horizontal line of two phones, 0.75 m apart: about the platform, as it moves on.
  const auto& moved = kept->told.back();
  EXPECT_NEAR(moved.time, 5.5, 1e-9);
  EXPECT_EQ(moved.block, 55);
  const Vec3 middle = 0.5 * (moved.positions.at(0) + moved.positions.at(1));
  EXPECT_NEAR(middle.x(), 10.0 + 3.0 * 4.0, 1e-9);
  EXPECT_NEAR(middle.y(), 20.0, 1e-9);
  EXPECT_NEAR(middle.z(), 210.0, 1e-9);
  EXPECT_NEAR((moved.positions[0] - moved.positions[1]).norm(), 0.75, 1e-9);
  ASSERT_EQ(kept->ends.size(), 2U);
  const auto last = serve::read_descriptor(kept->ends[1]).value();
  EXPECT_TRUE(last.ended);
  EXPECT_EQ(last.block, 65);
  EXPECT_NEAR(last.time, 6.5, 1e-9);
}

TEST(Stream, IsRefusedWhereThereIsNoWayForIt) {
  support::Served none;
  const std::string line = R"({"command": "listen", "seconds": 1, "deliver": "udp")";
  EXPECT_THAT(
      none.refusal(line + "}"),
      HasSubstr(R"(value: deliver: found "udp", expected "samples": the server has no --udp)"));
  EXPECT_THAT(none.refusal(R"({"command": "listen", "seconds": 1, "deliver": "post"})"),
              HasSubstr("deliver: found \"post\""));
  const auto kept = std::make_shared<Kept>();
  serve::SessionSettings settings;
  settings.udp = kept;
  support::Served served(support::served_scenario, settings);
  kept->taken = true;
  EXPECT_THAT(served.refusal(line + "}"), HasSubstr("another session"));
  kept->taken = false;
  EXPECT_THAT(served.refusal(line + R"(, "block": 50})"), HasSubstr("at most 100000 bytes"));
  EXPECT_FALSE(kept->taken);
}

TEST(Stream, PlacesAreChecked) {
  const auto refused = [](const std::string& place, const std::string& interface = "") {
    try {
      serve::UdpOutlet(place, interface, [](const std::string&) {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  for (const char* wrong : {"", "4711", ":4711", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0",
                            "127.0.0.1:65536", "127.0.0.1:4711x", "::1:4711"})
    EXPECT_THAT(refused(wrong), HasSubstr("expected HOST:PORT")) << wrong;
  EXPECT_EQ(refused("127.0.0.1:4711"), "taken");
  EXPECT_THAT(refused("239.1.2.3:4711", "lo"), HasSubstr("--udp-interface: found \"lo\""));
}

}  // namespace
}  // namespace asdic::detail
