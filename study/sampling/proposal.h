#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "study/sampling/law.h"

// Importance sampling: inputs drawn where an event is, weighed so that nothing is biased.
// docs/theory/rare-events.md
namespace asdic::detail::study {

/// A normal law of a coordinate's normal score z = Φ⁻¹(u), instead of the standard one.
struct ScoreLaw {
  double centre = 0.0, deviation = 1.0;
};
/// A continuous law in place of another one, within whose ends it lies.
struct LawInstead {
  CutLaw law;      ///< of the input
  CutLaw instead;  ///< from which it is drawn
};
/// Other weights of the same choices.
struct WeightsInstead {
  std::vector<double> cumulative;  ///< [choices] of the input, the last one 1
  std::vector<double> instead;     ///< [choices] likewise
};

/// How one coordinate of the unit cube is drawn: uniformly, or so that what its input makes of it
/// follows another law.
using CoordinateDraw = std::variant<std::monostate, ScoreLaw, LawInstead, WeightsInstead>;

/// A coordinate that is drawn so. \param v  uniform in (0, 1)
[[nodiscard]] double drawn_coordinate(const CoordinateDraw& draw, double v) noexcept;
/// ln of its density at u, where the uniform one's is 0.
[[nodiscard]] double log_density(const CoordinateDraw& draw, double u) noexcept;

/// One way of drawing all coordinates, each by itself.
struct ProposalPart {
  std::string name{};                   ///< "laws", "wide", "component 1"
  double share = 1.0;                   ///< of the rows
  std::vector<CoordinateDraw> draws{};  ///< [coordinates]; none: all are uniform
  bool guards = false;                  ///< it is there for what the others may miss
};

/// A mixture from which the coordinates of inputs are drawn together. A row's weight is the
/// quotient of the uniform density and the mixture's, so it is at most one over the share of the
/// part in which all are uniform (Hesterberg, Technometrics 37, 185, 1995).
class Proposal {
 public:
  /// The laws of the inputs themselves: weights are 1.
  Proposal() = default;
  /// \param parts  at least one; shares above 0, of sum 1
  explicit Proposal(std::vector<ProposalPart> parts);

  [[nodiscard]] bool empty() const noexcept { return parts_.empty(); }
  [[nodiscard]] const std::vector<ProposalPart>& parts() const noexcept { return parts_; }
  /// Coordinates of the design that it takes beside those of the inputs.
  [[nodiscard]] std::size_t dimensions() const noexcept { return empty() ? 0 : 1; }
  /// How a row was drawn.
  struct Drawn {
    double log_weight = 0.0;
    std::size_t part = 0;
  };
  /// \param which  uniform in (0, 1): which of the parts
  /// \param u  [coordinates] uniform; becomes what is drawn
  Drawn draw(double which, std::span<double> u) const noexcept;
  /// ln of the weight of a point. \param u  [coordinates]
  [[nodiscard]] double log_weight(std::span<const double> u) const noexcept;

 private:
  std::vector<ProposalPart> parts_;
};

}  // namespace asdic::detail::study
