#include "app/export_wav.h"

#include <fmt/format.h>

#include <vector>

#include "app/console.h"
#include "core/error.h"
#include "io/wav/wav.h"

namespace asdic::detail::app {

void WavExport::check(const PingFile& file, const ExportChoice& choice) {
  if (file.is_complex())
    throw InputError({.where = choice.file.string(),
                      .got = "complex baseband",
                      .expected = "pressure: pings.samples = \"pressure\" in the scenario"});
}

void WavExport::write(const PingFile& file, const ExportChoice& choice) {
  const std::string stem = choice.file.stem().string();
  const std::vector<int> numbers = file.numbers();
  for (std::size_t i = choice.first; i < choice.end; ++i) {
    std::vector<float> pressure;
    for (std::size_t channel = 0; channel < file.channels(); ++channel) {
      const std::vector<float> phone = file.pressure(i, channel);
      pressure.insert(pressure.end(), phone.begin(), phone.end());
    }
    const std::filesystem::path path =
        choice.folder / fmt::format("{}_ping{:03}.wav", stem, numbers[i]);
    const WavScale scale =
        write_wav(path, pressure, file.channels(), file.sample_rate(), {.force = choice.force});
    print(fmt::format("{}: {}, {} Hz, full scale {:.6g} Pa\n", path.string(),
                      count_of(file.channels(), "channel"), scale.sample_rate,
                      scale.pascal_per_unit));
  }
}

}  // namespace asdic::detail::app
