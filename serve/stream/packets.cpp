#include "serve/stream/packets.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace asdic::detail::serve {
namespace {

static_assert(std::endian::native == std::endian::little, "headers go out as they lie in memory");
constexpr std::uint8_t packet_version = 2;

template <class T>
void put(char* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

template <class T>
T get(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

std::optional<Packet> read_packet(std::string_view bytes) {
  if (bytes.size() <= Packet::header_bytes || bytes.size() > Packet::header_bytes + most_payload ||
      bytes[0] != 'A' || bytes[1] != 'S' || get<std::uint8_t>(bytes, 2) != packet_version ||
      get<std::uint8_t>(bytes, 3) > 1)
    return std::nullopt;
  const Packet packet{.kind = PacketKind{get<std::uint8_t>(bytes, 3)},
                      .sequence = get<std::uint32_t>(bytes, 4),
                      .block = get<std::uint32_t>(bytes, 8),
                      .fragment = get<std::uint16_t>(bytes, 12),
                      .fragments = get<std::uint16_t>(bytes, 14),
                      .stream = get<std::uint64_t>(bytes, 16),
                      .payload = bytes.substr(Packet::header_bytes)};
  if (packet.fragment >= packet.fragments) return std::nullopt;
  if (packet.fragment + 1 < packet.fragments && packet.payload.size() != most_payload)
    return std::nullopt;
  return packet;
}

void Packets::split(PacketKind kind, std::uint64_t stream, std::int64_t block,
                    std::string_view message, const Send& send) {
  assert(!message.empty() && message.size() <= longest_message);
  const std::size_t fragments = (message.size() + most_payload - 1) / most_payload;
  char* const header = packet_.data();
  put(header, 'A');
  put(header + 1, 'S');
  put(header + 2, packet_version);
  put(header + 3, static_cast<std::uint8_t>(kind));
  put(header + 8, static_cast<std::uint32_t>(block));
  put(header + 14, static_cast<std::uint16_t>(fragments));
  put(header + 16, stream);
  for (std::size_t i = 0; i < fragments; ++i) {
    const std::string_view piece = message.substr(i * most_payload, most_payload);
    put(header + 4, sequence_++);
    put(header + 12, static_cast<std::uint16_t>(i));
    std::copy(piece.begin(), piece.end(), header + Packet::header_bytes);
    send({header, Packet::header_bytes + piece.size()});
  }
}

}  // namespace asdic::detail::serve
