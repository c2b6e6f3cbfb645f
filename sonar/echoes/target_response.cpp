#include "sonar/echoes/target_response.h"

#include <cmath>

#include "core/mixed_bits.h"
#include "core/random.h"

namespace asdic::detail {
namespace {

/// Distinct for all looks of one kind: 16 bits each.
std::uint64_t entity(std::uint64_t target, int highlight, const Look& look) {
  const auto word = [](int value, int place) {
    return static_cast<std::uint64_t>(value & 0xffff) << (16 * place);
  };
  return mixed(target, word(highlight + 1, 1) | word(look.transmitter, 2) | word(look.platform, 3));
}

}  // namespace

std::uint64_t target_identity(const Scenario& scenario, int target) {
  const std::string& name = scenario.targets[static_cast<std::size_t>(target)].name;
  std::uint64_t identity = 0;
  for (int before = 0; before < target; ++before)
    if (scenario.targets[static_cast<std::size_t>(before)].name == name) ++identity;
  for (const char letter : name) identity = mixed(identity, static_cast<unsigned char>(letter));
  return identity;
}

std::complex<double> fluctuation(const Scenario& scenario, int target, int highlight,
                                 const Look& look) {
  const Target& one = scenario.targets[static_cast<std::size_t>(target)];
  if (one.fluctuation == Fluctuation::none) return 1.0;
  const bool by_scan =
      one.fluctuation == Fluctuation::swerling_1 || one.fluctuation == Fluctuation::swerling_3;
  const int realisation = by_scan ? (look.own_ping - 1) / one.scan_pings : look.ping;
  RandomStream draw(scenario.seed, Draw::target_fluctuation,
                    static_cast<std::uint32_t>(realisation),
                    entity(target_identity(scenario, target), highlight, look));
  const std::complex<double> w = draw.complex_normal();
  if (one.fluctuation == Fluctuation::swerling_1 || one.fluctuation == Fluctuation::swerling_2)
    return w;  // |w|² is exponential
  // Chi-square with four degrees of freedom is the mean of two exponentials; the phase is w's.
  const double power = 0.5 * (std::norm(w) + std::norm(draw.complex_normal()));
  return std::sqrt(power) * w / std::abs(w);
}

std::vector<Glint> glints(const Scenario& scenario, int target, const Look& look, const Vec3& in,
                          const Vec3& out, double time) {
  const Target& body = scenario.targets[static_cast<std::size_t>(target)];
  const double heading = heading_of(body, time);
  const double aspect = aspect_of(in, out, heading);
  const auto amplitude = [&](double strength, int highlight) {
    return amplitude_from_db(strength) * fluctuation(scenario, target, highlight, look);
  };
  if (body.highlights.empty()) return {{.amplitude = amplitude(strength_db(body, aspect), -1)}};
  const double from = aspect_of(in, -in, heading), to = aspect_of(-out, out, heading);
  std::vector<Glint> seen;
  for (std::size_t h = 0; h < body.highlights.size(); ++h) {
    const Highlight& one = body.highlights[h];
    if (body.hull && (hidden(*body.hull, one.offset, from) || hidden(*body.hull, one.offset, to)))
      continue;
    const int index = static_cast<int>(h);
    seen.push_back(
        {.highlight = index,
         .offset = from_body(one.offset, heading),
         .amplitude = amplitude(one.aspect ? one.aspect->at(aspect) : one.strength_db, index)});
  }
  return seen;
}

}  // namespace asdic::detail
