#pragma once
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

#include "io/bellhop/bellhop_files.h"
#include "io/hdf5/hdf5_file.h"
#include "raytrace/cases/earth_line.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// A pressure field, relative to 1 m from the source, time dependence e^{+iωt}; TL = −20·log₁₀|p|.
/// The root of the intensity, as a real number, where it was not added coherently.
struct FieldData {
  std::string title;
  double frequency = 0.0;  ///< [Hz]
  FieldKind kind = FieldKind::coherent;
  SourceKind source = SourceKind::point;
  std::vector<double> source_depths;  ///< [m]
  ReceiverGrid receivers;
  std::vector<std::complex<float>> pressure;  ///< [planes × sources × rows × ranges]
  std::string beam_kind;                      ///< "hat", "gaussian" …; empty: not known
  std::size_t beams = 0;                      ///< rays traced per source; 0: not known
  double beam_error_db = 0.0;       ///< what more beams would change, at 95 % of receivers
  bool beam_error_bounded = false;  ///< that is a bound, else an estimate
  std::vector<float> beam_errors;  ///< [sources × rows × ranges] the same of each receiver [dB], ∞
                                   ///< where no number bounds it, NaN where it is not known;
                                   ///< empty: not known of any (PropagationResult::beam_errors)
  std::string solver;           ///< "beams" or "waves"; empty: not known
  bellhop::MapPlaces map = {};  ///< of a field over a map: its planes
  EarthLine earth = {};         ///< where its receivers are on the Earth
};

/// Writes the datasets and attributes of docs/formats/field.md, but for the root's (filetype,
/// provenance), into an open file.
void write_field(Hdf5File& file, const FieldData& field);

/// \throws InputError if it is no field file or a part is missing or of the wrong shape
[[nodiscard]] FieldData read_field(const Hdf5File& file);
[[nodiscard]] FieldData read_field(const std::filesystem::path& path);

/// A .shd file holds the negative of a point source's field (docs/formats/bellhop.md).
[[nodiscard]] bellhop::ShadeFile to_shade_file(const FieldData& field);
/// Nothing in the file says how it was added: without an imaginary part it was not coherently. Nor
/// does it tell a line source from a point source, which is assumed.
[[nodiscard]] FieldData from_shade_file(const bellhop::ShadeFile& file);

}  // namespace asdic::detail
