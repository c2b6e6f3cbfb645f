#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"

namespace asdic::detail {

/// "1.5 GB": powers of 1000, one digit behind the point.
[[nodiscard]] std::string bytes_text(double bytes);

/// What a process may use of a machine, and who says so.
struct MemoryLimit {
  double bytes = 0.0;
  std::string source;  ///< "the machine's memory", "the control group", "the address space's limit"
};

/// The least of the machine's memory, the limits of this process' control groups (cgroup v1 and
/// v2, with all groups above) and its resource limits RLIMIT_AS and RLIMIT_DATA.
/// \param root  where /proc and /sys are found
[[nodiscard]] MemoryLimit memory_limit(const std::filesystem::path& root = "/");

/// Something large that is about to be made.
struct MemoryNeed {
  std::string where;   ///< the key to turn: "reverberation.ground_spacing"
  std::string what;    ///< "78 million pairs of paths to scatterers"
  double bytes = 0.0;  ///< at its peak
  std::string remedy;  ///< what takes less: "a larger spacing or fewer bounces"
};

/// More memory is asked for than may be used. An input's fault: keys make it large.
class MemoryError : public InputError {
 public:
  MemoryError(InputFault fault, double needed) : InputError(std::move(fault)), needed_(needed) {}
  /// All that was asked for so far, this included [bytes].
  [[nodiscard]] double needed() const noexcept { return needed_; }

 private:
  double needed_;
};

/// What a piece of work may take, and what it has taken: asked before each large allocation, so
/// that too much ends with one message that names what asks for how much and which key to turn.
/// A copy is a budget of its own. Not shared by threads.
class MemoryBudget {
 public:
  /// Half of what the process may use.
  MemoryBudget() : MemoryBudget(1) {}
  /// That, divided among as many processes as run on this machine.
  explicit MemoryBudget(int processes);
  /// As run.memory says [bytes]; 0: by default.
  [[nodiscard]] static MemoryBudget of(double bytes);
  /// By default, of work that has no run.memory: a BELLHOP case, a file.
  [[nodiscard]] static MemoryBudget without_key();
  /// Less of it, and nothing taken. \param bytes  at most   \param origin  who says so
  [[nodiscard]] MemoryBudget share(double bytes, const std::string& origin) const;

  /// \throws MemoryError if it is more than is left; what then counts as asked for is in it
  void take(MemoryNeed need);

  [[nodiscard]] double bytes() const noexcept { return bytes_; }
  [[nodiscard]] double left() const noexcept { return bytes_ - taken_; }
  [[nodiscard]] double taken() const noexcept { return taken_; }
  [[nodiscard]] const std::vector<MemoryNeed>& needs() const noexcept { return needs_; }
  /// "11.6 GB, half of the machine's memory": for messages.
  [[nodiscard]] std::string text() const;

 private:
  double bytes_ = 0.0, taken_ = 0.0;
  std::string origin_;  // "half of the machine's memory"
  bool has_key_ = true;
  std::vector<MemoryNeed> needs_;
};

}  // namespace asdic::detail
