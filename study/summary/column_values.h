#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace asdic::detail::study {

/// A column of a table of rows: a vector of doubles that leaves memory when it is long.
///
/// Beyond `most_in_memory` values it lies in a file without a name in the folder for temporary
/// files (TMPDIR, else /var/tmp), mapped into memory: the system holds of it what is looked at. So
/// tables of any number of rows and columns take little memory. Where that folder has no room, the
/// column stays in memory.
class ColumnValues {
 public:
  static constexpr std::size_t most_in_memory = std::size_t{1} << 17;  // 1 MB

  ColumnValues() noexcept;
  ColumnValues(std::initializer_list<double> values);
  ColumnValues(std::span<const double> values);  // NOLINT: as a vector's values are
  ColumnValues(const std::vector<double>& values) : ColumnValues(std::span(values)) {}  // NOLINT
  ColumnValues(const ColumnValues& other) : ColumnValues(other.span()) {}
  ColumnValues(ColumnValues&&) noexcept;
  ColumnValues& operator=(ColumnValues other) noexcept;
  ~ColumnValues();

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const double* data() const noexcept { return data_; }
  [[nodiscard]] const double* begin() const noexcept { return data_; }
  [[nodiscard]] const double* end() const noexcept { return data_ + size_; }
  [[nodiscard]] double* begin() noexcept { return data_; }
  [[nodiscard]] double* end() noexcept { return data_ + size_; }
  [[nodiscard]] std::span<const double> span() const noexcept { return {data_, size_}; }
  [[nodiscard]] double operator[](std::size_t i) const noexcept { return data_[i]; }
  [[nodiscard]] double& operator[](std::size_t i) noexcept { return data_[i]; }
  /// \throws std::out_of_range
  [[nodiscard]] double at(std::size_t i) const {
    if (i >= size_) throw std::out_of_range("column of a table");
    return data_[i];
  }

  void push_back(double x) {
    if (size_ == step_) grow();
    data_[size_++] = x;
  }
  void append(std::span<const double> values) {
    for (const double x : values) push_back(x);
  }
  void pop_back() noexcept { --size_; }
  void clear() noexcept { *this = ColumnValues(); }

  /// Lets go of what the system holds of it in memory; what is asked for next comes back. Whoever
  /// has gone through a column calls it.
  void rest() const noexcept;
  [[nodiscard]] bool in_file() const noexcept { return file_ != nullptr; }

 private:
  class File;
  void grow();

  std::vector<double> memory_;
  std::unique_ptr<File> file_;
  double* data_ = nullptr;
  std::size_t size_ = 0, step_ = 0;  // values until it has to do something
};

}  // namespace asdic::detail::study
