#include "raytrace/runs/image_field.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "raytrace/beams/fan.h"
#include "raytrace/math/integer_power.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/tracing/reflected.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double wanted_share = 1e-5;  // of the root of the summed intensity that may be left out
constexpr double fan_edge = 1e-12;     // elevations there belong to it [rad]
constexpr double nearest = 0.1;        // receivers nearer than this in range are there [m]
constexpr double lossless = 1e-9;      // what a cycle may lose and count as endless
constexpr std::size_t angles = 1024;   // of the table of losses
constexpr double most_terms = 5e7;     // beyond this beams are cheaper,
constexpr double hardly_lossy = 0.9;   // unless a cycle leaves this: there beams do not converge,
constexpr double most_terms_there = 1e9;
constexpr int most_shells = 1 << 17;

/// What became of a sum over images, its paths.
struct ImageSum : RaySum {
  bool extrapolated = false;
};

/// Levin's u-transform of a series, term by term; D. Levin, Int. J. Comput. Math. B 3, 371 (1973),
/// by the recursion of E. J. Weniger, Comput. Phys. Rep. 10, 189 (1989), §7.2.
class LevinSum {
 public:
  static constexpr int most = 40;

  /// \param start  the sum so far   \param first  index of the first term to come, ≥ 1
  LevinSum(Complex start, double first) : partial_(start), beta_(first) {}

  void add(Complex term) {
    partial_ += term;
    const auto n = static_cast<std::size_t>(count_++);
    const Complex weight = (beta_ + double(n)) * term;
    if (weight == 0.0) return;
    numerator_[n] = partial_ / weight;
    denominator_[n] = 1.0 / weight;
    for (std::size_t j = n; j-- > 0;) {
      const double k = double(n - j) - 1.0, at = beta_ + double(j);
      const double share = at / (at + k + 1.0) * std::pow((at + k) / (at + k + 1.0), k - 1.0);
      numerator_[j] = numerator_[j + 1] - share * numerator_[j];
      denominator_[j] = denominator_[j + 1] - share * denominator_[j];
    }
    const Complex now = denominator_[0] == 0.0 ? partial_ : numerator_[0] / denominator_[0];
    // two steps must agree: one may be small by chance
    error_ = std::max(last_change_, std::abs(now - value_));
    last_change_ = std::abs(now - value_);
    value_ = now;
  }
  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] Complex value() const noexcept { return value_; }
  [[nodiscard]] double error() const noexcept { return count_ < 4 ? infinity : error_; }

 private:
  Complex partial_, value_ = 0.0;
  double beta_, error_ = infinity, last_change_ = infinity;
  int count_ = 0;
  std::array<Complex, most> numerator_{}, denominator_{};
};

/// A wall of the guide.
struct Wall {
  const Boundary& boundary;
  WaterAtBoundary water;
  double wavenumber;
  bool coherent;

  /// Reflection coefficient at a grazing angle [rad]; where intensities are added its square is the
  /// energy, with what a rough wall scatters.
  [[nodiscard]] Complex at(double grazing) const noexcept {
    const Complex mirror = reflection_coefficient(boundary.material, grazing, water);
    if (boundary.roughness.smooth()) return mirror;
    return mirror * left_by_roughness(boundary.roughness, std::sin(grazing), wavenumber, coherent);
  }
};

class ImageGuide {
 public:
  ImageGuide(const PropagationCase& run_case, double source_depth)
      : case_(run_case),
        c_(run_case.environment.water.at(source_depth).c),
        wavenumber_(2.0 * pi * run_case.frequency / c_),
        loss_(attenuation_np_per_m(run_case.environment, run_case.frequency).at(source_depth)),
        depth_(run_case.environment.bottom.depth - run_case.environment.surface.depth),
        source_(source_depth - run_case.environment.surface.depth),
        source_depth_(source_depth),
        surface_(wall(run_case.environment.surface)),
        bottom_(wall(run_case.environment.bottom)),
        coherent_(run_case.field == FieldKind::coherent),
        exponent_(coherent_ ? 1 : 2) {
    const double steepest =
        std::max(std::abs(run_case.beams.lowest), std::abs(run_case.beams.highest));
    widest_ = steepest < 0.5 * pi - fan_edge ? std::tan(steepest) : infinity;
    double largest = 0.0;
    for (std::size_t i = angles; i-- > 0;) {
      const double grazing = 0.5 * pi * double(i) / double(angles - 1);
      largest = std::max(largest, std::abs(surface_.at(grazing) * bottom_.at(grazing)));
      steeper_[i] = std::min(largest, 1.0);
      loudest_ = std::max({loudest_, launch(grazing), launch(-grazing)});
    }
  }

  /// Whether paths that go up and down have no end.
  [[nodiscard]] bool endless() const noexcept {
    return std::isinf(widest_) && cycle(0.5 * pi) > 1.0 - lossless;
  }
  /// Whether their intensities have a sum.
  [[nodiscard]] bool summable() const noexcept {
    if (coherent_ || !std::isinf(widest_) || cycle(0.5 * pi) < 0.999) return true;
    return endless() && case_.beams.source == SourceKind::point;
  }
  /// More terms than this are dearer than beams.
  [[nodiscard]] double affordable_terms() const noexcept {
    return cycle(0.5 * pi) > hardly_lossy ? most_terms_there : most_terms;
  }
  /// About how many images count at a range.
  [[nodiscard]] double images_at(double range) const noexcept {
    double shells = 1.0;
    const double wanted = wanted_share * std::pow(spreading(std::max(range, nearest)), exponent_);
    while (shells < most_shells && bound(range, shells) > wanted) shells = std::ceil(1.3 * shells);
    return 4.0 *
           (has_known_tail() ? std::min(shells, first_tail_shell(range) + LevinSum::most) : shells);
  }

  /// \param range  [m], ≥ 0   \param depth  [m]
  [[nodiscard]] ImageSum at(double range, double depth) const {
    const Environment& ocean = case_.environment;
    const std::optional<double> there = depth_in_water(ocean, depth);
    if (!there) return {};
    if (case_.box_range > 0.0 && range > case_.box_range) return {};
    const Receiver to{std::max(range, nearest), *there - ocean.surface.depth};
    Tally tally;
    const auto tail = static_cast<int>(first_tail_shell(to.range));
    for (int k = 0; k < most_shells; ++k) {
      if (2.0 * (k - 1) * depth_ > widest_ * to.range) return tally.ended(0.0);
      const double left = bound(to.range, k);
      const double scale = coherent_ ? std::sqrt(tally.intensity) : tally.intensity;
      if (k > 0 && left <= wanted_share * scale) return tally.ended(left);
      if (k >= tail && has_known_tail())
        return coherent_ ? levin(to, k, tally) : powers(to, k, tally);
      add_shell(to, k, tally);
    }
    return tally.ended(bound(to.range, most_shells));
  }

  [[nodiscard]] bool coherent() const noexcept { return coherent_; }

 private:
  struct Receiver {
    double range, below_surface;
  };
  struct Tally {
    Complex sum = 0.0;
    double intensity = 0.0;
    int images = 0;
    [[nodiscard]] ImageSum ended(double error) const noexcept {
      return {{sum, error, images}, false};
    }
  };

  [[nodiscard]] bool has_known_tail() const noexcept {
    return coherent_ ? std::isinf(widest_) : endless();
  }

  [[nodiscard]] Wall wall(const Boundary& boundary) const noexcept {
    return {boundary,
            {.speed = c_,
             .density = case_.environment.water_density.at(boundary.depth),
             .frequency = case_.frequency},
            wavenumber_,
            case_.field == FieldKind::coherent};
  }
  [[nodiscard]] double launch(double elevation) const noexcept {
    return launch_amplitude(case_, source_depth_, c_, elevation);
  }
  /// Spreading over a length: 1/R of a point source, 4√(π/R) of a line.
  [[nodiscard]] double spreading(double length) const noexcept {
    return case_.beams.source == SourceKind::point ? 1.0 / length : 4.0 * std::sqrt(pi / length);
  }
  /// The most that a way to both walls and back leaves of any ray this steep or steeper.
  [[nodiscard]] double cycle(double grazing) const noexcept {
    const auto i = static_cast<std::size_t>(grazing / (0.5 * pi) * double(angles - 1));
    return steeper_[std::min(i, angles - 1)] * std::exp(-2.0 * loss_ * depth_);
  }
  /// Upper bound of what all shells from k ≥ 1 on bring, amplitudes or intensities; infinite if
  /// there is none.
  [[nodiscard]] double bound(double range, double k) const noexcept {
    const double rise = 2.0 * std::max(k - 1.0, 0.0) * depth_;
    const double most = cycle(std::atan2(rise, range));
    if (most >= 1.0 || k < 1.0) return infinity;
    const double loudest = loudest_ * spreading(std::hypot(range, rise)) * std::pow(most, k - 1.0);
    return 4.0 * std::pow(loudest, exponent_) / (1.0 - std::pow(most, exponent_));
  }
  /// From here on the shells' terms run smoothly: steep paths, whose phase over k, π-cycles aside,
  /// changes by A/k², A = ωr²/4Dc.
  [[nodiscard]] double first_tail_shell(double range) const noexcept {
    const double bend = wavenumber_ * range * range / (4.0 * depth_);
    return std::ceil(8.0 + 2.0 * range / depth_ + 8.0 * std::cbrt(2.0 * bend));
  }

  /// The image at `rise` below the source (negative: above), after so many bounces.
  void add_image(const Receiver& to, double rise, int surface, int bottom, Tally& tally) const {
    const double elevation = -std::atan2(rise, to.range), grazing = std::abs(elevation);
    if (elevation < case_.beams.lowest - fan_edge || elevation > case_.beams.highest + fan_edge)
      return;
    const double length = std::hypot(to.range, rise);
    const double amplitude = launch(elevation) * spreading(length) * std::exp(-loss_ * length);
    const Complex reflection =
        integer_power(surface_.at(grazing), surface) * integer_power(bottom_.at(grazing), bottom);
    const double intensity = amplitude * amplitude * std::norm(reflection);
    tally.sum += coherent_ ? amplitude * reflection * std::polar(1.0, -wavenumber_ * length)
                           : Complex(intensity);
    tally.intensity += intensity;
    ++tally.images;
  }
  /// The images of k bounces off each wall, and those of one more off the surface or one less.
  void add_shell(const Receiver& to, int k, Tally& tally) const {
    const double same = to.below_surface - source_, mirrored = -to.below_surface - source_;
    const double up = 2.0 * k * depth_;
    add_image(to, same - up, k, k, tally);
    add_image(to, mirrored - up, k + 1, k, tally);
    if (k == 0) return;
    add_image(to, same + up, k, k, tally);
    add_image(to, mirrored + up, k - 1, k, tally);
  }
  [[nodiscard]] Complex shell(const Receiver& to, int k, Tally& tally) const {
    const Complex before = tally.sum;
    add_shell(to, k, tally);
    return tally.sum - before;
  }

  /// A coherent sum from shell k on; later and later until it settles.
  [[nodiscard]] ImageSum levin(const Receiver& to, int k, Tally& tally) const {
    for (;;) {
      LevinSum tail(tally.sum, k);
      Tally ahead = tally;
      const double wanted = wanted_share * std::sqrt(tally.intensity);
      while (tail.count() < LevinSum::most && tail.error() > wanted)
        tail.add(shell(to, k + tail.count(), ahead));
      if (tail.error() <= wanted || 2 * k > most_shells)
        return {{tail.value(), tail.error(), ahead.images}, true};
      for (const int next = 2 * k; k < next; ++k) add_shell(to, k, tally);
    }
  }
  /// A sum of intensities: what is left after shell K is a/M + b/M³ + …, M = K + ½, since the
  /// shells are even in k and midpoints integrate them.
  [[nodiscard]] ImageSum powers(const Receiver& to, int k, Tally& tally) const {
    std::array<double, 3> x{}, s{};  // 1/M, sum up to there
    for (std::size_t i = 0; i < 3; ++i) {
      for (const int next = k << (i > 0 ? 1 : 0); k < next; ++k) add_shell(to, k, tally);
      x[i] = 1.0 / (double(k) - 0.5), s[i] = tally.sum.real();
    }
    const auto without_first = [&](std::size_t i, std::size_t j) {  // S + b·…
      return (s[j] * x[i] - s[i] * x[j]) / (x[i] - x[j]);
    };
    // then b·x_i·x_j·(x_i + x_j) is left in each
    const double e1 = without_first(0, 1), e2 = without_first(1, 2);
    const double w1 = x[0] * x[1] * (x[0] + x[1]), w2 = x[1] * x[2] * (x[1] + x[2]);
    const double value = (e2 * w1 - e1 * w2) / (w1 - w2);
    return {{value, std::abs(value - e2), tally.images}, true};
  }

  const PropagationCase& case_;
  double c_, wavenumber_, loss_, depth_;
  double source_, source_depth_;  // below the surface, and in depth
  Wall surface_, bottom_;
  bool coherent_;
  int exponent_;                          // of an amplitude in what is summed
  double widest_ = 0.0;                   // tangent of the steepest elevation of the fan
  double loudest_ = 0.0;                  // launch amplitude
  std::array<double, angles> steeper_{};  // largest |R_s R_b| at this grazing angle and above
};

bool is_flat_guide(const PropagationCase& run_case) {
  const Environment& ocean = run_case.environment;
  const SoundSpeedProfile& water = ocean.water;
  if (ocean.section || ocean.surface.shape || ocean.bottom.shape || water.munk_parameters() ||
      !attenuation_np_per_m(ocean, run_case.frequency).is_constant())
    return false;
  // Columns of a map are interpolated: what is the same everywhere may differ by rounding there.
  constexpr double rounding = 1e-12;
  const auto speeds = water.speeds();
  return std::all_of(speeds.begin(), speeds.end(), [&](double c) {
    return std::abs(c - speeds.front()) <= rounding * speeds.front();
  });
}

std::string note_of(int images, bool extrapolated, double error_db, bool exact) {
  char text[400];
  std::snprintf(
      text, sizeof text,
      "isovelocity water between flat boundaries: the field is the sum over up to %d "
      "images of the source%s; images left out are %s %.1g dB at 95 %% of the receivers%s",
      images, extrapolated ? ", whose tail, since little is lost, is extrapolated" : "",
      extrapolated ? "about" : "at most", error_db,
      exact ? ""
            : "; all are reflected as plane waves are, by which the wave equation differs "
              "by decibels next to a floor's critical angle");
  return text;
}

/// |ΔTL| that an error may make, at 95 % of those receivers that receive anything [dB].
double error_at_95(const std::vector<RaySum>& sums, bool coherent) {
  std::vector<double> all;
  for (const RaySum& s : sums)
    if (s.paths > 0 && s.value != 0.0) {
      const double share = std::min(s.error / std::abs(s.value), 1.0);
      all.push_back((coherent ? 20.0 : 10.0) * std::log10(1.0 + share));
    }
  if (all.empty()) return 0.0;
  const auto at = all.begin() + std::ptrdiff_t(0.95 * double(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

}  // namespace

bool narrows_to_paths(const PropagationCase& run_case) {
  const BeamSettings& beams = run_case.beams;
  const Environment& ocean = run_case.environment;
  const bool hats = beams.kind == BeamKind::hat || beams.kind == BeamKind::ray_centred_hat;
  const bool forward = beams.lowest >= -0.5 * pi - fan_edge && beams.highest <= 0.5 * pi + fan_edge;
  const bool within_box =
      !(run_case.box_depth > 0.0) ||
      (run_case.box_depth >= ocean.bottom.depth && -run_case.box_depth <= ocean.surface.depth);
  return hats && forward && within_box && beams.elevations.empty() && !beams.displacement &&
         run_case.receivers.ranges.front() >= 0.0;
}

bool mirrors_exactly(const PropagationCase& run_case) noexcept {
  const Environment& ocean = run_case.environment;
  const auto mirrors = [&](const Boundary& wall) {
    const auto at = [&](double grazing) {
      return reflection_coefficient(wall.material, grazing,
                                    {.speed = sound_speed(ocean, 0.0, wall.depth).c,
                                     .density = ocean.water_density.at(wall.depth),
                                     .frequency = run_case.frequency});
    };
    bool alike = wall.roughness.smooth();
    for (const double grazing : {0.01, 0.1, 0.3, 0.6, 1.0})
      alike = alike && std::abs(at(grazing) - at(0.5 * pi)) < 1e-6;
    return alike;
  };
  return mirrors(ocean.surface) && mirrors(ocean.bottom);
}

std::optional<double> depth_in_water(const Environment& ocean, double depth) noexcept {
  constexpr double on_boundary = 1e-3;
  const double there = std::clamp(depth, ocean.surface.depth, ocean.bottom.depth);
  return std::abs(depth - there) <= on_boundary ? std::optional(there) : std::nullopt;
}

ConvergedField field_of_sums(const std::vector<RaySum>& sums, bool coherent) {
  ConvergedField result;
  result.field.reserve(sums.size());
  for (const RaySum& s : sums)
    result.field.push_back(coherent ? s.value : std::sqrt(std::max(s.value.real(), 0.0)));
  result.error_db = error_at_95(sums, coherent);
  return result;
}

std::optional<ConvergedField> image_field(const PropagationCase& run_case, double source_depth,
                                          const Progress& progress) {
  if (!is_flat_guide(run_case) || !narrows_to_paths(run_case)) return std::nullopt;
  const ImageGuide guide(run_case, source_depth);
  const ReceiverGrid& grid = run_case.receivers;
  const double images_each = guide.images_at(grid.ranges[grid.ranges.size() / 2]);
  if (!guide.summable() || double(grid.size()) * images_each > guide.affordable_terms())
    return std::nullopt;

  const std::size_t columns = grid.ranges.size(), rows = grid.rows();
  std::vector<RaySum> sums(grid.size());
  std::atomic<bool> extrapolated = false;
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel(columns, [&](std::size_t j) {
    for (std::size_t i = 0; i < rows && !stopped; ++i) {
      const ImageSum sum = guide.at(grid.ranges[j], grid.depths[grid.irregular ? j : i]);
      sums[i * columns + j] = sum;
      if (sum.extrapolated) extrapolated = true;
    }
    if (progress && !progress(double(++done) / double(columns))) stopped = true;
  });
  if (stopped) throw Interrupted();

  ConvergedField result = field_of_sums(sums, guide.coherent());
  int images = 0;
  for (const RaySum& s : sums) images = std::max(images, s.paths);
  result.bounded = !extrapolated;
  result.note = note_of(images, extrapolated, result.error_db,
                        mirrors_exactly(run_case) || !guide.coherent());
  return result;
}

}  // namespace asdic::detail
