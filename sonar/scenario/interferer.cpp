#include "sonar/scenario/interferer.h"

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {

void Tonal::describe(Fields& field) {
  field(required("frequency"), frequency, quantity::frequency, "of the line");
  field(required("level_db"), level_db, quantity::level_re("1 µPa at 1 m"), "of the line, rms");
}

void Interferer::describe(Fields& field) {
  field.name(name, "of the ship");
  track.describe(field);
  if (const Only with(field, field.finds("spectrum") || field.exhaustive(), {.key = "spectrum"});
      with)
    field.excludes("spectrum", {"level_db", "slope_db_per_decade"});
  field("spectrum", table, "of its broadband noise at 1 m");
  if (!table || field.exhaustive()) {
    field("level_db", level_db, quantity::level_re("1 µPa²/Hz at 1 m"),
          "of its broadband noise at 1 kHz");
    if (const Only with(field, level_db || field.exhaustive(), {.key = "level_db"}); with)
      field("slope_db_per_decade", slope_db_per_decade,
            {.noun = "slope", .unit = "dB", .low = -60.0, .high = 20.0},
            "of the level above 100 Hz; below it is constant");
  }
  field("tonal", tonals, "lines of its spectrum");
  if (field.checks() && !level_db && !table && tonals.empty())
    field.fault("level_db", "a level, a spectrum or a tonal", "none of them");
}

}  // namespace asdic::detail
