#pragma once
#include <algorithm>
#include <atomic>
#include <deque>
#include <iterator>
#include <memory>
#include <vector>

#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/tracing/search_watch.h"

namespace asdic::detail {

/// A fan that is split until neighbours tell what lies between them, in parallel, with the same
/// result for any number of threads.
///
/// Work is one thread's memory and method. It names Ray (what is kept of a ray; `angle` is its
/// launch elevation) and Result, and has
///   void trace(double angle, Ray& out);
///   bool holds(const Ray& a, const Ray& m, const Ray& b);  m between a and b: is a–b known well?
///   double middle(const Ray& a, const Ray& b);  where to split a–b
///   void search(const Ray& a, const Ray& b, std::vector<Result>& out);  a–b is known: take it
///   std::size_t coarse_levels;  the fan begins with 256/2ⁿ intervals; if that is not none, as well
///   bool regular(const Ray& a, const Ray& m, const Ray& b);  may a–b be wider than 1/256?
///   bool pair_tells(const Ray& a, const Ray& b);  is a–b known without a ray between?
/// and may have
///   SearchCost cost();  of all its rays
template <class Work>
class FanSplitting {
 public:
  using Ray = typename Work::Ray;
  using Result = typename Work::Result;
  static constexpr int first_intervals = 256 >> Work::coarse_levels;

  FanSplitting(double lowest, double highest) : lowest_(lowest), highest_(highest) {}

  /// \param make_work  called once a thread   \param watch  see SearchWatch
  /// \return results by increasing launch elevation; too few when it was stopped
  template <class MakeWork>
  [[nodiscard]] std::vector<Result> run(const MakeWork& make_work,
                                        SearchWatch* watch = nullptr) const {
    struct Memory {
      Work work;
      std::deque<Ray> rays;  // the middle of each depth of splitting
    };
    std::vector<std::unique_ptr<Memory>> memories(most_workers());
    const auto memory_of = [&](std::size_t worker) -> Memory& {
      if (!memories[worker]) memories[worker] = std::make_unique<Memory>(Memory{make_work(), {}});
      return *memories[worker];
    };
    std::vector<Ray> ends(first_intervals + 1);  // each serves the intervals on both sides
    in_parallel_by_worker(first_intervals + 1, [&](std::size_t worker, std::size_t i) {
      memory_of(worker).work.trace(first_angle(static_cast<int>(i)), ends[i]);
    });
    std::vector<std::vector<Result>> results(first_intervals);
    std::vector<int> left(first_intervals, most_rays);
    std::atomic<int> done = 0;
    std::atomic<bool> stopped = false;
    in_parallel_by_worker(first_intervals, [&](std::size_t worker, std::size_t slot) {
      if (stopped) return;
      Memory& memory = memory_of(worker);
      const auto stop = [&] {  // asked now and then within an interval too, which may take long
        stop_point();
        if (watch != nullptr && watch->progress &&
            !watch->progress(double(done.load()) / first_intervals))
          stopped = true;
        return stopped.load();
      };
      split(memory.work, memory.rays, ends[slot], ends[slot + 1], 0, left[slot], results[slot],
            stop);
      ++done;
      stop();
    });
    if (watch != nullptr) {
      watch->stopped = stopped;
      watch->intervals = first_intervals;
      watch->unfinished = static_cast<int>(
          std::count_if(left.begin(), left.end(), [](int rays) { return rays <= 0; }));
      if constexpr (requires(const Work& work) { work.cost(); })
        for (const auto& memory : memories)
          if (memory) watch->cost += memory->work.cost();
    }
    std::vector<Result> all;
    for (auto& some : results)
      all.insert(all.end(), std::make_move_iterator(some.begin()),
                 std::make_move_iterator(some.end()));
    return all;
  }

 private:
  static constexpr std::size_t deepest = 58;
  static constexpr double least_middle = 0.35;  // how far from the even middle a ray may lie
  static constexpr int rays_per_question = 32;
  static constexpr int most_rays = (1 << 22) / first_intervals;  // in one of the first intervals

  /// Twice denser about the middle of the fan, mostly the horizontal, where rays are bent most.
  [[nodiscard]] double first_angle(int i) const {
    if (i == 0 || i == first_intervals) return i == 0 ? lowest_ : highest_;
    const double v = 2.0 * i / first_intervals - 1.0;  // −1..1
    return lowest_ + 0.5 * (highest_ - lowest_) * (1.0 + v * (0.5 + 0.5 * v * v));
  }

  [[nodiscard]] static bool known(const Work& work, const Ray& a, const Ray& m, const Ray& b,
                                  std::size_t slot) {
    if (!work.holds(a, m, b)) return false;
    if constexpr (Work::coarse_levels > 0)
      if (slot < Work::coarse_levels) return work.regular(a, m, b);
    return true;
  }

  /// \param left  rays that may still be traced   \param stop  asked every so many rays
  template <class Stop>
  static void split(Work& work, std::deque<Ray>& rays, const Ray& a, const Ray& b, std::size_t slot,
                    int& left, std::vector<Result>& out, const Stop& stop) {
    if (left % rays_per_question == 0 && stop()) return;
    if constexpr (Work::coarse_levels > 0)
      if (slot >= Work::coarse_levels && work.pair_tells(a, b)) return work.search(a, b, out);
    double middle = slot % 4 == 2 ? 0.5 * (a.angle + b.angle) : work.middle(a, b);
    if (!(middle > a.angle && middle < b.angle)) middle = 0.5 * (a.angle + b.angle);
    if (!(middle > a.angle && middle < b.angle)) return work.search(a, b, out);
    if (rays.size() <= slot) rays.emplace_back();  // a deque: references stay
    Ray& m = rays[slot];
    work.trace(middle, m);
    bool told = --left <= 0 || slot >= deepest || known(work, a, m, b, slot);
    // one beside an end tells nothing of what lies between
    if (const double even = 0.5 * (a.angle + b.angle);
        told && left > 0 && slot < deepest &&
        std::abs(middle - even) > least_middle * (b.angle - a.angle)) {
      work.trace(even, m);
      told = --left <= 0 || known(work, a, m, b, slot);
    }
    if (!told) {
      split(work, rays, a, m, slot + 1, left, out, stop);
      split(work, rays, m, b, slot + 1, left, out, stop);
    } else {
      work.search(a, m, out);
      work.search(m, b, out);
    }
  }

  double lowest_, highest_;
};

}  // namespace asdic::detail
