#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/output_lock.h"
#include "io/files/unfinished.h"

namespace asdic::detail {

/// Whether a file that is there was written by asdic, or, where its kind has no room to say so, is
/// one of that kind. Never throws for what it finds in the file.
using Recognise = bool (*)(const std::filesystem::path& path);

/// What a result may be written over.
struct OutputRules {
  Recognise own = nullptr;    ///< what counts as ours; none: no file
  Recognise worth = nullptr;  ///< unfinished parts that are worth keeping; none: no part
  bool force = false;         ///< any file, but never one of those below
  std::vector<std::filesystem::path> inputs{};  ///< that the run reads, beside those it has read
  /// The run replaces the target after it has read it, so the target is not one of its inputs.
  bool renews = false;
  std::string option = "--output";  ///< option that names the result, for messages
};

/// That a result may have a name: in a folder that is there, not a folder, link, device, FIFO or
/// socket, not an input of the run, and not a file that asdic did not write, unless forced. An
/// empty file is nobody's loss. \throws InputError
void check_output(const std::filesystem::path& target, const OutputRules& rules);

/// A result on its way to its name: every file that asdic writes.
///
/// It is written beside its target under a name that nobody had before (TARGET.k3f9.part), brought
/// to the disk, and renamed. Nobody else writes the same target meanwhile (OutputLock). Without
/// finish() the part goes, and only the part. A signal that ends the program removes the part
/// (Unfinished). A part that is left after `kill -9` is removed when the next run of this target
/// is complete, unless it is worth keeping (OutputRules::worth).
class OutputFile {
 public:
  /// Before the work: checks the target and takes the lock. \throws InputError, RunError
  explicit OutputFile(std::filesystem::path target, OutputRules rules = {});
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  /// Where to write: an empty file, made by the first call. \throws RunError
  [[nodiscard]] const std::filesystem::path& part();
  /// It is worth something though it is not whole: without finish() it stays.
  void keep() noexcept {
    kept_ = true;
    unfinished_.reset();
  }
  /// All of it at once, and finish(). \throws RunError
  void write(std::string_view bytes);
  /// Brings the part to the disk and gives it its name. If that fails, or somebody has put a file
  /// of their own there meanwhile, the part stays and the message names it. \throws RunError
  void finish();

 private:
  std::filesystem::path target_;
  OutputRules rules_;
  OutputLock lock_;
  std::filesystem::path part_{};  ///< "": not made, or renamed
  bool kept_ = false;
  std::optional<Unfinished> unfinished_{};  ///< the part, until keep() or finish()
};

/// Parts of a target that other runs have left, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> parts_of(const std::filesystem::path& target);
/// The target of a part: ping.h5 of ping.h5.k3f9.part; "" for another name.
[[nodiscard]] std::filesystem::path target_of(const std::filesystem::path& part);

}  // namespace asdic::detail
