#pragma once
#include <atomic>
#include <cstddef>
#include <string>

#include "serve/refusal.h"

namespace asdic::detail::serve {

/// Bytes of files that all sessions of a server have written, or are about to.
class OutputQuota {
 public:
  /// \throws Refusal ("limit") if there is no room for so many more
  void take(std::size_t bytes, std::size_t most) {
    std::size_t so_far = written_;
    do {
      if (so_far > most || bytes > most - so_far)
        throw Refusal("limit",
                      refusal_text("output_bytes",
                                   std::to_string(so_far + bytes) + " bytes of files with this one",
                                   "at most " + std::to_string(most) + " over the server's life"));
    } while (!written_.compare_exchange_weak(so_far, so_far + bytes));
  }
  void give_back(std::size_t bytes) noexcept { written_ -= bytes; }

  [[nodiscard]] std::size_t written() const noexcept { return written_; }

 private:
  std::atomic<std::size_t> written_ = 0;
};

/// A file that counts: with what it may take while it is made, then with its size. One that is not
/// kept is removed and does not count.
class CountedFile {
 public:
  /// \throws Refusal ("limit")
  CountedFile(OutputQuota& quota, std::size_t most, std::string path, std::size_t expected)
      : quota_(quota), most_(most), path_(std::move(path)), counted_(expected) {
    quota_.take(expected, most);
  }
  ~CountedFile();
  CountedFile(const CountedFile&) = delete;
  CountedFile& operator=(const CountedFile&) = delete;

  /// It is complete. \throws Refusal ("limit") if it has become too large, which removes it
  void keep();

 private:
  OutputQuota& quota_;
  std::size_t most_;
  std::string path_;
  std::size_t counted_;
  bool kept_ = false;
};

}  // namespace asdic::detail::serve
