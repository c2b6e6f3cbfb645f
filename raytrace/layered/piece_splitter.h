#pragma once
#include <functional>
#include <span>

#include "raytrace/layered/branch_table.h"

namespace asdic::detail {

/// Splits the piece between two nodes wherever the cubic through their ranges and slopes says
/// that r has an extremum; the extrema themselves are found on the exact r.
class PieceSplitter {
 public:
  PieceSplitter(const BranchTable& table, const FanInterval& interval, const Branch& branch,
                std::span<const double> ranges,
                const std::function<void(const MonotonePiece&)>& visit)
      : table_(table), interval_(interval), branch_(branch), ranges_(ranges), visit_(visit) {}

  void split_cell(std::size_t cell, const HermiteNode& a, const HermiteNode& b) {
    cell_ = cell;
    split(a, b, false, 0);
  }

 private:
  void split(const HermiteNode& a, const HermiteNode& b, bool caustic_a, int depth);
  [[nodiscard]] HermiteNode node(double sigma) const;
  [[nodiscard]] bool near_enough(const HermiteNode& here, double curvature) const;
  [[nodiscard]] HermiteNode extremum(HermiteNode a, HermiteNode b) const;
  void emit(const HermiteNode& a, const HermiteNode& b, bool caustic_a, bool caustic_b) const;

  const BranchTable& table_;
  const FanInterval& interval_;
  Branch branch_;
  std::size_t cell_ = 0;
  std::span<const double> ranges_;
  const std::function<void(const MonotonePiece&)>& visit_;
};

}  // namespace asdic::detail
