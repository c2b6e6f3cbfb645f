#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "reverb/fields/scatterer_field.h"
#include "reverb/scattering/models.h"
#include "reverb/scattering/motion.h"

namespace asdic::detail {

/// What scatters from a boundary or a layer, apart from the law: how its scatterers move and how
/// their weights are drawn.
struct ScattererField {
  ScattererMotion motion;
  ScattererStatistics statistics;

  void describe(Fields& field);
};

/// A layer of the water that scatters: bubbles, fish, plankton.
struct VolumeLayer {
  double top = 0.0, bottom = 100.0;  ///< depths [m]
  double strength_db = -80.0;        ///< S_v [dB re 1 m⁻¹]
  std::optional<int> sheets;         ///< number of sheets; by default sheets_of() chooses
  ScattererField field;

  void describe(Fields& setting);
};

/// How the sound of scatterers is made.
enum class ScattererSynthesis {
  automatic,   ///< where there are many: by their covariance or as streams; else one by one
  scatterers,  ///< one by one, or by sectors beyond `most_returns`
  covariance,  ///< by their covariance wherever that serves, one by one elsewhere
  streams,     ///< as streams of noise wherever that serves, one by one elsewhere
};
inline constexpr std::string_view scatterer_synthesis_words[] = {"automatic", "scatterers",
                                                                 "covariance", "streams"};
constexpr std::span<const std::string_view> words(ScattererSynthesis /*any*/) {
  return scatterer_synthesis_words;
}

/// How a kind of sea floor scatters that a map of kinds has.
struct SeabedScattering {
  int number = 0;  ///< in the map
  AnyBottomScattering law = {};

  void describe(Fields& field);
};

/// Reverberation of surface, bottom and volume as scatterers on polar grids.
struct ReverberationSettings {
  bool enabled = true;
  AnySurfaceScattering surface =
      NrlSurface{};   ///< wind and surface sound speed are filled in from the environment
  int azimuths = 36;  ///< sectors of a ring, at least; planes around a place over a transect
  std::optional<double> ground_spacing;  ///< of the grid [m]; by default from the pulse's bandwidth
  int scatterers_per_cell = 1;           ///< of ring and sector
  bool resolve_azimuth = true;           ///< as many sectors as array and Doppler resolve, if more
  bool surface_scatters = true;
  ScattererField surface_field;
  std::optional<AnyBottomScattering> bottom;  ///< none: the bottom does not scatter
  ScattererField bottom_field = {.motion = {}, .statistics = {.coherence_time = infinity}};
  std::vector<SeabedScattering> seabed;  ///< kinds that do not scatter as `bottom` says
  std::vector<VolumeLayer> volume;
  ScattererSynthesis synthesis = ScattererSynthesis::automatic;
  std::size_t most_returns =
      4'000'000;  ///< of a ping at one array; beyond, sectors are synthesised

  void describe(Fields& field);
};

}  // namespace asdic::detail
