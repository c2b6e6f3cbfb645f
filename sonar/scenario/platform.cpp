#include "sonar/scenario/platform.h"

#include "core/fields.h"

namespace asdic::detail {

void Platform::describe(Fields& field) {
  field.name(name, "by which transmitters and arrays name it");
  track.describe(field, true);
}

}  // namespace asdic::detail
