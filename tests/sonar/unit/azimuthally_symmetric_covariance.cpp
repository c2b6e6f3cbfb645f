#include "sonar/reverberation/azimuthally_symmetric_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "sonar/reverberation/segment_covariance.h"

// The mean over bearings in closed form against the plain sum over many of them.
namespace asdic::detail {
namespace {

using Matrix = Eigen::MatrixXcd;

/// Phones around a reference, at several depths or at its own; two frequencies.
struct Listening {
  std::vector<Vec3> phones;
  std::vector<double> frequencies = {900.0, 1100.0};
  static constexpr double fastest = 1.0 / 1450.0;

  explicit Listening(bool flat) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-0.8, 0.8);
    for (int i = 0; i < 5; ++i)
      phones.emplace_back(place(random), place(random), flat ? 0.0 : place(random));
  }
};

/// A line whose phones are their own image in its middle.
Listening uniform_line() {
  Listening line(true);
  line.phones.clear();
  for (int i = 0; i < 7; ++i) line.phones.emplace_back(0.1 * (i - 3), 0.05 * (i - 3), 0.0);
  line.frequencies = {1000.0};
  return line;
}

/// A circle's sound from an elevation, by the pair and its reciprocal.
Received received(double one_elevation, double other_elevation, std::complex<double> other) {
  const auto slowness = [](double elevation) {
    return Vec3(Listening::fastest * std::cos(elevation), 0.0,
                Listening::fastest * std::sin(elevation));
  };
  return {.delay = 1.0,
          .one = {0.7, 0.4},
          .other = other,
          .one_slowness = slowness(one_elevation),
          .other_slowness = slowness(other_elevation),
          .azimuthally_symmetric = true};
}

/// ⟨v v^H⟩ over so many bearings that the aliases, J_256 of at most 14, vanish.
Matrix over_bearings(const Listening& to, const Received& h) {
  const Steering steering(to.phones, to.frequencies);
  const auto n = static_cast<Eigen::Index>(steering.components());
  constexpr int bearings = 256;
  Matrix sum = Matrix::Zero(n, n);
  for (int i = 0; i < bearings; ++i) {
    const double angle = 2.0 * pi * i / bearings;
    const auto turned = [&](const Vec3& s) {
      return Vec3(s.x() * std::cos(angle), s.x() * std::sin(angle), s.z());
    };
    Eigen::VectorXcd v = Eigen::VectorXcd::Zero(n);
    steering.add(h.one, turned(h.one_slowness), v.data());
    steering.add(h.other, turned(h.other_slowness), v.data());
    sum += v * v.adjoint() / bearings;
  }
  return sum;
}

Matrix closed(const AzimuthallySymmetricArray& array, std::span<const Received> all) {
  AzimuthallySymmetricSum sum(array);
  for (const Received& h : all) sum.add(from_azimuthally_symmetric(h));
  const auto n = static_cast<Eigen::Index>(array.components());
  Matrix found = Matrix::Zero(n, n);
  sum.add_to({found.data(), static_cast<std::size_t>(found.size())});
  return found;
}

// One way, and two that are received together; phones in a plane, not, and in a uniform line. The
// table's 1.5e-8 and differences between components on a grid of 1e-6 rad, times powers of up
// to 2.5. Left out what is received by both, |2ab*J₀| = 1, it must fail.
TEST(AzimuthallySymmetricCovariance, IsTheMeanOverBearings) {
  for (const Listening& to : {Listening(true), Listening(false), uniform_line()}) {
    const AzimuthallySymmetricArray array(to.phones, to.frequencies, Listening::fastest);
    for (const std::complex<double> other :
         {std::complex<double>(0.0, 0.0), {0.5, 0.1}, {0.35, 0.2}}) {
      const std::vector<Received> all = {received(0.3, 0.5, other)};
      const Matrix expected = over_bearings(to, all[0]), found = closed(array, all);
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 5e-6) << to.phones.size() << other;
      EXPECT_NEAR(array.power(from_azimuthally_symmetric(all[0])),
                  expected.diagonal().real().mean(), 5e-6);
      Received alone = all[0];
      alone.one = std::sqrt(std::norm(alone.one) + std::norm(alone.other));
      alone.other = 0.0;
      const double missed = (closed(array, {&alone, 1}) - expected).cwiseAbs().maxCoeff();
      EXPECT_TRUE(other == 0.0 || missed > 0.05) << missed;
    }
  }
}

// What arrives nearly alike is one sound: 40 elevations over 4°, several such groups, within
// 4e-4 of their power and less of each other's ways together.
TEST(AzimuthallySymmetricCovariance, SoundsThatArriveAlikeAreOne) {
  const Listening to(false);
  const AzimuthallySymmetricArray array(to.phones, to.frequencies, Listening::fastest);
  std::vector<Received> all;
  const auto n = static_cast<Eigen::Index>(array.components());
  Matrix expected = Matrix::Zero(n, n);
  for (int i = 0; i < 40; ++i) {
    const double more = radians(0.1) * i;
    all.push_back(received(0.2 + more, 0.4 + 0.8 * more, {0.3, 0.01 * i}));
    expected += over_bearings(to, all.back());
  }
  const double power = expected.diagonal().real().mean();
  const double error = (closed(array, all) - expected).cwiseAbs().maxCoeff() / power;
  EXPECT_LT(error, 4e-4);
  EXPECT_GT(error, 1e-7);  // they were put together
}

// F F^H is the covariance but for a millionth of its trace, with fewer columns than components
// where few directions are received; real and complex ones.
TEST(SegmentCovariance, FactorGivesTheCovariance) {
  for (const bool flat : {true, false}) {
    const Listening to(flat);
    const Steering steering(to.phones, to.frequencies);
    const AzimuthallySymmetricArray array(to.phones, to.frequencies, Listening::fastest);
    SegmentSum sum(steering, array);
    const auto n = static_cast<Eigen::Index>(steering.components());
    Matrix expected = Matrix::Zero(n, n);
    Received circle = received(0.3, 0.5, {0.35, 0.2});
    expected += over_bearings(to, circle);
    sum.add(circle);
    if (!flat) {  // and one place
      Received place = received(0.9, 0.1, {0.3, 0.0});
      place.azimuthally_symmetric = false;
      Eigen::VectorXcd v = Eigen::VectorXcd::Zero(n);
      steering.add(place.one, place.one_slowness, v.data());
      steering.add(place.other, place.other_slowness, v.data());
      expected += v * v.adjoint();
      sum.add(place);
      EXPECT_NEAR(place.power, v.squaredNorm() / double(n), 1e-12);
    }
    expected /= expected.diagonal().real().mean();
    std::vector<std::complex<float>> columns;
    const std::size_t rank = sum.factor(columns);
    ASSERT_EQ(columns.size(), rank * steering.components());
    const Eigen::Map<const Eigen::MatrixXcf> f(columns.data(), n, Eigen::Index(rank));
    const Matrix found = f.cast<std::complex<double>>() * f.cast<std::complex<double>>().adjoint();
    // What is left is positive: no element is larger than its trace, 1e-6·n; 4e-7 of floats.
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * double(n) + 5e-6) << flat;
  }
}

TEST(SegmentCovariance, HasNoColumnsInSilence) {
  const Listening to(true);
  const Steering steering(to.phones, to.frequencies);
  const AzimuthallySymmetricArray array(to.phones, to.frequencies, Listening::fastest);
  SegmentSum sum(steering, array);
  std::vector<std::complex<float>> columns;
  EXPECT_EQ(sum.factor(columns), 0U);
  EXPECT_TRUE(columns.empty());
}

}  // namespace
}  // namespace asdic::detail
