#include "serve/sound_request.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/units.h"
#include "io/settings/reader.h"
#include "io/text/toml_table.h"
#include "raytrace/paths/trace_ray.h"
#include "serve/update.h"

namespace asdic::detail::serve {
namespace {

constexpr const char* when = "of the scenario; default: now, as of `state`";
constexpr Quantity bearing = quantity::bearing.in_degrees();
constexpr Quantity launch{.noun = "angle", .unit = "degrees", .low = -90.0, .high = 90.0};

}  // namespace

void ArrivalsRequest::describe(Fields& field) {
  field("time", time, quantity::time, when);
  field("leg", leg, "`target`: from the platform; `array`: from there to the arrays");
  field("target", target, "the name of one; default: all");
  field("receiver_depth", receiver_depth, quantity::depth,
        "of a receiver in place of targets; with `range`");
  field("range", range,
        Quantity{.noun = "range", .unit = "m", .low = 0.0, .high = traced_range.high},
        "of that receiver, horizontal");
  field("source_depth", source_depth, quantity::depth, "with `range`; default: the platform's");
  field("bearing_deg", bearing_deg, bearing,
        "true, of that receiver; default: along the transect, or north");
  field("frequency", frequency, quantity::frequency,
        "at which losses are told; default: the pulse's centre");
}

void RaysRequest::describe(Fields& field) {
  field("time", time, quantity::time, when);
  field("from_deg", from_deg, launch, "first elevation, positive up");
  field("to_deg", to_deg, launch, "last elevation");
  field("count", count, 1, most_traced_rays, "of rays, evenly between");
  field("elevations_deg", elevations_deg, launch, "these instead");
  field("range", range, traced_range, "how far");
  field("source_depth", source_depth, quantity::depth, "default: the platform's");
  field("bearing_deg", bearing_deg, bearing, "true; default: along the transect");
  field("bounces", bounces, 0, most_traced_bounces, "after which a ray ends");
}

std::vector<double> RaysRequest::elevations() const {
  std::vector<double> all;
  for (const double elevation : elevations_deg) all.push_back(radians(elevation));
  if (!all.empty()) return all;
  for (int i = 0; i < count; ++i)  // in degrees, so that whole ones stay whole
    all.push_back(
        radians(count == 1 ? from_deg : std::lerp(from_deg, to_deg, double(i) / (count - 1))));
  return all;
}

void FieldRequest::describe(Fields& field) { field("time", time, quantity::time, when); }

template <class Request>
Request read_request(const TomlValue& fields, std::span<const std::string_view> more) {
  try {
    TomlTable reader(fields);
    Request request;
    KnownSettings known;
    TomlReader walker(reader, known);
    request.describe(walker);
    for (const std::string_view key : more) static_cast<void>(reader.has(std::string(key)));
    reader.finish();
    return request;
  } catch (const InputError& error) {
    throw refusal_of_value(error);
  }
}

template ArrivalsRequest read_request(const TomlValue&, std::span<const std::string_view>);
template RaysRequest read_request(const TomlValue&, std::span<const std::string_view>);
template FieldRequest read_request(const TomlValue&, std::span<const std::string_view>);

}  // namespace asdic::detail::serve
