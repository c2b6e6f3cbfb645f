#include "sonar/reverberation/reverberation_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raytrace/ocean/absorption.h"
#include "sonar/scenario/ping_bounds.h"

namespace asdic::detail {
namespace {

using Response = std::function<double(double frequency)>;

constexpr double lowest = 1.0;  // [Hz]: below, no law of absorption or scattering means anything

/// Some number of points, and how well responses are interpolated through them.
class Trial {
 public:
  Trial(double centre, double half_width, std::size_t count)
      : nodes_(chebyshev_nodes(centre, half_width, count)) {
    const std::size_t tried = count <= 16 ? 32 : 4 * count;
    for (std::size_t i = 0; i <= tried; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(tried);
      between_.push_back(centre + half_width * (2.0 * share - 1.0));
      for (std::size_t k = 0; k < count; ++k) basis_.push_back(nodes_.basis(k, between_.back()));
    }
  }

  [[nodiscard]] std::size_t count() const noexcept { return nodes_.frequencies.size(); }
  /// How far interpolation through the points is off, over the largest value in the band.
  [[nodiscard]] double error_of(const Response& response) const {
    std::vector<double> known;
    for (const double f : nodes_.frequencies) known.push_back(response(std::max(lowest, f)));
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < between_.size(); ++i) {
      const double exact = response(std::max(lowest, between_[i]));
      double sum = 0.0;
      for (std::size_t k = 0; k < known.size(); ++k) sum += basis_[i * known.size() + k] * known[k];
      worst = std::max(worst, std::abs(sum - exact));
      largest = std::max(largest, std::abs(exact));
    }
    return largest > 0.0 ? worst / largest : 0.0;
  }

 private:
  BandNodes nodes_;
  std::vector<double> between_, basis_;
};

/// One more, but a quarter more where a kink asks for many: its error falls as 1/K.
std::size_t next_count(std::size_t count) noexcept {
  return std::min(ReverberationBand::most_points, count + (count < 16 ? 1 : count / 4));
}

/// Angles as boundaries see them.
std::vector<ScatterGeometry> geometries() {
  std::vector<ScatterGeometry> all;
  for (const double in : {2.0, 8.0, 20.0, 45.0, 80.0})
    for (const double out : {2.0, 20.0, 80.0})
      for (const double rotation : {180.0, 90.0})
        all.push_back(
            {.grazing_in = radians(in), .grazing_out = radians(out), .azimuth = radians(rotation)});
  return all;
}

}  // namespace

ReverberationBand::ReverberationBand(const Scenario& scenario, const PropagationPaths& paths,
                                     std::span<const ScatteringSheet::Law> laws,
                                     const Transmitter& projector, const Kinematics& source,
                                     double heading, double centre, double half_band,
                                     double latest) {
  const auto nepers_per_metre = [&](double frequency) {
    return absorption_db_per_km(scenario.environment.absorption, frequency) / 1000.0 *
           std::numbers::ln10 / 20.0;
  };
  const double at_centre = nepers_per_metre(centre);
  const double longest = fastest_water(scenario.environment) * latest;
  std::vector<Response> responses;
  for (const double length : {0.0, longest}) {
    const auto water = [=](double f) {
      return std::exp(-(nepers_per_metre(f) - at_centre) * length);
    };
    responses.emplace_back(water);
    for (const ScatteringSheet::Law& law : laws)
      for (const ScatterGeometry& geometry : geometries())
        responses.emplace_back([=](double f) {
          return water(f) * std::sqrt(std::visit(
                                [&](const auto& l) { return l.cross_section(geometry, f); }, law));
        });
  }
  Trial trial(centre, half_band, 1);
  for (const Response& response : responses)
    while (trial.count() < most_points && trial.error_of(response) > error)
      trial = Trial(centre, half_band, next_count(trial.count()));
  for (const Response& response : responses)
    reached_ = std::max(reached_, trial.error_of(response));

  const double c = paths.speed_at(source.position);
  const auto pattern_at = [&](double frequency) {
    return BeamPattern(projector, c / frequency, c, heading, c / centre);
  };
  // A product of polynomials of K₁ and K₂ points is one of K₁ + K₂ − 1.
  const std::size_t count =
      trial.count() + nodes_for(0.0, pi * half_band * pattern_at(centre).longest_delay(), error) -
      1;
  nodes_ = chebyshev_nodes(centre, half_band, count);
  for (const double f : nodes_.frequencies) patterns_.push_back(pattern_at(std::max(lowest, f)));
  for (std::size_t k = 0; k < count; ++k) {
    const double f = std::max(lowest, nodes_.frequencies[k]);
    points_.push_back(
        {.frequency = f, .pattern = &patterns_[k], .more_nepers = nepers_per_metre(f) - at_centre});
  }
}

std::vector<std::function<double(double)>> ReverberationBand::filters() const {
  std::vector<std::function<double(double)>> all;
  for (std::size_t k = 0; k < points_.size(); ++k)
    all.emplace_back([this, k](double beside) { return nodes_.basis(k, nodes_.centre + beside); });
  return all;
}

}  // namespace asdic::detail
