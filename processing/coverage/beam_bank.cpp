#include "processing/coverage/beam_bank.h"

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "processing/signal_excess.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// Extents of an array, all of it.
struct Extents {
  double level = 0.0, upright = 0.0;  // [m]
};

Extents extents_of(std::span<const Vec3> phones) {
  Extents found;
  double low = infinity, high = -infinity;
  for (const Vec3& a : phones) {
    low = std::min(low, a.z());
    high = std::max(high, a.z());
    for (const Vec3& b : phones) found.level = std::max(found.level, (a - b).head<2>().norm());
  }
  if (high > low) found.upright = high - low;
  return found;
}

}  // namespace

ElevationNodes::ElevationNodes(std::span<const Vec3> phones, double wavelength) {
  // A line resolves λ/L of the sine across itself; two nodes in that. Level arrays change with the
  // cosine, slowly about the horizontal, and receive the mean over a cone anyhow.
  constexpr double coarse[] = {0.0, 3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 48.0, 62.0, 78.0};  // [°]
  constexpr double unresolved = 0.1, most = 128.0;
  const Extents extents = extents_of(phones);
  mirrored_ = extents.upright < unresolved * wavelength;
  if (mirrored_) {
    for (const double angle : coarse) sines_.push_back(std::sin(radians(angle)));
    return;
  }
  std::vector<double> all;
  for (const double angle : coarse)
    for (const double sign : {-1.0, 1.0}) all.push_back(sign * std::sin(radians(angle)));
  const int fine = static_cast<int>(std::clamp(4.0 * extents.upright / wavelength, 8.0, most));
  for (int i = 0; i <= fine; ++i) all.push_back(-1.0 + 2.0 * i / fine);
  std::sort(all.begin(), all.end());
  const double least = 0.5 / fine;
  for (const double s : all)
    if (sines_.empty() || s - sines_.back() > least) sines_.push_back(s);
}

double ElevationNodes::elevation(std::size_t node) const noexcept {
  return std::asin(std::clamp(sines_[node], -1.0, 1.0));
}

ElevationNodes::Place ElevationNodes::at(double elevation) const noexcept {
  const double s = mirrored_ ? std::abs(std::sin(elevation)) : std::sin(elevation);
  const auto above = std::upper_bound(sines_.begin(), sines_.end(), s);
  if (above == sines_.begin()) return {};
  const auto i = static_cast<std::size_t>(above - sines_.begin()) - 1;
  if (i + 1 == sines_.size()) return {i, 1.0};
  return {i, (sines_[i + 1] - s) / (sines_[i + 1] - sines_[i])};
}

std::size_t ElevationNodes::nearest(double elevation) const noexcept {
  const Place place = at(elevation);
  return place.share >= 0.5 ? place.node : place.node + 1;
}

BeamBank::BeamBank(std::vector<Vec3> phones, double frequency, double sound_speed, int sectors,
                   const ElevationNodes& nodes, const NoiseField& noise)
    : phones_(std::move(phones)),
      angular_frequency_(2.0 * pi * frequency),
      sound_speed_(sound_speed),
      sectors_(sectors),
      nodes_(nodes),
      coherence_(noise_coherences(phones_, angular_frequency_ / sound_speed, noise)) {
  // |w·e|² over the bearing has no more harmonics than kL: a mean of so many places is exact.
  const double waves = angular_frequency_ / sound_speed * extents_of(phones_).level;
  parts_ = static_cast<int>(std::clamp(std::ceil((2.0 * waves + 16.0) / sectors), 1.0, 64.0));
  if (omnidirectional()) return;
  const std::size_t elevations = nodes_.size(),
                    rows = static_cast<std::size_t>(sectors_ * parts_) * elevations;
  real_.resize(rows * phones_.size());
  imaginary_.resize(rows * phones_.size());
  in_parallel(phones_.size(), [&](std::size_t i) {
    for (std::size_t row = 0; row < rows; ++row) {
      const double bearing =
          2.0 * pi * (static_cast<double>(row / elevations) + 0.5) / (sectors_ * parts_);
      const double phase = -angular_frequency_ *
                           slowness(bearing, nodes_.elevation(row % elevations)).dot(phones_[i]);
      real_[i * rows + row] = static_cast<float>(std::cos(phase));
      imaginary_[i * rows + row] = static_cast<float>(std::sin(phase));
    }
  });
}

/// Of sound that comes from there.
Vec3 BeamBank::slowness(double bearing, double elevation) const noexcept {
  return -direction(bearing, elevation) / sound_speed_;
}

void BeamBank::beam(double bearing, std::size_t node, std::span<float> received) const {
  std::fill(received.begin(), received.end(), omnidirectional() ? 1.0F : 0.0F);
  if (omnidirectional()) return;
  const std::size_t nodes = nodes_.size(), rows = real_.size() / phones_.size();
  const Vec3 s = slowness(bearing, nodes_.elevation(node));
  std::vector<float> re(rows, 0.0F), im(rows, 0.0F);
  for (std::size_t i = 0; i < phones_.size(); ++i) {
    const double phase = angular_frequency_ * s.dot(phones_[i]);
    const auto n = static_cast<double>(phones_.size());
    const auto c = static_cast<float>(std::cos(phase) / n),
               d = static_cast<float>(std::sin(phase) / n);
    const float* const a = &real_[i * rows];
    const float* const b = &imaginary_[i * rows];
    for (std::size_t row = 0; row < rows; ++row) {
      re[row] += c * a[row] - d * b[row];
      im[row] += c * b[row] + d * a[row];
    }
  }
  const auto parts = static_cast<std::size_t>(parts_);
  for (std::size_t row = 0; row < rows; ++row)
    received[row / nodes / parts * nodes + row % nodes] +=
        (re[row] * re[row] + im[row] * im[row]) / static_cast<float>(parts);
}

double BeamBank::gain_over_noise_db(double bearing, std::size_t node) const {
  return asdic::detail::gain_over_noise_db(phones_, slowness(bearing, nodes_.elevation(node)),
                                           angular_frequency_, coherence_);
}

}  // namespace asdic::detail
