#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "core/units.h"

namespace asdic::detail {

/// What an array can tell of a direction.
enum class ArrayKind {
  point,   ///< nothing: one phone, or all in one place
  line,    ///< the angle with its axis: a cone of directions
  plane,   ///< a direction or its mirror image in the plane; of a `bent` line, the side
  volume,  ///< the direction
};

/// How phones lie, seen with a wavelength: what strays less than an eighth of it from a line (or
/// plane) lies on it.
struct ArrayShape {
  ArrayKind kind = ArrayKind::point;
  Vec3 centre = Vec3::Zero();   ///< mean of the phones [m]
  Vec3 axis = Vec3::UnitY();    ///< line: unit vector, from the first phone towards the last
  Vec3 across = Vec3::UnitX();  ///< plane: unit vector of the widest extent across the axis
  Vec3 normal = Vec3::UnitZ();  ///< plane: unit vector
  double length = 0.0;          ///< of the longest way through the phones [m]
  double width = 0.0;           ///< and along `across` [m]
  double height = 0.0;          ///< vertical extent [m]
  double breadth = 0.0;         ///< longest horizontal extent [m]
  /// A plane that is a line but for a bend too slight to tell elevations (within 45° of the
  /// horizontal it answers within 3 dB): it tells the angle with its axis, as a line does, and on
  /// which side of it. docs/theory/processing.md
  bool bent = false;

  /// Line: within 45° of the vertical (then it measures elevation, not bearing).
  [[nodiscard]] bool upright() const noexcept {
    return kind == ArrayKind::line && std::abs(axis.z()) > std::sqrt(0.5);
  }
};

[[nodiscard]] ArrayShape shape_of(std::span<const Vec3> phones, double wavelength);

/// Directions that an array is steered to: unit vectors towards where sound comes from.
struct BeamGrid {
  std::vector<Vec3> looks;
  std::vector<double> cosine;  ///< line: of the angle between look and axis; else empty
  double spacing = 0.0;        ///< between neighbours: of the cosine (line), or of the angle [rad]
};

/// Beams half a resolution cell, λ/(2·extent), apart, so that a plane wave between two loses about
/// a decibel at most (two where beams step in two angles): in the cosine for a line, in bearing and
/// elevation for others (rows of elevation as close as height and breadth ask for, one half space
/// for a plane; for a bent line the horizontal one). \param lowest, highest  elevation looked at by
/// planes and volumes [rad]
[[nodiscard]] BeamGrid beam_grid(const ArrayShape& shape, double wavelength,
                                 double lowest = -0.5 * pi, double highest = 0.5 * pi);

/// Phones' weights that lower side lobes: Hann over the array's longest extent; normalised to a sum
/// of 1. \param hann  false: all the same
[[nodiscard]] std::vector<double> shading(std::span<const Vec3> phones, bool hann);

/// Phase of a plane wave from `look` at each phone: e^{+i·k·look·x}, x from the shape's centre.
[[nodiscard]] std::vector<std::complex<double>> steering_vector(std::span<const Vec3> phones,
                                                                const Vec3& centre,
                                                                const Vec3& look,
                                                                double wavenumber);

/// |Σ w a*(steered)·a(from)|²: how much power of a plane wave from one direction is in the beam
/// towards another. \param weights  sum 1
[[nodiscard]] double beam_pattern(std::span<const Vec3> phones, std::span<const double> weights,
                                  const Vec3& steered, const Vec3& from, double wavenumber);

/// Where within about a beam of `look` the conventional beam of one snapshot is loudest: the most
/// likely direction of a single plane wave in white noise. A line moves along its cosine, a bent
/// one in bearing, others in bearing and elevation. \param snapshot  [phones]   \param step spacing
/// of the grid
[[nodiscard]] Vec3 refine_direction(std::span<const std::complex<double>> snapshot,
                                    std::span<const Vec3> phones, const ArrayShape& shape,
                                    std::span<const double> weights, const Vec3& look, double step,
                                    double wavenumber);

/// What a line (in the horizontal plane) or a plane cannot tell from a direction; the direction
/// itself of others, and of bent lines.
[[nodiscard]] Vec3 mirrored(const ArrayShape& shape, const Vec3& look);

/// The horizontal unit vector to a line's right (starboard); north of an upright one.
[[nodiscard]] Vec3 right_of(const Vec3& axis);

/// A unit vector at an angle to a line: in the horizontal plane on its right (starboard) where the
/// line allows, north of an upright one. \param cosine  of the angle with the axis, −1 … 1
[[nodiscard]] Vec3 on_cone(const Vec3& axis, double cosine);

}  // namespace asdic::detail
