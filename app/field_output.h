#pragma once
#include <complex>
#include <string>
#include <vector>

#include "app/output.h"
#include "io/result/result_json.h"

namespace asdic::detail::app {

/// How loud a field is, a line for people: "loss       60.1 to 99.0 dB, median …".
[[nodiscard]] std::string loss_text(const std::vector<std::complex<float>>& pressure);

/// docs/formats/field.md \throws RunError
void write_field_file(OutputFile&& to, const FieldResult& result);

/// A few lines for people. \param wall  [s]
[[nodiscard]] std::string field_text(const FieldResult& result, double wall);

}  // namespace asdic::detail::app
