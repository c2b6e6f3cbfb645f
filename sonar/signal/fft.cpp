#include "sonar/signal/fft.h"

#include <fftw3.h>

#include <cassert>
#include <map>
#include <mutex>
#include <utility>

namespace asdic::detail {
namespace {

enum class Kind { forward, inverse, real_forward, real_inverse };

/// What differs between FFTW's two precisions.
template <class Real>
struct Fftw;

template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static void destroy(Plan plan) { fftwf_destroy_plan(plan); }
  static Plan c2c(int n, Complex* x, int sign) {
    return fftwf_plan_dft_1d(n, x, x, sign, FFTW_ESTIMATE);
  }
  static Plan r2c(int n, float* x, Complex* y) {
    return fftwf_plan_dft_r2c_1d(n, x, y, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
  }
  static Plan c2r(int n, Complex* x, float* y) {
    return fftwf_plan_dft_c2r_1d(n, x, y, FFTW_ESTIMATE);
  }
  static void run(const void* plan, Complex* x) {
    fftwf_execute_dft(static_cast<Plan>(const_cast<void*>(plan)), x, x);
  }
  static void run(const void* plan, float* x, Complex* y) {
    fftwf_execute_dft_r2c(static_cast<Plan>(const_cast<void*>(plan)), x, y);
  }
  static void run(const void* plan, Complex* x, float* y) {
    fftwf_execute_dft_c2r(static_cast<Plan>(const_cast<void*>(plan)), x, y);
  }
};

template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static void destroy(Plan plan) { fftw_destroy_plan(plan); }
  static Plan c2c(int n, Complex* x, int sign) {
    return fftw_plan_dft_1d(n, x, x, sign, FFTW_ESTIMATE);
  }
  static Plan r2c(int n, double* x, Complex* y) {
    return fftw_plan_dft_r2c_1d(n, x, y, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
  }
  static Plan c2r(int n, Complex* x, double* y) {
    return fftw_plan_dft_c2r_1d(n, x, y, FFTW_ESTIMATE);
  }
  static void run(const void* plan, Complex* x) {
    fftw_execute_dft(static_cast<Plan>(const_cast<void*>(plan)), x, x);
  }
  static void run(const void* plan, double* x, Complex* y) {
    fftw_execute_dft_r2c(static_cast<Plan>(const_cast<void*>(plan)), x, y);
  }
  static void run(const void* plan, Complex* x, double* y) {
    fftw_execute_dft_c2r(static_cast<Plan>(const_cast<void*>(plan)), x, y);
  }
};

template <class Real>
auto* fftw_pointer(std::complex<Real>* x) {
  return reinterpret_cast<typename Fftw<Real>::Complex*>(x);
}

// FFTW's planner is not thread safe in either precision, and the two share nothing we may rely on.
std::mutex planner_mutex;

/// Frees its plans when the program ends.
template <class Real>
struct Plans {
  std::map<std::pair<Kind, std::size_t>, typename Fftw<Real>::Plan> made;
  ~Plans() {
    for (auto& [key, plan] : made) Fftw<Real>::destroy(plan);
  }
};

/// The plan for this kind and length, made on first use.
template <class Real>
const void* plan(Kind kind, std::size_t length) {
  static Plans<Real> plans;
  const std::lock_guard lock(planner_mutex);
  auto& known = plans.made[{kind, length}];
  if (known) return known;
  FftBuffer<std::complex<Real>> complex_data(length + 1);
  FftBuffer<Real> real_data(length);
  auto* x = fftw_pointer(complex_data.data());
  const int n = static_cast<int>(length);
  switch (kind) {
    case Kind::forward:
      return known = Fftw<Real>::c2c(n, x, FFTW_FORWARD);
    case Kind::inverse:
      return known = Fftw<Real>::c2c(n, x, FFTW_BACKWARD);
    case Kind::real_forward:
      return known = Fftw<Real>::r2c(n, real_data.data(), x);
    case Kind::real_inverse:
      return known = Fftw<Real>::c2r(n, x, real_data.data());
  }
  return nullptr;
}

}  // namespace

std::size_t fast_fft_length(std::size_t n) noexcept {
  for (std::size_t candidate = n < 1 ? 1 : n;; ++candidate) {
    std::size_t rest = candidate;
    for (std::size_t prime : {2U, 3U, 5U, 7U})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return candidate;
  }
}

template <class Real>
ComplexFft<Real>::ComplexFft(std::size_t length)
    : length_(length),
      forward_(plan<Real>(Kind::forward, length)),
      inverse_(plan<Real>(Kind::inverse, length)) {
  assert(length > 0 && forward_ && inverse_);
}

template <class Real>
void ComplexFft<Real>::forward(std::complex<Real>* data) const noexcept {
  Fftw<Real>::run(forward_, fftw_pointer(data));
}

template <class Real>
void ComplexFft<Real>::inverse(std::complex<Real>* data) const noexcept {
  Fftw<Real>::run(inverse_, fftw_pointer(data));
}

template <class Real>
RealFft<Real>::RealFft(std::size_t length)
    : length_(length),
      forward_(plan<Real>(Kind::real_forward, length)),
      inverse_(plan<Real>(Kind::real_inverse, length)) {
  assert(length > 0 && forward_ && inverse_);
}

template <class Real>
void RealFft<Real>::forward(Real* samples, std::complex<Real>* bins) const noexcept {
  Fftw<Real>::run(forward_, samples, fftw_pointer(bins));
}

template <class Real>
void RealFft<Real>::inverse(std::complex<Real>* bins, Real* samples) const noexcept {
  Fftw<Real>::run(inverse_, fftw_pointer(bins), samples);
}

template class ComplexFft<float>;
template class ComplexFft<double>;
template class RealFft<float>;
template class RealFft<double>;

}  // namespace asdic::detail
