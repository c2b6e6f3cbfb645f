#include "study/pilot/process_memory.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace asdic::detail::study {
namespace {

/// Of /proc/self/status: "VmRSS", "VmHWM" [bytes].
double told_by_system(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ':')) return 1024.0 * std::stod(line.substr(key.size() + 1));
  return std::nan("");
}

}  // namespace

double resident_bytes() { return told_by_system("VmRSS"); }

double taken_by(const std::function<void()>& work) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5\n" << std::flush;  // the peak begins anew
  const double before = resident_bytes(), began = told_by_system("VmHWM");
  work();
  const double peak = told_by_system("VmHWM");
  // Where the peak could not be begun anew, an earlier one may be all that is seen.
  if (!(began < before + 16e6) && peak <= began) return std::nan("");
  return std::max(0.0, peak - before);
}

}  // namespace asdic::detail::study
