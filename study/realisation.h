#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "study/study.h"

namespace asdic::study {

/// A column of a study's table.
struct Column {
  enum class Role { input, measure, reuse };
  std::string name;  ///< "wind_speed", "echo_level_db"; [a-z0-9_]
  std::string unit;  ///< "m/s", "dB re 1 µPa", "1"
  std::string meaning;
  Role role = Role::measure;
  std::vector<std::string> labels;  ///< of a categorical column, whose values are indices into it
};

/// What came out of one realisation: a pure function of (study, index).
struct Row {
  std::uint64_t index = 0;
  bool valid = true;            ///< false: skipped (on_error = "skip"); its measures are NaN
  std::string fault;            ///< why it was skipped
  std::vector<double> values;   ///< [columns]
  std::vector<float> pressure;  ///< kept time series, empty where none [channels × samples × iq]
  std::vector<std::size_t> pressure_shape;
};

/// The columns of a study's rows: inputs first, in the order of [vary], then measures.
[[nodiscard]] std::vector<Column> columns(const Study& study);

/// What realisations so far found known (sonar/reuse.h). It tells of the run: counts depend on
/// which realisation came first, rows never do.
struct ReuseCounts {
  std::uint64_t pings = 0;             ///< simulated
  std::uint64_t oceans_known = 0;      ///< of them in an ocean that another had used
  std::uint64_t legs_searched = 0;     ///< sets of eigenrays
  std::uint64_t legs_reused = 0;       ///< the same, out of what was kept
  std::uint64_t boundaries_known = 0;  ///< pings whose paths to scatterers were all known
};

/// Makes rows. Built once; shared by threads. It keeps what realisations have in common (the ocean,
/// its paths) for as long as they have it, which never changes a bit of a row.
class Realiser {
 public:
  explicit Realiser(Study study);
  ~Realiser();

  /// \throws InputError naming realisation, key and drawn value (on_error = "stop")
  [[nodiscard]] Row realise(std::uint64_t index) const;

  [[nodiscard]] const Study& study() const noexcept;
  [[nodiscard]] ReuseCounts reuse() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::study
