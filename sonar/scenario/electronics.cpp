#include "sonar/scenario/electronics.h"

#include <cmath>
#include <string>
#include <string_view>

#include "core/fields.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

/// One number for each phone, or none.
void check_of_phones(Fields& field, std::string_view key, const std::vector<double>& values) {
  if (!field.checks() || values.empty()) return;
  const auto phones = static_cast<std::size_t>(field.known("phones"));
  if (values.size() != phones)
    field.fault(key, "one number for each of " + std::to_string(phones) + " phones",
                std::to_string(values.size()) + " numbers");
}

/// Numbers of phones, from 0.
void describe_dead(Fields& field, std::vector<int>& dead) {
  std::vector<double> phones(dead.begin(), dead.end());
  field("dead", phones, {.noun = "phone", .low = 0.0, .high = 4095.0},
        "phones, from 0, that give nothing");
  if (field.checks()) {
    const double all = field.known("phones");
    for (std::size_t i = 0; i < phones.size(); ++i)
      if (phones[i] != std::floor(phones[i]) || phones[i] >= all)
        field.fault("dead[" + std::to_string(i) + "]",
                    "the number of a phone, 0 to " + std::to_string(static_cast<int>(all) - 1));
  }
  if (field.reads()) dead.assign(phones.begin(), phones.end());
}

}  // namespace

void Electronics::BandPass::describe(Fields& field) {
  field("order", order, 1, 32, "of the Butterworth filter");
  field(required("low"), low, quantity::frequency_step, "3 dB down, below the band");
  field(required("high"), high, quantity::frequency_step, "3 dB down, above the band");
  if (field.checks() && high <= low)
    field.fault("high", "a frequency above low, " + to_text(low) + " Hz");
}

void Electronics::Converter::describe(Fields& field) {
  field(required("bits"), bits, 2, 24, "of a sample");
  field(required("full_scale"), full_scale,
        {.noun = "pressure", .unit = "Pa", .low = 1e-9, .high = 1e9},
        "peak that is just not clipped");
}

void Electronics::describe(Fields& field) {
  field("gain_db", gain_db, {.noun = "gain", .unit = "dB", .low = -200.0, .high = 200.0},
        "of each phone, re the nominal gain");
  check_of_phones(field, "gain_db", gain_db);
  field("phase", phase, AngleQuantity{"phase", -360.0, 360.0},
        "of each phone, at frequencies above 0");
  check_of_phones(field, "phase_deg", phase);
  field("gain_std_db", gain_std_db,
        {.noun = "standard deviation", .unit = "dB", .low = 0.0, .high = 40.0},
        "of further gain errors, drawn for each phone");
  field("phase_std", phase_std, AngleQuantity{"standard deviation", 0.0, 360.0},
        "of further phases, drawn for each phone");
  describe_dead(field, dead);
  field("band_pass", band_pass, "a filter, of magnitude alone");
  field("converter", converter, "to whole numbers, clipped at full scale");
}

}  // namespace asdic::detail
