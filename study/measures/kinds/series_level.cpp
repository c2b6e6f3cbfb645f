#include "study/measures/kinds/series_level.h"

#include <algorithm>

namespace asdic::detail::study {

void SeriesLevel::of_ping(const MeasuredPing& ping, Collector& to) {
  double sum = 0.0, peak = 0.0;
  std::size_t count = 0;
  if (ping) {
    const Recording& r = ping.record->recording;
    const auto array = static_cast<std::size_t>(ping.plan.array);
    count = ping.scenario.arrays[array].phones.size() * r.samples;
    const float* p = ping.record->pressure.data() +
                     first_channel(ping.scenario, ping.plan.array) * r.samples * r.components();
    for (std::size_t i = 0; i < count; ++i) {
      const double power =
          r.is_complex() ? static_cast<double>(p[2 * i] * p[2 * i] + p[2 * i + 1] * p[2 * i + 1])
                         : 2.0 * static_cast<double>(p[i] * p[i]);
      sum += power;
      peak = std::max(peak, power);
    }
  }
  const auto level = [](double envelope_squared) {
    return db_from_power(0.5 * envelope_squared / (micropascal * micropascal));
  };
  to.add("series_rms_db", level_unit, "rms of all samples of the array",
         count == 0 ? no_value : level(sum / static_cast<double>(count)));
  to.add("series_peak_db", level_unit, "greatest of all samples: envelope/√2, of pressure |p|",
         level(peak));
}

}  // namespace asdic::detail::study
