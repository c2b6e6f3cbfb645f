#include "sonar/reverberation/azimuthally_symmetric_covariance.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/rotate_back.h"

namespace asdic::detail {

namespace {

/// The largest argument: ξ|f_k x_m − f_l x_n| and, where two slownesses differ, no more than
/// ξ·f_l|x_n| beyond.
double furthest_argument(std::span<const Vec3> phones, std::span<const double> frequencies,
                         double fastest) {
  double furthest = 0.0, highest = 0.0;
  for (const Vec3& phone : phones) furthest = std::max(furthest, phone.head<2>().norm());
  for (const double f : frequencies) highest = std::max(highest, f);
  return 2.0 * pi * fastest * highest * 3.0 * furthest;
}

}  // namespace

AzimuthallySymmetricArray::AzimuthallySymmetricArray(std::span<const Vec3> phones,
                                                     std::span<const double> frequencies,
                                                     double fastest)
    : components_(phones.size() * frequencies.size()),
      bessel_(furthest_argument(phones, frequencies, fastest)) {
  std::vector<Vec3> scaled;
  for (const double f : frequencies)
    for (const Vec3& phone : phones) scaled.push_back(f * phone);
  for (const Vec3& x : scaled) {
    flat_ = flat_ && x.z() == 0.0;
    reach_.push_back(2.0 * pi * x.head<2>().norm());
    depth_.push_back(x.z());
    for (const Vec3& y : scaled) gram_.push_back(4.0 * pi * pi * x.head<2>().dot(y.head<2>()));
  }
  // A uniform line, or any array that is its own image in its middle: on a grid of a millionth.
  const double most = *std::max_element(reach_.begin(), reach_.end());
  for (std::size_t i = 0; i < gram_.size() / 2 && mirrored_; ++i)
    mirrored_ = std::abs(gram_[i] - gram_[gram_.size() - 1 - i]) <= 1e-12 * most * most;
  constexpr double alike = 0.05;  // [rad]
  const auto width = [](double furthest) { return furthest > 0.0 ? alike / furthest : infinity; };
  alike_level_ = width(*std::max_element(reach_.begin(), reach_.end()));
  const auto deepest = std::minmax_element(depth_.begin(), depth_.end());
  alike_down_ = width(2.0 * pi * std::max(-*deepest.first, *deepest.second));
  // Equal but for rounding: on a grid of a millionth of a turn.
  constexpr double grid = 1e-6;
  const double step = fastest > 0.0 ? grid / fastest : 1.0;
  const auto rounded = [&](double x) { return step * std::round(x / step); };
  std::vector<Apart> all(components_ * components_);
  for (std::size_t m = 0; m < components_; ++m)
    for (std::size_t n = 0; n <= m; ++n) {
      const Vec3 d = scaled[m] - scaled[n];
      all[m * components_ + n] = {rounded(2.0 * pi * d.head<2>().norm()), rounded(d.z())};
      apart_.push_back(all[m * components_ + n]);
    }
  std::sort(apart_.begin(), apart_.end());
  apart_.erase(std::unique(apart_.begin(), apart_.end()), apart_.end());
  which_.assign(all.size(), 0);
  for (std::size_t m = 0; m < components_; ++m)
    for (std::size_t n = 0; n <= m; ++n)
      which_[m * components_ + n] = static_cast<std::uint32_t>(
          std::lower_bound(apart_.begin(), apart_.end(), all[m * components_ + n]) -
          apart_.begin());
}

double AzimuthallySymmetricArray::power(const ReceivedAzimuthally& received) const noexcept {
  double power = received.one + received.other;
  if (received.both == 0.0) return power;
  const double level = std::abs(received.level_one - received.level_other);
  const double down = received.down_one - received.down_other;
  double beat = 0.0;
  for (std::size_t m = 0; m < components_; ++m) {
    double re = received.both.real(), im = received.both.imag();
    if (!flat_) rotate_back(down * depth_[m], re, im);
    beat += re * bessel_(level * reach_[m]);
  }
  return power + 2.0 * beat / static_cast<double>(components_);
}

AzimuthallySymmetricSum::AzimuthallySymmetricSum(const AzimuthallySymmetricArray& array)
    : array_(array) {}

AzimuthallySymmetricSum::Slownesses AzimuthallySymmetricSum::Sound::mean() const noexcept {
  Slownesses s = weighted;
  for (double& x : s) x /= weight;
  return s;
}

void AzimuthallySymmetricSum::add(const ReceivedAzimuthally& received) {
  const double a = received.level_one, down_a = received.down_one;
  const double b = received.level_other, down_b = received.down_other;
  add_sound(received.one, {a, down_a, a, down_a}, own_);
  add_sound(received.other, {b, down_b, b, down_b}, own_);
  // Real but for rounding, as beams of real patterns are.
  std::complex<double> both = received.both;
  if (std::abs(both.imag()) < 1e-9 * std::abs(both.real())) both = both.real();
  add_sound(both, {a, down_a, b, down_b}, between_);
  real_ = real_ && both.imag() == 0.0;
}

void AzimuthallySymmetricSum::add_sound(std::complex<double> power, const Slownesses& s,
                                        std::vector<Sound>& sounds) const {
  // Own powers and those between beams of real patterns are real: no root then.
  const double weight = power.imag() == 0.0 ? std::abs(power.real()) : std::abs(power);
  if (!(weight > 0.0)) return;
  const auto alike = [&](const Sound& sound) {
    const Slownesses& t = sound.first;
    return std::abs(s[0] - t[0]) <= array_.alike_level_ &&
           std::abs(s[1] - t[1]) <= array_.alike_down_ &&
           std::abs(s[2] - t[2]) <= array_.alike_level_ &&
           std::abs(s[3] - t[3]) <= array_.alike_down_;
  };
  auto sound = std::find_if(sounds.begin(), sounds.end(), alike);
  if (sound == sounds.end())
    sound = sounds.insert(sound, {.power = 0.0, .weight = 0.0, .first = s, .weighted = {}});
  sound->power += power;
  sound->weight += weight;
  for (std::size_t i = 0; i < s.size(); ++i) sound->weighted[i] += weight * s[i];
}

void AzimuthallySymmetricSum::add_own(const Sound& sound, std::span<double> re,
                                      std::span<double> im) const {
  const auto& apart = array_.apart_;
  const auto [level, down, same_level, same_down] = sound.mean();
  const double power = sound.power.real();
  if (array_.flat_) {
    for (std::size_t i = 0; i < apart.size(); ++i)
      re[i] += power * array_.bessel_(level * apart[i].level);
    return;
  }
  for (std::size_t i = 0; i < apart.size(); ++i) {
    double x = power * array_.bessel_(level * apart[i].level), y = 0.0;
    rotate_back(down * apart[i].down, x, y);
    re[i] += x;
    im[i] += y;
  }
}

void AzimuthallySymmetricSum::add_between(const Sound& sound, std::span<double> re,
                                          std::span<double> im, std::span<double> arguments) const {
  const std::size_t components = array_.components_;
  const auto [a, down_a, b, down_b] = sound.mean();
  const double x = sound.power.real(), y = sound.power.imag();
  using Under = Eigen::Map<const Eigen::ArrayXd>;
  const auto length = static_cast<Eigen::Index>(components);
  const Under reach(array_.reach_.data(), length);
  const bool half = array_.flat_ && array_.mirrored_;  // of the rows: the others are their images
  for (std::size_t m = 0; m < (half ? (components + 1) / 2 : components); ++m) {
    const Under gram(&array_.gram_[m * components], length);
    const double own = a * a * array_.reach_[m] * array_.reach_[m], twice = 2.0 * a * b;
    Eigen::Map<Eigen::ArrayXd>(arguments.data(), length) =  // |ξ_a x_m − ξ_b x_n|
        (own + b * b * reach.square() - twice * gram).max(0.0).sqrt();
    array_.bessel_.replace(arguments);
    const std::size_t row = m * components;
    if (!array_.flat_) {
      for (std::size_t n = 0; n < components; ++n) {
        double part = x * arguments[n], other_part = y * arguments[n];
        rotate_back(down_a * array_.depth_[m] - down_b * array_.depth_[n], part, other_part);
        re[row + n] += part;
        im[row + n] += other_part;
      }
      continue;
    }
    const auto add = [&](double power, std::span<double> into) {
      for (std::size_t n = 0; n < components; ++n) into[row + n] += power * arguments[n];
      if (!half || 2 * m + 1 == components) return;
      double* const image = &into[into.size() - row - components];
      for (std::size_t n = 0; n < components; ++n)
        image[n] += power * arguments[components - 1 - n];
    };
    add(x, re);
    if (y != 0.0) add(y, im);
  }
}

template <class Number>
void AzimuthallySymmetricSum::add_all_to(std::span<Number> into) const {
  constexpr bool complex = !std::is_same_v<Number, double>;
  const std::size_t components = array_.components_, distinct = array_.apart_.size();
  const std::size_t all = components * components, parts = complex ? 2 : 1;
  // Of components by what they differ by; of ordered pairs of them.
  std::vector<double> memory(parts * (distinct + all) + components, 0.0);
  const std::span<double> re(memory.data(), distinct), between_re(memory.data() + distinct, all),
      arguments(between_re.data() + all, components);
  const std::span<double> im(arguments.data() + components, complex ? distinct : 0),
      between_im(im.data() + im.size(), complex ? all : 0);
  for (const Sound& sound : own_) add_own(sound, re, im);
  for (const Sound& sound : between_) add_between(sound, between_re, between_im, arguments);
  for (std::size_t m = 0; m < components; ++m)
    for (std::size_t n = 0; n <= m; ++n) {
      const std::size_t i = array_.which_[m * components + n];
      // a·b* of (m, n), and its conjugate of (n, m)
      const std::size_t there = m * components + n, back = n * components + m;
      const double real = re[i] + between_re[there] + between_re[back];
      if constexpr (complex) {
        const Number sum(real, im[i] + between_im[there] - between_im[back]);
        into[back] += sum;  // column by column
        if (m != n) into[there] += std::conj(sum);
      } else {
        into[back] += real;
        if (m != n) into[there] += real;
      }
    }
}

void AzimuthallySymmetricSum::add_to(std::span<std::complex<double>> into) const {
  add_all_to(into);
}
void AzimuthallySymmetricSum::add_to(std::span<double> into) const { add_all_to(into); }

}  // namespace asdic::detail
