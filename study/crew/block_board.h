#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "study/sampling/index_set.h"

namespace asdic::detail::study {

/// Which block of a study's indices is whose: small files in a folder that all workers see, of
/// which there is no master. Each step is one of the few that file systems of clusters do as a
/// whole: making a file that must not be there, renaming, removing.
///
///     study            identity of the study, indices of a block
///     worker-N         of each worker, touched while it lives
///     B.taken          a block in work; its text is N
///     B.done           a block whose rows are in the journal of its worker
///     assembly         whoever makes the file of all rows; its text is N
///
/// A worker that has not touched its file for `silence`, as seen by whoever looks, is gone: clocks
/// of two machines are never compared. What is done twice is harmless, as rows depend on their
/// index alone.
class BlockBoard {
 public:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;

  /// Joins, or begins. \param folder  made if it is not there \param range  of all indices
  /// \param silence  after which a worker is taken for gone
  /// \throws InputError if it is another study's; RunError if the folder cannot be written
  BlockBoard(std::filesystem::path folder, const std::string& identity, IndexRange range,
             Seconds silence);
  ~BlockBoard();  ///< leaves: what this worker has taken is free again
  BlockBoard(const BlockBoard&) = delete;
  BlockBoard& operator=(const BlockBoard&) = delete;

  [[nodiscard]] int worker() const noexcept { return worker_; }  ///< own number, from 1
  /// Touches the own file; called more often than `silence`. Any thread may.
  void live() const;

  struct Block {
    std::uint64_t number = 0;
    IndexRange range;
    std::optional<int> before;  ///< the worker that had it and is gone
  };
  /// Takes a block that is nobody's, or one whose worker is gone. None: there is none at present.
  [[nodiscard]] std::optional<Block> take();
  /// Its rows are in the journal, committed.
  void done(const Block& block);
  /// Gives it back.
  void give_back(const Block& block);

  [[nodiscard]] std::uint64_t rows_done() const noexcept { return rows_done_; }  ///< when last seen
  [[nodiscard]] bool all_done() const noexcept { return done_.size() == blocks_; }

  /// Whether this worker is to make the file: the first that asks, or one after the one that began
  /// is gone.
  [[nodiscard]] bool assembles();
  [[nodiscard]] bool is_over() const;  ///< the folder is gone: the file is made
  void remove();                       ///< the folder and what it holds of this

  /// Indices of a block: 4096 blocks or, of long studies, of 64 rows each up to 65536 blocks, so
  /// that a folder can hold them and ten thousand workers have some each.
  [[nodiscard]] static std::uint64_t block_size(std::uint64_t rows) noexcept;

 private:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string name_of(std::uint64_t block, const char* what) const;
  [[nodiscard]] IndexRange range_of(std::uint64_t block) const noexcept;
  [[nodiscard]] bool is_gone(int worker);
  [[nodiscard]] int workers_there() const;  ///< the greatest of their numbers
  void look();
  void free(std::uint64_t block) const;  // if it is this worker's
  /// A file that a worker holds is taken from one that is gone. \return the one before
  [[nodiscard]] std::optional<int> take_over(const std::string& name);

  std::filesystem::path folder_;
  IndexRange range_;
  Seconds silence_;
  std::uint64_t size_ = 1, blocks_ = 0;
  int worker_ = 0;
  std::set<std::uint64_t> done_, taken_;  // when last seen
  std::set<std::uint64_t> own_;
  std::uint64_t rows_done_ = 0, next_ = 0;
  struct Seen {
    std::filesystem::file_time_type touched;
    Clock::time_point since;
  };
  std::map<int, Seen> seen_;  // of workers
};

/// The folder of an output's workers.
[[nodiscard]] std::filesystem::path crew_of(const std::filesystem::path& output);

}  // namespace asdic::detail::study
