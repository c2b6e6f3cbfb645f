#include "serve/stream/descriptor.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "serve/token.h"
#include "sonar/ping/ping.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double between_descriptors = 1.0;  // of the stream [s]
/// A stream's number as 16 hexadecimal digits.
std::string text_of(std::uint64_t stream) {
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, stream >>= 4U)
    *digit = "0123456789abcdef"[stream & 15U];
  return text;
}

/// \throws std::invalid_argument
std::uint64_t stream_of(const std::string& text) {
  std::uint64_t stream = 0;
  std::from_chars(text.data(), text.data() + text.size(), stream, 16);
  if (text_of(stream) != text) throw std::invalid_argument("no number of a stream");
  return stream;
}

constexpr std::size_t most_channels = 1u << 20, most_samples = 1u << 28;

}  // namespace

std::string descriptor_text(const Descriptor& one) {
  OrderedJson json{{"stream", text_of(one.stream)},
                   {"block", one.block},
                   {"time", one.time},
                   {"sample_rate", one.sample_rate}};
  if (one.carrier) json["carrier"] = *one.carrier;
  json["channels"] = one.channels;
  json["block_samples"] = one.block_samples;
  json["unit"] = "Pa";
  json["type"] = one.carrier ? "complex64" : "float32";
  json["byte_order"] = "little";
  if (one.ended) json["ended"] = true;
  json["arrays"] = OrderedJson::array();
  for (const auto& array : one.arrays)
    json["arrays"].push_back({{"name", array.name}, {"phones", array.phones}});
  json["positions"] = OrderedJson::array();
  for (const Vec3& at : one.positions) json["positions"].push_back({at.x(), at.y(), at.z()});
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::optional<Descriptor> read_descriptor(std::string_view text) {
  try {
    const auto shallow = [](int level, nlohmann::json::parse_event_t, nlohmann::json&) {
      if (level > 4) throw std::invalid_argument("too deep");
      return true;
    };
    const nlohmann::json json = nlohmann::json::parse(text, shallow);
    Descriptor one{.stream = stream_of(json.at("stream")),
                   .block = json.at("block"),
                   .time = json.at("time"),
                   .sample_rate = json.at("sample_rate"),
                   .carrier = {},
                   .channels = json.at("channels"),
                   .block_samples = json.at("block_samples"),
                   .arrays = {},
                   .positions = {},
                   .ended = json.value("ended", false)};
    if (json.contains("carrier")) one.carrier = json.at("carrier").get<double>();
    for (const auto& array : json.at("arrays"))
      one.arrays.push_back({.name = array.at("name"), .phones = array.at("phones")});
    for (const auto& at : json.at("positions"))
      one.positions.emplace_back(at.at(0).get<double>(), at.at(1).get<double>(),
                                 at.at(2).get<double>());
    const bool sound = one.block >= 0 && std::isfinite(one.time) && one.sample_rate > 0.0 &&
                       std::isfinite(one.sample_rate) && one.carrier.value_or(1.0) > 0.0 &&
                       std::isfinite(one.carrier.value_or(1.0)) && one.channels >= 1 &&
                       one.channels <= most_channels && one.block_samples >= 1 &&
                       one.block_samples <= most_samples && one.positions.size() == one.channels;
    if (!sound) return std::nullopt;
    return one;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

Descriptor descriptor_of(const Listening::Block& block, std::uint64_t stream,
                         std::size_t block_samples) {
  const Scenario& scenario = block.place.simulator->scenario();
  Descriptor one{.stream = stream,
                 .block = block.number,
                 .time = block.time,
                 .sample_rate = recorded_rate(scenario),
                 .carrier = {},
                 .channels = block.channels,
                 .block_samples = block_samples,
                 .arrays = {},
                 .positions = {}};
  if (block.components > 1) one.carrier = recorded_carrier(scenario);
  for (const ArrayMotion& motion : array_motions(scenario)) {
    const Vec3 reference = motion.at(block.time).position;
    const std::vector<Vec3> phones = motion.phones(block.place.ping, block.time);
    one.arrays.push_back({.name = motion.array().name, .phones = phones.size()});
    for (const Vec3& phone : phones) one.positions.emplace_back(reference + phone);
  }
  return one;
}

DescribedStream::DescribedStream(std::size_t block_samples)
    : stream_(stream_of(new_token().substr(0, 16))), block_samples_(block_samples) {}

std::optional<std::string> DescribedStream::before(const Listening::Block& block) {
  next_ = block.number + 1;
  const double rate =
      latest_ ? latest_->sample_rate : recorded_rate(block.place.simulator->scenario());
  next_time_ = block.time + static_cast<double>(block.samples) / rate;
  const bool changed =
      !latest_ || place_.simulator != block.place.simulator || place_.ping != block.place.ping;
  if (!changed && block.time < latest_->time + between_descriptors) return std::nullopt;
  place_ = block.place;
  latest_ = descriptor_of(block, stream_, block_samples_);
  return descriptor_text(*latest_);
}

std::optional<std::string> DescribedStream::end() const {
  if (!latest_) return std::nullopt;
  Descriptor last = *latest_;
  last.block = next_;
  last.time = next_time_;
  last.ended = true;
  return descriptor_text(last);
}

}  // namespace asdic::detail::serve
