#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/kinematics.h"
#include "reverb/pairs/boundary_fans.h"
#include "reverb/pairs/doppler_span.h"
#include "reverb/pairs/path_groups.h"
#include "reverb/pairs/receiver_leg.h"
#include "reverb/pairs/transmit_pattern.h"
#include "reverb/scattering/models.h"
#include "reverb/scattering/motion.h"

namespace asdic::detail {

/// One of the frequencies at which amplitudes are known where one is not enough.
struct BandPoint {
  double frequency = 1000.0;                 ///< [Hz]
  const TransmitPattern* pattern = nullptr;  ///< there
  double more_nepers = 0.0;                  ///< absorption over that at the centre [Np/m]
};

/// A way for sound to take from the source to a scatterer and on to the receiver: a path, or a
/// group of paths that is received as one, on either leg.
struct PathPair {
  const BoundaryPath* out = nullptr;            ///< the strongest of its group
  const BoundaryPath* back = nullptr;           ///< as launched from the receiver
  std::uint32_t out_index = 0, back_index = 0;  ///< among the paths of their cells
  const PathEnds* out_ends = nullptr;
  const PathEnds* back_ends = nullptr;
  double delay = 0.0;  ///< of the leading edge when it is received [s]
  /// D·A_out·A_back·√σ [1/m] of a scatterer of 1 m², summed over the groups.
  std::complex<double> amplitude = 0.0;
  double power = 0.0;                          ///< |amplitude|², the largest in the band
  double cross_section = 0.0;                  ///< [1/sr], volume: times the sheet's thickness
  double grazing_in = 0.0, grazing_out = 0.0;  ///< to the boundary itself [rad]
  double area = 1.0;                           ///< of the boundary over its horizontal projection
  Vec2 leaving = Vec2::Zero();                 ///< unit vector from the source to the scatterer
  Vec2 coming = Vec2::Zero();  ///< unit vector from the scatterer to the receiver, as it receives
  const Kinematics* receiver = nullptr;  ///< the straight way on which it receives: of the sheet
  bool of_many = false;  ///< it stands for the pairs of a bundle, whose sounds add by energy
  /// Of such a pair: power of what is received over its own, 2 where the same way back is taken in
  /// the opposite direction with the same phase.
  double reciprocal = 1.0;
};

/// A group of paths that is followed from an end to a place: itself, or one out of a bundle.
struct TakenGroup {
  static constexpr std::uint32_t no_bundle = 0xffffffff;
  std::uint32_t group = 0;           ///< among the groups of the cell
  std::uint32_t bundle = no_bundle;  ///< that it stands for
  double gain = 1.0;                 ///< of its amplitude, to stand for all

  [[nodiscard]] bool of_many() const noexcept { return bundle != no_bundle; }
};

class ScatteringSheet;

/// By which laws a boundary scatters.
struct ScatteringLaws {
  AnyScattering usual;
  std::map<int, AnyScattering> of_kind = {};  ///< of cells of that CellFacet::kind

  /// A law is laws.
  template <std::convertible_to<AnyScattering> Model>
  requires(!std::same_as<std::remove_cvref_t<Model>, ScatteringLaws>)
      ScatteringLaws(Model&& law)  // NOLINT
      : usual(std::forward<Model>(law)) {}
};

/// The pairs of paths through a place, and the memory that finding them takes: used again from
/// place to place, nothing is allocated once it is large enough. Places of one ring that see the
/// same cells under the same angles share their cross-sections.
struct PathPairs {
  std::vector<PathPair> found;
  std::vector<std::complex<double>>
      responses;  ///< [found × points of the band] as PathPair::amplitude

 private:
  friend class ScatteringSheet;
  const ScatteringSheet* sheet_ = nullptr;
  std::size_t out_ = 0, back_ = 0;  // first paths of the cells whose cross-sections these are
  double turn_ = 0.0;
  std::vector<TakenGroup> out_taken_, back_taken_;
  // [taken × (centre, points of the band)], with their gains; then one more of the way back
  std::vector<std::complex<double>> sent_, home_, other_home_;
  std::vector<double> way_home_, power_home_;  // [taken] delay [s], and norm of home_ at the centre
  std::vector<double>
      sigma_;  // [out × back × (centre, points of the band)], below 0: not known yet
};

/// What is too faint to be received: in every segment of delay, the power up to which a pair
/// through a whole ring is left out.
struct AudibleLimits {
  double segment = 1.0;       ///< length [s]
  std::vector<double> least;  ///< [segments] [1]

  [[nodiscard]] double at(double delay) const noexcept {
    const auto i = static_cast<std::size_t>(std::max(0.0, delay) / segment);
    return i < least.size() ? least[i] : 0.0;
  }
  /// No more than at() of any delay less than `segments` segments away.
  [[nodiscard]] double about(double delay, std::size_t segments) const noexcept {
    const auto i = static_cast<std::size_t>(std::max(0.0, delay) / segment);
    if (i + segments >= least.size()) return 0.0;
    const auto at = [&](std::size_t k) { return least.begin() + static_cast<std::ptrdiff_t>(k); };
    return *std::min_element(at(i > segments ? i - segments : 0), at(i + segments + 1));
  }
};

/// A law over the ends of one ping: which the boundary is, who sends and who receives.
struct SheetEnds {
  Kinematics source, receiver;                            ///< at the ping's start
  std::vector<ReceiverLeg> legs = {};                     ///< none: it keeps its velocity
  double source_speed = 1500.0, receiver_speed = 1500.0;  ///< of sound there [m/s]
  double frequency = 1000.0;                              ///< [Hz]
  double latest = infinity;                               ///< end of the record [s]
  std::span<const BandPoint> band = {};  ///< where one frequency is not enough; outlives the sheet

  /// Where the receiver is when a leading edge of that delay is received [m].
  [[nodiscard]] Vec3 receiver_at(double delay) const noexcept {
    const Kinematics& way = legs.empty() ? receiver : leg_at(legs, delay).line;
    return way.position + way.velocity * delay;
  }
  [[nodiscard]] bool receiver_moves() const noexcept {
    return !legs.empty() || !receiver.velocity.isZero();
  }
};

/// One scattering boundary of one ping: joins the paths out and the paths back at any place.
class ScatteringSheet {
 public:
  /// Every law there is, as one list.
  using Law = AnyScattering;
  using Laws = ScatteringLaws;

  /// Which paths are received as one, out and back.
  struct Groups {
    std::shared_ptr<const FanGroups> out, back;
  };

  /// \param groups  of those fans, the same for one fan; none: every path by itself
  ScatteringSheet(std::shared_ptr<const BoundaryFan> out, std::shared_ptr<const BoundaryFan> back,
                  Laws laws, const SheetEnds& ends, const TransmitPattern& pattern,
                  Groups groups = {});

  /// All pairs of paths through a place, in the order of the tables, received before the record
  /// ends. \param limits  pairs that are fainter are left out; null: none   \param ring  area of
  /// the whole ring around [m²] \param below  the sheet's level [m]: shifts the delays by the
  /// vertical slownesses \param chance  of this place: which path stands for each bundle where
  /// there are very many
  void pairs_at(const Vec2& place, PathPairs& pairs, const AudibleLimits* limits = nullptr,
                double ring = 0.0, double below = 0.0, std::uint64_t chance = 0) const;

  /// Frequency received over frequency sent. \param motion, velocity of the scatterer (the current
  /// included)   \param bragg  −1, 0 or +1: the wave that scatters goes away, is none, or comes
  [[nodiscard]] double doppler(const PathPair& pair, const Vec3& velocity,
                               double bragg) const noexcept;
  /// Segments that hold every factor that doppler() gives with scatterers that move so.
  [[nodiscard]] std::vector<DopplerSpan> dopplers(const ScattererMotion& motion) const;
  /// Sum of the speeds with which source and receiver go along at most, by which Doppler factors
  /// change with the bearing [m/s].
  [[nodiscard]] double fastest_ends() const noexcept;
  /// The sound's slowness at the receiver.
  [[nodiscard]] Vec3 arriving(const PathPair& pair) const noexcept;

  /// Distance of a place on the sheet from the nearer of source and receiver, depth included [m].
  [[nodiscard]] double nearest_end(const Vec2& place, double depth) const noexcept;
  /// Largest size of a piece of ground whose middle stands for all of it, where it may lie in the
  /// lobe of facets that mirror one end to the other: what their tilt changes by 1.5 slopes over
  /// [m]. Infinity elsewhere, and under laws without facets. \param size  of the piece [m]
  [[nodiscard]] double largest_piece(const Vec2& place, double depth, double size) const noexcept;
  /// Adds all that pairs_at() depends on to a key. \return whether the patterns did
  [[nodiscard]] bool add_to(ExactKey& key) const;
  [[nodiscard]] const SheetEnds& ends() const noexcept { return ends_; }
  /// Source and receiver share a fan: the paths of a cell are the same out and back.
  [[nodiscard]] bool one_fan() const noexcept { return out_ == back_; }
  /// Somewhere there are very many paths.
  [[nodiscard]] bool bundled() const noexcept;
  /// Each sector has a plane of its own, and no two are alike: over an area.
  [[nodiscard]] bool unlike_all_round() const noexcept {
    return (out_->planes.size() > 1 && !out_->mirrored) ||
           (back_->planes.size() > 1 && !back_->mirrored);
  }
  /// Paths, and what is sent along them, are the same in all bearings from either end.
  [[nodiscard]] bool depends_on_range_alone() const noexcept {
    return azimuthally_symmetric_pattern_ && back_->planes.size() == 1;
  }
  /// The same at every bearing around the grid's middle.
  [[nodiscard]] bool azimuthally_symmetric() const noexcept;

 private:
  /// One leg at one place.
  struct Leg {
    std::span<const BoundaryPath> paths;
    const GroupedPaths* grouped = nullptr;
    std::span<const PathGroup> groups;
    std::span<const PathBundle> bundles;
    const PathEnds* ends = nullptr;  // [paths]
    const float* weights = nullptr;  // [paths], or none: all 1
    const CellFacet* facet = nullptr;
    Vec2 direction = Vec2::Zero();  // unit vector from the end to the place
    double bearing = 0.0;           // of it, where a table has bearings
    double range = 0.0;             // of the place [m]
    double beyond = 0.0;            // of the place past the cell's centre [m]
    std::size_t first = 0;          // of the paths in their table
  };
  [[nodiscard]] std::complex<double> beam(const Leg& out, std::size_t path,
                                          std::size_t point) const noexcept;
  /// σ of the paths that out and back are at a place. \param sigma  [1 + points]: at the centre,
  /// then at those of the band [1/sr]
  void cross_sections(std::size_t law, const ScatterSines& sines, double* sigma) const noexcept;
  /// Which of the laws a cell has.
  [[nodiscard]] std::size_t law_of(const CellFacet* facet) const noexcept;
  enum class Way { out, back };
  [[nodiscard]] Leg leg(Way way, const Vec2& end, const Vec2& place, bool bearing) const noexcept;
  /// The groups that are followed: all, or one of each bundle.
  static void take(const Leg& leg, std::uint64_t chance, std::vector<TakenGroup>& taken);
  [[nodiscard]] static TakenGroup drawn_of(const Leg& leg, std::uint32_t bundle,
                                           std::uint64_t chance) noexcept;
  /// The pressure of a group at a place for a source of 1, with the phase of its strongest path: at
  /// the centre, then at the points of the band. \param below  as pairs_at() \param stretched  the
  /// source's Doppler factor   \param sums  [1 + points]
  void sum_up(Way way, const Leg& leg, const TakenGroup& taken, double below, double stretched,
              std::complex<double>* sums) const noexcept;
  void weigh(Way way);
  /// Bounds how much later or earlier a receiver that keeps its velocity receives what comes home
  /// from a place than one that stays [s]. \param delay  the latest for one that stays
  [[nodiscard]] double most_shift(const Leg& back, double delay) const noexcept;
  /// When a receiver that changes its velocity receives what comes along a path.
  struct Reception {
    double delay = 0.0;                    // of the leading edge [s]
    const Kinematics* receiver = nullptr;  // the leg on which it receives, at the ping's start
  };
  [[nodiscard]] Reception received_under_way(const Leg& back, std::size_t path, double received,
                                             double unmoved) const noexcept;

  std::shared_ptr<const BoundaryFan> out_, back_;
  Groups groups_;
  /// Of every path, [plane][path]: √√ of its backscatter over that of the strongest of its group,
  /// which √σ of a pair of groups is told for. Empty where no paths are added.
  std::vector<std::vector<float>> out_weights_, back_weights_;
  Laws laws_;
  SheetEnds ends_;
  // Of the usual law, then of those of the kinds: the centre and each point of the band.
  std::vector<AtFrequencies<Law>> at_;
  std::vector<int> kinds_;  // of at_[1 …], increasing
  const TransmitPattern& pattern_;
  bool azimuthally_symmetric_pattern_, receiver_moves_, moving_, one_place_;
  bool in_phase_;  // so close together and at rest that a pair and its reciprocal are received as
                   // one
  // Of every outgoing path, if azimuthally symmetric: at the centre, then at each point of the
  // band.
  std::vector<std::complex<double>> beam_;
};

}  // namespace asdic::detail
