#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/memory_budget.h"
#include "core/propagation_memory.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

/// Reverberation as streams of noise: what source, sea and receiver in any geometry and motion
/// send to an array, summed over what the array and the pulse can resolve.
///
/// Delays are cut into blocks. What is received in a block out of one cell of directions, with
/// Doppler factors of one cell, is one stream: a wave of white Gaussian noise through the pulse as
/// that Doppler factor stretches it, with the power over delay of all its places and pairs of
/// paths. Cells are as wide as lets sums over them be the integrals that they stand for: for the
/// powers of beams and for Doppler spectra the trapezoidal rule has no error at such steps.
/// A pair of paths and its reciprocal that are received in phase are a stream out of two
/// directions. docs/theory/reverberation.md, "Streams"
struct ReverberationStreams {
  /// Who receives, and how finely.
  struct Listener {
    std::array<Vec3, 3> extents = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< extents_of()
    std::size_t phones = 1;
    double frequency = 1000.0;    ///< the highest that matters [Hz]
    double bandwidth = 10.0;      ///< of the pulse [Hz]
    double pulse_duration = 1.0;  ///< [s]
    /// Doppler shifts so close to each other only delay the pulse, as they do a sweep [Hz].
    double doppler_tolerance = 0.0;
    /// Of the pulse with itself; none: a tone that never ends.
    std::shared_ptr<const PulseCoherence> coherence = std::make_shared<const PulseCoherence>();
    /// Of phones, over which sounds of one place interfere in the mean, relative to the array's
    /// reference point [m]; none: one there.
    std::vector<Vec3> places = {};
    double latest = 60.0;  ///< end of the record [s]
  };
  /// A part of a cell: where its sound comes from. Fronts are spheres about a point so far back as
  /// the way from the ground is long.
  struct Part {
    std::array<Vec3, 2> slowness = {Vec3::Zero(), Vec3::Zero()};  ///< as the array meets it [s/m]
    /// Mean length of the slownesses [s/m]: more than the length of their mean, where directions on
    /// either side of a line of phones are one part.
    std::array<double, 2> length = {0.0, 0.0};
    std::array<double, 2> curvature = {0.0, 0.0};  ///< one over the radius [1/m]
    /// Pressure of each for each of two noises, Σ|weight|² = 1. One direction has one noise; two
    /// have one, too, as far as what comes from there is in phase.
    std::array<std::array<std::complex<double>, 2>, 2> weight = {};
    double doppler = 1.0;  ///< frequency received over frequency sent
    double chance = 1.0;   ///< of this part and those before it
  };
  /// The noise of a cell: out of one of its parts in a ping, drawn by its power.
  struct Stream {
    std::uint64_t entity = 0;               ///< key of its draws
    bool lasts = false;                     ///< from ping to ping (ScatteringField::stays)
    std::size_t first = 0;                  ///< of its intensities
    std::size_t first_part = 0, parts = 0;  ///< of its parts
  };
  /// Bins of delay with the same streams.
  struct Block {
    std::size_t begin = 0, end = 0;   ///< bins
    std::size_t first = 0, last = 0;  ///< streams
  };

  /// None.
  ReverberationStreams() = default;
  /// \param fields  every one of which is served   \param limits  as the scatterers have
  ReverberationStreams(std::span<const ScatteringField* const> fields, const AudibleLimits& limits,
                       const Listener& listener);

  /// A box that holds each of an array's shapes: vectors at right angles to each other, as long as
  /// it is that way [m]. Rounded, so that shapes that are much alike have one: directions to a
  /// phase of ½ rad at the ends, lengths up to the next of a geometric row.
  /// \param shapes  [m], at least one; where they lie does not matter
  [[nodiscard]] static std::array<Vec3, 3> extents_of(std::span<const std::vector<Vec3>> shapes,
                                                      double frequency);
  /// Whether a field may be received so: scatterers without velocities of their own and without
  /// texture, amplitudes of the centre frequency, and weights of every ping's own or of which every
  /// ping receives the same sums.
  [[nodiscard]] static bool serves(const ScatteringField& field) noexcept;
  /// Returns that take as long to grid one by one as a ping of the field's streams, roughly: a
  /// sparse array resolves very many directions.
  [[nodiscard]] static double worth(const Listener& listener, const ScatteringField& field);
  /// What making them and a ping out of them takes beside the ping's samples, at most: a guess from
  /// the number of cells.
  [[nodiscard]] static MemoryNeed need(std::span<const ScatteringField* const> fields,
                                       const Listener& listener);
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Out of which a stream sounds. \param ping  key of its draws beside the seed
  [[nodiscard]] const Part& part_of(const Stream& stream, std::uint64_t seed,
                                    std::uint32_t ping) const noexcept;

  double bin = 1.0;  ///< width of a bin of delay [s]
  std::vector<Block> blocks;
  std::vector<Stream> streams;
  std::vector<Part> parts;
  std::vector<float> intensity;  ///< of each stream, [bins of its block] mean power [1/s]
};

}  // namespace asdic::detail
