#include "sonar/stretch_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sonar/phase_turn.h"

namespace asdic {
namespace {

Vec3 turned(const Vec3& s, double sine, double cosine) {  // about the vertical
  return {cosine * s.x() + sine * s.y(), cosine * s.y() - sine * s.x(), s.z()};
}

}  // namespace

Steering::Steering(std::span<const Vec3> phones, std::span<const double> frequencies) {
  for (const double f : frequencies)
    for (const Vec3& phone : phones) {
      x_.push_back(f * phone.x());
      y_.push_back(f * phone.y());
      z_.push_back(f * phone.z());
    }
}

void Steering::add(std::complex<double> amplitude, const Vec3& s,
                   std::complex<double>* column) const {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    double re = amplitude.real(), im = amplitude.imag();
    turn_back(s.x() * x_[i] + s.y() * y_[i] + s.z() * z_[i], re, im);
    column[i] += std::complex<double>(re, im);
  }
}

StretchSum::StretchSum(const Steering& steering, double begin, double end, std::size_t turns)
    : steering_(steering),
      begin_(begin),
      length_(end - begin),
      turns_(turns),
      columns_(static_cast<Eigen::Index>(steering.components()), block),
      sum_(Matrix::Zero(columns_.rows(), columns_.rows())) {}

void StretchSum::add(Heard& h) {
  const std::size_t turns = h.all_round ? turns_ : 1;
  // The sum's bearings interleave: they turn by one step of the circle in the stretch's length.
  const double share = std::clamp((h.delay - begin_) / length_, 0.0, 1.0);
  const double scale = std::sqrt(1.0 / static_cast<double>(turns));
  for (std::size_t k = 0; k < turns; ++k) {
    const double angle =
        h.all_round ? 2.0 * pi * (static_cast<double>(k) + share) / static_cast<double>(turns)
                    : 0.0;
    const double s = std::sin(angle), c = std::cos(angle);
    columns_.col(used_).setZero();
    std::complex<double>* column = columns_.col(used_).data();
    steering_.add(scale * h.one, turned(h.one_slowness, s, c), column);
    if (h.other != 0.0) steering_.add(scale * h.other, turned(h.other_slowness, s, c), column);
    h.power += columns_.col(used_).squaredNorm() / static_cast<double>(columns_.rows());
    if (++used_ == block) take();
  }
}

void StretchSum::take() {
  if (used_ > 0) sum_.selfadjointView<Eigen::Lower>().rankUpdate(columns_.leftCols(used_));
  used_ = 0;
}

std::size_t StretchSum::factor(std::vector<std::complex<float>>& columns) {
  take();
  const double mean = sum_.diagonal().real().mean();
  if (!(mean > 0.0)) return 0;
  constexpr double left = 1e-6;
  const Eigen::LDLT<Matrix> ldlt(sum_ / mean);
  const Eigen::Index n = sum_.rows();
  const Eigen::VectorXd root = ldlt.vectorD().real().cwiseMax(0.0).cwiseSqrt();
  const Matrix l = ldlt.matrixL();
  Matrix f = ldlt.transpositionsP().transpose() * l;
  f.array().rowwise() *= root.transpose().array().cast<std::complex<double>>();
  // A column's share of the trace is its norm; pivots come in falling order.
  const Eigen::VectorXd share = f.colwise().squaredNorm();
  Eigen::Index rank = n;
  for (double rest = 0.0; rank > 0 && (rest += share[rank - 1]) <= left * share.sum();) --rank;
  for (Eigen::Index k = 0; k < rank; ++k)
    for (Eigen::Index i = 0; i < n; ++i) columns.emplace_back(f(i, k));
  return static_cast<std::size_t>(rank);
}

}  // namespace asdic
