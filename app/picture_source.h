#pragma once
#include <filesystem>
#include <string>

namespace asdic::detail::app {

/// A folder for files that nobody is to see; it goes with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder();  ///< \throws RunError
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// A result as the pictures' script reads it: an HDF5 file as it is; of a .shd, .arr or .ray an
/// HDF5 file in the folder, with the sea of the .env beside it if that can be read. \param name  of
/// the new file, without .h5 \throws InputError as read_result()
[[nodiscard]] std::filesystem::path picture_source(const std::filesystem::path& result,
                                                   const TemporaryFolder& folder,
                                                   const std::string& name);

}  // namespace asdic::detail::app
