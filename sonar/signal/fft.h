#pragma once
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

#include "core/huge_pages.h"

namespace asdic::detail {

/// Zeroed, 64-byte aligned memory: what every transform below reads and writes. It is cut out of a
/// little more of malloc's: aligned_alloc of glibc before 2.38 leaves holes that nothing fits into,
/// and a study of many geometries grew by 200 kB a realisation.
template <class T>
class FftBuffer {
 public:
  FftBuffer() = default;
  explicit FftBuffer(std::size_t size) : size_(size) {
    std::size_t room = size * sizeof(T) + alignment;
    memory_.reset(std::malloc(room));
    void* begin = memory_.get();
    if (begin == nullptr || std::align(alignment, size * sizeof(T), begin, room) == nullptr)
      throw std::bad_alloc();
    data_ = static_cast<T*>(begin);
    prefer_huge_pages(data_, size * sizeof(T));
    clear();
  }

  /// Grows to at least `size` elements (zeroed when it grows, untouched otherwise).
  void reserve(std::size_t size) {
    if (size > size_) *this = FftBuffer(size);
  }
  void clear() noexcept { std::uninitialized_value_construct_n(data_, size_); }

  [[nodiscard]] T* data() noexcept { return data_; }
  [[nodiscard]] const T* data() const noexcept { return data_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }

  /// Elements from one row to the next of a matrix whose every row is aligned.
  [[nodiscard]] static constexpr std::size_t row_stride(std::size_t columns) noexcept {
    constexpr std::size_t step = alignment / sizeof(T);
    return (columns + step - 1) / step * step;
  }

 private:
  static constexpr std::size_t alignment = 64;
  struct Free {
    void operator()(void* p) const noexcept { std::free(p); }
  };
  std::unique_ptr<void, Free> memory_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Smallest length ≥ n (at least 1) whose only prime factors are 2, 3, 5 and 7: a fast transform.
[[nodiscard]] std::size_t fast_fft_length(std::size_t n) noexcept;

/// Discrete Fourier transforms, in place, without scaling: X_k = Σ x_n e^{∓i2πkn/N}, − forward.
///
/// Real = float or double. The plan is made once per length under a lock (FFTW_ESTIMATE: timed
/// plans change the last bits), kept for the life of the program, and executed by any number of
/// threads at once. Data must come from an FftBuffer, at its start or at a row_stride().
template <class Real>
class ComplexFft {
 public:
  explicit ComplexFft(std::size_t length);
  void forward(std::complex<Real>* data) const noexcept;
  void inverse(std::complex<Real>* data) const noexcept;
  [[nodiscard]] std::size_t length() const noexcept { return length_; }

 private:
  std::size_t length_;
  const void *forward_, *inverse_;
};

/// The same between N real samples and their N/2 + 1 bins of frequency ≥ 0, out of place.
/// inverse() uses its input as scratch. Unscaled: inverse(forward(x)) = N·x.
template <class Real>
class RealFft {
 public:
  explicit RealFft(std::size_t length);
  void forward(Real* samples, std::complex<Real>* bins) const noexcept;
  void inverse(std::complex<Real>* bins, Real* samples) const noexcept;
  [[nodiscard]] std::size_t length() const noexcept { return length_; }
  [[nodiscard]] std::size_t bins() const noexcept { return length_ / 2 + 1; }

 private:
  std::size_t length_;
  const void *forward_, *inverse_;
};

extern template class ComplexFft<float>;
extern template class ComplexFft<double>;
extern template class RealFft<float>;
extern template class RealFft<double>;

}  // namespace asdic::detail
