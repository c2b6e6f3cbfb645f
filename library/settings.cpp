// The structs of settings as values: the same keys that files have.
#include <type_traits>

#include "asdic/array.h"
#include "asdic/environment.h"
#include "asdic/platform.h"
#include "asdic/pulse.h"
#include "asdic/reverberation.h"
#include "asdic/target.h"

namespace asdic {
namespace {

/// Puts settings into a table; those that are empty, or not given, stay out.
class Settings {
 public:
  Settings() = default;
  explicit Settings(const char* kind) { put("kind", kind); }

  template <class T>
  Settings& put(const char* key, const T& value) {
    table_.set(key, value);
    return *this;
  }
  template <class T>
  Settings& put(const char* key, const std::optional<T>& value) {
    if (value) table_.set(key, *value);
    return *this;
  }
  Settings& unless_empty(const char* key, const std::string& text) {
    return text.empty() ? *this : put(key, text);
  }
  Settings& unless_zero(const char* key, double number) {
    return number == 0.0 ? *this : put(key, number);
  }
  Settings& unless_zero(const char* key, const Vector& vector) {
    return vector == Vector{} ? *this : put(key, vector);
  }
  /// A list of tables.
  template <class T>
  Settings& tables(const char* key, const std::vector<T>& items) {
    return items.empty() ? *this : put(key, std::vector<Value>(items.begin(), items.end()));
  }
  [[nodiscard]] const Value& value() const { return table_; }

 private:
  Value table_ = Value::table();
};

template <class Pulse>
Settings window_of(Settings settings, const Pulse& pulse) {
  settings.put("duration", pulse.duration);
  return settings.put("window", pulse.window).put("tukey_fraction", pulse.tukey_fraction);
}

Settings sweep(const char* kind, double start, double end) {
  return Settings(kind).put("start_frequency", start).put("end_frequency", end);
}

template <class Array>
Settings fixed(const char* kind, const Array& array) {
  return Settings(kind)
      .unless_empty("name", array.name)
      .unless_empty("platform", array.platform)
      .unless_zero("offset", array.offset);
}

std::vector<Value> values_of(const std::vector<Waypoint>& waypoints) {
  std::vector<Value> result;
  for (const Waypoint& point : waypoints)
    result.push_back(Value::table({{"time", point.time}, {"position", point.position}}));
  return result;
}

}  // namespace

Cw::operator Value() const {
  return window_of(Settings("cw").put("frequency", frequency), *this).value();
}
Lfm::operator Value() const {
  return window_of(sweep("lfm", start_frequency, end_frequency), *this).value();
}
Hfm::operator Value() const {
  return window_of(sweep("hfm", start_frequency, end_frequency), *this).value();
}
Sfm::operator Value() const {
  return window_of(Settings("sfm")
                       .put("frequency", frequency)
                       .put("swing", swing)
                       .put("modulation_frequency", modulation_frequency)
                       .put("end_modulation_frequency", end_modulation_frequency),
                   *this)
      .value();
}
Costas::operator Value() const {
  Settings settings = Settings("costas").put("frequency", frequency);
  if (!order.empty()) settings.put("order", order);
  return window_of(settings.put("prime", prime).put("root", root).put("step", step), *this).value();
}
Ptfm::operator Value() const {
  return window_of(sweep("ptfm", start_frequency, end_frequency).put("sweeps", sweeps), *this)
      .value();
}
GeometricComb::operator Value() const {
  return window_of(sweep("geometric_comb", start_frequency, end_frequency)
                       .put("lines", lines)
                       .put("gap_ratio", gap_ratio),
                   *this)
      .value();
}
PulseTrain::operator Value() const {
  return window_of(Settings("pulse_train")
                       .put("frequency", frequency)
                       .put("start_frequency", start_frequency)
                       .put("end_frequency", end_frequency)
                       .put("pulses", pulses)
                       .put("pulse_duration", pulse_duration),
                   *this)
      .value();
}
PulseFile::operator Value() const { return Settings("file").put("file", file).value(); }

Platform::operator Value() const {
  Settings settings = Settings().unless_empty("name", name);
  if (!waypoints.empty()) return settings.tables("waypoints", values_of(waypoints)).value();
  return settings.put("position", position).unless_zero("velocity", velocity).value();
}

Transmitter::operator Value() const {
  return Settings()
      .unless_empty("name", name)
      .unless_empty("platform", platform)
      .unless_zero("offset", offset)
      .put("source_level_db", source_level_db)
      .put("elevation_deg", elevation_deg)
      .put("taper", taper)
      .put("beamwidth_deg", beamwidth_deg)
      .value();
}

LineArray::operator Value() const {
  return fixed("line", *this)
      .put("phones", phones)
      .put("spacing", spacing)
      .put("heading_deg", heading_deg)
      .put("pitch_deg", pitch_deg)
      .value();
}
PhonePositions::operator Value() const {
  return fixed("positions", *this)
      .put("positions", std::vector<Value>(positions.begin(), positions.end()))
      .value();
}
TowedArray::operator Value() const {
  return fixed("towed", *this)
      .put("behind", behind)
      .unless_zero("heading_deg", heading_deg)
      .value();
}

Aspect::operator Value() const {
  return Value::table({{"bow_db", bow_db}, {"beam_db", beam_db}, {"stern_db", stern_db}});
}
Highlight::operator Value() const {
  return Settings()
      .put("offset", offset)
      .put("strength_db", strength_db)
      .put("aspect", aspect)
      .value();
}
Target::operator Value() const {
  Settings settings = Settings().unless_empty("name", name);
  settings.put("position", position).put("range", range).put("depth", depth);
  settings.unless_zero("bearing_deg", bearing_deg).tables("waypoints", values_of(waypoints));
  settings.unless_zero("velocity", velocity).put("strength_db", strength_db);
  settings.put("aspect", aspect).tables("highlight", highlights).put("heading_deg", heading_deg);
  return settings.unless_empty("fluctuation", fluctuation).put("scan_pings", scan_pings).value();
}

SoundSpeed::operator Value() const {
  return Settings("table")
      .put("depth", depth)
      .put("speed", speed)
      .put("interpolation", interpolation)
      .value();
}
Munk::operator Value() const {
  return Settings("munk")
      .put("axis_speed", axis_speed)
      .put("axis_depth", axis_depth)
      .put("scale_depth", scale_depth)
      .put("perturbation", perturbation)
      .value();
}
TemperatureSalinity::operator Value() const {
  return Settings("temperature-salinity")
      .put("depth", depth)
      .put("temperature", temperature)
      .put("salinity", salinity)
      .put("equation", equation)
      .put("latitude_deg", latitude_deg)
      .put("interpolation", interpolation)
      .value();
}
SoundSpeedSection::operator Value() const {
  return Settings("section")
      .put("range", range)
      .put("depth", depth)
      .put("speed", std::vector<Value>(speed.begin(), speed.end()))
      .value();
}
Bathymetry::operator Value() const {
  return Settings()
      .put("range", range)
      .put("depth", depth)
      .put("interpolation", interpolation)
      .value();
}
Bottom::operator Value() const {
  return Settings(kind.c_str())
      .put("depth", depth)
      .put("shape", bathymetry)
      .put("speed", speed)
      .put("density", density)
      .put("attenuation_db_per_wavelength", attenuation_db_per_wavelength)
      .put("shear_speed", shear_speed)
      .put("shear_attenuation_db_per_wavelength", shear_attenuation_db_per_wavelength)
      .put("grain_size", grain_size)
      .value();
}

NrlSurface::operator Value() const {
  return Settings("nrl").put("A_s", A_s).put("gamma2", gamma2).put("h0", h0).value();
}
ChapmanHarris::operator Value() const { return Settings("chapman-harris").value(); }
OgdenErskine::operator Value() const { return Settings("ogden-erskine").value(); }
Lambert::operator Value() const { return Settings("lambert").put("mu_db", mu_db).value(); }
EllisCrowe::operator Value() const {
  return Settings("ellis-crowe")
      .put("mu_db", mu_db)
      .put("nu_db", nu_db)
      .put("slope_deg", slope_deg)
      .value();
}
ScatteringTable::operator Value() const {
  return Settings("table").put("grazing_deg", grazing_deg).put("strength_db", strength_db).value();
}
VolumeLayer::operator Value() const {
  return Settings()
      .put("depth", std::vector<double>{top, bottom})
      .put("strength_db", strength_db)
      .value();
}

}  // namespace asdic
