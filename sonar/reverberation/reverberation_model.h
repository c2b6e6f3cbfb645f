#pragma once
#include <memory>
#include <span>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "reverb/power/expected_reverberation.h"
#include "sonar/reverberation/ping_reverberation.h"
#include "sonar/reverberation/reverberation_context.h"
#include "sonar/reverberation/reverberation_fields.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Makes the reverberation of any ping at any array of a scenario, and chooses how it is received:
/// scatterers one by one, by their covariance or as streams. Built once; shared by threads.
class ReverberationModel {
 public:
  /// \param scenario, paths  must outlive this   \param widest  of the pulses: it sets the grid
  ReverberationModel(const Scenario& scenario, const PropagationPaths& paths, const Pulse& widest);

  [[nodiscard]] PingReverberation ping(const ReverberationContext& context) const;
  /// What ping() would ask the context's budget for, though it may be known: takes it.
  void take_memory(const ReverberationContext& context) const;
  /// The same reverberation as streams of noise, all of it, however ping() receives it; without
  /// any, no streams. Null where a field cannot be received so.
  [[nodiscard]] std::shared_ptr<const ReverberationStreams> as_streams(
      const ReverberationContext& context) const;
  /// Of the rings of scatterers [m].
  [[nodiscard]] double ground_spacing() const noexcept { return fields_.ground_spacing(); }
  /// Vertical planes around a place in which a record's reverberation is followed.
  [[nodiscard]] int planes() const;
  /// Of everything that scatters.
  [[nodiscard]] std::vector<ScatteringSheet::Law> laws() const;
  /// That a ping's paths follow, the most of all boundaries and layers.
  [[nodiscard]] Bounces bounces(const ReverberationContext& context) const;

 private:
  [[nodiscard]] std::shared_ptr<const ExpectedReverberation> expected(
      std::span<const ScatteringField> fields, const ReverberationContext& context) const;
  [[nodiscard]] std::shared_ptr<const ReverberationCovariance> covariance(
      std::span<ScatteringField> fields, const ExpectedReverberation& expected,
      const ReverberationContext& context) const;
  [[nodiscard]] std::shared_ptr<const ReverberationStreams> streams(
      std::span<ScatteringField> fields, const ExpectedReverberation& expected,
      const ReverberationContext& context) const;

  /// Of the fields that are received so. Out of the paths' memory if they are there.
  [[nodiscard]] std::shared_ptr<const ReverberationStreams> streams_of(
      std::span<const ScatteringField> fields, const ExpectedReverberation& expected,
      const ReverberationContext& context) const;

  const Scenario& scenario_;
  const PropagationPaths& paths_;
  ReverberationFields fields_;
};

}  // namespace asdic::detail
