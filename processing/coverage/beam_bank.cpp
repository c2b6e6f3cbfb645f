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

ElevationNodes::ElevationNodes(std::span<const Vec3> phones, double wavelength, double way) {
  // A line resolves λ/L of the sine across itself; two nodes in that. A level array resolves λ/L of
  // the cosine, at endfire: slowly about the horizontal. Three nodes in that, of a line.
  constexpr double coarse[] = {0.0, 3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 48.0, 62.0, 78.0};  // [°]
  constexpr double unresolved = 0.1, most = 128.0;
  const Extents extents = extents_of(phones);
  mirrored_ = extents.upright < unresolved * wavelength;
  if (mirrored_) {
    // Of others than lines each node costs a sum over the phones.
    const bool line = phones.size() < 2 || axis_of(phones, wavelength);
    const double most_level = line ? 128.0 : 24.0, in_lobe = line ? 3.0 : 2.0;
    constexpr double steepest = 78.0;
    double step = 1.0 - std::cos(radians(steepest));  // of the cosine
    step /= std::clamp(in_lobe * step * (extents.level + way) / wavelength, 1.0, most_level);
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

namespace {

/// Whether a shift loses nothing worth the work [Hz].
bool passes_all(const PulseBand& band, double shift) {
  constexpr double unnoticed = 0.005;
  return 1.0 - band.passes(shift) <= unnoticed;
}

}  // namespace

BeamBank::BeamBank(std::vector<Vec3> phones, const PulseBand& band, double frequency,
                   double sound_speed, int sectors, const ElevationNodes& nodes,
                   const NoiseField& noise, const Vec2& closing)
    : phones_(std::move(phones)),
      angular_frequency_(2.0 * pi * frequency),
      sound_speed_(sound_speed),
      sectors_(sectors),
      nodes_(nodes),
      coherence_(noise_coherences(phones_, angular_frequency_ / sound_speed, noise)),
      closing_(closing) {
  // |w·e|² over the bearing has no more harmonics than kL, and what passes by its shift as many as
  // a length that resolves the same: a mean of so many places is exact.
  const double level = extents_of(phones_).level,
               fastest = frequency / sound_speed * closing.norm(),
               way = closing.norm() / band.half();
  const double waves = angular_frequency_ / sound_speed * (level + way);
  parts_ = static_cast<int>(std::clamp(std::ceil((2.0 * waves + 16.0) / sectors), 1.0, 64.0));
  smear_ = level / sound_speed + band.later(2.0 * fastest);
  if (phones_.size() > 1) axis_ = axis_of(phones_, 2.0 * pi * sound_speed / angular_frequency_);
  if (!shifts_along_axis(band) && !passes_all(band, 2.0 * fastest)) find_shifts(band);
  if (axis_)
    look_along_axis(band);
  else if (phones_.size() > 1)
    look_all_round(band);
}

/// Doppler shifts of a line that goes along itself depend on the same cosines as its beam.
bool BeamBank::shifts_along_axis(const PulseBand& band) const {
  if (!axis_) return false;
  const Vec3 closing(closing_.x(), closing_.y(), 0.0);
  const double aside = (closing - axis_->dot(closing) * *axis_).norm();
  return passes_all(band, 2.0 * aside * angular_frequency_ / (2.0 * pi * sound_speed_));
}

/// The rows of an array that is no line.
void BeamBank::look_all_round(const PulseBand& band) {
  constexpr int most_lines = 6;  // each costs a sum over the phones
  lines_ = band.lines(extents_of(phones_).level / sound_speed_, most_lines);
  shares_ = band.shares(lines_, 0.0);
  const std::size_t elevations = nodes_.size(), count = phones_.size(),
                    rows = static_cast<std::size_t>(sectors_ * parts_) * elevations;
  real_.resize(lines_.size() * rows * count);
  imaginary_.resize(lines_.size() * rows * count);
  in_parallel(lines_.size() * count, [&](std::size_t i) {
    for (std::size_t row = 0; row < rows; ++row) {
      const double bearing =
          2.0 * pi * (static_cast<double>(row / elevations) + 0.5) / (sectors_ * parts_);
      const double phase =
          -angular_frequency_ * lines_[i / count].ratio *
          slowness(bearing, nodes_.elevation(row % elevations)).dot(phones_[i % count]);
      real_[i * rows + row] = static_cast<float>(std::cos(phase));
      imaginary_[i * rows + row] = static_cast<float>(std::sin(phase));
    }
  });
}

/// Of sound from there, of what lies still [Hz].
double BeamBank::shift(const Vec3& towards) const noexcept {
  return angular_frequency_ / (2.0 * pi * sound_speed_) * closing_.dot(towards.head<2>());
}

void BeamBank::find_shifts(const PulseBand& band) {
  const std::size_t rows = static_cast<std::size_t>(sectors_ * parts_) * nodes_.size();
  shifts_.resize(rows);
  for (std::size_t row = 0; row < rows; ++row)
    shifts_[row] = static_cast<float>(shift(
        direction(2.0 * pi * (static_cast<double>(row / nodes_.size()) + 0.5) / (sectors_ * parts_),
                  nodes_.elevation(row % nodes_.size()))));
  constexpr double dense = 64.0, most = 65536.0;
  const double widest = 2.0 * shift(Vec3(closing_.x(), closing_.y(), 0.0).normalized());
  const auto steps =
      static_cast<std::size_t>(std::clamp(std::ceil(widest / band.half() * dense), dense, most));
  shift_step_ = widest / static_cast<double>(steps);
  passes_.resize(steps + 2);
  for (std::size_t i = 0; i < passes_.size(); ++i)
    passes_[i] = static_cast<float>(band.passes(static_cast<double>(i) * shift_step_));
}

/// Times what the replica of what rests where one looks lets through.
void BeamBank::pass(const Vec3& looks, std::span<float> rows) const {
  if (shifts_.empty()) return;
  const auto own = static_cast<float>(shift(looks));
  const auto in_steps = static_cast<float>(1.0 / shift_step_);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const float at = std::abs(shifts_[row] - own) * in_steps;
    const auto i = std::min(static_cast<std::size_t>(at), passes_.size() - 2);
    const float later = at - static_cast<float>(i);
    rows[row] *= passes_[i] + later * (passes_[i + 1] - passes_[i]);
  }
}

/// A line's beam depends on the difference of two cosines with its axis alone, times frequency.
void BeamBank::look_along_axis(const PulseBand& band) {
  constexpr double dense = 24.0;  // places in the width of a lobe
  constexpr int most_lines = 1024;
  double length = 0.0;
  for (const Vec3& a : phones_) length = std::max(length, std::abs(axis_->dot(a - phones_[0])));
  const double wavenumber = angular_frequency_ / sound_speed_;
  const std::vector<PulseBand::Line> lines = band.lines(2.0 * length / sound_speed_, most_lines);
  double highest = 1.0;
  for (const PulseBand::Line& line : lines) highest = std::max(highest, line.ratio);
  const auto steps =
      static_cast<std::size_t>(std::ceil(2.0 * dense * (2.0 + length * wavenumber / (2.0 * pi))));
  cosine_step_ = 2.0 / static_cast<double>(steps);
  main_lobe_ = 2.0 * pi / (wavenumber * length);
  // At the centre, as far as the highest frequency asks for; then the mean over the band.
  std::vector<double> centre(static_cast<std::size_t>(highest * static_cast<double>(steps)) + 4);
  in_parallel(centre.size(), [&](std::size_t i) {
    std::complex<double> sum = 0.0;
    for (const Vec3& phone : phones_)
      sum += std::polar(
          1.0, wavenumber * static_cast<double>(i) * cosine_step_ * axis_->dot(phone - phones_[0]));
    const auto n = static_cast<double>(phones_.size());
    centre[i] = std::norm(sum) / (n * n);
  });
  // Of a line that goes along itself, with what passes by the shift.
  const double widest = shifts_along_axis(band) ? 2.0 * std::abs(shift(*axis_)) : 0.0;  // [Hz]
  constexpr double shift_dense = 8.0, most_shifts = 4096.0;
  const double shifts = std::clamp(std::ceil(widest / band.half() * shift_dense), 1.0, most_shifts);
  std::vector<std::vector<double>> shares(static_cast<std::size_t>(shifts) + 2);
  in_parallel(shares.size(), [&](std::size_t i) {
    shares[i] = band.shares(lines, widest * static_cast<double>(i) / shifts);
  });
  line_.assign(steps + 2, 0.0F);
  in_parallel(line_.size(), [&](std::size_t i) {
    const double place =
        shifts * std::min(1.0, static_cast<double>(i) / static_cast<double>(steps));
    const auto from = static_cast<std::size_t>(place);
    double sum = 0.0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const double at = std::max(0.0, lines[l].ratio) * static_cast<double>(i);
      const auto k = std::min(static_cast<std::size_t>(at), centre.size() - 2);
      sum += std::lerp(shares[from][l], shares[from + 1][l], place - static_cast<double>(from)) *
             std::lerp(centre[k], centre[k + 1], at - static_cast<double>(k));
    }
    line_[i] = static_cast<float>(sum);
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

BeamBank::Beam BeamBank::beam(double bearing, std::size_t node) const {
  const std::size_t nodes = nodes_.size(), sectors = static_cast<std::size_t>(sectors_);
  Beam found{.all = std::vector<float>(sectors * nodes, omnidirectional() ? 1.0F : 0.0F),
             .aside = std::vector<float>(sectors * nodes, 0.0F)};
  if (omnidirectional()) return found;
  const auto parts = static_cast<std::size_t>(parts_);
  const Vec3 looks = direction(bearing, nodes_.elevation(node));
  std::vector<float> rows(sectors * parts * nodes, 1.0F);
  const auto own = axis_ ? static_cast<float>(axis_->dot(looks)) : 0.0F;
  if (axis_) {
    const auto in_steps = static_cast<float>(1.0 / cosine_step_);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const float at = std::abs(cosines_[row] - own) * in_steps;
      const auto i = std::min(static_cast<std::size_t>(at), line_.size() - 2);
      const float later = at - static_cast<float>(i);
      rows[row] = line_[i] + later * (line_[i + 1] - line_[i]);
    }
  } else if (phones_.size() > 1) {
    receive_all_round(slowness(bearing, nodes_.elevation(node)), rows);
  }
  constexpr float half = 0.5F;  // of other arrays the main lobe is what is louder
  std::vector<float> beside(rows.size(), 0.0F);
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (axis_ ? std::abs(cosines_[row] - own) > static_cast<float>(main_lobe_) : rows[row] < half)
      beside[row] = rows[row];
  pass(looks, rows);
  pass(looks, beside);
  const float share = 1.0F / static_cast<float>(parts_);
  for (std::size_t sector = 0, row = 0; sector < sectors; ++sector)
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t k = 0; k < nodes; ++k, ++row) {
        found.all[sector * nodes + k] += share * rows[row];
        found.aside[sector * nodes + k] += share * beside[row];
      }
  return found;
}

/// |w·e|² of an array that is no line.
void BeamBank::receive_all_round(const Vec3& slowness, std::span<float> rows) const {
  std::fill(rows.begin(), rows.end(), 0.0F);
  const std::size_t count = phones_.size();
  std::vector<float> re(rows.size()), im(rows.size());
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    std::fill(re.begin(), re.end(), 0.0F);
    std::fill(im.begin(), im.end(), 0.0F);
    for (std::size_t i = 0; i < count; ++i) {
      const double phase = angular_frequency_ * lines_[l].ratio * slowness.dot(phones_[i]);
      const auto n = static_cast<double>(count);
      const auto c = static_cast<float>(std::cos(phase) / n),
                 d = static_cast<float>(std::sin(phase) / n);
      const float* const a = &real_[(l * count + i) * rows.size()];
      const float* const b = &imaginary_[(l * count + i) * rows.size()];
      for (std::size_t row = 0; row < rows.size(); ++row) {
        re[row] += c * a[row] - d * b[row];
        im[row] += c * b[row] + d * a[row];
      }
    }
    const auto share = static_cast<float>(shares_[l]);
    for (std::size_t row = 0; row < rows.size(); ++row)
      rows[row] += share * (re[row] * re[row] + im[row] * im[row]);
  }
}

double BeamBank::gain_over_noise_db(double bearing, std::size_t node) const {
  return asdic::detail::gain_over_noise_db(phones_, slowness(bearing, nodes_.elevation(node)),
                                           angular_frequency_, coherence_);
}

}  // namespace asdic::detail
