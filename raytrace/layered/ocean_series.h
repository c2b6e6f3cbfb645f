#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "raytrace/layered/leg_series.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// What rays add up from every cut of an ocean to their vertices above and below, as series in σ:
/// wherever source and receiver lie, their legs are two of these and the way from a cut to the
/// depth itself (OceanLegs). For cubics and Munk's law, where walking through the layers takes
/// several times as long.
///
/// A piece is computed when it is first asked for; the numbers do not depend on who asks.
class OceanSeries {
 public:
  /// With fewer layers walking them is as quick; more would take too much memory (1 kB a cut and
  /// piece: 20 MB at most).
  static constexpr std::size_t fewest_layers = 6, most_layers = 96;
  /// Whether the layers, not yet cut by source and receiver, are such an ocean's.
  [[nodiscard]] static bool worth_keeping(std::span<const Layer> layers) noexcept;

  /// \param layers  uncut; must outlive this
  explicit OceanSeries(std::span<const Layer> layers);

  /// A extent of σ.
  class Piece {
   public:
    Piece(std::span<const Layer> layers, double c_ref, double speed_between, double from,
          double to) noexcept
        : layers_(layers),
          reference_speed_(c_ref),
          between_(speed_between),
          low_(from),
          high_(to) {}

    /// Of rays, by their sine where the speed is this [m/s].
    [[nodiscard]] double reference_speed() const noexcept { return reference_speed_; }
    [[nodiscard]] SigmaExtent extent() const noexcept { return {low_, high_}; }

    /// Legs from a cut: up, to the vertex above it, and down.
    static constexpr std::size_t up = 0, down = 1;
    struct Cut {
      LegFit<2> legs;  ///< values, or once it was asked for, series
      bool good = false;
      bool turns_above = false, turns_below = false;  ///< the vertices are no boundaries
      std::atomic<bool> ready = false;
    };
    /// \param index  from 0, the surface, to the number of layers, the bottom
    [[nodiscard]] const Cut& cut(std::size_t index);
    /// Its rays are not for series.
    void give_up() noexcept { given_up_ = true; }
    [[nodiscard]] bool given_up() const noexcept { return given_up_; }
    /// One half of the extent or the other.
    [[nodiscard]] Piece& half(double sigma);

   private:
    void compute();
    void make(std::size_t index);

    std::span<const Layer> layers_;
    double reference_speed_, between_;  ///< a speed inside the rays' interval
    double low_, high_;
    bool given_up_ = false;
    std::mutex mutex_;  ///< of what is being made
    std::atomic<bool> computed_ = false;
    std::unique_ptr<Cut[]> cuts_;
    std::once_flag halved_;
    std::array<std::unique_ptr<Piece>, 2> half_;
  };

  /// The piece of a ray, whose series hold from these two cuts; none if there is none. \param
  /// c_ref  of σ, not above the speed at which the ray turns [m/s]
  struct Found {
    const Piece* piece = nullptr;
    const Piece::Cut *cut = nullptr, *other_cut = nullptr;

    bool operator==(const Found&) const = default;
  };
  [[nodiscard]] Found find(double c_ref, double sigma, std::size_t cut,
                           std::size_t other_cut) const;

 private:
  struct Interval {
    double reference_speed;
    std::vector<std::unique_ptr<Piece>> pieces;  ///< of increasing σ
  };
  std::vector<Interval> intervals_;  ///< between the cuts' speeds, and from the fastest on
};

/// The legs of a column out of the series of its ocean.
class OceanLegs {
 public:
  OceanLegs(const Column& column, const OceanSeries& series, std::span<const Layer> uncut);

  [[nodiscard]] OceanSeries::Found find(double c_ref, double sigma) const {
    return series_->find(c_ref, sigma, upper_.cut, lower_.cut);
  }
  /// As walk_sums and walk_all. Where nothing is found, and beyond the piece's ends, rays are
  /// walked.
  [[nodiscard]] SimdColumn sums(const Column& column, const OceanSeries::Found& found,
                                const SimdRays& rays) const noexcept;
  /// As walk_sums, of rays that may have a piece each.
  [[nodiscard]] SimdColumn sums(const Column& column, const SimdRays& rays) const noexcept;
  [[nodiscard]] SimdColumn all(const Column& column, const OceanSeries::Found& found,
                               const SimdRays& rays) const noexcept;

 private:
  /// The cut at the slower edge of the layer that a depth lies in: every ray of the depth comes
  /// there.
  struct Anchor {
    std::size_t cut = 0;
    std::size_t first = 0, last = 0;  ///< the column's layers between the two
    bool above = true;                ///< the cut is above the depth
  };
  static Anchor anchor(const Column& column, std::size_t node, std::span<const Layer> uncut);
  template <bool detailed>
  SimdColumn legs(const Column& column, const OceanSeries::Found& found,
                  const SimdRays& rays) const noexcept;

  const OceanSeries* series_;
  Anchor upper_, lower_;
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
