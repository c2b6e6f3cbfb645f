#include <oneapi/tbb/parallel_for.h>

#include <cassert>
#include <cmath>

#include "core/units.h"
#include "sonar/synthesis.h"
#include "sonar/synthesis_plan.h"

namespace asdic {
/// p₊(t)·e^{−i2πf_c t} = A·c(u)·e^{i2π(f·u − f_c·t)}, u = u(t') − T/2 from the pulse's middle.
void Synthesizer::add_curved(std::span<const CurvedReturn> returns, std::span<const Vec3> phones,
                             Baseband& baseband) const {
  const Plan& plan = plan_.front();
  assert(baseband.channels == phones.size() && baseband.samples == plan.length);
  const BandLimitedPulse& pulse = plan.pulses.front();
  const auto period = static_cast<std::ptrdiff_t>(plan.length);
  const double start = plan.recording.start;
  const double record_end =
      start + static_cast<double>(plan.recording.samples) / plan.recording.sample_rate;
  const double longest = pulse.half_duration() / (1.0 - plan.max_doppler);
  oneapi::tbb::parallel_for(std::size_t{0}, phones.size(), [&](std::size_t channel) {
    std::complex<float>* row = baseband.values.data() + channel * plan.length;
    for (const CurvedReturn& r : returns) {
      if (r.straight.channel != Return::all_channels &&
          r.straight.channel != static_cast<int>(channel))
        continue;
      const bool own = r.straight.channel != Return::all_channels;
      const Vec3 x = own ? Vec3(Vec3::Zero()) : phones[channel];
      const double ringing =
          (pulse.half_duration() - 0.5 * plan.pulse_duration) / (1.0 - plan.max_doppler);
      const auto& pieces = r.curve.pieces();
      const double from = r.curve.first_heard() + pieces.front().first_slowness.dot(x) - ringing;
      const double to = r.curve.last_heard() + pieces.back().last_slowness.dot(x) + ringing;
      const double middle = 0.5 * (from + to);  // beyond these nothing reaches the record
      if (middle < start - longest || middle > record_end + longest) continue;
      const auto last = static_cast<std::ptrdiff_t>(std::floor((to - start) * plan.rate));
      for (auto i = static_cast<std::ptrdiff_t>(std::ceil((from - start) * plan.rate)); i <= last;
           ++i) {
        const double t = start + static_cast<double>(i) / plan.rate;
        const double u = r.curve.sent_at(t, x) - 0.5 * plan.pulse_duration;
        const double cycles = pulse.centre_frequency() * u - plan.carrier * t;
        const std::complex<double> value =
            r.straight.amplitude * pulse.at(u) *
            std::polar(1.0, 2.0 * pi * (cycles - std::round(cycles)));
        row[(i % period + period) % period] += std::complex<float>(value);
      }
    }
  });
}

}  // namespace asdic
