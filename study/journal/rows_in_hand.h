#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace asdic::detail::study {

/// How many processes died while they made a row, by its index.
using Deaths = std::map<std::uint64_t, int>;

/// What a process makes at this moment, in a small file beside its journal: so that the next one
/// knows which rows may have killed it (docs/formats/study-results.md, "A row that kills").
///
/// Two writes a row into the system's cache, which outlives the process, not the machine: rows that
/// were in hand when the machine went down are not held against them. Shared by threads.
class RowsInHand {
 public:
  /// \param journal   beside which the file lies; what was in it is written over
  /// \param suspects  rows whose deaths are still to be remembered
  /// \throws RunError if it cannot be written
  explicit RowsInHand(const std::filesystem::path& journal, Deaths suspects = {});
  /// Takes the file away, unless there are suspects left.
  ~RowsInHand();
  RowsInHand(const RowsInHand&) = delete;
  RowsInHand& operator=(const RowsInHand&) = delete;

  /// A row in hand, while it lives.
  class Mark {
   public:
    Mark(RowsInHand& rows, std::uint64_t index) : rows_(rows), slot_(rows.begin(index)) {}
    ~Mark() { rows_.end(slot_); }
    Mark(const Mark&) = delete;
    Mark& operator=(const Mark&) = delete;

   private:
    RowsInHand& rows_;
    std::size_t slot_;
  };

  [[nodiscard]] Deaths suspects() const;
  void clear(std::uint64_t index);  ///< of its deaths: it was made, or given up
  /// From now on no row is to blame: the process was told to end.
  void call_off();

 private:
  enum class State : char { empty = '-', making = 'm', suspect = 's' };
  struct Slot {
    std::uint64_t index = 0;
    int deaths = 0;
    State state = State::empty;
  };
  std::size_t begin(std::uint64_t index);
  void end(std::size_t slot);
  void write(std::size_t slot) const;

  std::filesystem::path path_;
  int file_ = -1;
  mutable std::mutex mutex_;
  std::vector<Slot> slots_;
  bool called_off_ = false;

  friend Deaths deaths_beside(const std::filesystem::path& journal, bool anywhere);
};

/// What processes left beside the journals of an output. Those that are still at work have their
/// journals locked: whoever asks has opened them.
[[nodiscard]] Deaths deaths_of(const std::filesystem::path& output);
/// What a process left beside one journal. \param anywhere  it ran on whatever machine; else rows
/// that were in hand when this machine went down are not held against them
[[nodiscard]] Deaths deaths_beside(const std::filesystem::path& journal, bool anywhere);
/// Takes the files away in which that stood, but for that of one journal.
void forget_deaths(const std::filesystem::path& output, const std::filesystem::path& but);

/// The file beside a journal.
[[nodiscard]] std::filesystem::path hand_of(const std::filesystem::path& journal);

}  // namespace asdic::detail::study
