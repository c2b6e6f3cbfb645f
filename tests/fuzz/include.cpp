#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"
#include "io/scenario/scenario_reader.h"

// The file that a scenario includes.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  static const fuzz::Scratch folder;
  folder.write("ocean.toml", data, size);
  static const std::string scenario = R"(include = "ocean.toml"
platform = { position = [0.0, 0.0, 20.0] }
transmitter = { source_level_db = 200.0, taper = "omnidirectional" }
pulse = { kind = "cw", frequency = 1000.0, duration = 0.1 }
array = { kind = "horizontal", phones = 2, spacing = 0.75 }
pings = { samples = "baseband", recording_duration = 5.0 }
)";
  (void)fuzz::refuses([&] { (void)parse_scenario(scenario, folder / "fuzz.toml"); });
  return 0;
}
