#include "study/summary/column_values.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

namespace asdic::detail::study {
namespace {

constexpr std::size_t piece = std::size_t{1} << 17;  // values between two rests: 1 MB

/// A file that nobody else sees and that goes with the process; -1: there is none to be had.
int nameless_file() {
  for (const char* folder : {static_cast<const char*>(std::getenv("TMPDIR")), "/var/tmp", "/tmp"}) {
    if (folder == nullptr || *folder == '\0') continue;
    std::string name = std::string(folder) + "/asdic-XXXXXX";
    const int file = mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) continue;
    unlink(name.c_str());
    return file;
  }
  return -1;
}

}  // namespace

/// A mapped file.
class ColumnValues::File {
 public:
  File() : file_(nameless_file()) {}
  ~File() {
    if (data_ != nullptr) munmap(data_, bytes(capacity_));
    if (file_ >= 0) close(file_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] double* data() const noexcept { return static_cast<double*>(data_); }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// Makes room. The blocks are had now: a disk that is full must not be found out by a fault of a
  /// page. \return whether there is
  bool reserve(std::size_t values) {
    if (file_ < 0) return false;
    if (posix_fallocate(file_, static_cast<off_t>(bytes(capacity_)),
                        static_cast<off_t>(bytes(values - capacity_))) != 0)
      return false;
    void* more = data_ == nullptr
                     ? mmap(nullptr, bytes(values), PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0)
                     : mremap(data_, bytes(capacity_), bytes(values), MREMAP_MAYMOVE);
    if (more == MAP_FAILED) return false;
    data_ = more;
    capacity_ = values;
    return true;
  }
  /// Of a mapping that is shared, the pages' values stay in the file.
  void rest() const noexcept {
    if (data_ != nullptr) madvise(data_, bytes(capacity_), MADV_DONTNEED);
  }

 private:
  static std::size_t bytes(std::size_t values) noexcept { return values * sizeof(double); }

  int file_;
  void* data_ = nullptr;
  std::size_t capacity_ = 0;
};

ColumnValues::ColumnValues() noexcept = default;
ColumnValues::~ColumnValues() = default;

ColumnValues::ColumnValues(std::initializer_list<double> values)
    : ColumnValues(std::span<const double>(values.begin(), values.size())) {}

ColumnValues::ColumnValues(std::span<const double> values) { append(values); }

ColumnValues::ColumnValues(ColumnValues&& other) noexcept
    : memory_(std::move(other.memory_)),
      file_(std::move(other.file_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      step_(std::exchange(other.step_, 0)) {}

ColumnValues& ColumnValues::operator=(ColumnValues other) noexcept {
  memory_.swap(other.memory_);
  file_.swap(other.file_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(step_, other.step_);
  return *this;
}

void ColumnValues::grow() {
  const auto in_memory = [&] {
    const std::size_t more = std::max<std::size_t>(16, 2 * size_);
    memory_.resize(size_ < most_in_memory ? std::min(more, most_in_memory) : more);
    data_ = memory_.data();
    step_ = memory_.size();
  };
  if (file_ == nullptr) {
    if (size_ != most_in_memory) return in_memory();  // above it: there was no room for a file
    auto file = std::make_unique<File>();
    if (!file->reserve(2 * most_in_memory)) return in_memory();
    std::copy_n(data_, size_, file->data());
    memory_ = std::vector<double>();  // {} would keep its memory
    malloc_trim(0);                   // what malloc keeps of it would be all that is saved
    file_ = std::move(file);
    file_->rest();
  } else if (size_ == file_->capacity() && !file_->reserve(size_ + size_ / 2 / piece * piece)) {
    memory_.assign(data_, data_ + size_);
    file_.reset();
    return in_memory();
  } else {
    file_->rest();
  }
  data_ = file_->data();
  step_ = std::min(file_->capacity(), size_ + piece);
}

void ColumnValues::rest() const noexcept {
  if (file_ != nullptr) file_->rest();
}

}  // namespace asdic::detail::study
