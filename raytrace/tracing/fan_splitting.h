#pragma once
#include <algorithm>
#include <deque>
#include <iterator>
#include <memory>
#include <vector>

#include "raytrace/tracing/parallel.h"

namespace asdic {

/// A fan that is split until neighbours tell what lies between them, in parallel, with the same
/// result for any number of threads.
///
/// Work is one thread's memory and method. It names Ray (what is kept of a ray; `angle` is its
/// launch elevation) and Result, and has
///   void trace(double angle, Ray& out);
///   bool holds(const Ray& a, const Ray& m, const Ray& b);  m between a and b: is a–b known well?
///   void search(const Ray& a, const Ray& b, std::vector<Result>& out);  a–b is known: take it
template <class Work>
class FanSplitting {
 public:
  using Ray = typename Work::Ray;
  using Result = typename Work::Result;
  static constexpr int first_intervals = 256;

  FanSplitting(double lowest, double highest) : lowest_(lowest), highest_(highest) {}

  /// \param make_work  called once a thread \return results by increasing launch elevation
  template <class MakeWork>
  [[nodiscard]] std::vector<Result> run(const MakeWork& make_work) const {
    struct Memory {
      Work work;
      std::deque<Ray> rays;  // two ends, then the middle of each depth of splitting
    };
    std::vector<std::unique_ptr<Memory>> memories(tracing::most_workers());
    std::vector<std::vector<Result>> results(first_intervals);
    tracing::parallel(first_intervals, [&](std::size_t worker, int i) {
      if (!memories[worker]) {
        memories[worker] = std::make_unique<Memory>(Memory{make_work(), {}});
        memories[worker]->rays.resize(2);
      }
      Memory& memory = *memories[worker];
      Ray &a = memory.rays[0], &b = memory.rays[1];
      memory.work.trace(first_angle(i), a);
      memory.work.trace(first_angle(i + 1), b);
      split(memory.work, memory.rays, a, b, 2, results[static_cast<std::size_t>(i)]);
    });
    std::vector<Result> all;
    for (auto& some : results)
      all.insert(all.end(), std::make_move_iterator(some.begin()),
                 std::make_move_iterator(some.end()));
    return all;
  }

 private:
  static constexpr std::size_t deepest = 60;

  /// Twice denser about the middle of the fan, mostly the horizontal, where rays are bent most.
  [[nodiscard]] double first_angle(int i) const {
    if (i == 0 || i == first_intervals) return i == 0 ? lowest_ : highest_;
    const double v = 2.0 * i / first_intervals - 1.0;  // −1..1
    return lowest_ + 0.5 * (highest_ - lowest_) * (1.0 + v * (0.5 + 0.5 * v * v));
  }

  static void split(Work& work, std::deque<Ray>& rays, const Ray& a, const Ray& b, std::size_t slot,
                    std::vector<Result>& out) {
    const double middle = 0.5 * (a.angle + b.angle);
    if (!(middle > a.angle && middle < b.angle)) return work.search(a, b, out);
    if (rays.size() <= slot) rays.emplace_back();  // a deque: references stay
    Ray& m = rays[slot];
    work.trace(middle, m);
    if (slot < deepest && !work.holds(a, m, b)) {
      split(work, rays, a, m, slot + 1, out);
      split(work, rays, m, b, slot + 1, out);
    } else {
      work.search(a, m, out);
      work.search(m, b, out);
    }
  }

  double lowest_, highest_;
};

}  // namespace asdic
