#include "study/placement/placement_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/random.h"
#include "core/text.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "processing/coverage/coverage.h"
#include "processing/detection_threshold.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"
#include "sonar/ping/ping.h"
#include "study/measures/sampler.h"

namespace asdic::detail::study {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// Probability of detection over signal excess, in steps so small that it is straight between them.
class DetectionCurve {
 public:
  DetectionCurve(const CoverageSettings& settings, double threshold_db) {
    const double shape = fluctuation_shape(settings.fluctuation);
    values_.resize(static_cast<std::size_t>((high - low) / step) + 2);
    in_parallel(values_.size(), [&](std::size_t i) {
      values_[i] =
          detection_probability(power_from_db(low + double(i) * step + threshold_db),
                                settings.false_alarm_probability, settings.reference_cells, shape);
    });
  }
  [[nodiscard]] double operator()(double excess_db) const noexcept {
    const double at = (std::clamp(excess_db, low, high) - low) / step;
    const auto i = std::min(static_cast<std::size_t>(at), values_.size() - 2);
    return std::lerp(values_[i], values_[i + 1], at - double(i));
  }

 private:
  static constexpr double low = -50.0, high = 50.0, step = 0.1;  // [dB]
  std::vector<double> values_;
};

/// A scenario as it was drawn, with what its maps are of.
struct DrawnOption {
  Scenario scenario;
  CoverageSettings settings;
  bool varies = false;  ///< from place to place
};

/// What one array sees of one transmitter's pings, from wherever they are.
struct SensorMap {
  Coverage found;
  Vec2 offset = Vec2::Zero();  ///< of its middle, the array, from where the receiver is put [m]
  std::shared_ptr<const DetectionCurve> curve;
};

/// The cell of a map in which a place lies; none beyond its reach. \param off  from the array [m]
std::optional<std::size_t> cell_at(const Coverage& map, const Vec2& off) {
  const auto i = static_cast<std::size_t>(off.norm() / (2.0 * map.ranges.front()));
  if (i >= map.ranges.size()) return std::nullopt;
  double turn = std::atan2(off.x(), off.y()) / (2.0 * pi);
  turn -= std::floor(turn);
  const auto j = static_cast<std::size_t>(turn * double(map.bearings.size()));
  return std::min(j, map.bearings.size() - 1) * map.ranges.size() + i;
}

void move_by(Track& track, const Vec3& step) {
  track.start.position += step;
  for (Waypoint& one : track.waypoints) one.position += step;
}

/// All of a scenario's platforms, so that the first one starts at a place.
void move_to(Scenario& scenario, const Vec2& place) {
  const Vec3 start = scenario.platforms.front().track.at(0.0).position;
  const Vec3 step(place.x() - start.x(), place.y() - start.y(), 0.0);
  for (Platform& platform : scenario.platforms) move_by(platform.track, step);
}

class Placing {
 public:
  Placing(const PlacementPlan& plan, const Progress& progress)
      : plan_(plan), progress_(progress), budget_(budget_of_all(plan)) {}

  Placement run() {
    begin();
    PlacementProblem& problem = made_.problem;
    std::optional<Sampler> sampler;
    if (!plan_.inputs.variables.empty()) sampler.emplace(plan_.inputs);
    const std::size_t maps = count() * (problem.pairs ? count() : 1);
    // Maps with a flag for each cell that a ray reaches, and the numbers that the search keeps of a
    // set.
    const double numbers = double(std::max(plan_.draws, plan_.judging)) * double(size());
    const double sets = problem.pairs ? double(most_workers()) + 1.0 : 1.0;
    budget_.take(
        {.where = "placement.draws",
         .what = std::to_string(maps) + " maps in " + std::to_string(plan_.draws) + " draws",
         .bytes = double(maps) * (4.0 * double(plan_.draws) + 1.0) * double(size()) +
                  8.0 * numbers * (sets * double(plan_.at_least) + 2.0),
         .remedy = "fewer places, cells or draws"});
    problem.maps.assign(maps, {});  // each is made with its first draw
    std::vector<std::size_t> all(count());
    for (std::size_t c = 0; c < all.size(); ++c) all[c] = c;
    to_do_ = double(maps * plan_.draws);
    make_draws(sampler, 0, plan_.draws, all);
    made_.choice = choose_sensors(problem, plan_.search, [&](double) { return tell(0.0); });
    see_alone();
    if (plan_.judging > 0) {
      std::set<std::size_t> wanted(made_.choice.best.begin(), made_.choice.best.end());
      wanted.insert(made_.choice.runner_up.begin(), made_.choice.runner_up.end());
      const std::vector<std::size_t> chosen(wanted.begin(), wanted.end());
      problem.maps.assign(maps, {});
      problem.draws = plan_.judging;
      make_draws(sampler, plan_.draws, plan_.judging, chosen);
    }
    judge();
    problem.maps.clear();
    made_.warnings = plan_.warnings;
    made_.warnings.insert(made_.warnings.end(), warnings_.begin(), warnings_.end());
    for (const auto& [kind, told] : of_maps_)
      made_.warnings.push_back(told.first + (told.second > 0 ? " (one map; others alike)" : ""));
    warn_of_answer();
    return std::move(made_);
  }

 private:
  /// Budget of the option whose run.memory is the least.
  static MemoryBudget budget_of_all(const PlacementPlan& plan) {
    MemoryBudget least = budget_of(plan.options.front().scenario);
    for (const PlacementOption& option : plan.options)
      if (MemoryBudget own = budget_of(option.scenario); own.bytes() < least.bytes())
        least = std::move(own);
    return least;
  }
  [[nodiscard]] std::size_t count() const { return made_.problem.candidates.size(); }
  [[nodiscard]] std::size_t size() const { return made_.problem.weight.size(); }
  [[nodiscard]] const Vec2& place_of(std::size_t candidate) const {
    return plan_.places[made_.problem.candidates[candidate].place];
  }
  bool tell(double maps) {
    done_ += maps;
    return !progress_ || progress_(0.98 * std::min(1.0, done_ / std::max(1.0, to_do_)));
  }

  /// An option's scenario, with what a draw puts into it.
  [[nodiscard]] DrawnOption drawn(std::size_t option, const Sampler* sampler,
                                  std::size_t index) const {
    const PlacementOption& of = plan_.options[option];
    TomlValue tree = of.scenario;
    DrawnOption made;
    try {
      if (sampler == nullptr) {
        made.scenario = scenario_of(tree, of.path);
      } else {
        const Sampler::Drawn values = sampler->draw(index);
        try {
          sampler->apply(values, tree);
          made.scenario = scenario_of(tree, of.path);
        } catch (const InputError& error) {
          throw told(error, of.path, index, sampler->describe(values));
        }
      }
    } catch (const InputError& error) {
      if (plan_.options.size() == 1) throw;
      throw InputError({.where = "option " + in_quotes(of.name) + ": " + error.fault().where,
                        .got = error.fault().got,
                        .expected = error.fault().expected});
    }
    AreaWishes wishes = plan_.wishes;
    wishes.depths = plan_.depths;
    wishes.transmitter = of.transmitter;
    wishes.array = of.array;
    made.settings = coverage_settings(made.scenario, wishes);
    if (!wishes.reach) made.settings.reach = std::min(made.settings.reach, farthest_);
    made.varies = made.scenario.area != nullptr || ocean_on_map(made.scenario).varies();
    made.scenario.targets.clear();
    made.scenario.interferers.clear();
    return made;
  }

  /// Places, candidates, cells.
  void begin() {
    for (const Vec2& place : plan_.places)
      for (const Vec2& cell : plan_.cells)
        farthest_ = std::max(farthest_, 1.02 * (place - cell).norm());
    farthest_ = std::max(farthest_, 1e3);
    PlacementProblem& problem = made_.problem;
    made_.refused.assign(plan_.places.size(), PlaceRefused::too_shallow);
    std::vector<DrawnOption> options;
    for (std::size_t o = 0; o < plan_.options.size(); ++o) {
      options.push_back(drawn(o, nullptr, 0));
      for (const std::string& note : options.back().scenario.notes) warnings_.insert(note);
    }
    for (std::size_t p = 0; p < plan_.places.size(); ++p)
      for (std::size_t o = 0; o < options.size(); ++o) {
        const PlaceRefused why = refusal(options[o], plan_.places[p]);
        if (why != PlaceRefused::too_shallow || made_.refused[p] == PlaceRefused::too_shallow)
          if (made_.refused[p] != PlaceRefused::no) made_.refused[p] = why;
        if (why == PlaceRefused::no) problem.candidates.push_back({.place = p, .option = o});
      }
    const auto good = static_cast<std::size_t>(
        std::count(made_.refused.begin(), made_.refused.end(), PlaceRefused::no));
    if (good < plan_.sensors)
      throw InputError(
          {.where = plan_.path.string() + ": placement.places",
           .got = count_of(good, "place") + " that " + std::to_string(plan_.places.size()) +
                  " candidates leave (the others are too shallow or off the map)",
           .expected = "at least one for each of the " + count_of(plan_.sensors, "sensor")});
    made_.depths = options.front().settings.depths;
    made_.origin = options.front().scenario.origin;
    made_.area = options.front().scenario.area;
    weigh_cells(options.front());
    problem.pairs = plan_.multistatic;
    problem.sensors = plan_.sensors;
    problem.at_least = plan_.at_least;
    problem.draws = plan_.draws;
    made_.sets = number_of_sets(problem);
  }

  /// Whether a sensor could be there, and why not.
  [[nodiscard]] PlaceRefused refusal(const DrawnOption& option, const Vec2& place) const {
    const Scenario& scenario = option.scenario;
    if (scenario.area && scenario.area->end_at(place.x(), place.y()) == Area::End::floor)
      return PlaceRefused::beyond_map;
    Scenario there = scenario;
    move_to(there, place);
    const OceanOnMap ocean = ocean_on_map(there);
    const Transmission sent =
        transmissions(there)[static_cast<std::size_t>(option.settings.ping - 1)];
    const Vec3 source = transmitter_at(there, sent.transmitter, sent.time).position;
    const Vec3 array = array_at(there, option.settings.array, sent.time).position;
    double deepest = std::max(source.z(), array.z());
    for (const Vec3& phone :
         phones_at(there, option.settings.array, option.settings.ping, sent.time))
      deepest = std::max(deepest, array.z() + phone.z());
    for (const Vec3& at : {source, array}) {
      const double floor = ocean.bottom_depth(at);
      if (floor < deepest + plan_.clearance ||
          floor < std::max(plan_.least_water, ocean.surface_depth(at) + Area::film))
        return PlaceRefused::too_shallow;
    }
    return PlaceRefused::no;
  }

  void weigh_cells(const DrawnOption& option) {
    const Scenario& scenario = option.scenario;
    const OceanOnMap ocean = ocean_on_map(scenario);
    const std::size_t cells = plan_.cells.size(), depths = made_.depths.size();
    std::vector<double>& weight = made_.problem.weight;
    weight.assign(depths * cells, 0.0);
    made_.protect.assign(depths * cells, 0);
    made_.floor.assign(cells, unknown);
    std::size_t off = 0;
    for (std::size_t c = 0; c < cells; ++c) {
      const Vec2& at = plan_.cells[c];
      if (scenario.area && scenario.area->end_at(at.x(), at.y()) == Area::End::floor) {
        if (plan_.weights[c] > 0.0) ++off;
        continue;
      }
      const double floor = ocean.bottom_depth({at.x(), at.y(), 0.0});
      made_.floor[c] = float(floor);
      for (std::size_t d = 0; d < depths; ++d) {
        if (!(made_.depths[d] < floor)) continue;
        weight[d * cells + c] = plan_.weights[c] * plan_.depth_weights[d];
        made_.protect[d * cells + c] = weight[d * cells + c] > 0.0 ? 1 : 0;
      }
    }
    double sum = 0.0;
    for (const double w : weight) sum += w;
    if (!(sum > 0.0))
      throw InputError({.where = plan_.path.string() + ": placement.cells",
                        .got = "no cell with a weight and with water at the target's depth",
                        .expected = "cells where a target may be"});
    for (double& w : weight) w /= sum;
    if (off > 0)
      warnings_.insert("placement.cells: " + count_of(off, "cell") +
                       " beyond the map of the sea floor do not count");
  }

  /// All maps of some draws. \param wanted  candidates   \param first  of the draws, that is kept
  /// in slot 0
  void make_draws(const std::optional<Sampler>& sampler, std::size_t first, std::size_t draws,
                  const std::vector<std::size_t>& wanted) {
    // Where no input is drawn, all draws are of the same map.
    const std::size_t each = sampler ? 1 : draws;
    for (std::size_t d = 0; d < draws; d += each) {
      std::vector<DrawnOption> options;
      for (std::size_t o = 0; o < plan_.options.size(); ++o)
        options.push_back(drawn(o, sampler ? &*sampler : nullptr, first + d));
      known_.clear();
      const auto make = [&](std::size_t a, std::size_t b, std::vector<float>& values) {
        const std::shared_ptr<const SensorMap> map = map_of(options, a, b);
        for (std::size_t slot = d; slot < d + each; ++slot)
          fill(*map, a, b, first + slot, slot, values);
      };
      for (const std::size_t a : wanted)
        for (const std::size_t b : wanted) {
          PlacementProblem& problem = made_.problem;
          const auto& candidates = problem.candidates;
          if (!problem.pairs && a != b) continue;
          stop_point();
          std::vector<float>& values = problem.maps[problem.pairs ? a * count() + b : a];
          values.resize(draws * size());
          if (candidates[a].option != candidates[b].option && !plan_.across_options) continue;
          make(a, b, values);
          if (!tell(double(each))) throw Interrupted();
        }
    }
  }

  /// What is seen of candidate a's pings by candidate b. Where the sea is the same everywhere, a
  /// map depends on how the two lie to one another alone.
  std::shared_ptr<const SensorMap> map_of(const std::vector<DrawnOption>& options, std::size_t a,
                                          std::size_t b) {
    const auto& candidates = made_.problem.candidates;
    const std::size_t sends = candidates[a].option, hears = candidates[b].option;
    const Vec2 apart = place_of(a) - place_of(b);
    using Key = std::tuple<std::size_t, std::size_t, std::int64_t, std::int64_t>;
    const Key key{sends, hears, std::llround(1e3 * apart.x()), std::llround(1e3 * apart.y())};
    const bool shared = !options[sends].varies && !options[hears].varies;
    if (shared)
      if (const auto it = known_.find(key); it != known_.end()) return it->second;
    DrawnOption pair = options[sends];
    move_to(pair.scenario, place_of(a));
    if (a != b) {
      // The receiver's platforms, its array and its noise beside the transmitter's.
      Scenario other = options[hears].scenario;
      move_to(other, place_of(b));
      Scenario& scenario = pair.scenario;
      const int first = static_cast<int>(scenario.platforms.size());
      scenario.platforms.insert(scenario.platforms.end(), other.platforms.begin(),
                                other.platforms.end());
      ReceiverArray array = other.arrays[static_cast<std::size_t>(options[hears].settings.array)];
      array.platform += first;
      scenario.arrays = {array};
      scenario.noise = other.noise;
      pair.settings.array = 0;
    }
    auto made = std::make_shared<SensorMap>();
    const PingSimulator simulator(std::move(pair.scenario), nullptr,
                                  budget_.share(budget_.left(), "what the maps leave"));
    budget_.share(budget_.left(), "what the maps leave")
        .take(coverage_need(simulator, pair.settings));
    made->found = coverage(simulator, pair.settings, [&](double) { return tell(0.0); });
    made->offset = made->found.receiver.head<2>() - place_of(b);
    auto& curve = curves_[std::tuple(pair.settings.fluctuation, made->found.threshold_db)];
    if (!curve) curve = std::make_shared<DetectionCurve>(pair.settings, made->found.threshold_db);
    made->curve = curve;
    for (const std::string& text : made->found.warnings) note_of_map(text);
    if (!shared) return made;
    const double cells = double(made->found.bearings.size()) * double(made->found.ranges.size());
    const double bytes = cells * (4.0 + 37.0 * double(made->found.layers.size()));
    if ((double(known_.size()) + 1.0) * bytes > 0.5 * budget_.left()) known_.clear();
    known_[key] = made;
    return made;
  }

  /// Warnings of many maps differ in their numbers: of each kind the first one stands for all.
  void note_of_map(const std::string& text) {
    std::string kind = text.substr(0, text.find(": "));
    std::size_t& alike = of_maps_.try_emplace(kind, text, 0).first->second.second;
    if (of_maps_.at(kind).first != text) ++alike;
  }

  /// What of a map is at the plan's cells, with what it is off by.
  void fill(const SensorMap& map, std::size_t a, std::size_t b, std::size_t index, std::size_t slot,
            std::vector<float>& values) {
    const Coverage& found = map.found;
    const std::size_t cells = plan_.cells.size();
    const Vec2 middle = place_of(b) + map.offset;
    const std::uint64_t id = (std::uint64_t{a} * count() + b) << 32;
    double of_map = 0.0;
    if (plan_.map_error == MapError::maps)
      of_map =
          RandomStream(plan_.inputs.seed, Draw::study_noise, std::uint32_t(index), id | 0xffffffffU)
              .normal();
    float* const to = values.data() + slot * size();
    in_parallel_chunks(size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t x = begin; x < end; ++x) {
        to[x] = 0.0F;
        const std::optional<std::size_t> at = cell_at(found, plan_.cells[x % cells] - middle);
        if (!at || !(made_.problem.weight[x] > 0.0)) continue;
        const CoverageLayer& layer = found.layers[x / cells];
        const std::size_t cell = *at;
        if (layer.certainty[cell] == std::int8_t(CoverageCertainty::no_water)) continue;
        double p = double(layer.detection_probability[cell]);
        const double uncertainty = double(layer.uncertainty_db[cell]);
        if (plan_.map_error != MapError::none && std::isfinite(uncertainty)) {
          const double z =
              plan_.map_error == MapError::maps
                  ? of_map
                  : RandomStream(plan_.inputs.seed, Draw::study_noise, std::uint32_t(index), id | x)
                        .normal();
          p = (*map.curve)(double(layer.signal_excess_db[cell]) + uncertainty * z);
        }
        to[x] = std::isfinite(p) ? float(std::clamp(p, 0.0, 1.0)) : 0.0F;
      }
    });
    if (slot == 0) note_silence(found, a, b, middle);
  }

  /// Cells to which a ray of this map comes, in the draw that is kept first.
  void note_silence(const Coverage& found, std::size_t a, std::size_t b, const Vec2& middle) {
    std::vector<char>& heard = heard_[{a, b}];
    heard.assign(size(), 0);
    const std::size_t cells = plan_.cells.size();
    for (std::size_t x = 0; x < size(); ++x) {
      const std::optional<std::size_t> at = cell_at(found, plan_.cells[x % cells] - middle);
      if (!at) continue;
      const auto certainty = found.layers[x / cells].certainty[*at];
      heard[x] = certainty == std::int8_t(CoverageCertainty::sure) ||
                 certainty == std::int8_t(CoverageCertainty::edge);
    }
  }

  void see_alone() {
    PlacementProblem one = {.candidates = made_.problem.candidates,
                            .pairs = made_.problem.pairs,
                            .draws = made_.problem.draws,
                            .weight = made_.problem.weight,
                            .maps = {}};
    std::swap(one.maps, made_.problem.maps);
    made_.alone.resize(count());
    in_parallel(count(), [&](std::size_t c) { made_.alone[c] = mean(shares_of(one, {c})); });
    std::swap(one.maps, made_.problem.maps);
  }

  static double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
  }

  void judge() {
    const PlacementProblem& problem = made_.problem;
    const SensorSet& best = made_.choice.best;
    const std::vector<double> found = combined_detection(problem, best);
    made_.best = shares_of(problem, best);
    made_.detection.assign(size(), unknown);
    made_.deviation.assign(size(), unknown);
    made_.least = 2.0;
    for (std::size_t x = 0; x < size(); ++x) {
      if (made_.protect[x] == 0) continue;
      Moments moments;
      for (std::size_t d = 0; d < problem.draws; ++d) moments.add(found[d * size() + x]);
      made_.detection[x] = float(moments.mean());
      made_.deviation[x] = problem.draws > 1 ? float(moments.deviation()) : unknown;
      if (moments.mean() < 0.5) made_.below_half += problem.weight[x];
      if (moments.mean() < made_.least) {
        made_.least = moments.mean();
        made_.least_cell = x;
      }
      if (!any_heard(x)) made_.silent += problem.weight[x];
    }
    for (std::size_t m = 0; m < best.size(); ++m) {
      SensorSet others = best;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
      made_.without.push_back(mean(shares_of(problem, others)));
    }
    Moments differences;
    if (!made_.choice.runner_up.empty()) {
      made_.runner_up = shares_of(problem, made_.choice.runner_up);
      for (std::size_t d = 0; d < problem.draws; ++d) {
        const double difference = made_.best[d] - made_.runner_up[d];
        differences.add(difference);
        if (difference > 1e-12) ++made_.better;
        if (difference < -1e-12) ++made_.worse;
      }
    }
    made_.difference = difference_of_means(differences, plan_.confidence);
  }
  [[nodiscard]] bool any_heard(std::size_t x) const {
    const auto heard = [&](std::size_t a, std::size_t b) {
      const auto it = heard_.find({a, b});
      return it != heard_.end() && it->second[x] != 0;
    };
    for (const std::size_t a : made_.choice.best) {
      if (!made_.problem.pairs && heard(a, a)) return true;
      for (const std::size_t b : made_.choice.best)
        if (made_.problem.pairs && heard(a, b)) return true;
    }
    return false;
  }

  void warn_of_answer() {
    if (made_.silent > 0.005)
      made_.warnings.push_back(
          "placement: no ray of the chosen set comes to " +
          to_text(std::round(1000.0 * made_.silent) / 10.0) +
          " % of the weight, or it lies beyond the reach; there it counts as not detected");
    if (plan_.multistatic && plan_.wishes.bearings < 36)
      made_.warnings.push_back(
          "placement.bearings: " + std::to_string(plan_.wishes.bearings) +
          " sectors all round are coarse for what one sensor hears of another; "
          "72 are usual");
    if (plan_.judging == 0)
      made_.warnings.emplace_back(
          "placement: nothing was drawn: how sure the choice is cannot be told ([vary], "
          "map_error)");
  }

  const PlacementPlan& plan_;
  const Progress& progress_;
  MemoryBudget budget_;
  Placement made_;
  std::set<std::string> warnings_;
  std::map<std::string, std::pair<std::string, std::size_t>> of_maps_;  // by their keys
  double farthest_ = 0.0, done_ = 0.0, to_do_ = 1.0;
  std::map<std::tuple<std::size_t, std::size_t, std::int64_t, std::int64_t>,
           std::shared_ptr<const SensorMap>>
      known_;
  std::map<std::tuple<Fluctuation, double>, std::shared_ptr<const DetectionCurve>> curves_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<char>> heard_;
};

}  // namespace

Placement place_sensors(const PlacementPlan& plan, const Progress& progress) {
  return Placing(plan, progress).run();
}

}  // namespace asdic::detail::study
