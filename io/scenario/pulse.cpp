#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/settings/reader.h"
#include "io/wav.h"

namespace asdic::scenario {

PulseSettings read_pulse(TomlTable table, const std::filesystem::path& folder) {
  PulseSettings pulse;
  pulse.kind = read_word(table, required("kind"), pulse.kind);
  if (pulse.kind == PulseKind::file) {
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
  } else if (pulse.kind == PulseKind::cw) {
    pulse.frequency = table.number("frequency", quantity::frequency);
  } else {
    pulse.start_frequency = table.number("start_frequency", quantity::frequency);
    pulse.end_frequency = table.number("end_frequency", quantity::frequency);
    if (pulse.start_frequency == pulse.end_frequency)
      throw table.fault("end_frequency", "a frequency other than start_frequency (or kind \"cw\")");
  }
  if (pulse.kind != PulseKind::file) {
    pulse.duration = table.number("duration", quantity::duration);
    pulse.window = read_word(table, "window", PulseWindow::none);
    if (pulse.window == PulseWindow::tukey)
      pulse.tukey_fraction = table.number(
          "tukey_fraction", {.noun = "fraction", .low = 0.0, .high = 1.0}, pulse.tukey_fraction);
  }
  table.finish();
  return pulse;
}

}  // namespace asdic::scenario
