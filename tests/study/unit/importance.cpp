#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "study/runs/adapt.h"
#include "study/runs/run_study.h"
#include "study/sampling/cross_entropy.h"
#include "study/summary/summary_parts.h"
#include "support/function_study.h"
#include "support/mixture.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// Rows drawn from a proposal: what their weights make of them, against closed forms at 10⁻⁶.

namespace asdic::detail::study {
namespace {

using support::column_named;
using support::Coverage;
using support::FunctionStudy;
using support::mixture;
using support::normal_input;
using support::table_named;

constexpr double far = 4.753424308822899;  // P(Z > far) = 10⁻⁶

double tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

FunctionStudy detects(std::size_t inputs, const Proposal& proposal, std::uint64_t rows) {
  FunctionStudy made;
  made.measure = "detected";
  made.study.realisations = rows;
  made.study.proposal = proposal;
  made.study.summary.roc = made.study.summary.sensitivity = made.study.summary.convergence = false;
  for (std::size_t i = 0; i < inputs; ++i)
    made.study.variables.push_back(normal_input("x" + std::to_string(i)));
  return made;
}

/// What many studies of other seeds say of one probability.
struct Said {
  Coverage coverage{};
  int warned = 0, silent_and_wrong = 0;
  double least_effective = 1e300;
};
Said of_many(FunctionStudy made, double truth, int studies) {
  Said said;
  for (int seed = 1; seed <= studies; ++seed) {
    made.study.seed = static_cast<std::uint64_t>(seed);
    const Table table = made.table();
    const SummaryTable t = statistics_table(made.study, table);
    const std::size_t row = column_named(t, "mean").size() - 1;
    const double low = column_named(t, "mean_low")[row], high = column_named(t, "mean_high")[row];
    said.coverage.add(column_named(t, "mean")[row], low, high, truth);
    const bool warns = !weight_warnings(made.study, table).empty();
    said.warned += warns;
    said.silent_and_wrong += !warns && !(low <= truth && truth <= high);
    said.least_effective =
        std::min(said.least_effective, column_named(t, "effective_of_event")[row]);
  }
  return said;
}

/// Intervals that cover 95 % by counting, with an estimate that has no bias.
void expect_covers(const Said& said, double truth) {
  const Coverage& c = said.coverage;
  EXPECT_GE(c.held, c.least());
  EXPECT_NEAR(c.mean() / truth, 1.0, 5.0 * c.deviation() / truth / std::sqrt(double(c.count)));
}

TEST(GammaInterval, IsGarwoodsOfCounts) {
  EXPECT_NEAR(incomplete_gamma(1.0, 2.5), 1.0 - std::exp(-2.5), 1e-14);
  EXPECT_NEAR(incomplete_gamma(0.5, 0.7), std::erf(std::sqrt(0.7)), 1e-14);
  EXPECT_NEAR(incomplete_gamma(0.5, 9.0), std::erf(3.0), 1e-14);
  // Five of a Poisson law, Garwood, Biometrika 28, 437 (1936): 1.62349 to 11.66833.
  const Interval five = gamma_interval(5.0, 5.0, 1.0, 0.95);
  EXPECT_NEAR(five.low, 1.623486, 1e-5);
  EXPECT_NEAR(five.high, 11.668332, 1e-5);
  // Wilson & Hilferty's of large counts joins it.
  EXPECT_NEAR(gamma_quantile(1.0001e4, 0.975) / gamma_quantile(0.9999e4, 0.975), 1.0002, 1e-5);
}

// One hit of a tiny weight among a hundred rows: others of larger weight may be unseen.
TEST(GammaInterval, AFewRowsBoundNothing) {
  WeightedMean mean;
  for (std::uint64_t i = 0; i < 100; ++i) mean.add(i, i == 7 ? 1.0 : 0.0, i == 7 ? 1e-18 : 1.0);
  EXPECT_NEAR(mean.probability(), 1e-18 / 99.0, 1e-25);
  EXPECT_NEAR(mean.probability_interval(0.95).high, 1.0 - std::pow(0.025, 1.0 / 99.0), 1e-9);
}

// What is drawn has the law that it should, and its density is that law's over the input's.
TEST(Proposals, DrawAndWeighWhatTheySay) {
  const CutLaw nominal(Normal{2.0, 1.0}), other(Normal{4.0, 0.5});
  const LawInstead laws{nominal, other};
  const WeightsInstead weights{{0.5, 0.9, 1.0}, {0.0, 0.2, 1.0}};
  for (const double v : {1e-6, 0.1, 0.5, 0.9, 1.0 - 1e-6}) {
    const double u = drawn_coordinate(laws, v), x = nominal.quantile(u);
    EXPECT_NEAR(x, other.quantile(v), 1e-9 * std::abs(x));
    EXPECT_NEAR(log_density(laws, u), std::log(other.density(x) / nominal.density(x)), 1e-6);
    const double s = drawn_coordinate(ScoreLaw{4.0, 0.5}, v);
    EXPECT_NEAR(normal_score(s), 4.0 + 0.5 * normal_score(v), 1e-6);
    EXPECT_NEAR(log_density(ScoreLaw{2.0, 0.5}, u),
                log_density(LawInstead{nominal, CutLaw(Normal{4.0, 0.5})}, u), 1e-6);
  }
  // 0.2 of the middle value, which has 0.4; 0.8 of the last one, which has 0.1; none of the first.
  for (int i = 0; i < 1000; ++i) {
    const double v = (i + 0.5) / 1000.0, u = drawn_coordinate(weights, v);
    EXPECT_GE(u, v < 0.2 ? 0.5 : 0.9);
    EXPECT_LT(u, v < 0.2 ? 0.9 : 1.0);
    EXPECT_NEAR(log_density(weights, u), std::log(v < 0.2 ? 0.5 : 8.0), 1e-12);
  }
  EXPECT_EQ(log_density(weights, 0.3), -std::numeric_limits<double>::infinity());
  // Never more than one over the share of the laws themselves.
  const Proposal far_off = mixture({{ScoreLaw{5.0, 1.0}}}, 0.1, 0.0);
  EXPECT_LE(far_off.log_weight(std::vector<double>{1e-9}), std::log(10.0));
}

// The sum of two normal inputs: 10⁻⁶ in closed form.
TEST(Importance, TailOfASum) {
  const double a = far / std::sqrt(2.0);
  FunctionStudy made = detects(2, mixture({{ScoreLaw{a, 1.0}, ScoreLaw{a, 1.0}}}), 2000);
  made.of = [](std::span<const double> x, double) {
    return x[0] + x[1] > std::sqrt(2.0) * far ? 1.0 : 0.0;
  };
  const Said said = of_many(made, 1e-6, 200);
  expect_covers(said, 1e-6);
  EXPECT_LT(said.coverage.width / said.coverage.count, 0.35e-6);
  EXPECT_LE(said.warned, 20);
  EXPECT_GT(said.least_effective, 50.0);
  // Rows drawn as they are, without weights, hold it in none.
  const Table table = made.table();
  Table bare = table;
  for (std::size_t c = bare.columns.size(); c-- > 0;)
    if (bare.columns[c].role == Column::Role::weight) {
      bare.columns.erase(bare.columns.begin() + static_cast<std::ptrdiff_t>(c));
      bare.values.erase(bare.values.begin() + static_cast<std::ptrdiff_t>(c));
    }
  EXPECT_GT(column_named(statistics_table(made.study, bare), "mean_low")[2], 0.1);
}

// Weights over the one part that is proposed, as if all rows came from it: no interval is to be
// trusted. And weights that are all too large: the summary says so.
TEST(Importance, WrongWeightsAreFound) {
  FunctionStudy made = detects(1, mixture({{ScoreLaw{far, 1.0}}}), 2000);
  made.of = [](std::span<const double> x, double) { return x[0] > far ? 1.0 : 0.0; };
  int held = 0, warned = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    made.study.seed = seed;
    const Table table = made.table();
    Table of_part = table, too_large = table;
    for (std::size_t row = 0; row < table.index.size(); ++row) {
      of_part.values[1][row] = -log_density(ScoreLaw{far, 1.0}, normal_share(table.values[0][row]));
      too_large.values[1][row] += std::log(1.5);
    }
    const SummaryTable t = statistics_table(made.study, of_part);
    held += column_named(t, "mean_low")[1] <= 1e-6 && 1e-6 <= column_named(t, "mean_high")[1];
    const std::vector<std::string> told = weight_warnings(made.study, too_large);
    warned += !told.empty() && told[0].starts_with("weights: their mean is 1.");
  }
  EXPECT_LT(held, 25);  // fewer than 27 of 40 has a probability of 10⁻⁶ at 95 %
  EXPECT_EQ(warned, 40);
}

// A Rayleigh input through another law of its kind: P(X > x) = e^(−x²/2σ²).
TEST(Importance, TailOfARayleighInput) {
  const CutLaw nominal(Weibull{2.0, 1.0}), other(Weibull{2.0, 3.5});
  FunctionStudy made = detects(1, Proposal{}, 2000);
  made.study.variables[0].law = NumberLaw{nominal};
  made.study.proposal = mixture({{LawInstead{nominal, other}}});
  const double x6 = std::sqrt(6.0 * std::log(10.0));
  made.of = [x6](std::span<const double> x, double) { return x[0] > x6 ? 1.0 : 0.0; };
  expect_covers(of_many(made, 1e-6, 120), 1e-6);
}

// Two modes, of which the proposal knows one. Without the wide part no study comes near the truth,
// and each says that nothing guards it. With it the other mode is found, and whoever is wrong says
// that it may be.
TEST(Importance, AModeThatIsMissedIsTold) {
  const auto both = [](std::span<const double> x, double) {
    return std::abs(x[0]) > far ? 1.0 : 0.0;
  };
  FunctionStudy blind = detects(1, mixture({{ScoreLaw{far, 1.0}}}, 0.1, 0.0), 2000);
  blind.of = both;
  const Said unseen = of_many(blind, 2e-6, 40);
  EXPECT_EQ(unseen.coverage.held, 0);
  EXPECT_EQ(unseen.warned, 40);
  FunctionStudy guarded = detects(1, mixture({{ScoreLaw{far, 1.0}}}), 3000);
  guarded.of = both;
  const Said seen = of_many(guarded, 2e-6, 120);
  EXPECT_NEAR(seen.coverage.mean() / 2e-6, 1.0,
              5.0 * seen.coverage.deviation() / 2e-6 / std::sqrt(120.0));
  EXPECT_GT(seen.warned, 80);
  EXPECT_LE(seen.silent_and_wrong, 11);  // 5 % and 2 standard deviations
  FunctionStudy knows = detects(1, mixture({{ScoreLaw{far, 1.0}}, {ScoreLaw{-far, 1.0}}}), 2000);
  knows.of = both;
  expect_covers(of_many(knows, 2e-6, 100), 2e-6);
}

// Along a choice with other weights, in bins whose probability is not known beforehand.
TEST(Importance, TablesAlongAxesKnowTheWeights) {
  const ChoiceLaw kinds{.values = {{{.data = std::int64_t{0}, .origin = ""}},
                                   {{.data = std::int64_t{1}, .origin = ""}}},
                        .cumulative = {0.9, 1.0},
                        .labels = {{}}};
  FunctionStudy made = detects(1, Proposal{}, 2000);
  made.study.variables.insert(made.study.variables.begin(),
                              {.name = "kind", .keys = {"kind"}, .origin = "", .law = kinds});
  made.study.proposal = mixture({{WeightsInstead{{0.9, 1.0}, {0.5, 1.0}}, ScoreLaw{far, 1.0}}});
  made.study.summary.by = {{{.column = "kind"}}};
  made.of = [](std::span<const double> x, double) { return x[1] > far - x[0] ? 1.0 : 0.0; };
  const double truth = 0.9 * tail(far) + 0.1 * tail(far - 1.0);
  std::vector<Coverage> bins(2);
  Coverage all, input;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    made.study.seed = seed;
    const auto tables = summarise(made.study, made.table());
    const SummaryTable& by = table_named(tables, "pd_by_kind");
    for (std::size_t k = 0; k < 2; ++k)
      bins[k].add(column_named(by, "pd")[k], column_named(by, "pd_low")[k],
                  column_named(by, "pd_high")[k], tail(far - double(k)));
    const SummaryTable& t = table_named(tables, "statistics");
    all.add(column_named(t, "mean")[2], column_named(t, "mean_low")[2],
            column_named(t, "mean_high")[2], truth);
    // The input's own mean, 0, of rows most of which lie at 4.75.
    input.add(column_named(t, "mean")[1], column_named(t, "mean_low")[1],
              column_named(t, "mean_high")[1], 0.0);
    EXPECT_NEAR(column_named(t, "q0500")[1], 0.0, 0.5);
    EXPECT_NEAR(column_named(t, "deviation")[1], 1.0, 0.35);
  }
  EXPECT_GE(all.held, all.least());
  for (const Coverage& bin : bins) EXPECT_GE(bin.held, bin.least());
  EXPECT_GE(input.held, input.least());
}

// What is not known is no event, and the rest is what is known: P(x > t | x > −1).
TEST(Importance, RowsThatAreNotKnownDoNotCount) {
  FunctionStudy made = detects(1, mixture({{ScoreLaw{far, 1.0}}}), 2000);
  made.of = [](std::span<const double> x, double) {
    return x[0] < -1.0 ? std::nan("") : x[0] > far ? 1.0 : 0.0;
  };
  const double truth = 1e-6 / tail(-1.0);
  const Said said = of_many(made, truth, 100);
  EXPECT_GE(said.coverage.held, said.coverage.least());
  EXPECT_NEAR(said.coverage.mean() / truth, 1.0, 0.05);
}

// Scrambled nets that are drawn from a proposal: the interval is of the scatter between them.
TEST(Importance, ReplicatesHaveWeightsToo) {
  FunctionStudy made = detects(1, mixture({{ScoreLaw{far, 1.0}}}), 16 * 64);
  made.study.design = Design::sobol;
  made.study.design_options.replicates = 16;
  made.of = [](std::span<const double> x, double) { return x[0] > far ? 1.0 : 0.0; };
  const Said nets = of_many(made, 1e-6, 100);
  EXPECT_GE(nets.coverage.held, nets.coverage.least());
  made.study.design = Design::random;
  made.study.design_options.replicates = 1;
  EXPECT_LT(nets.coverage.deviation(), 0.5 * of_many(made, 1e-6, 100).coverage.deviation());
}

/// Levels of a function, as adapt() makes them of a study.
std::vector<ProposalPart> levels_of(FunctionStudy made,
                                    const std::function<double(std::span<const double>)>& excess,
                                    int& levels) {
  std::vector<ProposalPart> parts;
  for (levels = 1; levels <= 12; ++levels) {
    made.study.seed = static_cast<std::uint64_t>(1000 + levels);
    const Sampler sampler(made.study);
    std::vector<LevelRow> rows;
    for (std::uint64_t i = 0; i < 500; ++i) {
      LevelRow row{.scores = std::vector<double>(sampler.dimensions())};
      row.log_weight = sampler.point(i, row.scores).log_weight;
      for (double& u : row.scores) u = normal_score(u);
      row.excess = excess(row.scores);
      rows.push_back(row);
    }
    const Level level = next_level(rows, 500.0, 20.0, made.study.seed);
    parts = level.parts;
    if (level.there()) return parts;
    std::vector<std::vector<CoordinateDraw>> components;
    for (const ProposalPart& part : parts) components.push_back(part.draws);
    made.study.proposal = mixture(components);
  }
  return {};
}

// Levels find it without being told where it is: among five inputs, of which two matter; on both
// sides; and where two conditions hold at once.
TEST(CrossEntropy, FindsTheEventAtTenToTheMinusSix) {
  struct Case {
    std::function<double(std::span<const double>)> excess;
    double truth;
    std::size_t components;
  };
  const std::vector<Case> cases{
      {[](std::span<const double> x) { return x[0] - x[1] - std::sqrt(2.0) * far; }, 1e-6, 1},
      {[](std::span<const double> x) { return std::abs(x[2]) - far; }, 2e-6, 2},
      {[](std::span<const double> x) { return std::min(x[0], -x[1]) - 3.090232306167814; }, 1e-6,
       1}};
  for (const Case& one : cases) {
    FunctionStudy made = detects(5, Proposal{}, 4000);
    int levels = 0;
    const std::vector<ProposalPart> parts = levels_of(made, one.excess, levels);
    ASSERT_FALSE(parts.empty());
    EXPECT_EQ(parts.size(), one.components);
    EXPECT_LE(levels, 8);
    std::vector<std::vector<CoordinateDraw>> components;
    for (const ProposalPart& part : parts) components.push_back(part.draws);
    made.study.proposal = mixture(components);
    made.of = [&one](std::span<const double> x, double) { return one.excess(x) > 0.0 ? 1.0 : 0.0; };
    const Said said = of_many(made, one.truth, 25);
    expect_covers(said, one.truth);
    EXPECT_LT(said.coverage.width / said.coverage.count, one.truth) << levels;
  }
}

const std::string drawn_study =
    "[study]\nrealisations = 400\nseed = 3\n"
    "[vary]\n\"target.0.strength_db\" = { law = \"normal\", mean = 10.0, deviation = 3.0 }\n"
    "\"target.0.range\" = { law = \"uniform\", low = 5e3, high = 6e3 }\n"
    "[measure]\necho_level = true\n";

Study read(const support::TemporaryDirectory& folder, const std::string& tables) {
  const std::filesystem::path path = folder.path() / "study.toml";
  std::ofstream(path) << tables << support::plain_sea;
  return read_study(path);
}

// The echo's level follows the strength dB by dB, so its tail is the strength's: found by levels of
// pings, written into the file, read again, and its rows are those of (seed, index) alone.
TEST(Adapt, WritesAStudyThatRepeatsItself) {
  const support::TemporaryDirectory folder;
  const std::string event = "[rare]\nevent = \"strength_db > 24.26027\"\n";  // 10⁻⁶
  const Study plain = read(folder, drawn_study + event);
  EXPECT_FALSE(is_weighted(plain));
  std::vector<int> levels;
  const auto tell = [&](const AdaptedLevel& told) { levels.push_back(told.number); };
  const std::vector<ProposalPart> parts = adapt(plain, tell), again = adapt(plain, tell);
  const std::string text = with_components(plain, parts, "# found\n");
  EXPECT_EQ(text, with_components(plain, again, "# found\n"));
  EXPECT_LE(levels.back(), 8);
  std::ofstream(folder.path() / "found.toml") << text;
  const Study found = read_study(folder.path() / "found.toml");
  ASSERT_TRUE(is_weighted(found));
  EXPECT_NE(identity(plain), identity(found));
  const Realiser realiser(found);
  RunningEstimate estimate(found);
  for (std::uint64_t i = 0; i < found.realisations; ++i) estimate.add(realiser.realise(i));
  EXPECT_EQ(realiser.realise(17).values, Realiser(found).realise(17).values);
  const std::optional<Estimate> p = estimate.estimate();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->name, "p_event");
  EXPECT_GT(p->high, 0.8e-6);
  EXPECT_GT(p->value, 0.5e-6);
  EXPECT_LT(p->low, 1.2e-6);
  EXPECT_LT(p->high - p->low, 2e-6);
  // How it was found is no part of what it is.
  EXPECT_EQ(identity(plain),
            identity(read(folder, drawn_study + event + "levels = 3\nrows_per_level = 60\n")));
  EXPECT_NE(identity(plain), identity(read(folder, drawn_study + event + "share = 0.2\n")));
}

// Inputs that depend on one another, by a copula and by a choice: scores are drawn before either.
// Their difference is normal about 10 with the deviation 3, as ρ is 1/2. The event lies 4.75 of
// them beyond in winter, which has a quarter: ¼·10⁻⁶.
TEST(Adapt, InputsMayDependOnOneAnother) {
  const support::TemporaryDirectory folder;
  const Study plain =
      read(folder,
           "[study]\nrealisations = 1000\nseed = 3\n[vary]\n"
           "season = { law = \"categorical\", values = [\"winter\", \"summer\"], "
           "weights = [1, 3], keys = [] }\n"
           "\"target.0.strength_db\" = { law = \"normal\", mean = 10.0, deviation = "
           "3.0 }\nmore = { law = \"normal\", mean = 0.0, deviation = 3.0, keys = [] "
           "}\n[vary.shift]\ngiven = \"season\"\nkeys = []\nlaws.winter = { law = "
           "\"uniform\", low = 0.0, high = 1e-9 }\nlaws.summer = { law = \"uniform\", "
           "low = 20.0, high = 20.1 }\n[correlation]\ninputs = [\"strength_db\", "
           "\"more\"]\nmatrix = [[1.0, 0.5], [0.5, 1.0]]\n[measure]\necho_level = "
           "true\n[rare]\nevent = \"strength_db - more - shift > 24.26027\"\n"
           "rows_per_level = 200\n");
  std::ofstream(folder.path() / "found.toml") << with_components(plain, adapt(plain, {}), "");
  const Study found = read_study(folder.path() / "found.toml");
  const Realiser realiser(found);
  RunningEstimate estimate(found);
  for (std::uint64_t i = 0; i < found.realisations; ++i) estimate.add(realiser.realise(i));
  const std::optional<Estimate> p = estimate.estimate();
  ASSERT_TRUE(p);
  EXPECT_LT(p->low, 0.25e-6);
  EXPECT_GT(p->high, 0.25e-6);
  EXPECT_LT(p->high - p->low, 0.3e-6);
}

std::string fault_of(const std::string& tables, bool adapted = false) {
  const support::TemporaryDirectory folder;
  try {
    const Study study = read(folder, tables);
    if (adapted) static_cast<void>(adapt(study, {}));
  } catch (const InputError& error) {
    const std::string text = error.what();
    const auto at = text.find("study.toml");
    return at == std::string::npos ? text : text.substr(at);
  }
  return "no fault";
}

TEST(Rare, FaultsSayWhereFoundAndExpected) {
  const auto rare = [](const std::string& keys) { return drawn_study + "[rare]\n" + keys + "\n"; };
  EXPECT_EQ(fault_of(rare("event = \"echo_level_db\"")),
            "study.toml:10: rare.event: found \"echo_level_db\", expected one comparison by <, <=, "
            "> or >= of columns, \"echo_to_background_db > 12\"; of two conditions min(a, b) > 0 "
            "is both, max(a, b) > 0 either");
  EXPECT_NE(fault_of(rare("event = \"echo_levl_db > 3\"")).find("echo_levl_db"), std::string::npos);
  EXPECT_EQ(fault_of(rare("share = 0.7\nwide = 0.4")),
            "study.toml:11: rare.wide: found 0.4, expected less than 0.3: share and wide leave "
            "something to what is proposed");
  EXPECT_NE(fault_of(rare("[[rare.component]]\ncentre = { strenth_db = 3.0 }")).find("strength_db"),
            std::string::npos);
  EXPECT_NE(fault_of(rare("[[rare.component]]\ncentre = { range = [1.0, 2.0] }"))
                .find("one number: this input takes one coordinate"),
            std::string::npos);
  std::string gridded = drawn_study;
  gridded.insert(gridded.find("seed"), "design = \"grid\"\n");
  EXPECT_NE(fault_of(gridded + "[[rare.component]]\ncentre = { range = 1.0 }\n")
                .find("study.design: found \"grid\", expected \"random\""),
            std::string::npos);
  EXPECT_NE(fault_of(drawn_study, true).find("rare: found no event"), std::string::npos);
  EXPECT_NE(fault_of(rare("rows_per_level = 50\nevent = \"max(strength_db, 50) > 60\""), true)
                .find("an event that rows come nearer to"),
            std::string::npos);
}

std::string with_proposal(const std::string& entry) {
  return "[study]\nrealisations = 10\n[vary]\n" + entry + "\n[measure]\necho_level = true\n";
}

TEST(Rare, ProposalsOfInputsAreRead) {
  const support::TemporaryDirectory folder;
  const Study study = read(
      folder, with_proposal("\"target.0.strength_db\" = { law = \"normal\", mean = 10.0, deviation "
                            "= 3.0, proposal = { law = \"normal\", mean = 20.0, deviation = 3.0 } "
                            "}\n\"array.phones\" = { law = \"categorical\", values = [1, 2], "
                            "weights = [9, 1], proposal = { weights = [1, 1] } }"));
  ASSERT_EQ(study.proposal.parts().size(), 3U);
  EXPECT_EQ(study.proposal.parts()[2].share, 1.0 - 0.1 - 0.2);
  EXPECT_EQ(columns(study)[2].name, "log_weight");
  EXPECT_EQ(columns(study)[3].labels, (std::vector<std::string>{"laws", "wide", "proposal"}));
  EXPECT_NE(fault_of(with_proposal("\"target.0.strength_db\" = { law = \"uniform\", low = 0.0, "
                                   "high = 10.0, proposal = { law = \"uniform\", low = 20.0, "
                                   "high = 30.0 } }"))
                .find("a law whose middle lies where the input itself has values, from"),
            std::string::npos);
  EXPECT_NE(fault_of(with_proposal("\"array.phones\" = { law = \"categorical\", values = [1, 2], "
                                   "weights = [1, 0], proposal = { weights = [1, 1] } }"))
                .find("0, as the input itself never takes this value"),
            std::string::npos);
  EXPECT_NE(fault_of(with_proposal("\"array.phones\" = { law = \"list\", values = [1, 2], "
                                   "proposal = { weights = [1, 1] } }"))
                .find("drawn by [[rare.component]]"),
            std::string::npos);
}

}  // namespace
}  // namespace asdic::detail::study
