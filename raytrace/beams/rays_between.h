#pragma once
#include <vector>

#include "raytrace/beams/crossings.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// Rays of a fan between three that were traced, where these foretell one another: of a family that
/// is smooth at most columns, a ray costs a fortieth of one that is traced.
///
/// At a column, depth z and delay τ are cubics in the launch elevation α between two rays, whose
/// slopes are known: ∂z/∂α = ∓q/cos θ, ∂τ/∂α = (sin θ/c)·∂z/∂α; all else is a parabola through the
/// three. Where one of two has been reflected and the other has yet to be, either is taken as it
/// would be on the other's side, mirrored in the boundary's tangent: a ray between them is the one
/// of two parabolas that is in the water. docs/theory/fields.md, "Rays
/// between traced ones"
class RaysBetween {
 public:
  explicit RaysBetween(const PropagationCase& run_case);

  /// A ray of the fan that was traced.
  struct Traced {
    double elevation = 0.0;
    Crossings crossings;
  };

  /// Takes three neighbours, which have to stay as they are. \return whether the outer two foretell
  /// the middle one so well that those between any two of the three are right to a hundredth of a
  /// radian, of a beam's width and of its level. If not, nothing is to be had from them.
  /// \param spacing  from ray to ray of the fan there [rad]
  bool fit(const Traced& lowest, const Traced& middle, const Traced& highest, double spacing);

  /// A ray between the lowest and the highest.
  void at(double elevation, Crossings& out) const;

 private:
  /// One crossing.
  struct Place {
    double depth, cosine, sine, speed, time, q, dq_ds, level, phase, mirror;
  };
  [[nodiscard]] static Place place(const Traced& ray, std::size_t k) noexcept;
  [[nodiscard]] static double depth_slope(const Place& x) noexcept;
  /// Crossing k between two rays.
  [[nodiscard]] Place between(const Traced& a, const Traced& b, std::size_t k,
                              double elevation) const noexcept;
  /// The same as a neighbour of one of them, on its side of what parts it from the other.
  [[nodiscard]] Place beside(const Traced& ray, const Traced& other, std::size_t k,
                             double elevation) const noexcept;
  /// Crossings between two of the three, as polynomials in t, 0 at the lower and 1 at the higher.
  class Half {
   public:
    void fit(const Traced& a, const Traced& b, const Traced& third, std::size_t size);
    void at(double elevation, Crossings& out) const;
    /// Crossings that no polynomial tells, where the two have another history.
    [[nodiscard]] const std::vector<std::size_t>& parted() const noexcept { return parted_; }

   private:
    static constexpr std::size_t cubics = 2, parabolas = 6, numbers = 4 * cubics + 3 * parabolas;
    double begin_ = 0.0, width_ = 1.0;
    std::vector<double> coefficients_;  // [numbers × crossings]
    std::vector<std::size_t> parted_;
    const Crossings* like_ = nullptr;  // columns, directions and mirrors
    std::size_t size_ = 0;
  };
  [[nodiscard]] bool in_water(std::size_t column, double depth) const noexcept;
  /// \param smooth  the outer two are of one history with it
  [[nodiscard]] bool foretold(const Place& said, const Place& is, bool smooth) const noexcept;

  double omega_, spacing_ = 0.0;
  bool is_hat_, coherent_;
  struct Wall {
    double depth, slope;
  };
  std::vector<Wall> surface_, bottom_;  // [columns]
  const Traced *low_ = nullptr, *middle_ = nullptr, *high_ = nullptr;
  std::size_t size_ = 0;  // crossings of the three
  Half halves_[2];
};

}  // namespace asdic::detail
