#include "io/hdf5_file.h"
#include "io/output/own_files.h"

namespace asdic::own {

bool hdf5(const std::filesystem::path& path) {
  try {
    const Hdf5File file = Hdf5File::peek(path);
    return file.has_attribute("", "filetype") &&
           file.attribute_text("", "filetype").starts_with("asdic ");
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace asdic::own
