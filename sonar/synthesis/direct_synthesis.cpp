#include "sonar/synthesis/direct_synthesis.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

std::vector<double> direct_synthesis(const Pulse& pulse, const Recording& recording,
                                     std::span<const Return> returns,
                                     std::span<const Vec3> phones) {
  std::vector<double> pressure(phones.size() * recording.samples, 0.0);
  const auto count = static_cast<double>(recording.samples);
  for (std::size_t n = 0; n < phones.size(); ++n) {
    double* row = pressure.data() + n * recording.samples;
    for (const Return& r : returns) {
      if (r.channel != Return::all_channels && static_cast<std::size_t>(r.channel) != n) continue;
      const double delay = r.delay + r.slowness.dot(phones[n]);
      const double first = (delay - recording.start) * recording.sample_rate;
      const double last = first + pulse.duration() / r.doppler * recording.sample_rate;
      const double end = std::min(last + 1.0, count - 1.0);
      for (auto i = static_cast<std::size_t>(std::max(0.0, first)); static_cast<double>(i) <= end;
           ++i) {
        const double t = recording.start + static_cast<double>(i) / recording.sample_rate;
        row[i] += (r.amplitude * pulse.analytic(r.doppler * (t - delay))).real();
      }
    }
  }
  return pressure;
}

}  // namespace asdic::detail
