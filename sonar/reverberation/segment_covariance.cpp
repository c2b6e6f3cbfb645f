#include "sonar/reverberation/segment_covariance.h"

#include <algorithm>
#include <cmath>

#include "core/rotate_back.h"

namespace asdic::detail {
namespace {

/// Columns of Cholesky's factorisation of a Hermitian matrix with pivots, until no more than a
/// share of its trace is left. The pivot is the first of the largest: the phones of an array that
/// is its own mirror image are alike in pairs, and the last bits would say which of two comes first
/// and so what a ping draws. \param scale  of the columns that are appended \return their number
template <class Matrix>
std::size_t factorise(const Matrix& a, double left, double scale,
                      std::vector<std::complex<float>>& columns) {
  const Eigen::Index n = a.rows();
  Eigen::VectorXd rest = a.diagonal().real();
  const double enough = left * rest.sum();
  Matrix f(n, n);
  Eigen::Index rank = 0;
  for (; rank < n && rest.sum() > enough; ++rank) {
    constexpr double alike = 1e-9;
    const double most = (1.0 - alike) * rest.maxCoeff();
    Eigen::Index pivot = 0;
    while (rest[pivot] < most) ++pivot;
    const double largest = rest[pivot];
    auto column = f.col(rank);
    column = a.col(pivot);
    column.noalias() -= f.leftCols(rank) * f.row(pivot).head(rank).adjoint();
    column *= 1.0 / std::sqrt(largest);
    rest = (rest - column.cwiseAbs2()).cwiseMax(0.0);
    rest[pivot] = 0.0;
  }
  const std::size_t first = columns.size();
  columns.resize(first + static_cast<std::size_t>(rank * n));
  Eigen::Map<Eigen::MatrixXcf>(columns.data() + first, n, rank) =
      (scale * f.leftCols(rank)).template cast<std::complex<float>>();
  return static_cast<std::size_t>(rank);
}

/// F of C = sum over its mean diagonal.
template <class Matrix>
std::size_t factor_of(const Matrix& sum, std::vector<std::complex<float>>& columns) {
  constexpr double left = 1e-6;
  const double mean = sum.diagonal().real().mean();
  return mean > 0.0 ? factorise(sum, left, 1.0 / std::sqrt(mean), columns) : 0;
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
    rotate_back(s.x() * x_[i] + s.y() * y_[i] + s.z() * z_[i], re, im);
    column[i] += std::complex<double>(re, im);
  }
}

SegmentSum::SegmentSum(const Steering& steering,
                       const AzimuthallySymmetricArray& azimuthally_symmetric)
    : steering_(steering),
      array_(azimuthally_symmetric),
      azimuthally_symmetric_(azimuthally_symmetric) {}

SegmentSum::~SegmentSum() = default;

void SegmentSum::add(Received& h) {
  if (h.azimuthally_symmetric) {
    const ReceivedAzimuthally circle = from_azimuthally_symmetric(h);
    h.power = array_.power(circle);
    azimuthally_symmetric_.add(circle);
    return;
  }
  if (columns_.size() == 0)
    columns_.resize(static_cast<Eigen::Index>(steering_.components()), block);
  columns_.col(used_).setZero();
  std::complex<double>* column = columns_.col(used_).data();
  steering_.add(h.one, h.one_slowness, column);
  if (h.other != 0.0) steering_.add(h.other, h.other_slowness, column);
  h.power = columns_.col(used_).squaredNorm() / static_cast<double>(columns_.rows());
  if (++used_ == block) take();
}

void SegmentSum::take() {
  if (used_ == 0) return;
  if (sum_.size() == 0) sum_ = Matrix::Zero(columns_.rows(), columns_.rows());
  sum_.selfadjointView<Eigen::Lower>().rankUpdate(columns_.leftCols(used_));
  used_ = 0;
}

std::size_t SegmentSum::factor(std::vector<std::complex<float>>& columns) {
  take();
  const auto n = static_cast<Eigen::Index>(steering_.components());
  if (sum_.size() == 0 && azimuthally_symmetric_.real()) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    azimuthally_symmetric_.add_to({sum.data(), static_cast<std::size_t>(sum.size())});
    return factor_of(sum, columns);
  }
  if (sum_.size() == 0)
    sum_ = Matrix::Zero(n, n);
  else
    sum_.triangularView<Eigen::StrictlyUpper>() = sum_.adjoint();
  azimuthally_symmetric_.add_to({sum_.data(), static_cast<std::size_t>(sum_.size())});
  return factor_of(sum_, columns);
}

}  // namespace asdic::detail
