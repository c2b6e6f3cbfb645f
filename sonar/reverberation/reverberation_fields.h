#pragma once
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/fields/scattering_parts.h"
#include "reverb/pairs/boundary_fans.h"
#include "sonar/reverberation/reverberation_context.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// Speed of sound at the surface over a scenario's first platform's first place [m/s].
[[nodiscard]] double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths);

/// The fields of scatterers that any ping of a scenario meets at any of its arrays: laid around
/// which anchors, in which cells, reached by which paths. Built once; shared by threads.
class ReverberationFields {
 public:
  /// \param scenario, paths  must outlive this   \param widest  of the pulses: it sets the grid
  ReverberationFields(const Scenario& scenario, const PropagationPaths& paths, const Pulse& widest);

  /// How finely the paths to a boundary are known.
  enum class Ground {
    scatterers,  ///< for each scatterer by itself: cells of the grid
    means        ///< for means over many: wider cells where they are far away
  };
  /// All that a ping receives.
  [[nodiscard]] std::vector<ScatteringField> of(const ReverberationContext& context,
                                                Ground ground) const;
  /// Those fields with the paths to each scatterer, as far as they are received one by one.
  [[nodiscard]] std::vector<ScatteringField> in_detail(std::vector<ScatteringField> fields,
                                                       const ReverberationContext& context) const;
  [[nodiscard]] double ground_spacing() const noexcept { return spacing_; }  ///< [m]
  [[nodiscard]] std::vector<ScatteringPart> parts() const;
  /// Vertical planes around a place: as many as settings and the grid of an area ask for.
  [[nodiscard]] int planes(double reach) const;

 private:
  /// Whether nothing tells where in the world a part of the sea lies: each ping has weights of its
  /// own, there is one array, and the ocean is the same everywhere.
  [[nodiscard]] bool forgets_places(const ScatteringPart& part,
                                    const ReverberationContext& context) const;
  /// Cells for means over many scatterers: places that a level, a covariance or streams look at lie
  /// further apart [m].
  [[nodiscard]] static double wide_cells(const Pulse& pulse) noexcept;
  /// Of those that a fan is followed to. \param reach  of them [m]
  [[nodiscard]] double wide_cells(const Pulse& pulse, Ground ground, double reach) const noexcept;
  /// Adds the fields of a part that a ping receives, one for every anchor.
  void meet(ScatteringPart part, const ReverberationContext& context, Ground ground,
            std::vector<ScatteringField>& fields) const;
  /// Whether it can be received that pairs of ends with other anchors receive other seas: of
  /// weights that outlast a ping, or if one ping is received from several platforms.
  [[nodiscard]] bool seas_compared(const ScattererField& field) const;
  /// The same, as one of which every ping draws its own.
  void meet_anew(ScatteringPart part, const ReverberationContext& context, Ground ground,
                 std::vector<ScatteringField>& fields) const;
  /// ScatteringField::stays
  [[nodiscard]] bool stays(const ScattererField& field) const;
  /// Whether the next ping receives other sums of the same scatterers, and streams could stand for
  /// them. \param middle, next  of source and receiver, at this ping and the next
  [[nodiscard]] bool left_behind(const ReverberationContext& context, const Vec2& middle,
                                 const Vec2& next) const;
  /// Of a ring: as many as are resolved, but no more scatterers in all rings than twice the most
  /// returns, and no fewer sectors than the scenario says. \param reach  of the rings [m]
  [[nodiscard]] int sectors(double reach) const;

  const Scenario& scenario_;
  const PropagationPaths& paths_;
  BoundaryFans fans_;
  double spacing_, fastest_water_;
  int resolved_sectors_;
  LayerEnds ends_;          // of all pings
  std::vector<int> winds_;  // kinds of them (wind_kind()) that are heard, where they are mapped
};

}  // namespace asdic::detail
