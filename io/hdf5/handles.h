#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "io/hdf5/hdf5_file.h"
#include "io/isolated/child.h"

// Inside of Hdf5File, for its own .cpp files; hid_t is std::int64_t in HDF5 1.10 and later.
namespace asdic::detail::hdf5 {

/// An HDF5 identifier with its closing function.
class Handle {
 public:
  using Close = int (*)(std::int64_t);
  Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator std::int64_t() const { return id_; }  // NOLINT: it stands for the identifier
  [[nodiscard]] std::int64_t release() { return std::exchange(id_, -1); }

 private:
  std::int64_t id_;
  Close close_;
};

/// What HDF5 says about the last failure, innermost first; "the disk is full" if that is it.
[[nodiscard]] std::string last_message();

/// Throws RunError "FILE: OBJECT: ACTION failed: HDF5's words".
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& object,
                       const std::string& action);

/// To be called before anything else of HDF5, also by netCDF: keeps its error stack off the
/// terminal, and its hands off at exit.
void prepare();

/// H5Fcreate (with H5F_ACC_TRUNC) or H5Fopen, without HDF5's locks where the system refuses them.
[[nodiscard]] std::int64_t open_file(const std::filesystem::path& path, unsigned flags);

}  // namespace asdic::detail::hdf5

namespace asdic::detail {

struct Hdf5File::Impl {
  std::filesystem::path path;
  std::int64_t file = -1;
  mutable bool failed = false;             // a write may have: the file is then left as it lies
  std::unique_ptr<isolated::Child> child;  // who reads it for us; `file` is then none

  /// The identifier if it is one, else the failure.
  std::int64_t check(std::int64_t id, const std::string& object, const std::string& action) const {
    if (id >= 0) return id;
    failed = true;
    hdf5::fail(path, object, action);
  }
  [[nodiscard]] hdf5::Handle open_dataset(const std::string& dataset) const;
  [[nodiscard]] hdf5::Handle open_object(const std::string& object) const;
  /// A block, piece by piece.
  template <class T>
  [[nodiscard]] std::vector<T> read_by_child(const std::string& dataset, const Shape& start,
                                             const Shape& count) const;
  [[nodiscard]] Shape shape_of(std::int64_t dataset_id, const std::string& dataset) const;
};

}  // namespace asdic::detail
