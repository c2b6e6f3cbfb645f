#include <algorithm>
#include <cmath>

#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"
#include "io/wav/wav.h"

// A pulse out of a file of sound: finite samples, the loudest of which is 1.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  static const fuzz::Scratch folder;
  const auto path = folder.write("fuzz.wav", data, size);
  SampledPulse pulse;
  if (fuzz::refuses([&] { pulse = read_pulse_file(path); })) return 0;
  double peak = 0.0;
  for (const double x : pulse.samples) {
    fuzz::insist(std::isfinite(x), "samples are finite");
    peak = std::max(peak, std::abs(x));
  }
  fuzz::insist(pulse.samples.size() >= 2 && peak == 1.0, "a pulse is not silent");
  fuzz::insist(pulse.sample_rate > 0.0, "it has a sample rate");
  return 0;
}
