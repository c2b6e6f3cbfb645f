#include "raytrace/layered/piece_splitter.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// With slope zero, and the sign of what follows.
HermiteNode as_extremum(HermiteNode node, bool rises) {
  node.slope = rises ? -1e-300 : 1e-300;
  return node;
}

}  // namespace

void PieceSplitter::split(const HermiteNode& a, const HermiteNode& b, bool caustic_a, int depth) {
  const bool steep = a.x > steep_sigma;
  const Hermite cubic = steep ? Hermite(in_cosine(a), in_cosine(b)) : Hermite(a, b);
  const auto turns = cubic.extrema();
  if (depth < 4 && !turns.empty()) {
    // A change of sign of the exact slope brackets an extremum; without one the cubic saw a
    // wiggle: look at its place and decide there.
    const HermiteNode middle = node(steep ? sine_of_cosine(turns.front()) : turns.front());
    if ((a.slope > 0.0) != (b.slope > 0.0) || (middle.slope > 0.0) != (a.slope > 0.0)) {
      const HermiteNode caustic =
          (middle.slope > 0.0) != (a.slope > 0.0) ? extremum(a, middle) : extremum(middle, b);
      emit(a, caustic, caustic_a, true);
      split(caustic, b, true, depth + 1);
      return;
    }
    split(a, middle, caustic_a, depth + 1);
    split(middle, b, false, depth + 1);
    return;
  }
  emit(a, b, caustic_a, false);
}

HermiteNode PieceSplitter::node(double sigma) const {
  const auto [range, slope] = table_.evaluate(interval_, branch_, sigma);
  return {sigma, range, slope};
}

/// Whether no wanted range lies between r there and the extremum, slope²/(2|r″|) away (held to be
/// eight times as far): then it serves as well.
bool PieceSplitter::near_enough(const HermiteNode& here, double curvature) const {
  if (ranges_.empty()) return false;
  const double away = 4.0 * here.slope * here.slope / curvature + 1e-3;
  const auto next = std::lower_bound(ranges_.begin(), ranges_.end(), here.value - away);
  return next == ranges_.end() || *next > here.value + away;
}

/// The zero of the exact slope between two nodes where it has different signs: secant steps
/// inside a shrinking bracket.
HermiteNode PieceSplitter::extremum(HermiteNode a, HermiteNode b) const {
  const bool rises = a.slope > 0.0;
  HermiteNode best = std::abs(a.slope) < std::abs(b.slope) ? a : b;
  for (int i = 0; i < 60; ++i) {
    // With curvature r″ the range there differs from the extremum by slope²/(2r″).
    const double curvature = std::abs((b.slope - a.slope) / (b.x - a.x));
    if (best.slope * best.slope < 2e-6 * curvature || b.x - a.x < 1e-14 * b.x ||
        (i > 0 && near_enough(best, curvature)))
      break;
    double x = a.x - a.slope * (b.x - a.x) / (b.slope - a.slope);
    if (i % 3 == 2 || !(x > a.x && x < b.x)) x = 0.5 * (a.x + b.x);
    best = node(x);
    ((best.slope > 0.0) == rises ? a : b) = best;
  }
  return as_extremum(best, rises);
}

void PieceSplitter::emit(const HermiteNode& a, const HermiteNode& b, bool caustic_a,
                         bool caustic_b) const {
  if (!(b.x > a.x) || !std::isfinite(a.value) || !std::isfinite(b.value)) return;
  visit_({.interval = &interval_,
          .cell = cell_,
          .branch = branch_,
          .sigma_begin = a.x,
          .sigma_end = b.x,
          .range_begin = a.value,
          .range_end = b.value,
          .slope_begin = a.slope,
          .slope_end = b.slope,
          .caustic_begin = caustic_a,
          .caustic_end = caustic_b});
}

}  // namespace asdic::detail
