#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/measures/cell_counts.h"
#include "study/measures/kept_array.h"
#include "study/measures/row_cost.h"
#include "study/plan/study.h"

namespace asdic::detail::study {

/// A column of a study's table.
struct Column {
  /// `ping`: of one ping of several, which has no tables of its own.
  enum class Role { input, measure, ping, reuse, weight };
  std::string name;  ///< "wind_speed", "echo_level_db"; [a-z0-9_]
  std::string unit;  ///< "m/s", "dB re 1 µPa", "1"
  std::string meaning;
  Role role = Role::measure;
  std::vector<std::string> labels;   ///< of a categorical column, whose values are indices into it
  std::string formula{};             ///< of a measure of [summary.own], of which rows hold nothing
  bool event = false;                ///< such a one that is 0 or 1
  std::optional<bool> least_best{};  ///< such a one that says so
};

/// What places a kept time series in time and band: p(t) = Re(x_k e^{i2πf_c(t + t_0)}) at
/// t = start + k/sample_rate after the ping; of real pressure, p = x_k.
struct SeriesTiming {
  double sample_rate = 0.0;  ///< [Hz]
  double start = 0.0;        ///< of the first sample, after the ping's start [s]
  double carrier = 0.0;      ///< f_c of complex baseband [Hz]; 0: real pressure
  double epoch = 0.0;        ///< t_0 [s]

  bool operator==(const SeriesTiming&) const = default;
};

/// What came out of one realisation: a pure function of (study, index), but for `reuse`.
struct Row {
  std::uint64_t index = 0;
  bool valid = true;            ///< false: skipped (on_error = "skip"); its measures are NaN
  std::string fault;            ///< why it was skipped
  std::string unknown{};        ///< why a measure is not known; "" in rows that were read
  std::vector<double> values;   ///< [columns]
  std::vector<float> pressure;  ///< kept time series, empty where none [channels × samples × iq]
  std::vector<std::size_t> pressure_shape;
  SeriesTiming timing{};              ///< of the time series
  std::vector<double> reuse;          ///< [reuse_columns()] what was known before it was made
  std::vector<std::uint8_t> cells{};  ///< packed_counts() of those without an echo, if counted
  std::vector<KeptArray> kept{};      ///< spectra, detections, in the order of kept_kinds()
};

/// The column with ln of the weights of rows that are drawn from a proposal: nominal density over
/// that from which they were drawn.
inline constexpr const char* log_weight_column = "log_weight";
/// … and that which tells from which part of the proposal.
inline constexpr const char* drawn_from_column = "drawn_from";

/// The columns of a study's rows: inputs first, in the order of [vary], then weight and part where
/// they have them, then measures, last the event of [rare].
[[nodiscard]] std::vector<Column> columns(const Study& study);

/// Of the cells that are counted in each row.
[[nodiscard]] CellShape cell_shape(const Study& study);

/// What a realisation found known (raytrace/places/reuse.h), NaN of one that was skipped. It tells
/// of the run: of two alike the first one searches, whichever that is; their rows are the same.
[[nodiscard]] const std::vector<Column>& reuse_columns();

/// Makes rows. Built once; shared by threads. It keeps what realisations have in common (the ocean,
/// its paths) for as long as they have it, which never changes a bit of a row.
class Realiser {
 public:
  /// Bound on what is kept of what rows have in common, so that memory stays flat. The streams of
  /// reverberation of a hull on a shelf take 100 MB, and every draw of a row asks for them.
  static constexpr std::size_t shared_bytes = std::size_t{192} << 20;

  /// \param processes  on this machine, which share its memory where run.memory does not say
  explicit Realiser(Study study, int processes = 1);
  ~Realiser();

  /// \throws InputError naming realisation, key and drawn value (on_error = "stop")
  /// \param cost  gets what it took; none: nobody asks
  [[nodiscard]] Row realise(std::uint64_t index, RowCost* cost = nullptr) const;
  /// One that is not made: what it drew, and why. Its measures are NaN.
  [[nodiscard]] Row skipped(std::uint64_t index, const std::string& fault) const;

  [[nodiscard]] const Study& study() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail::study
