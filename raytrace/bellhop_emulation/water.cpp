#include "raytrace/bellhop_emulation/water.h"

#include <algorithm>

namespace asdic::detail::bellhop_emulation {
namespace {

/// The interval of increasing nodes that holds x; on a node, on the side to which `direction`
/// points.
std::size_t locate_on(const std::vector<double>& node, double x, double direction, std::size_t i) {
  const std::size_t last = node.size() - 2;
  i = std::min(i, last);
  while (i > 0 && (x < node[i] || (x == node[i] && direction < 0.0))) --i;
  while (i < last && (x > node[i + 1] || (x == node[i + 1] && direction >= 0.0))) ++i;
  return i;
}

}  // namespace

LiteralWater::LiteralWater(const Environment& environment, double frequency)
    : water_(environment.water),
      density_(environment.water_density),
      attenuation_(attenuation_np_per_m(environment, frequency)),
      angular_frequency_(2.0 * pi * frequency),
      first_depth_(environment.surface.depth),
      last_depth_(environment.bottom.depth) {
  // Imaginary part at a node: α·c²/ω.
  const auto loss_at = [&](double z) {
    const double c = water_.at(z).c;
    return attenuation_.at(z) * c * c / angular_frequency_;
  };
  if (environment.section) {
    const SoundSpeedSection& section = *environment.section;
    depth_.assign(section.depths().begin(), section.depths().end());
    range_.assign(section.ranges().begin(), section.ranges().end());
    speed_.assign(section.speeds().begin(), section.speeds().end());
    for (const double z : depth_) loss_.push_back(loss_at(z));
  } else if (water_.depths().size() >= 2) {
    depth_.assign(water_.depths().begin(), water_.depths().end());
    std::vector<double> loss;
    for (const double z : depth_) loss.push_back(loss_at(z));
    make_laws(water_, loss);
  }
  if (!depth_.empty()) {
    first_depth_ = depth_.front();
    last_depth_ = depth_.back();
  }
}

void LiteralWater::make_laws(const SoundSpeedProfile& water, const std::vector<double>& loss) {
  const auto z = water.depths();
  const auto c = water.speeds();
  const Interpolation rule = water.interpolation();
  const bool cubic = rule != Interpolation::c_linear && rule != Interpolation::n2_linear;
  // A cubic law of the imaginary part is that of base + scale·loss, of the size of a sound speed:
  // all these laws commute with adding a constant and with a positive factor.
  constexpr double base = 1500.0;
  const double largest = *std::max_element(loss.begin(), loss.end());
  const double scale = largest > 0.0 ? 100.0 / largest : 0.0;
  std::optional<SoundSpeedProfile> imaginary;
  if (cubic && scale > 0.0) {
    std::vector<double> lifted;
    for (const double x : loss) lifted.push_back(base + scale * x);
    imaginary = SoundSpeedProfile::table(z, lifted, rule);
  }
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    ComplexLaw law{.z0 = z[i]};
    if (cubic) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double lifted = imaginary ? imaginary->law(i).a[k] - (k == 0 ? base : 0.0) : 0.0;
        law.a[k] = {water.law(i).a[k], scale > 0.0 ? lifted / scale : 0.0};
      }
    } else {
      const auto value = [&](std::size_t k) {
        const std::complex<double> speed(c[k], loss[k]);
        return rule == Interpolation::n2_linear ? 1.0 / (speed * speed) : speed;
      };
      law.a[0] = value(i);
      law.a[1] = (value(i + 1) - value(i)) / (z[i + 1] - z[i]);
    }
    law_.push_back(law);
  }
}

void LiteralWater::locate(const Vec2& x, const Vec2& direction, WaterCell& cell) const noexcept {
  if (depth_.size() >= 2) cell.row = locate_on(depth_, x.y(), direction.y(), cell.row);
  if (range_.size() >= 2) cell.column = locate_on(range_, x.x(), direction.x(), cell.column);
}

double LiteralWater::upper(const WaterCell& cell) const noexcept {
  return depth_.size() >= 2 ? depth_[cell.row] : -infinity;
}
double LiteralWater::lower(const WaterCell& cell) const noexcept {
  return depth_.size() >= 2 ? depth_[cell.row + 1] : infinity;
}
double LiteralWater::left(const WaterCell& cell) const noexcept {
  return range_.size() >= 2 ? range_[cell.column] : -infinity;
}
double LiteralWater::right(const WaterCell& cell) const noexcept {
  return range_.size() >= 2 ? range_[cell.column + 1] : infinity;
}

WaterPoint LiteralWater::at(const Vec2& x, const WaterCell& cell) const noexcept {
  if (!speed_.empty()) return in_section(x, cell);
  if (law_.empty()) {
    const SoundSpeed s = water_.at(x.y());
    return {.c = s.c,
            .c_loss = attenuation_.at(x.y()) * s.c * s.c / angular_frequency_,
            .c_z = s.dc_dz,
            .c_zz = s.d2c_dz2};
  }
  const ComplexLaw& law = law_[cell.row];
  const double t = x.y() - law.z0;
  const std::complex<double> value = law.a[0] + t * (law.a[1] + t * (law.a[2] + t * law.a[3]));
  if (water_.interpolation() == Interpolation::n2_linear) {
    const std::complex<double> speed = 1.0 / std::sqrt(value);
    const double c = speed.real();
    const double c_z = -0.5 * c * c * c * law.a[1].real();  // dc/dz = −(c³/2)·d(1/c²)/dz
    return {.c = c, .c_loss = speed.imag(), .c_z = c_z, .c_zz = 3.0 * c_z * c_z / c};
  }
  return {.c = value.real(),
          .c_loss = value.imag(),
          .c_z = law.a[1].real() + t * (2.0 * law.a[2].real() + 3.0 * t * law.a[3].real()),
          .c_zz = 2.0 * law.a[2].real() + 6.0 * t * law.a[3].real()};
}

WaterPoint LiteralWater::in_section(const Vec2& x, const WaterCell& cell) const noexcept {
  const std::size_t n = depth_.size(), j = cell.row;
  const double dz = depth_[j + 1] - depth_[j];
  const double w = (x.y() - depth_[j]) / dz;
  struct Column {
    double c, c_z;
  };
  const auto column = [&](std::size_t i) {
    const double above = speed_[i * n + j], below = speed_[i * n + j + 1];
    return Column{above + w * (below - above), (below - above) / dz};
  };
  WaterPoint p;
  p.c_loss = loss_[j] + w * (loss_[j + 1] - loss_[j]);
  if (range_.size() < 2) {
    const Column only = column(0);
    p.c = only.c;
    p.c_z = only.c_z;
    return p;
  }
  const std::size_t i = cell.column;
  const double dr = range_[i + 1] - range_[i];
  const double s = (x.x() - range_[i]) / dr;
  const Column a = column(i), b = column(i + 1);
  p.c = a.c + s * (b.c - a.c);
  p.c_z = a.c_z + s * (b.c_z - a.c_z);
  p.c_r = (b.c - a.c) / dr;
  p.c_rz = (b.c_z - a.c_z) / dr;
  return p;
}

}  // namespace asdic::detail::bellhop_emulation
