#pragma once
#include "io/bellhop/case_writer.h"

/// The parts of a case as they are written; for case_writer.cpp alone.
namespace asdic::detail::bellhop {

/// A case that is being written, and what all parts must know.
struct CaseWriting {
  const PropagationCase& run_case;
  std::vector<double> depths;     ///< [n] of the profile's rows, from the surface to DEPTH
  double volume_loss = 0.0;       ///< [Np/m]
  const MapInput* map = nullptr;  ///< of a case of BELLHOP3D
  Written out{};

  void note(std::string text) { out.notes.push_back(std::move(text)); }
  void companion(std::string extension, std::string text) {
    out.texts.companions.emplace_back(std::move(extension), std::move(text));
  }
};

/// "speed shear density attenuation shear": a half space, in the units of the file. \param
/// volume_loss that the reader will add [Np/m]   \throws InputError unless it is fluid or elastic
[[nodiscard]] std::string half_space_text(CaseWriting& writing, const BoundaryMaterial& material,
                                          double volume_loss, const std::string& where);
/// The option letter of what is behind a boundary.
[[nodiscard]] char letter_of(const Boundary& boundary) noexcept;

void write_section(CaseWriting& writing);
void write_shape(CaseWriting& writing, const Boundary& boundary, bool surface);
void write_reflection_table(CaseWriting& writing, const ReflectionTable& table, bool surface);
void write_source_pattern(CaseWriting& writing, const SourcePattern& pattern);

/// Sources, receivers, run type, fan, step, box: the last lines of the .env file.
[[nodiscard]] std::string run_text(CaseWriting& writing, bool binary_arrivals);

}  // namespace asdic::detail::bellhop
