#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "reverb/fields/met_scatterer.h"
#include "reverb/power/expected_reverberation.h"
#include "sonar/paths/return_source.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// The statistical equivalent of more scatterers than can be received one by one: those of a
/// sector, received within one bin of delay out of the same range of elevations, are one return
/// with the power of all, a Gaussian weight of its own, and delay, direction and Doppler factor of
/// one of them, chosen with the chances of their powers. Reciprocal pairs share a weight.
/// docs/theory/reverberation.md
class SectorReturns {
 public:
  /// \param pulse  must outlive this   \param latest  end of the record, since the ping [s]
  /// \param most  returns of all the fields   \param fields  how many share them
  SectorReturns(const ScattererMeeting& meeting, const Pulse& pulse, double latest,
                std::size_t most, std::size_t fields);

  /// Adds those of a sector of a field.
  void add(const ScatteringField& field, int sector, ReturnBlock& into) const;
  /// A block for every sector of every field.
  [[nodiscard]] std::vector<ExpectedReverberation::Block> blocks(
      std::span<const ScatteringField> fields) const;

 private:
  /// Half of 1/B, or as much as the limit of returns asks for [s].
  [[nodiscard]] double bin(const ScatteringField& field) const;

  ScattererMeeting meeting_;
  const Pulse& pulse_;
  double latest_;
  std::size_t most_, fields_;
};

}  // namespace asdic::detail
