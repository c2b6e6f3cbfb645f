#include "core/memory_budget.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>

namespace asdic::detail {
namespace {

namespace fs = std::filesystem;

/// The number that a file of a control group holds; none: "max", or no such file.
std::optional<double> number_in(const fs::path& file) {
  std::ifstream in(file);
  std::string text;
  if (!(in >> text)) return {};
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return static_cast<double>(value);
}

/// The least limit of a group and of those above it. A container may see its group as the root:
/// folders that are not there are passed over.
double least_of_groups(const fs::path& mount, const std::string& group,
                       std::initializer_list<const char*> files) {
  double least = HUGE_VAL;
  for (fs::path at = fs::path(group).relative_path();; at = at.parent_path()) {
    for (const char* file : files)
      if (const auto limit = number_in(mount / at / file)) least = std::min(least, *limit);
    if (at.empty()) return least;
  }
}

/// Lines of /proc/self/cgroup: "0::/user.slice" is version 2, "4:memory:/docker/1f" version 1.
double control_group_limit(const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  const fs::path mount = root / "sys/fs/cgroup";
  double least = HUGE_VAL;
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") {
      for (const fs::path& unified : {mount, mount / "unified"})
        least = std::min(least, least_of_groups(unified, group, {"memory.max", "memory.high"}));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, least_of_groups(mount / "memory", group, {"memory.limit_in_bytes"}));
    }
  }
  return least;
}

double resource_limit(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return HUGE_VAL;
  return limit.rlim_cur == RLIM_INFINITY ? HUGE_VAL : static_cast<double>(limit.rlim_cur);
}

}  // namespace

std::string bytes_text(double bytes) {
  constexpr std::array units = {"bytes", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < units.size()) {
    bytes /= 1000.0;
    ++unit;
  }
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f %s", unit == 0 ? 0 : 1, bytes, units[unit]);
  return text.data();
}

MemoryLimit memory_limit(const fs::path& root) {
  const std::array<MemoryLimit, 4> all{
      {{static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)),
        "the machine's memory"},
       {control_group_limit(root), "the control group's memory"},
       {resource_limit(RLIMIT_AS), "the address space (ulimit -v)"},
       {resource_limit(RLIMIT_DATA), "the data segment (ulimit -d)"}}};
  return *std::min_element(all.begin(), all.end(), [](const MemoryLimit& a, const MemoryLimit& b) {
    return a.bytes < b.bytes;
  });
}

MemoryBudget::MemoryBudget(int processes) {
  static const MemoryLimit limit = memory_limit();  // it does not change while a process runs
  const int parts = 2 * std::max(1, processes);
  bytes_ = limit.bytes / parts;
  origin_ =
      (parts == 2 ? "half of " : "one of " + std::to_string(parts) + " parts of ") + limit.source;
}

MemoryBudget MemoryBudget::of(double bytes) {
  MemoryBudget budget;
  if (bytes > 0.0) {
    budget.bytes_ = bytes;
    budget.origin_ = "as run.memory says";
  }
  return budget;
}

MemoryBudget MemoryBudget::without_key() {
  MemoryBudget budget;
  budget.has_key_ = false;
  return budget;
}

MemoryBudget MemoryBudget::share(double bytes, const std::string& origin) const {
  MemoryBudget part = *this;
  if (bytes < bytes_) {
    part.bytes_ = bytes;
    part.origin_ = origin;
  }
  part.taken_ = 0.0;
  part.needs_.clear();
  return part;
}

std::string MemoryBudget::text() const { return bytes_text(bytes_) + ", " + origin_; }

void MemoryBudget::take(MemoryNeed need) {
  taken_ += need.bytes;
  needs_.push_back(std::move(need));
  if (taken_ <= bytes_) return;
  const auto smaller = [](const MemoryNeed& a, const MemoryNeed& b) { return a.bytes < b.bytes; };
  const MemoryNeed& largest = *std::max_element(needs_.begin(), needs_.end(), smaller);
  const std::string all = needs_.size() == 1 ? "" : " (" + bytes_text(taken_) + " in all)";
  throw MemoryError(
      {.where = largest.where,
       .got = largest.what + ", which take " + bytes_text(largest.bytes) + " of memory" + all,
       .expected = "at most " + text() + ": " + largest.remedy +
                   (has_key_ ? ", or a larger run.memory" : "")},
      taken_);
}

}  // namespace asdic::detail
