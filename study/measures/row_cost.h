#pragma once
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace asdic::detail::study {

/// What a row's time goes to.
enum class Stage {
  scenario,      ///< the scenario's settings become a scenario
  ocean,         ///< the water, the pulse, the grids of what scatters
  target_paths,  ///< echoes and direct blasts
  sea_paths,     ///< to what scatters, and the expected level of its sound
  sound,         ///< synthesis of echoes and reverberation
  noise,         ///< noise, ships and the receivers' electronics
  draws,         ///< of the matched filter's expected background
  cells,         ///< all cells without an echo
  measures,      ///< matched filter, receiver, own measures
  count
};
/// "paths to targets"
[[nodiscard]] std::string_view name(Stage stage) noexcept;

/// Processor time of a row [s]: of the whole process, so that it is the row's where nothing else
/// runs beside it.
struct RowCost {
  double total = 0.0;
  std::array<double, static_cast<std::size_t>(Stage::count)> stages{};

  [[nodiscard]] double& operator[](Stage stage) { return stages[static_cast<std::size_t>(stage)]; }
  [[nodiscard]] double operator[](Stage stage) const {
    return stages[static_cast<std::size_t>(stage)];
  }
};

/// Processor time of this process, of all its threads [s].
[[nodiscard]] double processor_seconds() noexcept;

/// Processor time since it was made or last read. Where nobody wants to know, it reads no clock.
class CostClock {
 public:
  explicit CostClock(RowCost* to) : to_(to), start_(to == nullptr ? 0.0 : processor_seconds()) {}
  /// Adds what has passed to a stage.
  void lap(Stage stage) {
    if (to_ != nullptr) (*to_)[stage] += lap();
  }
  [[nodiscard]] double lap() {
    if (to_ == nullptr) return 0.0;
    const double now = processor_seconds();
    return now - std::exchange(start_, now);
  }

 private:
  RowCost* to_;
  double start_;
};

}  // namespace asdic::detail::study
