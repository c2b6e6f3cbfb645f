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

/// Unit vector along phones that lie on one line; none where some are aside of it.
std::optional<Vec3> axis_of(std::span<const Vec3> phones, double wavelength) {
  constexpr double aside = 0.01;  // of the wavelength
  Vec3 longest = Vec3::Zero();
  for (const Vec3& phone : phones)
    if ((phone - phones[0]).norm() > longest.norm()) longest = phone - phones[0];
  if (!(longest.norm() > 0.0)) return std::nullopt;
  const Vec3 axis = longest.normalized();
  for (const Vec3& phone : phones)
    if (((phone - phones[0]) - axis.dot(phone - phones[0]) * axis).norm() > aside * wavelength)
      return std::nullopt;
  return axis;
}

}  // namespace

ElevationNodes::ElevationNodes(std::span<const Vec3> phones, double wavelength) {
  // A line resolves λ/L of the sine across itself; two nodes in that. A level array resolves λ/L of
  // the cosine, at endfire: slowly about the horizontal.
  constexpr double coarse[] = {0.0, 3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 48.0, 62.0, 78.0};  // [°]
  constexpr double unresolved = 0.1, most = 128.0;
  const Extents extents = extents_of(phones);
  mirrored_ = extents.upright < unresolved * wavelength;
  if (mirrored_) {
    // Of others than lines each node costs a sum over the phones.
    const double most_level = axis_of(phones, wavelength) ? 96.0 : 24.0;
    constexpr double steepest = 78.0;
    double step = 1.0 - std::cos(radians(steepest));  // of the cosine
    step /= std::clamp(2.0 * step * extents.level / wavelength, 1.0, most_level);
    for (std::size_t i = 0; i + 1 < std::size(coarse); ++i) {
      const double from = std::cos(radians(coarse[i])), to = std::cos(radians(coarse[i + 1]));
      const int parts = std::max(1, static_cast<int>(std::ceil((from - to) / step - 1e-6)));
      for (int k = 0; k < parts; ++k) {
        const double cosine = std::lerp(from, to, static_cast<double>(k) / parts);
        sines_.push_back(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)));
      }
    }
    sines_.push_back(std::sin(radians(steepest)));
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
  axis_ = axis_of(phones_, 2.0 * pi * sound_speed / angular_frequency_);
  if (axis_) {
    look_along_axis();
    return;
  }
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

/// A line's beam depends on the difference of two cosines with its axis alone.
void BeamBank::look_along_axis() {
  constexpr double dense = 24.0;  // places in the width of a lobe
  double length = 0.0;
  for (const Vec3& a : phones_) length = std::max(length, std::abs(axis_->dot(a - phones_[0])));
  const double wavenumber = angular_frequency_ / sound_speed_;
  const auto steps =
      static_cast<std::size_t>(std::ceil(2.0 * dense * (2.0 + length * wavenumber / (2.0 * pi))));
  cosine_step_ = 2.0 / static_cast<double>(steps);
  line_.resize(steps + 2);
  in_parallel(line_.size(), [&](std::size_t i) {
    std::complex<double> sum = 0.0;
    for (const Vec3& phone : phones_)
      sum += std::polar(
          1.0, wavenumber * static_cast<double>(i) * cosine_step_ * axis_->dot(phone - phones_[0]));
    const auto n = static_cast<double>(phones_.size());
    line_[i] = static_cast<float>(std::norm(sum) / (n * n));
  });
  const std::size_t rows = static_cast<std::size_t>(sectors_ * parts_) * nodes_.size();
  cosines_.resize(rows);
  for (std::size_t row = 0; row < rows; ++row)
    cosines_[row] = static_cast<float>(axis_->dot(
        direction(2.0 * pi * (static_cast<double>(row / nodes_.size()) + 0.5) / (sectors_ * parts_),
                  nodes_.elevation(row % nodes_.size()))));
}

/// Of sound that comes from there.
Vec3 BeamBank::slowness(double bearing, double elevation) const noexcept {
  return -direction(bearing, elevation) / sound_speed_;
}

void BeamBank::beam(double bearing, std::size_t node, std::span<float> received) const {
  std::fill(received.begin(), received.end(), omnidirectional() ? 1.0F : 0.0F);
  if (omnidirectional()) return;
  const std::size_t nodes = nodes_.size();
  const auto parts = static_cast<std::size_t>(parts_);
  if (axis_) {
    const auto looks = static_cast<float>(axis_->dot(direction(bearing, nodes_.elevation(node))));
    const auto in_steps = static_cast<float>(1.0 / cosine_step_);
    const float share = 1.0F / static_cast<float>(parts_);
    for (std::size_t sector = 0, row = 0; sector < received.size() / nodes; ++sector)
      for (std::size_t part = 0; part < parts; ++part)
        for (std::size_t k = 0; k < nodes; ++k, ++row) {
          const float at = std::abs(cosines_[row] - looks) * in_steps;
          const auto i = std::min(static_cast<std::size_t>(at), line_.size() - 2);
          const float later = at - static_cast<float>(i);
          received[sector * nodes + k] += share * (line_[i] + later * (line_[i + 1] - line_[i]));
        }
    return;
  }
  const std::size_t rows = real_.size() / phones_.size();
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
  for (std::size_t row = 0; row < rows; ++row)
    received[row / nodes / parts * nodes + row % nodes] +=
        (re[row] * re[row] + im[row] * im[row]) / static_cast<float>(parts);
}

double BeamBank::gain_over_noise_db(double bearing, std::size_t node) const {
  return asdic::detail::gain_over_noise_db(phones_, slowness(bearing, nodes_.elevation(node)),
                                           angular_frequency_, coherence_);
}

}  // namespace asdic::detail
