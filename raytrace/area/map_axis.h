#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace asdic::detail {

/// One axis of a map or of a volume: places in increasing order, even or not, and how values run
/// between them.
///
/// Cubic: through the values, with the slope at every place that the parabola through it and its
/// neighbours has (at the ends: of the outermost line). Value and slope are continuous, values on a
/// parabola are met exactly. Beyond its ends an axis goes on level.
class MapAxis {
 public:
  /// \param name  for messages   \param places  [n ≥ 2] strictly increasing
  /// \throws InputError naming the first that is not
  MapAxis(const char* name, std::vector<double> places);

  [[nodiscard]] std::span<const double> places() const noexcept { return places_; }
  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }
  [[nodiscard]] double begin() const noexcept { return places_.front(); }
  [[nodiscard]] double end() const noexcept { return places_.back(); }
  [[nodiscard]] double mean_spacing() const noexcept {
    return (end() - begin()) / static_cast<double>(size() - 1);
  }
  /// The interval [i, i + 1] that holds x; the first or the last beyond the ends.
  [[nodiscard]] std::size_t interval(double x) const noexcept;
  /// The place that is nearest to x.
  [[nodiscard]] std::size_t nearest(double x) const noexcept;

  /// What of the values at four neighbouring places is the value, the slope and the second
  /// derivative at x. Unused places have the weight 0 and an index that exists.
  struct Cubic {
    std::array<std::size_t, 4> index{};
    std::array<double, 4> value{}, slope{}, bend{};
  };
  [[nodiscard]] Cubic cubic(double x) const noexcept;
  /// The same, but beyond the ends straight on.
  [[nodiscard]] Cubic cubic_going_on(double x) const noexcept;

 private:
  [[nodiscard]] Cubic inside(double x) const noexcept;

  std::vector<double> places_;
  double per_step_;  // 1/spacing of even places; 0: they are not even
};

}  // namespace asdic::detail
