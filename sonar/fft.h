#pragma once
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

namespace asdic {

/// Zeroed, 64-byte aligned memory: what every transform below reads and writes.
template <class T>
class FftBuffer {
 public:
  FftBuffer() = default;
  explicit FftBuffer(std::size_t size) : size_(size) {
    const std::size_t bytes = (size * sizeof(T) / alignment + 1) * alignment;
    data_.reset(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
    if (!data_) throw std::bad_alloc();
    clear();
  }

  /// Grows to at least `size` elements (zeroed when it grows, untouched otherwise).
  void reserve(std::size_t size) {
    if (size > size_) *this = FftBuffer(size);
  }
  void clear() noexcept { std::uninitialized_value_construct_n(data_.get(), size_); }

  [[nodiscard]] T* data() noexcept { return data_.get(); }
  [[nodiscard]] const T* data() const noexcept { return data_.get(); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_.get()[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_.get()[i]; }

  /// Elements from one row to the next of a matrix whose every row is aligned.
  [[nodiscard]] static constexpr std::size_t row_stride(std::size_t columns) noexcept {
    constexpr std::size_t step = alignment / sizeof(T);
    return (columns + step - 1) / step * step;
  }

 private:
  static constexpr std::size_t alignment = 64;
  struct Free {
    void operator()(T* p) const noexcept { std::free(p); }
  };
  std::unique_ptr<T, Free> data_;
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

}  // namespace asdic
