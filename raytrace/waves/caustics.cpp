#include "raytrace/waves/caustics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/waves/airy.h"
#include "raytrace/waves/make_wave.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double lit = 8.0, dark = -4.0;   // of Airy's argument ζ: where a caustic shows
constexpr double surely_two = 1.0;         // from which on the pair itself tells all
constexpr double faintest_caustic = 1e-3;  // of 1/r
constexpr std::array sample_places = {0.35, 1.0, 2.0, 3.2};  // ζ, about

/// A ray that touches a caustic at the receiver's depth: there its family's range has an extremum.
struct Fold {
  double range;   ///< of the extremum [m]
  double side;    ///< +1 if the family goes on beyond it, −1 if short of it
  double scale;   ///< range of one unit of Airy's argument [m]
  double launch;  ///< elevation [rad]
  int surface_bounces, bottom_bounces, vertices;
};

/// Two rays of one family, the second of which has touched the caustic. Indices of arrivals.
struct RayPair {
  std::size_t early, late;
};

/// The field about a caustic, p = √π·(direct·Ai(−ζ) + slope·Ai′(−ζ))·e^{−iωτ}: all smooth functions
/// of the place.
struct UniformPair {
  double zeta, delay;
  Complex direct, slope;
  double launch, arrival, slowness;  ///< means of the two

  /// Of the earlier ray (sign −1) or the later (+1): their sum is the field. \param at  delay that
  /// the amplitude belongs to [s]
  [[nodiscard]] Complex part(double sign, double omega, double at) const {
    const Airy<double> w = airy(-zeta);
    const Complex turned(0.0, zeta > 0.0 ? sign : 0.0);
    return 0.5 * std::sqrt(pi) *
           (direct * (w.ai + turned * w.bi) + slope * (w.ai_slope + turned * w.bi_slope)) *
           std::polar(1.0, -omega * (delay - at));
  }
};

/// ζ of two delays: they differ by (4/3)ζ^{3/2}/ω.
double argument_of(double omega, double apart) { return std::pow(0.75 * omega * apart, 2.0 / 3.0); }

/// Where there are two rays.
UniformPair uniform_of(const Arrival& early, const Arrival& late, double omega) {
  const double zeta = argument_of(omega, late.delay - early.delay), root = std::pow(zeta, 0.25);
  const double delay = 0.5 * (early.delay + late.delay);
  const Complex a = early.amplitude * std::polar(1.0, -0.25 * pi),
                b = late.amplitude * std::polar(1.0, 0.25 * pi);
  return {.zeta = zeta,
          .delay = delay,
          .direct = Complex(0.0, 1.0) * root * (a - b),
          .slope = -(a + b) / root,
          .launch = 0.5 * (early.launch_elevation + late.launch_elevation),
          .arrival = 0.5 * (early.arrival_elevation + late.arrival_elevation),
          .slowness = 0.5 * (early.horizontal_slowness + late.horizontal_slowness)};
}

/// All folds at ranges of an interval. \param nearest, furthest  its ends [m]
std::vector<Fold> folds_within(const BranchTable& table, double nearest, double furthest,
                               double omega) {
  std::vector<Fold> folds;
  table.for_each_piece(nearest, furthest, [&](const MonotonePiece& piece) {
    if (!piece.caustic_begin || piece.range_begin < nearest || piece.range_begin > furthest) return;
    const FanInterval& interval = *piece.interval;
    const RayParameter ray(interval.reference_speed, piece.sigma_begin);
    const double step = 1e-3 * (piece.sigma_end - piece.sigma_begin);
    const double bend =
        table.evaluate(interval, piece.branch, piece.sigma_begin + step).slope / step;
    // The phase ωτ is cubic about the fold: ω(ξ′x·δr − r″ξ′x³/6).
    const double turn = std::abs(ray.slowness_per_sigma());
    const double scale =
        std::cbrt(0.5 * std::abs(bend) * turn) / (std::pow(omega, 2.0 / 3.0) * turn);
    if (!std::isfinite(scale) || !(scale > 0.0)) return;
    const double sine = std::sqrt(std::max(0.0, ray.sine2(table.column().source_speed())));
    const double launch = std::asin(std::min(1.0, sine));
    const Branch& branch = piece.branch;
    folds.push_back({.range = piece.range_begin,
                     .side = piece.range_end > piece.range_begin ? 1.0 : -1.0,
                     .scale = scale,
                     .launch = branch.starts_up ? launch : -launch,
                     .surface_bounces = interval.turns_above ? 0 : branch.top_vertices(),
                     .bottom_bounces = interval.turns_below ? 0 : branch.bottom_vertices(),
                     .vertices = branch.vertices});
  });
  return folds;
}

int vertices_of(const Arrival& a) {
  return a.surface_bounces + a.bottom_bounces + a.upper_turns + a.lower_turns;
}

/// The rays on either side of a fold's. Through the horizontal a family goes on with one turn more.
std::optional<RayPair> pair_about(const Fold& fold, const Arrivals& rays) {
  std::size_t above = rays.size(), below = rays.size();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Arrival& a = rays[i];
    if (a.surface_bounces != fold.surface_bounces || a.bottom_bounces != fold.bottom_bounces ||
        std::abs(vertices_of(a) - fold.vertices) > 1)
      continue;
    if (a.launch_elevation > fold.launch) {
      if (above == rays.size() || a.launch_elevation < rays[above].launch_elevation) above = i;
    } else if (below == rays.size() || a.launch_elevation > rays[below].launch_elevation) {
      below = i;
    }
  }
  if (above == rays.size() || below == rays.size()) return std::nullopt;
  RayPair pair{above, below};
  if (rays[pair.early].delay > rays[pair.late].delay) std::swap(pair.early, pair.late);
  if (rays[pair.late].caustics != rays[pair.early].caustics + 1) return std::nullopt;
  return pair;
}

/// Whether two rays are as far apart as the fold's shape has them.
bool of_the_fold(double zeta, double expected) {
  return zeta > 0.5 * expected && zeta < 2.0 * expected;
}

/// The field about a fold, out of pairs of rays on its lit side.
class FoldField {
 public:
  FoldField(const EigenraySolver& solver, double source_depth, double receiver_depth,
            const Fold& fold, double frequency, const PathLimits& limits)
      : fold_(fold), omega_(2.0 * pi * frequency) {
    PathLimits of_fold = limits;  // other paths than its own are not asked for
    of_fold.max_surface_bounces = std::min(of_fold.max_surface_bounces, fold.surface_bounces);
    of_fold.max_bottom_bounces = std::min(of_fold.max_bottom_bounces, fold.bottom_bounces);
    of_fold.max_vertices = std::min(of_fold.max_vertices, fold.vertices + 1);
    of_fold.min_vertices = std::max(0, fold.vertices - 1);
    for (double share = 1.0; share > 0.2 && !known_; share *= 0.5) {
      std::array<double, sample_places.size()> ranges{};
      for (std::size_t j = 0; j < ranges.size(); ++j) {
        away_[j] = share * sample_places[j] * fold.scale;
        ranges[j] = fold.range + fold.side * away_[j];
      }
      if (!(*std::min_element(ranges.begin(), ranges.end()) > 0.0)) continue;
      const std::vector<Arrivals> rays =
          solver.find(source_depth, receiver_depth, ranges, frequency, of_fold);
      known_ = true;
      for (std::size_t j = 0; j < ranges.size() && known_; ++j) {
        const auto pair = pair_about(fold, rays[j]);
        known_ = pair.has_value();
        if (!known_) break;
        const Arrival &early = rays[j][pair->early], &late = rays[j][pair->late];
        if (j == 0) nearest_ = {early, late};
        pairs_[j] = uniform_of(early, late, omega_);
        known_ = of_the_fold(pairs_[j].zeta, away_[j] / fold.scale);
      }
    }
  }

  [[nodiscard]] bool known() const noexcept { return known_; }
  [[nodiscard]] const std::array<Arrival, 2>& nearest() const noexcept { return nearest_; }

  /// Nothing where cubics do not tell it: a parabola without the furthest sample is further from
  /// them than a share of the caustic's own field. \param away  into the lit side [m]
  [[nodiscard]] std::optional<UniformPair> at(double away) const {
    constexpr double tolerance = 0.05, greatest_airy = 0.5357;
    const UniformPair cubic = through(away_.size(), away),
                      parabola = through(away_.size() - 1, away);
    const auto field = [&](const UniformPair& pair) {
      return pair.part(-1.0, omega_, cubic.delay) + pair.part(1.0, omega_, cubic.delay);
    };
    const double peak = std::sqrt(pi) * greatest_airy * std::abs(cubic.direct);
    const double about = away / fold_.scale;
    if (!(std::abs(field(cubic) - field(parabola)) < tolerance * peak)) return std::nullopt;
    if (about < -surely_two && !of_the_fold(-cubic.zeta, -about)) return std::nullopt;
    return cubic;
  }

 private:
  /// Polynomials through the nearest of the samples.
  [[nodiscard]] UniformPair through(std::size_t count, double away) const {
    UniformPair sum{};
    for (std::size_t j = 0; j < count; ++j) {
      double weight = 1.0;
      for (std::size_t k = 0; k < count; ++k)
        if (k != j) weight *= (away - away_[k]) / (away_[j] - away_[k]);
      const UniformPair& here = pairs_[j];
      sum.zeta += weight * here.zeta / away_[j] * away;
      sum.delay += weight * here.delay;
      sum.direct += weight * here.direct;
      sum.slope += weight * here.slope;
      sum.launch += weight * here.launch;
      sum.arrival += weight * here.arrival;
      sum.slowness += weight * here.slowness;
    }
    return sum;
  }

  Fold fold_;
  double omega_;
  bool known_ = false;
  std::array<double, sample_places.size()> away_{};
  std::array<UniformPair, sample_places.size()> pairs_{};
  std::array<Arrival, 2> nearest_;
};

}  // namespace

class Caustics {
 public:
  Caustics(const EigenraySolver& solver, const CausticsNeed& need, const PathLimits& limits)
      : need_(need),
        limits_(limits),
        folds_(folds_within(*solver.table(need.source_depth, need.receiver_depth, limits),
                            need.nearest, need.furthest, 2.0 * pi * need.frequency)),
        slots_(std::make_unique<Slot[]>(folds_.size())) {}

  [[nodiscard]] std::span<const Fold> folds() const noexcept { return folds_; }
  /// Field about one of the folds, made when it is first asked for. \param solver  of that ocean
  [[nodiscard]] const FoldField& field(std::size_t fold, const EigenraySolver& solver) const {
    Slot& slot = slots_[fold];
    std::call_once(slot.once, [&] {
      slot.field.emplace(solver, need_.source_depth, need_.receiver_depth, folds_[fold],
                         need_.frequency, limits_);
    });
    return *slot.field;
  }
  [[nodiscard]] std::size_t bytes() const noexcept {
    constexpr std::size_t bounces = 1000;  // of the rays of a field
    return sizeof *this + folds_.size() * (sizeof(Fold) + sizeof(Slot) + bounces);
  }

 private:
  struct Slot {
    std::once_flag once;
    std::optional<FoldField> field;
  };
  CausticsNeed need_;
  PathLimits limits_;
  std::vector<Fold> folds_;
  std::unique_ptr<Slot[]> slots_;
};

std::size_t bytes_of(const Caustics& caustics) noexcept { return caustics.bytes(); }

void put_caustics(const EigenraySolver& solver, double source_depth, double receiver_depth,
                  double range, double frequency, const PathLimits& limits, Arrivals& found,
                  const CausticsKeeper& keeper) {
  const double omega = 2.0 * pi * frequency;
  const double wavelength = solver.environment().water.at(receiver_depth).c / frequency;
  const double reach = std::min(0.5 * range, 30.0 * std::cbrt(wavelength * wavelength * range));
  if (!(reach > 0.0)) return;
  // Ends are rounded, so that those of a leg that moves by metres have an interval in common.
  const double step = 0.125 * std::exp2(std::ceil(std::log2(reach)));
  const CausticsNeed need{.source_depth = source_depth,
                          .receiver_depth = receiver_depth,
                          .frequency = frequency,
                          .nearest = std::max(0.0, std::floor((range - reach) / step) * step),
                          .furthest = std::ceil((range + reach) / step) * step};
  const CausticsMaker make = [&] { return std::make_shared<Caustics>(solver, need, limits); };
  const std::shared_ptr<const Caustics> caustics = keeper ? keeper(need, make) : make();
  const Arrivals rays = found;
  for (std::size_t i = 0; i < caustics->folds().size(); ++i) {
    const Fold& fold = caustics->folds()[i];
    if (std::abs(fold.range - range) > reach) continue;
    const double away = fold.side * (range - fold.range), about = away / fold.scale;
    if (about > lit || about < dark) continue;
    const auto pair = pair_about(fold, rays);
    const auto replace = [&](const UniformPair& field) {
      for (const auto& [index, sign] : {std::pair{pair->early, -1.0}, {pair->late, 1.0}})
        make_wave(found[index], field.part(sign, omega, rays[index].delay) / rays[index].amplitude);
    };
    if (about > surely_two) {
      if (!pair) continue;
      const UniformPair field = uniform_of(rays[pair->early], rays[pair->late], omega);
      if (of_the_fold(field.zeta, about)) replace(field);
      continue;
    }
    const FoldField& about_fold = caustics->field(i, solver);
    if (!about_fold.known()) continue;
    const auto there = about_fold.at(away);
    if (!there) continue;
    const UniformPair& field = *there;
    if (pair && away > 0.0) {
      replace(field);
      continue;
    }
    const double apart = field.zeta > 0.0 ? 2.0 / 3.0 * std::pow(field.zeta, 1.5) / omega : 0.0;
    for (const auto& [index, sign] : {std::pair{0, -1.0}, {1, 1.0}}) {
      Arrival path = about_fold.nearest()[std::size_t(index)];
      path.delay = field.delay + sign * apart;
      make_wave(path, field.part(sign, omega, path.delay) / path.amplitude);
      path.launch_elevation = field.launch;
      path.arrival_elevation = field.arrival;
      path.horizontal_slowness = field.slowness;
      if (std::abs(path.amplitude) > faintest_caustic / range) found.push_back(std::move(path));
    }
  }
}

}  // namespace asdic::detail
