#include "app/export_wav.h"

#include <fmt/format.h>

#include <vector>

#include "app/console.h"
#include "core/error.h"
#include "io/wav/wav.h"

namespace asdic::detail::app {

void WavExport::check(const PingFile& file, const ExportChoice& choice) {
  const std::size_t channels = file.channels() * (file.is_complex() ? 2 : 1);
  if (channels > most_wav_channels)
    throw InputError(
        {.where = choice.file.string(),
         .got = fmt::format("{}, {} channels", count_of(file.channels(), "phone"), channels),
         .expected = fmt::format("at most {} channels, two a phone of complex "
                                 "baseband; --mat takes them all",
                                 most_wav_channels)});
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
        write_wav(path, pressure, {.phones = file.channels(), .carrier = file.carrier()},
                  file.sample_rate(), {.force = choice.force});
    const std::size_t channels = file.channels() * (file.is_complex() ? 2 : 1);
    print(fmt::format(
        "{}: {}{}, {} Hz, full scale {:.6g} Pa\n", path.string(), count_of(channels, "channel"),
        file.is_complex() ? fmt::format(" (I and Q about {:g} Hz)", file.carrier()) : "",
        scale.sample_rate, scale.pascal_per_unit));
  }
}

}  // namespace asdic::detail::app
