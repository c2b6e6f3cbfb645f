#include "serve/output_quota.h"

#include <filesystem>
#include <system_error>

namespace asdic::detail::serve {

CountedFile::~CountedFile() {
  if (kept_) return;
  quota_.give_back(counted_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void CountedFile::keep() {
  const std::size_t size = std::filesystem::file_size(path_);
  quota_.give_back(counted_);
  counted_ = 0;
  quota_.take(size, most_);
  kept_ = true;
}

}  // namespace asdic::detail::serve
