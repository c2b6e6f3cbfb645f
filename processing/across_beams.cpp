#include "processing/across_beams.h"

#include "core/units.h"

namespace asdic::detail {
namespace {

/// In even noise false alarms come where the background is found at half its value and the beams
/// around find 1 ± 0.3 of it: three times as much is seen by some hundredths of them.
constexpr float louder = 3.0F;

}  // namespace

AcrossBeams::AcrossBeams(const ArrayShape& shape, std::span<const Vec3> phones,
                         std::span<const double> weights, std::span<const Vec3> looks,
                         double wavelength, std::size_t filters, std::size_t samples, double cell)
    : phones_(phones),
      weights_(weights),
      looks_(looks.begin(), looks.end()),
      wavenumber_(2.0 * pi / wavelength),
      around_(shape, looks, wavelength),
      received_(filters, looks.size(), samples, cell) {}

const OwnLeak& AcrossBeams::leak_of(std::size_t beam) {
  if (const auto known = leaks_.find(beam); known != leaks_.end()) return known->second;
  const auto pattern = [&](std::size_t other) {
    return beam_pattern(phones_, weights_, looks_[other], looks_[beam], wavenumber_);
  };
  return leaks_.emplace(beam, OwnLeak(around_, beam, pattern)).first->second;
}

float AcrossBeams::background(std::size_t filter, std::size_t beam, std::size_t sample,
                              double power, float over_time) {
  const auto received = [&](const OwnLeak& leak) {
    return received_.background(around_, filter, beam, sample, power, leak, scratch_);
  };
  if (!(received({}) > louder * over_time)) return over_time;  // mostly: no need to know the leak
  const float around = received(leak_of(beam));
  return around > louder * over_time ? around : over_time;
}

}  // namespace asdic::detail
