#pragma once
#include <string>
#include <vector>

#include "app/console.h"
#include "sonar/ping/ping_record.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::app {

/// The columns of a line per ping and target, and that line.
[[nodiscard]] std::vector<Table::Column> summary_columns();
[[nodiscard]] std::vector<std::string> summary_row(int ping, double elevation_deg,
                                                   const TargetSummary& target);

/// What a run prints at its end: a line per ping and target, and where the time went.
class PingReport {
 public:
  /// \param scenario  outlives the report
  explicit PingReport(const Scenario& scenario) : scenario_(scenario) {}

  void add(const PingRecord& record);
  /// Warning of the first echo that its record does not hold completely; empty: none.
  [[nodiscard]] const std::string& echo_beside_record() const noexcept { return beside_record_; }
  /// \param wall  of the whole run [s]
  [[nodiscard]] std::string text(double wall) const;

 private:
  const Scenario& scenario_;
  Table table_{summary_columns()};
  bool sea_drawn_anew_ = false;
  std::string beside_record_;
  std::size_t ended_searches_ = 0;
  Bounces bounces_;                // that were followed
  double band_error_ = 0.0;        // of reverberation, where it is more than asked for
  double plane_wave_error_ = 0.0;  // of reverberation [periods]
  int pings_ = 0, lines_ = 0, left_out_ = 0;
  Timings total_;
  Reuse reuse_;  // sums
};

}  // namespace asdic::detail::app
