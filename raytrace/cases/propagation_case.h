#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "raytrace/area/ocean_on_map.h"
#include "raytrace/ocean/ocean_origin.h"
#include "raytrace/ocean/transect.h"

namespace asdic::detail {

/// What is computed.
enum class Task { rays, eigenrays, arrivals, eigenrays_and_arrivals, field };

/// How a field adds its beams.
enum class FieldKind {
  coherent,       ///< pressures
  incoherent,     ///< intensities
  semi_coherent,  ///< intensities, each launched with the Lloyd-mirror pattern of a surface at z =
                  ///< 0
};

/// What a coherent field is made of. docs/theory/waves.md
enum class FieldSolver {
  automatic,  ///< waves where the water is stratified and they are affordable, else beams
  beams,      ///< rays: nothing where rays do not go
  waves,      ///< the wave equation, whatever it costs
};

/// Shape of a beam across its ray. docs/theory/beams.md
enum class BeamKind {
  hat,              ///< geometric, triangular, in Cartesian coordinates
  gaussian,         ///< geometric, Gaussian, in Cartesian coordinates
  ray_centred_hat,  ///< along the normals of the ray
  ray_centred_gaussian,
  simple_gaussian,
  cerveny_cartesian,  ///< paraxial beams of complex curvature
  cerveny_ray_centred,
};

enum class SourceKind { point, line };

/// What only Cerveny beams know.
struct CervenyBeams {
  enum class Width { space_filling, minimum, wkb, cerveny };
  enum class Curvature { standard, doubled, zero };  ///< of the p-jump at a reflection
  enum class Component { pressure, vertical, horizontal };
  Width width = Width::space_filling;
  Curvature curvature = Curvature::standard;
  double width_multiplier = 1.0;  ///< ε multiplier
  double loop_range = 0.0;        ///< where a minimum-width beam is narrowest [m]
  int images = 1;                 ///< 1: the ray; 2: and over the surface; 3: and under the bottom
  int window = 4;                 ///< half-width of the beam, in its own widths
  Component component = Component::pressure;
};

/// Level over launch angle, linear amplitude between rows, going on from the last pair beyond them.
struct SourcePattern {
  std::vector<double> elevation;  ///< [n] increasing [rad], positive up
  std::vector<double> amplitude;  ///< [n] 1: as without a pattern
  [[nodiscard]] double at(double launch_elevation) const noexcept;
};

/// Where the field is wanted.
struct ReceiverGrid {
  std::vector<double> depths;  ///< [n] increasing [m]
  std::vector<double> ranges;  ///< [m] increasing [m]
  bool irregular =
      false;  ///< receiver i is at (ranges[i], depths[i]), n = m; else the grid of both
  [[nodiscard]] std::size_t rows() const noexcept { return irregular ? 1 : depths.size(); }
  [[nodiscard]] std::size_t size() const noexcept { return rows() * ranges.size(); }
};

/// The fan and the beams as asked for.
struct BeamSettings {
  BeamKind kind = BeamKind::hat;
  SourceKind source = SourceKind::point;
  std::optional<SourcePattern> pattern;
  std::optional<CervenyBeams> cerveny;
  bool displacement = false;  ///< beams are displaced along the boundary at reflection
  double lowest =
      -0.5 * pi;  ///< launch elevations between which the source shines [rad], positive up
  double highest = 0.5 * pi;
  std::vector<double>
      elevations;  ///< exactly these rays [rad]; empty: evenly from lowest to highest
  int count = 0;   ///< rays of a ray run; least number of beams otherwise; 0: by our own rule
};

/// What an input file of BELLHOP says and only a literal run obeys, but for the single beam
/// (docs/guide/from-bellhop.md).
struct LiteralSettings {
  double step = 0.0;               ///< [m]; 0: a tenth of the depth
  int beams = 0;                   ///< as written; 0: by BELLHOP's rule
  std::optional<int> single_beam;  ///< trace this one only, counted from 1
};

/// A run of the propagation model: everything that goes in. Plain data; SI units and radians.
struct PropagationCase {
  std::string title;
  double frequency = 1000.0;          ///< [Hz]
  Environment environment;            ///< along the transect
  std::optional<OceanOrigin> origin;  ///< where on the Earth it is, and what it was made of
  /// The area that it is cut out of: from a place on the map along a bearing.
  struct OnArea {
    std::shared_ptr<const Area> area;
    Vec2 place = Vec2::Zero();
    double bearing = 0.0;  ///< [rad]
  };
  std::optional<OnArea> on_area;   ///< none: the same everywhere across the transect
  std::optional<Transect> on_map;  ///< from the sources along `environment`; none: any bearing
  int dimension = 2;               ///< 3: rays are turned out of their planes, too
  double off_transect = 0.0;       ///< of the line on which the receivers lie, clockwise [rad]
  std::vector<double> source_depths = {100.0};  ///< [m]
  ReceiverGrid receivers;
  Task task = Task::field;
  FieldKind field = FieldKind::coherent;
  FieldSolver solver = FieldSolver::beams;
  BeamSettings beams;
  double box_range = 0.0;  ///< rays end at this distance from the source [m]
  double box_depth = 0.0;  ///< rays end this far below and above depth 0 [m]
  LiteralSettings literal;
};

/// The vertical plane through sources and receivers, `environment` unless they lie elsewhere.
[[nodiscard]] Environment plane_of(const PropagationCase& run_case);

/// How far the maps of an area go on in that plane, to `most` m; `most` itself without one [m].
[[nodiscard]] double reach_on_map(const PropagationCase& run_case, double most);

}  // namespace asdic::detail
