#include "fuzz/fuzz_target.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"

// A scenario file: as a sonar's scenario, and as a run of the propagation model. The files that its
// seeds name are there.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  const std::string text(fuzz::text(data, size));
  const std::filesystem::path path = ASDIC_FUZZ_COMPANIONS "/fuzz.toml";
  (void)fuzz::refuses([&] { (void)parse_scenario(text, path); });
  std::vector<std::string> notes;
  (void)fuzz::refuses([&] { (void)parse_propagation_case(text, path, {}, notes); });
  return 0;
}
