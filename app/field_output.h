#pragma once
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

#include "app/output.h"
#include "io/result/field_file.h"
#include "raytrace/propagation.h"

namespace asdic::detail::app {

/// A field that was computed, and what of.
struct FieldResult {
  ResultOrigin origin{};
  PropagationCase run_case{};
  FieldData data{};
  std::filesystem::path output{};
  std::vector<std::string> notes{};
};

/// How loud a field is, a line for people: "loss       60.1 to 99.0 dB, median …".
[[nodiscard]] std::string loss_text(const std::vector<std::complex<float>>& pressure);

[[nodiscard]] FieldData field_data(const PropagationCase& run_case, PropagationResult&& result);

/// docs/formats/field.md \throws RunError
void write_field_file(OutputFile&& to, const FieldResult& result);

/// A few lines for people. \param wall  [s]
[[nodiscard]] std::string field_text(const FieldResult& result, double wall);
[[nodiscard]] std::string field_json(const FieldResult& result);

}  // namespace asdic::detail::app
