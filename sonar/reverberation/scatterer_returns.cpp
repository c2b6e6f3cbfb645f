#include "sonar/reverberation/scatterer_returns.h"

#include "core/doppler.h"

namespace asdic::detail {

void add_return(const ScatteringField& field, const PathPairs& pairs, const PathPair& pair,
                const MetScatterer& met, std::complex<double> weight, ReturnBlock& into) {
  const std::complex<double> strength = met.strength * weight;
  into.returns.push_back({.delay = pair.delay,
                          .amplitude = pair.amplitude * strength,
                          .doppler = field.sheet.doppler(pair, met.velocity, met.bragg),
                          .slowness = met_by(pair.receiver->velocity, field.sheet.arriving(pair))});
  const std::size_t points = field.sheet.ends().band.size();
  const auto first = static_cast<std::size_t>(&pair - pairs.found.data()) * points;
  for (std::size_t k = 0; k < points; ++k)
    into.responses.emplace_back(pairs.responses[first + k] * strength);
}

void add_scatterers(const ScatteringField& field, const ScattererMeeting& meeting,
                    std::uint32_t begin, std::uint32_t end, ReturnBlock& into) {
  const ScattererWeights weights(field.field.statistics, field.weights, meeting.seed, meeting.time,
                                 meeting.ping);
  PathPairs pairs;
  for (std::uint32_t ring = begin; ring < end; ++ring)
    for (int sector = 0; sector < field.grid.azimuths; ++sector)
      for_each_scatterer(
          field, ring, sector, meeting, pairs,
          [&](const ScattererKey& /*key*/, std::uint64_t entity, const MetScatterer& met) {
            const std::complex<double> weight = weights(entity);
            for (const PathPair& pair : pairs.found)
              add_return(field, pairs, pair, met, weight, into);
          });
}

}  // namespace asdic::detail
