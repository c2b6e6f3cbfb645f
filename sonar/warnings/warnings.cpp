#include "sonar/warnings/warnings.h"

namespace asdic::detail {

std::vector<std::string> warnings(const Scenario& scenario) {
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  std::vector<std::string> all = warnings(scenario.environment, pulse.lowest, pulse.highest);
  add_warnings({checks::pulse_band(scenario), checks::noise_law_range(scenario),
                checks::noise_table_band(scenario), checks::surface_scattering_range(scenario),
                checks::reverberation_plane_waves(scenario), checks::noise_of_a_bent_line(scenario),
                checks::noise_from_below(scenario), checks::left_out_diffraction(scenario),
                checks::scattering_energy(scenario)},
               all);
  return all;
}

}  // namespace asdic::detail
