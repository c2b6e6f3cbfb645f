#include "study/summary/until.h"

#include "core/error.h"
#include "study/sampling/design.h"

namespace asdic::detail::study {

bool is_look(std::uint64_t count) noexcept {
  if (count < 100) return false;
  while (count % 10 == 0) count /= 10;
  return count < 10;
}

OrderedEstimate::OrderedEstimate(RunningEstimate estimate, std::uint64_t first,
                                 std::optional<double> half_width)
    : estimate_(std::move(estimate)), first_(first), next_(first), half_width_(half_width) {}

void OrderedEstimate::take(const Row& row) {
  if (enough_) return;
  estimate_.add(row);
  if (!row.valid) ++skipped_;
  ++next_;
  if (!half_width_ || !is_look(next_ - first_)) return;
  const std::optional<Estimate> now = estimate_.estimate();
  if (now && 0.5 * (now->high - now->low) <= *half_width_) enough_ = next_ - first_;
}

void OrderedEstimate::add(Row row) {
  if (row.index < next_ || enough_) return;
  if (row.index > next_) {
    row.pressure = {};
    row.cells = {};
    waiting_.emplace(row.index, std::move(row));
    return;
  }
  take(row);
  while (!waiting_.empty() && waiting_.begin()->first == next_ && !enough_)
    take(waiting_.extract(waiting_.begin()).mapped());
  if (enough_) waiting_.clear();
}

void check_until(const Study& study) {
  if (study.design == Design::random || study.design == Design::sobol) return;
  throw InputError({.where = "--until",
                    .got = "design = \"" + std::string(name(study.design)) + "\"",
                    .expected =
                        "\"random\" or \"sobol\": the points of this one depend on how many "
                        "there are, so it cannot stop early"});
}

}  // namespace asdic::detail::study
