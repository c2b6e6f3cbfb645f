#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/compare_output.h"
#include "app/console.h"
#include "app/output.h"
#include "app/picture_source.h"
#include "app/pictures.h"
#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "io/result/result_file.h"

namespace asdic::detail::app {
namespace {

/// The largest difference that passes; none: not asked.
struct Thresholds {
  std::optional<double> median_db, p95_db, level_db, relative_error;  // fields; arrivals: amplitude
  std::optional<double> matched_pct, strong_pct, delay_us, angle_deg;
  std::optional<double> distance_m;
  std::optional<double> compared_pct;  ///< none: all must be, where any of the others is asked for

  [[nodiscard]] bool any() const noexcept {
    return median_db || p95_db || level_db || relative_error || matched_pct || strong_pct ||
           delay_us || angle_deg || distance_m || compared_pct;
  }
};

struct CompareOptions {
  std::string a, b, picture;
  compare::FieldOptions field;
  compare::ArrivalOptions arrivals;
  compare::RayOptions rays;
  double pair_us = 2000.0, join_us = 20.0;
  Thresholds limits;
  bool json = false, force = false;
};

/// Holds results against thresholds, and remembers in words which are exceeded.
class Judge {
 public:
  /// \param value  NaN: there was nothing to be compared, which passes no threshold
  void at_most(const std::string& what, double value, const std::optional<double>& limit,
               const std::string& unit) {
    if (limit && !(value <= *limit))
      exceeded.push_back(
          fmt::format("{}: {:.4g}{}, expected at most {:g}", what, value, unit, *limit));
  }
  void at_least(const std::string& what, double value, const std::optional<double>& limit,
                const std::string& unit) {
    if (limit && !(value >= *limit))
      exceeded.push_back(
          fmt::format("{}: {:.4g}{}, expected at least {:g}", what, value, unit, *limit));
  }
  /// A threshold that means nothing for this kind of file.
  static void refuse(const std::string& option, bool given, const std::string& kind,
                     const std::string& expected) {
    if (given) throw InputError({.where = option, .got = kind, .expected = expected});
  }

  std::vector<std::string> exceeded;
};

/// What cannot be compared has no difference that a threshold could catch. \param what  "cells"
template <class Difference>
void judge_left_out(Judge& judge, const Difference& d, const Thresholds& limits,
                    const std::string& what) {
  if (!limits.any()) return;
  judge.at_least(what + " compared", d.compared_pct(), limits.compared_pct.value_or(100.0), " %");
}

double or_nan(double value, std::size_t count) { return count > 0 ? value : std::nan(""); }

void judge(Judge& judge, const compare::FieldDifference& d, const Thresholds& limits) {
  Judge::refuse("--min-matched", limits.matched_pct.has_value(), "fields", "arrivals or rays");
  Judge::refuse("--min-strong", limits.strong_pct.has_value(), "fields", "arrivals");
  Judge::refuse("--max-delay-us", limits.delay_us.has_value(), "fields", "arrivals");
  Judge::refuse("--max-angle-deg", limits.angle_deg.has_value(), "fields", "arrivals");
  Judge::refuse("--max-distance", limits.distance_m.has_value(), "fields", "rays");
  judge_left_out(judge, d, limits, "cells");
  const std::size_t n = d.compared;
  judge.at_most("median |dTL|", or_nan(d.tl_db.median, n), limits.median_db, " dB");
  judge.at_most("95 % |dTL|", or_nan(d.tl_db.p95, n), limits.p95_db, " dB");
  judge.at_most("mean level", or_nan(std::abs(d.level_db), n), limits.level_db, " dB");
  judge.at_most("relative error", or_nan(d.relative_error, n), limits.relative_error, "");
}

void judge(Judge& judge, const compare::ArrivalDifference& d, const Thresholds& limits) {
  Judge::refuse("--max-error", limits.relative_error.has_value(), "arrivals", "fields");
  Judge::refuse("--max-distance", limits.distance_m.has_value(), "arrivals", "rays");
  judge_left_out(judge, d, limits, "rows");
  const std::size_t n = d.matched;
  judge.at_least("paths matched", d.matched_pct(), limits.matched_pct, " %");
  judge.at_least("paths within 20 dB matched", d.strong_matched_pct(), limits.strong_pct, " %");
  judge.at_most("median amplitude", or_nan(d.amplitude_db.median, n), limits.median_db, " dB");
  judge.at_most("95 % amplitude", or_nan(d.amplitude_db.p95, n), limits.p95_db, " dB");
  judge.at_most("energy", or_nan(std::abs(d.energy_db), n), limits.level_db, " dB");
  judge.at_most("95 % delay", or_nan(d.delay_us.p95, n), limits.delay_us, " us");
  judge.at_most("95 % launch angle", or_nan(d.launch_deg.p95, n), limits.angle_deg, " deg");
  judge.at_most("95 % arrival angle", or_nan(d.arrival_deg.p95, n), limits.angle_deg, " deg");
}

void judge(Judge& judge, const compare::RayDifference& d, const Thresholds& limits) {
  for (const auto& [option, given] : {std::pair{"--max-median", limits.median_db.has_value()},
                                      std::pair{"--max-p95", limits.p95_db.has_value()},
                                      std::pair{"--max-level", limits.level_db.has_value()},
                                      std::pair{"--max-error", limits.relative_error.has_value()}})
    Judge::refuse(option, given, "rays", "fields or arrivals");
  Judge::refuse("--min-strong", limits.strong_pct.has_value(), "rays", "arrivals");
  Judge::refuse("--max-delay-us", limits.delay_us.has_value(), "rays", "arrivals");
  Judge::refuse("--max-angle-deg", limits.angle_deg.has_value(), "rays", "arrivals");
  judge_left_out(judge, d, limits, "rays");
  judge.at_least("rays paired", d.paired_pct(), limits.matched_pct, " %");
  judge.at_most("distance", or_nan(d.inside_m.max, d.paired), limits.distance_m, " m");
}

/// The strongest missed paths in words.
std::vector<std::string> missed_paths(const compare::ArrivalDifference& d,
                                      const bellhop::ArrivalsFile& b) {
  constexpr std::size_t most = 5;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(most, d.missed.size()); ++i) {
    const compare::MissedPath& path = d.missed[i];
    const std::size_t depth = b.irregular ? path.range : path.row;
    lines.push_back(fmt::format(
        "{} dB re the strongest at {}{} km, {} m: {} surface and {} bottom bounces, {} s, launched "
        "at "
        "{} deg (positive down)",
        number(path.level_db, 1),
        b.map.is_map() ? fmt::format("azimuth {:g} deg, ",
                                     b.map.azimuths_deg[path.plane % b.map.azimuths_deg.size()])
                       : "",
        number(b.receiver_ranges[path.range] / 1000.0, 3), number(b.receiver_depths[depth], 1),
        path.path.surface_bounces, path.path.bottom_bounces, number(path.path.delay, 6),
        number(path.path.launch_angle_deg, 3)));
  }
  return lines;
}

CompareResult compared(const CompareOptions& options, const PropagationFile& a,
                       const PropagationFile& b) {
  if (a.index() != b.index())
    throw InputError(
        {.where = options.a + " and " + options.b,
         .got = fmt::format("a file of kind \"{}\" and one of kind \"{}\"", kind_of(a), kind_of(b)),
         .expected = "two of one kind"});
  CompareResult result{.a = options.a,
                       .b = options.b,
                       .floor_db = options.field.floor_db,
                       .below_strongest_db = options.arrivals.below_strongest_db};
  if (const auto* field = std::get_if<bellhop::ShadeFile>(&a)) {
    result.comparison =
        compare::compare_fields(*field, std::get<bellhop::ShadeFile>(b), options.field);
  } else if (const auto* arrivals = std::get_if<bellhop::ArrivalsFile>(&a)) {
    compare::ArrivalOptions settings = options.arrivals;
    settings.max_delay_difference = 1e-6 * options.pair_us;
    settings.join_delay = 1e-6 * options.join_us;
    const auto& reference = std::get<bellhop::ArrivalsFile>(b);
    auto difference = compare::compare_arrivals(*arrivals, reference, settings);
    result.missed = missed_paths(difference, reference);
    result.comparison = std::move(difference);
  } else {
    result.comparison = compare::compare_rays(std::get<bellhop::RayFile>(a),
                                              std::get<bellhop::RayFile>(b), options.rays);
  }
  Judge verdict;
  std::visit([&](const auto& d) { judge(verdict, d, options.limits); }, result.comparison);
  result.exceeded = std::move(verdict.exceeded);
  result.within = result.exceeded.empty();
  return result;
}

void draw(const CompareOptions& options) {
  check_output(options.picture,
               {.own = own::picture, .force = options.force, .option = "--picture"});
  const TemporaryFolder folder;
  const auto a = picture_source(options.a, folder, "a"), b = picture_source(options.b, folder, "b");
  std::vector<std::string> words{
      a.string(), "--against",    b.string(), "--names",
      options.a,  options.b,      "--floor",  fmt::format("{}", options.field.floor_db),
      "-o",       options.picture};
  if (options.force) words.push_back("--force");
  const int status = draw_pictures(words);
  if (status != 0) throw RunError(options.picture + ": the picture was not drawn");
}

int compare_files(const CompareOptions& options) {
  const PropagationFile a = read_result(options.a), b = read_result(options.b);
  const CompareResult result = compared(options, a, b);
  print(options.json ? comparison_json(result) : comparison_table(result));
  if (!options.picture.empty()) draw(options);
  return result.within ? 0 : 1;
}

void add_threshold(const Command& command, const std::string& name, std::optional<double>& store,
                   const std::string& unit, const std::string& help) {
  command.add_option(name, store, help)
      .type_name(unit)
      .check(not_negative())
      .group("Thresholds (exit status 1 when one is exceeded)");
}

void add_thresholds(const Command& command, Thresholds& limits) {
  add_threshold(command, "--max-median", limits.median_db, "DB",
                "median of |dTL|; of arrivals, of the amplitudes [dB]");
  add_threshold(command, "--max-p95", limits.p95_db, "DB",
                "95 % of |dTL|; of arrivals, of the amplitudes [dB]");
  add_threshold(command, "--max-level", limits.level_db, "DB",
                "difference of the mean intensity; of arrivals, of their energy [dB]");
  add_threshold(command, "--max-error", limits.relative_error, "X",
                "relative complex error of fields");
  add_threshold(command, "--min-matched", limits.matched_pct, "%",
                "paths, or rays, of B found in A");
  add_threshold(command, "--min-strong", limits.strong_pct, "%",
                "paths within 20 dB of the strongest found in A");
  add_threshold(command, "--min-compared", limits.compared_pct, "%",
                "cells (rows of arrivals, rays) that can be compared: in both files, finite; 100 "
                "where another threshold is given");
  add_threshold(command, "--max-delay-us", limits.delay_us, "US", "95 % of the delays [us]");
  add_threshold(command, "--max-angle-deg", limits.angle_deg, "DEG",
                "95 % of launch and arrival angles [deg]");
  add_threshold(command, "--max-distance", limits.distance_m, "M",
                "of rays from their paths, end points aside [m]");
}

}  // namespace

void add_compare_command(Program& program) {
  program.add_command(
      "compare", "How far two fields, lists of arrivals or sets of rays are apart.",
      [](const Command& command) {
        auto options = std::make_shared<CompareOptions>();
        command
            .add_option("A", options->a, ".shd, .arr, .ray, or HDF5 of asdic field, arrivals, rays")
            .required()
            .type_name("FILE");
        command.add_option("B", options->b, "the reference, of the same kind")
            .required()
            .type_name("FILE");
        command
            .add_option("--floor", options->field.floor_db, "fields: cells with TL below this [dB]")
            .show_default()
            .type_name("DB");
        command.add_length("--min-range", options->field.min_range,
                           "fields: leave out nearer cells, e.g. 500m");
        command.add_flag("--resample", options->field.resample,
                         "fields: take from A the cells of B's grid, where it has them");
        command
            .add_option(
                "--rel-db", options->arrivals.below_strongest_db,
                "arrivals: leave out those further below the strongest at their receiver [dB]")
            .show_default()
            .type_name("DB")
            .check(above_zero());
        command
            .add_option("--pair-us", options->pair_us,
                        "arrivals: paths of one history are one within this delay [us]")
            .show_default()
            .type_name("US")
            .check(above_zero());
        command
            .add_option(
                "--join-us", options->join_us,
                "arrivals: neighbouring beams of one path are that close; 0 joins none [us]")
            .show_default()
            .type_name("US")
            .check(not_negative());
        command
            .add_option("--pair-deg", options->rays.angle_deg,
                        "rays: pair those within this launch angle [deg]")
            .show_default()
            .type_name("DEG")
            .check(not_negative());
        add_thresholds(command, options->limits);
        command.add_flag("--json", options->json, "print JSON (docs/formats/compare.md)");
        command.add_option("--picture", options->picture, "draw both and their difference")
            .type_name("FILE.png");
        add_force_option(command, options->force);
        command.footer(
            "Differences are A - B; TL is -20 log10 |p|.\n"
            "Exit status: 0 within the thresholds, 1 outside, 2 the input is wrong.\n"
            "Example:  asdic compare new.shd old.shd --max-p95 0.5 --picture difference.png");
        command.runs([options] { return compare_files(*options); });
      });
}

}  // namespace asdic::detail::app
