#pragma once
#include <filesystem>

#include "io/files/output_file.h"
#include "io/hdf5/hdf5_file.h"

namespace asdic::detail {

/// A small HDF5 file that gets its name when it is whole.
class Hdf5Output {
 public:
  explicit Hdf5Output(OutputFile&& output);

  [[nodiscard]] Hdf5File& file() noexcept { return file_; }
  void finish();  ///< \throws RunError

 private:
  OutputFile output_;
  Hdf5File file_;
};

/// What may be written over by a result of this name: files of its kind, which the ending tells.
/// \param input  of the run, which may not be read yet
[[nodiscard]] OutputRules rules_for(const std::filesystem::path& path, bool force,
                                    const std::filesystem::path& input = {});

}  // namespace asdic::detail
