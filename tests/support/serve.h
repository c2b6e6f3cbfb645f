#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "serve/session.h"
#include "support/temporary_directory.h"

namespace asdic::detail::support {

/// A small sea, as tests of `asdic serve` ping it: complex baseband, nothing that takes long.
inline constexpr const char* served_scenario = R"(title = "SECRET title"
seed = 3
[environment]
wind_speed = 8.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[environment.absorption]
kind = "none"
[platform]
position = [0.0, 0.0, 200.0]
[transmitter]
source_level_db = 200.0
elevation_deg = 0.0
beamwidth_deg = 20.0
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
window = "hann"
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
name = "rock"
position = [3000.0, 0.0, 200.0]
strength_db = 10.0
[noise]
spectral_level_db = 40.0
[reverberation]
azimuths = 8
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
count = 3
interval = 10.0
recording_duration = 5.0
samples = "baseband"
baseband_rate = 200.0
)";

/// A session without sockets, on a clock that goes when it is told to.
class Served {
 public:
  explicit Served(const std::string& text = served_scenario, serve::SessionSettings settings = {})
      : settings_(std::move(settings)) {
    settings_.scenario = {.text = text, .path = folder / "SECRET_scenario.toml", .overrides = {}};
    settings_.report = [this](const std::string& line) { log += line + '\n'; };
    session_ = std::make_unique<serve::Session>(settings_, [this] { return clock; });
  }

  nlohmann::json operator()(const std::string& line) {
    last = session_->answer(line);
    return nlohmann::json::parse(last.line);
  }

  /// "CODE: MESSAGE" of a refusal; what was answered if it is none.
  std::string refusal(const std::string& line) {
    const nlohmann::json said = (*this)(line);
    if (said["ok"] == true) return said.dump();
    return said["error"]["code"].get<std::string>() + ": " +
           said["error"]["message"].get<std::string>();
  }

  serve::Session& session() { return *session_; }

  TemporaryDirectory folder;
  double clock = 1000.0;
  std::string log;
  serve::Answer last;

 private:
  serve::SessionSettings settings_;
  std::unique_ptr<serve::Session> session_;
};

}  // namespace asdic::detail::support
