#include "reverb/pairs/path_groups.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numeric>

#include "raytrace/parallel/stop.h"

namespace asdic::detail {
namespace {

/// A group of the cell in hand, as bundles see it.
struct Candidate {
  PathGroup group;
  double delay = 0.0, launch_elevation = 0.0, downward = 0.0;  // of its strongest path
  std::complex<double> amplitude = 0.0;                        // of all, with the phase of that
  double power = 0.0;                                          // by which it is chosen
};

/// Least and greatest of what tells the paths of a group apart.
struct Spread {
  double low = 0.0, high = 0.0;

  [[nodiscard]] double with(double x) const noexcept {
    return std::max(high, x) - std::min(low, x);
  }
  void take(double x) noexcept {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// The box of slownesses of a group that still grows.
struct Growing {
  double first_delay = 0.0;
  Spread level, launch_level, launch_down, down;
  std::uint32_t first_path = 0, count = 0;
};

/// Whether two groups come within a period of each other, the same way: their waves add up at once.
bool come_together(const Candidate& a, const Candidate& b, double frequency) {
  return a.downward == b.downward && std::abs(a.delay - b.delay) * frequency < 1.0;
}

/// Of groups that come together: one went up first and was reflected, as from a source close to the
/// surface and its image. They interfere in the same way wherever a scatterer lies. The pair of a
/// caustic, a quarter of a turn apart, does not: over its range it has the energy of both.
bool are_images(const Candidate& a, const Candidate& b) {
  const std::complex<double> against = a.amplitude * std::conj(b.amplitude);
  return (a.launch_elevation > 0.0) != (b.launch_elevation > 0.0) &&
         against.real() < -std::abs(against.imag());
}

/// The power of two groups together over the sum of their powers.
double together(const Candidate& a, const Candidate& b, double frequency) {
  const double apart = std::norm(a.amplitude) + std::norm(b.amplitude);
  const std::complex<double> turned =
      b.amplitude * std::polar(1.0, -2.0 * pi * frequency * (b.delay - a.delay));
  return apart > 0.0 ? std::norm(a.amplitude + turned) / apart : 1.0;
}

/// Of groups in the order of their delays: whether each comes together with the one before it.
std::vector<bool> second_of_two(std::span<const Candidate> groups, double frequency) {
  std::vector<bool> second(groups.size(), false);
  for (std::size_t i = 1; i < groups.size(); ++i)
    second[i] = !second[i - 1] && come_together(groups[i - 1], groups[i], frequency);
  return second;
}

/// Each of two images has its share of what both are together. \return  the powers then
std::vector<double> powers(std::span<const Candidate> groups, const std::vector<bool>& second,
                           double frequency) {
  std::vector<double> power;
  power.reserve(groups.size());
  for (const Candidate& g : groups) power.push_back(g.power);
  for (std::size_t i = 1; i < groups.size(); ++i)
    if (second[i] && are_images(groups[i - 1], groups[i])) {
      const double share = together(groups[i - 1], groups[i], frequency);
      power[i - 1] *= share;
      power[i] *= share;
    }
  return power;
}

/// Which groups are followed by themselves: those of a power, so many at most, if they hold enough.
struct Strong {
  double least, enough;  // of the power of all
  std::size_t most;
};
/// Where a few groups hold all but a hundredth, as far away over a bottom that loses, they may all
/// but cancel, and a thousandth more is received; where many are as strong, they are worth a sum of
/// energies.
constexpr Strong all_but_a_little{.least = 1e-3, .enough = 0.99, .most = 12},
    the_strongest{.least = 1.0 / 16.0, .enough = 0.75, .most = 8};

/// Puts the strong ones first, and with one the other of two that come together; none if they hold
/// too little. \return  how many
std::size_t strong_first(std::vector<Candidate>& groups, std::span<const double> power,
                         const std::vector<bool>& second, const Strong& strong) {
  const double all = std::accumulate(power.begin(), power.end(), 0.0);
  std::vector<double> largest(power.begin(), power.end());
  std::nth_element(largest.begin(), largest.begin() + std::ptrdiff_t(strong.most), largest.end(),
                   std::greater<>());
  const double least = std::max(strong.least * all, largest[strong.most]);
  const auto is_strong = [&](std::size_t i) { return power[i] > least; };
  std::vector<Candidate> strong_ones, others;
  double held = 0.0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const bool with_next = i + 1 < groups.size() && second[i + 1] && is_strong(i + 1);
    const bool with_last = second[i] && is_strong(i - 1);
    const bool first = is_strong(i) || with_next || with_last;
    (first ? strong_ones : others).push_back(groups[i]);
    held += first ? power[i] : 0.0;
  }
  if (held < strong.enough * all) return 0;
  const std::size_t count = strong_ones.size();
  groups = std::move(strong_ones);
  std::move(others.begin(), others.end(), std::back_inserter(groups));
  return count;
}

/// A bundle of some groups, which are told their shares.
PathBundle bundle_of(std::span<Candidate> groups, std::span<const double> power,
                     std::uint32_t first) {
  const PathBundle bundle{.first = first, .count = static_cast<std::uint32_t>(groups.size())};
  const double all = std::accumulate(power.begin(), power.end(), 0.0);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    PathGroup& group = groups[i].group;
    group.share =
        all > 0.0 ? static_cast<float>(power[i] / all) : 1.0F / static_cast<float>(groups.size());
    group.gain =
        groups[i].power > 0.0 ? static_cast<float>(std::sqrt(power[i] / groups[i].power)) : 0.0F;
  }
  return bundle;
}

/// Bundles of very many groups: of one those that are strong, whose sounds interfere as they do;
/// behind them, of equal numbers that follow each other in delay, all others.
void add_bundles(std::vector<Candidate>& groups, double frequency,
                 std::vector<PathBundle>& bundles) {
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Candidate& a, const Candidate& b) { return a.delay < b.delay; });
  std::size_t alone = 0;
  {
    const std::vector<bool> together = second_of_two(groups, frequency);
    const std::vector<double> power = powers(groups, together, frequency);
    for (const Strong& strong : {all_but_a_little, the_strongest})
      if (alone == 0) alone = strong_first(groups, power, together, strong);
  }
  for (std::uint32_t i = 0; i < alone; ++i) bundles.push_back({.first = i, .count = 1});
  const std::span<Candidate> others = std::span(groups).subspan(alone);
  const std::vector<bool> second = second_of_two(others, frequency);
  const std::vector<double> power = powers(others, second, frequency);
  constexpr std::size_t many = GroupedPaths::most_bundles;
  const std::size_t most = many - std::min(many / 2, alone);
  // One of two that come together stands for both: out of two bundles, both would be received.
  const auto border = [&](std::size_t i) {
    const std::size_t even = i * others.size() / most;
    return even < others.size() && second[even] ? even + 1 : even;
  };
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t begin = border(i), count = border(i + 1) - begin;
    if (count > 0)
      bundles.push_back(bundle_of(others.subspan(begin, count),
                                  std::span(power).subspan(begin, count),
                                  static_cast<std::uint32_t>(alone + begin)));
  }
}

}  // namespace

PathResolution PathResolution::finer(const PathResolution& other) const noexcept {
  return {.delay = std::min(delay, other.delay),
          .level = std::max(level, other.level),
          .level_of_range = std::max(level_of_range, other.level_of_range),
          .depth = std::max(depth, other.depth),
          .thickness = std::max(thickness, other.thickness)};
}

/// Puts the paths of one cell after the other into groups; its memory is used again.
class GroupedPaths::Sorter {
 public:
  Sorter(const FanPlane& plane, const PathResolution& resolution, double frequency)
      : plane_(plane), resolution_(resolution), frequency_(frequency) {}

  /// As alike as few groups ask for, and no more than is not resolved. In the order of their first
  /// paths, `first` counted from the cell's first member.
  std::vector<Candidate>& groups(std::size_t cell) {
    const BoundaryPaths& all = *plane_.paths;
    paths_ = all.paths(cell);
    ends_ = plane_.ends.data() + (paths_.data() - all.all().data());
    level_ = resolution_.level + resolution_.level_of_range * all.range(cell);
    order_.resize(paths_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return paths_[a].delay != paths_[b].delay ? paths_[a].delay < paths_[b].delay : a < b;
    });
    group_of_.resize(paths_.size());
    for (const double share : {0.0, 0.125, 0.25, 0.5, 1.0}) {
      grow(share);
      if (growing_.size() <= few || !(resolution_.delay > 0.0)) break;
    }
    gather();
    return found_;
  }
  /// Of the groups found last, one after the other: paths of the cell, in their order.
  [[nodiscard]] std::span<const std::uint32_t> members(const PathGroup& group) const {
    return std::span(members_).subspan(group.first, group.count);
  }

 private:
  /// \param share  of what is not resolved
  void grow(double share) {
    growing_.clear();
    std::size_t open = 0;  // those before it began too early
    for (const std::uint32_t i : order_) {
      while (open < growing_.size() &&
             paths_[i].delay - growing_[open].first_delay > share * resolution_.delay)
        ++open;
      std::size_t g = growing_.size();
      while (g > open && !(share > 0.0 && fits(growing_[g - 1], i, share))) --g;
      if (g > open) {
        add(growing_[--g], i);
      } else {
        g = growing_.size();
        growing_.push_back(begun_with(i));
      }
      group_of_[i] = static_cast<std::uint32_t>(g);
    }
  }

  /// What has grown, in the order of first paths.
  void gather() {
    number_.resize(growing_.size());
    std::iota(number_.begin(), number_.end(), 0U);
    std::sort(number_.begin(), number_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return growing_[a].first_path < growing_[b].first_path;
    });
    found_.assign(growing_.size(), {});
    std::vector<std::uint32_t>& place = next_;  // of a growing group among those found
    place.resize(growing_.size());
    std::uint32_t first = 0;
    for (std::uint32_t n = 0; n < number_.size(); ++n) {
      place[number_[n]] = n;
      found_[n].group = {.first = first, .count = 0};
      first += growing_[number_[n]].count;
    }
    members_.resize(paths_.size());
    for (std::uint32_t i = 0; i < paths_.size(); ++i) {
      PathGroup& group = found_[place[group_of_[i]]].group;
      members_[group.first + group.count++] = i;
    }
    for (Candidate& candidate : found_) sum_up(candidate);
  }

  [[nodiscard]] Growing begun_with(std::uint32_t i) const {
    const BoundaryPath& path = paths_[i];
    const PathEnds& ends = ends_[i];
    const auto point = [](double x) { return Spread{x, x}; };
    return {.first_delay = path.delay,
            .level = point(path.horizontal_slowness),
            .launch_level = point(ends.launch_level),
            .launch_down = point(ends.launch_down),
            .down = point(ends.down),
            .first_path = i,
            .count = 1};
  }

  /// Whether all phases stay within a share of half a radian of each other.
  [[nodiscard]] bool fits(const Growing& g, std::uint32_t i, double share) const {
    constexpr double alike = 0.5;  // [rad]
    const BoundaryPath& path = paths_[i];
    const PathEnds& ends = ends_[i];
    const double level =
        std::max(g.level.with(path.horizontal_slowness), g.launch_level.with(ends.launch_level));
    return 2.0 * pi * frequency_ *
               (level_ * level + resolution_.depth * g.launch_down.with(ends.launch_down) +
                resolution_.thickness * g.down.with(ends.down)) <=
           share * alike;
  }

  void add(Growing& g, std::uint32_t i) const {
    g.level.take(paths_[i].horizontal_slowness);
    g.launch_level.take(ends_[i].launch_level);
    g.launch_down.take(ends_[i].launch_down);
    g.down.take(ends_[i].down);
    g.first_path = std::min(g.first_path, i);
    ++g.count;
  }

  void sum_up(Candidate& candidate) const {
    const std::span<const std::uint32_t> of_it = members(candidate.group);
    std::uint32_t strongest = of_it.front();
    double apart = 0.0;
    for (const std::uint32_t i : of_it) {
      const double power = std::norm(paths_[i].amplitude);
      apart += power;
      if (power > std::norm(paths_[strongest].amplitude)) strongest = i;
    }
    const BoundaryPath& first = paths_[strongest];
    candidate.group.strongest = strongest;
    candidate.delay = first.delay;
    candidate.launch_elevation = first.launch_elevation;
    candidate.downward = first.downward;
    candidate.amplitude = 0.0;
    for (const std::uint32_t i : of_it)
      candidate.amplitude +=
          i == strongest
              ? first.amplitude
              : paths_[i].amplitude *
                    std::polar(1.0, -2.0 * pi * frequency_ * (paths_[i].delay - first.delay));
    // Elsewhere in the cell it may not be in a null.
    constexpr double least = 0.1;
    candidate.power = std::max(std::norm(candidate.amplitude), least * apart);
  }

  const FanPlane& plane_;
  PathResolution resolution_;
  double frequency_, level_ = 0.0;
  std::span<const BoundaryPath> paths_;
  const PathEnds* ends_ = nullptr;
  std::vector<Growing> growing_;
  std::vector<std::uint32_t> order_, group_of_, number_, next_, members_;
  std::vector<Candidate> found_;
};

DrawnGroup draw(const PathBundle& bundle, std::span<const PathGroup> groups,
                double uniform) noexcept {
  constexpr double evenly = 0.1;
  const double even = evenly / bundle.count;
  const auto chance = [&](std::uint32_t i) {
    return (1.0 - evenly) * double(groups[i].share) + even;
  };
  std::uint32_t i = bundle.first;
  for (double sum = chance(i); sum < uniform && i + 1 < bundle.first + bundle.count;)
    sum += chance(++i);
  return {.group = i, .gain = double(groups[i].gain) / std::sqrt(chance(i))};
}

GroupedPaths::GroupedPaths(const FanPlane& plane, const PathResolution& resolution,
                           double frequency) {
  const BoundaryPaths& all = *plane.paths;
  Sorter sorter(plane, resolution, frequency);
  first_.assign(all.cells() + 1, 0);
  members_.reserve(all.size());
  std::vector<std::uint32_t> bundles_before(all.cells() + 1, 0);
  for (std::size_t cell = 0; cell < all.cells(); ++cell) {
    const auto before = static_cast<std::uint32_t>(members_.size());
    const auto count = static_cast<std::uint32_t>(all.paths(cell).size());
    if (count <= few) {  // each by itself
      for (std::uint32_t i = 0; i < count; ++i) {
        groups_.push_back({.first = before + i, .count = 1, .strongest = i});
        members_.push_back(i);
      }
    } else {
      stop_point();
      std::vector<Candidate>& found = sorter.groups(cell);
      if (found.size() > bundled_above) add_bundles(found, frequency, bundles_);
      for (Candidate& candidate : found) {
        const std::span<const std::uint32_t> members = sorter.members(candidate.group);
        candidate.group.first = static_cast<std::uint32_t>(members_.size());
        groups_.push_back(candidate.group);
        members_.insert(members_.end(), members.begin(), members.end());
      }
    }
    first_[cell + 1] = static_cast<std::uint32_t>(groups_.size());
    bundles_before[cell + 1] = static_cast<std::uint32_t>(bundles_.size());
  }
  if (!bundles_.empty()) first_bundle_ = std::move(bundles_before);
}

std::size_t GroupedPaths::bytes() const noexcept {
  return groups_.capacity() * sizeof(PathGroup) + bundles_.capacity() * sizeof(PathBundle) +
         (members_.capacity() + first_.size() + first_bundle_.size()) * sizeof(std::uint32_t);
}

FanGroups::FanGroups(const BoundaryFan& fan, const PathResolution& alike, double frequency)
    : resolution(alike) {
  planes.reserve(fan.planes.size());
  for (const FanPlane& plane : fan.planes) planes.emplace_back(plane, alike, frequency);
}

std::shared_ptr<const FanGroups> FanGroups::of(const BoundaryFan& fan, const PathResolution& alike,
                                               double frequency, PropagationMemory& memory) {
  ExactKey key(Kept::path_groups, 0);
  key.add_all(fan.identity, frequency, alike.delay, alike.level, alike.level_of_range, alike.depth,
              alike.thickness);
  return memory.remember(
      key, [&] { return std::make_shared<FanGroups>(fan, alike, frequency); },
      [](const FanGroups& groups) { return groups.bytes(); });
}

bool FanGroups::bundled() const noexcept {
  return std::any_of(planes.begin(), planes.end(),
                     [](const GroupedPaths& plane) { return plane.bundled(); });
}

bool FanGroups::added() const noexcept {
  return std::any_of(planes.begin(), planes.end(),
                     [](const GroupedPaths& plane) { return plane.added(); });
}

std::size_t FanGroups::bytes() const noexcept {
  std::size_t bytes = sizeof(FanGroups);
  for (const GroupedPaths& plane : planes) bytes += sizeof(GroupedPaths) + plane.bytes();
  return bytes;
}

}  // namespace asdic::detail
