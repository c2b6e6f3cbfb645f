#include "io/climatology/water.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/words.h"
#include "raytrace/area/map_frame.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail::climatology {
namespace {

/// Between places on the sphere [m].
double distance_between(double lat1, double lon1, double lat2, double lon2) {
  return MapFrame::geographic({lat1, lon1}).on_map(lon2, lat2).norm();
}

/// Linear between levels; nothing beyond the last.
std::optional<double> value_at(const Tiles::Column& column, double depth) {
  const auto& z = column.depths;
  if (z.empty() || depth > z.back()) return std::nullopt;
  if (depth <= z.front()) return column.values.front();
  const auto after =
      static_cast<std::size_t>(std::lower_bound(z.begin(), z.end(), depth) - z.begin());
  const double share = (depth - z[after - 1]) / (z[after] - z[after - 1]);
  return std::lerp(column.values[after - 1], column.values[after], share);
}

std::string file_names(const std::vector<DataFile>& files) {
  std::string names = files[0].path.filename().string();
  if (files.size() == 2) names += " and " + files[1].path.filename().string();
  if (files.size() > 2) names += " and " + std::to_string(files.size() - 1) + " more";
  return names;
}

}  // namespace

std::vector<double> speeds_of(const WaterColumn& column, const std::vector<double>& depths,
                              double latitude) {
  constexpr double by_pressure = 0.017;  // [(m/s)/m]
  const bool given = !column.speed.empty();
  std::vector<double> z, c;
  const auto add = [&](double depth, std::size_t level) {
    z.push_back(depth);
    if (given)
      c.push_back(column.speed[level] + by_pressure * (depth - column.depth[level]));
    else
      c.push_back(sound_speed(SeawaterEquation::chen_millero, column.temperature[level],
                              column.salinity[level], depth, latitude));
  };
  if (column.depth.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < column.depth.size(); ++level) add(column.depth[level], level);
  while (z.back() < depths.back() || z.size() < 2) add(z.back() + 250.0, column.depth.size() - 1);
  const auto profile = SoundSpeedProfile::table(z, c, Interpolation::pchip);
  std::vector<double> speed;
  speed.reserve(depths.size());
  for (const double depth : depths) speed.push_back(profile.at(depth).c);
  return speed;
}

Water::Water(const OceanSources& sources, const OceanTime& when, double latitude, double longitude)
    : dated_(when.month || when.date) {
  if (!sources.sound_speed.empty()) {
    if (is_cast_file(sources.sound_speed[0].path)) {
      read_cast(sources.sound_speed, when, latitude, longitude);
      return;
    }
    speed_.emplace(sources.sound_speed, sound_speed_quantity(), when);
    if (speed_->levels().empty())
      throw InputError({.where = speed_->name_at(latitude, longitude),
                        .got = "a sound speed without a depth axis",
                        .expected = "one on depth, longitude and latitude"});
    notes_ = speed_->remarks();
    return;
  }
  if (!sources.temperature.empty() && is_cast_file(sources.temperature[0].path)) {
    read_cast(sources.temperature, when, latitude, longitude);
    return;
  }
  temperature_.emplace(sources.temperature, temperature_quantity(), when);
  salinity_.emplace(sources.salinity, salinity_quantity(), when);
  for (const Tiles* tiles : {&*temperature_, &*salinity_})
    if (tiles->levels().empty())
      throw InputError({.where = tiles->name_at(latitude, longitude),
                        .got = "a variable without a depth axis",
                        .expected = "one on depth, longitude and latitude"});
  notes_ = temperature_->remarks();
  notes_.insert(notes_.end(), salinity_->remarks().begin(), salinity_->remarks().end());
  const DataGrid& t = temperature_->first();
  const std::string standard = lower(t.standard_name()), variable = lower(t.variable()),
                    about = standard + " " + lower(t.long_name());
  const auto says = [&](const char* word) { return about.find(word) != std::string::npos; };
  const std::string named = t.path().filename().string() + ": " + t.variable() + " is ";
  if (says("conservative") || variable == "ct") {
    scale_ = Scale::conservative;
    notes_.push_back(named +
                     "conservative temperature: that in situ was worked out of it (TEOS-10, "
                     "and Bryden's adiabatic lapse rate)");
  } else if (says("potential temp") || says("potential_temp") || variable == "thetao" ||
             variable == "votemper" || variable == "theta" || variable == "pt") {
    scale_ = Scale::potential;
    notes_.push_back(named +
                     "potential temperature: that in situ was worked out of it (Bryden's "
                     "adiabatic lapse rate)");
  }
  const DataGrid& s = salinity_->first();
  absolute_salinity_ =
      lower(s.standard_name()).find("absolute") != std::string::npos || lower(s.variable()) == "sa";
  if (absolute_salinity_)
    notes_.push_back(s.path().filename().string() + ": " + s.variable() +
                     " is absolute salinity: the practical one was worked out of it, without the "
                     "anomaly by place (at most 0.03 g/kg)");
  if (temperature_->levels() != salinity_->levels())
    notes_.push_back(
        "temperature and salinity are on different depths: the salinity is linear "
        "between its own");
}

void Water::read_cast(const std::vector<DataFile>& files, const OceanTime& when, double latitude,
                      double longitude) {
  cast_files_ = files;
  std::vector<Cast> casts;
  for (const DataFile& file : files)
    for (Cast& cast : read_casts(file.path, latitude)) casts.push_back(std::move(cast));
  // The nearest in space; of those as near, the nearest in time.
  const auto far = [&](const Cast& cast) {
    const double away = cast.latitude && cast.longitude
                            ? distance_between(latitude, longitude, *cast.latitude, *cast.longitude)
                            : 0.0;
    const double late =
        cast.time && when.date
            ? std::abs(days(Calendar::standard, *cast.time) - days(Calendar::standard, *when.date))
            : 0.0;
    return std::pair(std::round(away / 1000.0), late);
  };
  const auto nearest = std::min_element(
      casts.begin(), casts.end(), [&](const Cast& a, const Cast& b) { return far(a) < far(b); });
  cast_ = *nearest;
  is_cast_speed_ = cast_->temperature.empty();
  std::string about = "the profile is that of " + cast_->source;
  if (casts.size() > 1) about += ", the nearest of " + std::to_string(casts.size());
  if (cast_->latitude && cast_->longitude)
    about += ", " + to_text(far(*cast_).first) + " km away at " +
             place(*cast_->latitude, *cast_->longitude);
  else
    about += ", which does not say where it was taken";
  if (cast_->time) about += ", of " + iso(*cast_->time);
  notes_.push_back(about);
  if (when.month && cast_->time && cast_->time->month != *when.month)
    notes_.push_back("the profile is not of month " + std::to_string(*when.month));
  if (when.date && cast_->time && far(*cast_).second > 1.0)
    notes_.push_back("the profile was taken " + to_text(std::round(far(*cast_).second)) +
                     " days from " + iso(*when.date));
  for (const std::string& note : cast_->notes) notes_.push_back("of the profile, " + note);
}

WaterColumn Water::in_situ(WaterColumn column, double latitude) const {
  for (std::size_t i = 0; i < column.temperature.size(); ++i) {
    const double pressure = gauge_pressure(column.depth[i], latitude);
    double& t = column.temperature[i];
    double& s = column.salinity[i];
    const double absolute = absolute_salinity_ ? s : s / practical_salinity(1.0);
    if (absolute_salinity_) s = practical_salinity(s);
    if (scale_ == Scale::conservative) t = potential_temperature(t, absolute);
    if (scale_ != Scale::in_situ) t = temperature_in_situ(t, s, pressure);
  }
  return column;
}

WaterColumn Water::at(double latitude, double longitude) const {
  if (cast_) {
    WaterColumn column{.depth = cast_->depth};
    if (is_cast_speed_)
      column.speed = cast_->speed;
    else
      column.temperature = cast_->temperature, column.salinity = cast_->salinity;
    return column;
  }
  WaterColumn column;
  if (speed_) {
    const auto c = speed_->column(latitude, longitude);
    if (c) column.depth = c->depths, column.speed = c->values;
    return column;
  }
  const auto t = temperature_->column(latitude, longitude),
             s = salinity_->column(latitude, longitude);
  if (!t || !s) return column;
  for (std::size_t level = 0; level < t->depths.size(); ++level) {
    const auto salinity = value_at(*s, t->depths[level]);
    if (!salinity) break;
    column.depth.push_back(t->depths[level]);
    column.temperature.push_back(t->values[level]);
    column.salinity.push_back(*salinity);
  }
  return in_situ(std::move(column), latitude);
}

WaterColumn Water::require(double latitude, double longitude) const {
  WaterColumn column = at(latitude, longitude);
  if (!column.depth.empty()) return column;
  for (const Tiles* tiles : {temperature(), salinity(), speed()}) {
    if (tiles == nullptr) continue;
    tiles->check_holds(latitude, longitude);
    const auto part = tiles->column(latitude, longitude);
    if (part && part->depths.empty())
      throw InputError(
          {.where = tiles->name_at(latitude, longitude) + ": " + place(latitude, longitude),
           .got = "a hole: its nearest grid point has no value at the surface",
           .expected = "a place at sea, within the grid"});
  }
  throw InputError({.where = (speed_ ? *speed_ : *temperature_).name_at(latitude, longitude) +
                             ": " + place(latitude, longitude),
                    .got = "no temperature and salinity",
                    .expected = "a place at sea, within the grid"});
}

bool Water::same(double latitude, double longitude, double other_latitude,
                 double other_longitude) const {
  for (const Tiles* tiles : {temperature(), salinity(), speed()})
    if (tiles != nullptr &&
        tiles->where(latitude, longitude) != tiles->where(other_latitude, other_longitude))
      return false;
  return true;
}

const std::vector<double>& Water::levels() const {
  if (cast_) return cast_->depth;
  return speed_ ? speed_->levels() : temperature_->levels();
}

std::vector<std::string> Water::origins() const {
  const auto named = [](const Tiles& tiles) {
    return file_names(tiles.files()) + ", " + tiles.files()[0].variable;
  };
  if (cast_) {
    std::string variables;
    for (const std::string& name : cast_->variables)
      variables += (variables.empty() ? "" : ", ") + name;
    return {"profile: " + cast_->source + ", " + variables};
  }
  if (speed_) return {"sound speed: " + named(*speed_)};
  if (temperature_->files()[0].path == salinity_->files()[0].path)
    return {"profile: " + named(*temperature_) + " and " + salinity_->files()[0].variable};
  return {"temperature: " + named(*temperature_), "salinity: " + named(*salinity_)};
}

std::vector<Water::Source> Water::used(double latitude, double longitude) const {
  if (cast_) {
    const std::string time = cast_->time ? iso(*cast_->time) : "";
    std::string variables;
    for (const std::string& name : cast_->variables)
      variables += (variables.empty() ? "" : " ") + name;
    std::vector<DataFile> files;
    for (const DataFile& file : cast_files_)  // the one that it is of, by its name
      if (cast_->source.starts_with(file.path.filename().string()))
        files = {{file.path, variables}};
    return {{is_cast_speed_ ? "sound speed" : "temperature and salinity", time, files}};
  }
  std::vector<Source> all;
  for (const auto& [quantity, tiles] : {std::pair{"temperature", temperature()},
                                        {"salinity", salinity()},
                                        {"sound speed", speed()}})
    if (tiles != nullptr)
      all.push_back({quantity, tiles->time_at(latitude, longitude).said, tiles->files()});
  return all;
}

std::vector<std::string> Water::notes(double latitude, double longitude) const {
  std::vector<std::string> all;
  const auto tell = [&](const Tiles& tiles, const std::string& what) {
    const TimeChoice& time = tiles.time_at(latitude, longitude);
    // No word of a grid without times where no time was asked for.
    if (time.fit == 3 && !dated_) return;
    all.push_back(what + (time.fit == 3 && time.said.starts_with("has ") ? " " : ": ") + time.said);
  };
  if (speed_) tell(*speed_, "the profile");
  if (temperature_) {
    const TimeChoice &t = temperature_->time_at(latitude, longitude),
                     &s = salinity_->time_at(latitude, longitude);
    if (t.said == s.said) {
      tell(*temperature_, "the profile");
    } else {
      tell(*temperature_, "the temperature");
      tell(*salinity_, "the salinity");
    }
  }
  for (const Tiles* tiles : {temperature(), salinity(), speed()})
    if (tiles != nullptr)
      if (const auto column = tiles->column(latitude, longitude);
          column && !column->continued.empty())
        all.push_back(column->continued);
  all.insert(all.end(), notes_.begin(), notes_.end());
  return all;
}

}  // namespace asdic::detail::climatology
