#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/wav.h"

namespace asdic::scenario {

PulseSettings read_pulse(TomlTable table, const std::filesystem::path& folder) {
  PulseSettings pulse;
  const std::string kind = table.choice("kind", {"cw", "lfm", "hfm", "file"});
  if (kind == "file") {
    pulse.kind = PulseKind::file;
    const std::filesystem::path path = folder / table.text("file");
    if (!std::filesystem::exists(path))
      throw table.fault("file", "a WAV or CSV file of the pulse",
                        "no such file " + in_quotes(path.string()));
    const SampledPulse sampled = read_pulse_file(path);
    pulse.file = path.string();
    pulse.samples = sampled.samples;
    pulse.sample_rate = sampled.sample_rate;
    pulse.duration = static_cast<double>(sampled.samples.size()) / sampled.sample_rate;
    pulse.window = PulseWindow::none;
  } else if (kind == "cw") {
    pulse.kind = PulseKind::cw;
    pulse.frequency = table.number("frequency", quantity::frequency);
  } else {
    pulse.kind = kind == "lfm" ? PulseKind::lfm : PulseKind::hfm;
    pulse.start_frequency = table.number("start_frequency", quantity::frequency);
    pulse.end_frequency = table.number("end_frequency", quantity::frequency);
    if (pulse.start_frequency == pulse.end_frequency)
      throw table.fault("end_frequency", "a frequency other than start_frequency (or kind \"cw\")");
  }
  if (kind != "file") {
    pulse.duration = table.number("duration", quantity::duration);
    const std::string window = table.choice("window", {"none", "hann", "tukey"}, "none");
    pulse.window = window == "hann"    ? PulseWindow::hann
                   : window == "tukey" ? PulseWindow::tukey
                                       : PulseWindow::none;
    if (window == "tukey")
      pulse.tukey_fraction = table.number(
          "tukey_fraction", {.noun = "fraction", .low = 0.0, .high = 1.0}, pulse.tukey_fraction);
  }
  table.finish();
  return pulse;
}

}  // namespace asdic::scenario
