#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "support/synthetic_study.h"

namespace asdic::detail::study {
namespace {

/// Memory that is in use [kB].
long resident() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == "VmRSS:") {
      long kilobytes = 0;
      file >> kilobytes;
      return kilobytes;
    }
  return 0;
}

// What carries rows holds a bounded number of them: between a tenth of the way and its end memory
// grows by less than 4 MB (SQLite's page cache of 2 MB may fill; 18 000 rows of 24 bytes each would
// by themselves be 0.4 MB, with their time series 36 MB). ASDIC_SOAK=100000: the long form.
TEST(Soak, MemoryIsFlatInTheNumberOfRealisations) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer keeps what was freed (its quarantine, 256 MB)";
#endif
  const char* asked = std::getenv("ASDIC_SOAK");
  const std::uint64_t count = asked != nullptr ? std::stoull(asked) : 20000;
  const support::TemporaryDirectory folder;
  const support::SyntheticStudy synthetic{.realisations = count};
  Work work = synthetic.work();
  long early = 0, late = 0;
  work.realise = [&](std::uint64_t index) {
    Row row = synthetic.row(index);
    row.pressure_shape = {1, 500};
    row.pressure.assign(500, static_cast<float>(index));  // 2 kB
    if (index == count / 10) early = resident();
    if (index == count - 1) late = resident();
    return row;
  };
  const StudyOutcome outcome = run_study(work, {.output = folder / "s.h5", .range = {0, count}});
  EXPECT_TRUE(outcome.complete);
  EXPECT_LT(late - early, 4000) << early << " kB, then " << late << " kB";
}

}  // namespace
}  // namespace asdic::detail::study
