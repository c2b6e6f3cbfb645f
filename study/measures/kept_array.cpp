#include "study/measures/kept_array.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "io/processing/table.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/power_spectrum.h"
#include "study/measures/receiver_measure.h"

namespace asdic::detail::study {
namespace {

constexpr double finest_by_default = 1.0;  // [Hz]

std::array<KeptKind, 2> all_kinds() {
  KeptKind spectra{
      .name = "spectra",
      .layout = KeptKind::Layout::padded,
      .count = {"valid_frequencies", "frequencies before the padding", "", ElementType::int32},
      .head = {{"first_frequency", "of the first of them", "Hz"},
               {"frequency_step", "from one to the next", "Hz"},
               {"segments", "whose mean the spectrum of a phone is, half over one another", "",
                ElementType::int32}},
      .values = {{"power",
                  "one-sided power spectral density of what is received, by Welch's method",
                  "Pa2/Hz"}},
      .line = "channel",
      .number = "frequency",
      .line_says = "no values: number of the phone, from 0; the mean of all where there is one",
      .number_says = "no values: number k is at first_frequency + k frequency_step"};
  KeptKind detections{.name = "detections",
                      .layout = KeptKind::Layout::ragged,
                      .count = {"count", "detections of the realisation", "", ElementType::int32},
                      .head = {},
                      .values = processing::detection_columns(),
                      .line = "realisation",
                      .number = ""};
  return {std::move(spectra), std::move(detections)};
}

/// Samples of a segment. \param samples  of the record
std::size_t length_of_segments(const SpectrumPlan& plan, double rate, std::size_t samples) {
  const double seconds = static_cast<double>(samples) / rate;
  if (plan.resolution) {
    const std::size_t length = segment_length(rate, *plan.resolution);
    if (length <= samples) return length;
    throw InputError(
        {.where = "measure.spectra.resolution",
         .got = to_text(*plan.resolution) + " Hz of a record of " + to_text(seconds) + " s",
         .expected = to_text(std::ceil(100.0 / seconds) / 100.0) +
                     " Hz or a little more, which a segment of all of the record has"});
  }
  std::size_t half = samples / 9;  // of eight segments, each half over the last
  if (half < 2)
    throw InputError({.where = "measure.spectra",
                      .got = "a record of " + std::to_string(samples) + " samples",
                      .expected = "18 or more"});
  while (fast_fft_length(half) != half) --half;
  return std::min(segment_length(rate, finest_by_default), 2 * half);
}

PowerSpectrum of_phone(const ArrayRecording& received, std::size_t phone, std::size_t length) {
  const std::size_t phones = received.phones.size();
  const auto part = [&](const auto& all) {
    const std::size_t samples = all.size() / phones;
    return std::span(all).subspan(phone * samples, samples);
  };
  if (received.carrier)
    return power_spectrum(part(received.envelope), received.sample_rate, *received.carrier, length);
  return power_spectrum(part(received.pressure), received.sample_rate, length);
}

}  // namespace

std::span<const KeptKind> kept_kinds() {
  static const std::array<KeptKind, 2> all = all_kinds();
  return all;
}
const KeptKind& spectra_kind() { return kept_kinds()[0]; }
const KeptKind& detections_kind() { return kept_kinds()[1]; }

KeptArray kept_spectrum(const ArrayRecording& received, const SpectrumPlan& plan) {
  const std::size_t phones = received.phones.size();
  const std::size_t samples =
      (received.carrier ? received.envelope.size() : received.pressure.size()) / phones;
  const std::size_t length = length_of_segments(plan, received.sample_rate, samples);
  KeptArray made{.name = std::string(spectra_kind().name)};
  for (std::size_t phone = 0; phone < phones; ++phone) {
    const PowerSpectrum one = of_phone(received, phone, length);
    if (phone == 0) {
      made.head = {one.first_frequency, one.frequency_step, static_cast<double>(one.segments)};
      made.shape = {plan.each_phone ? phones : 1, one.density.size()};
      made.values.reserve(made.shape[0] * made.shape[1]);
    }
    if (plan.each_phone || phone == 0)
      made.values.insert(made.values.end(), one.density.begin(), one.density.end());
    else
      for (std::size_t k = 0; k < one.density.size(); ++k) made.values[k] += one.density[k];
  }
  if (!plan.each_phone)
    for (double& power : made.values) power /= static_cast<double>(phones);
  return made;
}

KeptArray kept_detections(const ReceiverAnswers& answers) {
  KeptArray made{.name = std::string(detections_kind().name),
                 .shape = {answers.detections.size(), detections_kind().values.size()}};
  for (std::size_t i = 0; i < answers.detections.size(); ++i) {
    const std::vector<double> line =
        processing::detection_row(answers.detections[i], answers.places.owner[i]);
    made.values.insert(made.values.end(), line.begin(), line.end());
  }
  return made;
}

}  // namespace asdic::detail::study
