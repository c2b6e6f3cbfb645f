#include "sonar/scenario/array.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "sonar/scenario/shapes/shapes.h"

namespace asdic::detail {

ReceiverArray line_array(int phones, double spacing, double heading, double pitch) {
  if (phones < 1)
    throw InputError(
        {.where = "phones", .got = std::to_string(phones), .expected = "at least 1 phone"});
  if (!((spacing > 0.0 || phones == 1) && std::isfinite(spacing)))
    throw InputError(
        {.where = "spacing", .got = std::to_string(spacing) + " m", .expected = "above 0 m"});
  if (!std::isfinite(heading) || !std::isfinite(pitch))
    throw InputError({.where = std::isfinite(heading) ? "pitch" : "heading",
                      .got = "nan or infinity",
                      .expected = "an angle"});
  // Along the line from the first phone to the last; positive pitch raises the last (z is down).
  const Vec3 along(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                   -std::sin(pitch));
  ReceiverArray array;
  for (int i = 0; i < phones; ++i)
    array.phones.push_back((i - 0.5 * (phones - 1)) * spacing * along);
  return array;
}

namespace {
/// How a file says where the phones are, bit for bit.
AnyArrayShape shape_of(const ReceiverArray& array) {
  if (array.towed) return TowedShape{*array.towed};
  PositionsShape shape{.positions = array.phones};
  for (const std::vector<Vec3>& one : array.shapes) shape.shapes.push_back({one});
  return shape;
}
}  // namespace

void ReceiverArray::describe(Fields& field) {
  field.name(name, "by which others name it");
  field.reference("platform", platform, "platform", "that carries it");
  AnyArrayShape shape = shape_of(*this);
  field.one_of(required("kind"), shape, "how its phones lie");
  if (field.reads()) std::visit([&](const auto& one) { one.build(*this); }, shape);
  field.know("phones", static_cast<double>(phones.size()));
  field(live("offset"), offset, quantity::coordinate, "from the platform; towed: of the tow point");
  field("electronics", electronics, "what its electronics do");
}

}  // namespace asdic::detail
