#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/results.h"
#include "io/compare/fields.h"
#include "raytrace/beams/fan.h"
#include "raytrace/runs/field_run.h"

// Fields of our own tracer beside what BELLHOP converges to (tests/data/bellhop; the docs are
// docs/theory/fields.md and docs/guide/from-bellhop.md). Bounds are as asked: a figure may be as
// large as the one stated or as the residual of the reference, whichever is larger.
namespace asdic::detail {
namespace {

struct Case {
  const char* name;
  double median_db, p95_db;  ///< same fan
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::filesystem::path folder(const std::string& name) {
  return std::filesystem::path(ASDIC_TEST_DATA) / "bellhop" / name;
}

nlohmann::json figures(const std::string& name) {
  std::ifstream file(folder(name) / "meta.json");
  return nlohmann::json::parse(file).at("figures");
}

compare::FieldDifference against_converged(const std::string& name,
                                           const PropagationCase& run_case) {
  const PropagationResult result = run_field(run_case);
  return compare::compare_fields(bellhop::shade_file(run_case, result),
                                 bellhop::read_shade_file(folder(name) / "converged" / "case.shd"));
}

class SameFan : public testing::TestWithParam<Case> {};

// The fan of converged/case.env taken literally: only the rays are better.
TEST_P(SameFan, GivesWhatBellhopConvergesTo) {
  const std::string name = GetParam().name;
  PropagationCase run_case = bellhop::read_case(folder(name) / "converged" / "case").run_case;
  run_case.beams.elevations =
      even_fan(run_case.beams.lowest, run_case.beams.highest, run_case.literal.beams).elevation;
  const auto difference = against_converged(name, run_case);
  const auto residual = figures(name).at("residual");
  EXPECT_LE(difference.tl_db.median,
            std::max(GetParam().median_db, residual.at("dtl_median").get<double>()));
  EXPECT_LE(difference.tl_db.p95,
            std::max(GetParam().p95_db, residual.at("dtl_p95").get<double>()));
  RecordProperty("median_db", std::to_string(difference.tl_db.median));
  RecordProperty("p95_db", std::to_string(difference.tl_db.p95));
}

// Gaps, named, all of them BELLHOP's: seamount-curved (2.0 dB at the median) and swell-surface
// (0.29 dB), normals that are not of unit length and facets that bend like the corner at their end
// (BellhopEmulationCurvilinear); cerveny-raycentred (0.23 dB, residual 0.21), a step of first order
// (BellhopEmulationCervenyRayCentred). docs/theory/fields.md
INSTANTIATE_TEST_SUITE_P(Geometric, SameFan,
                         testing::Values(Case{"munk-coherent-hat", 0.02, 0.1},
                                         Case{"munk-incoherent-gauss", 0.02, 0.1},
                                         Case{"pekeris-coherent", 0.02, 0.1},
                                         Case{"grain-semicoherent", 0.02, 0.1},
                                         Case{"cerveny-cartesian", 0.05, 0.5}));
INSTANTIATE_TEST_SUITE_P(GeometricSlow, SameFan,
                         testing::Values(Case{"front-range-dependent", 0.02, 0.1},
                                         Case{"tables-and-pattern", 0.02, 0.1},
                                         Case{"wedge-gauss", 0.02, 0.1}));

class OwnFan : public testing::TestWithParam<Case> {};

// case.env as a user has it, beams by our own rule. Where the reference itself is sure to 1 dB:
// median 0.1, 95 % 0.5 dB; elsewhere the median as good as BELLHOP's default and the mean level to
// 0.3 dB.
TEST_P(OwnFan, IsNearerToTheTruthThanBellhopAsAsked) {
  const std::string name = GetParam().name;
  const PropagationCase run_case = bellhop::read_case(folder(name) / "case").run_case;
  const auto difference = against_converged(name, run_case);
  const auto all = figures(name);
  if (all.at("residual").at("dtl_p95").get<double>() < 1.0) {
    EXPECT_LE(difference.tl_db.median, GetParam().median_db);
    EXPECT_LE(difference.tl_db.p95, GetParam().p95_db);
  } else {
    EXPECT_LE(difference.tl_db.median, all.at("default").at("dtl_median").get<double>());
  }
  EXPECT_NEAR(difference.level_db, 0.0, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Quick, OwnFan,
                         testing::Values(Case{"munk-coherent-hat", 0.1, 0.5},
                                         Case{"munk-incoherent-gauss", 0.1, 0.5},
                                         Case{"pekeris-coherent", 0.1, 0.5},
                                         Case{"grain-semicoherent", 0.1, 0.5}));
INSTANTIATE_TEST_SUITE_P(
    Slow, OwnFan,
    testing::Values(Case{"front-range-dependent", 0.1, 0.5}, Case{"cerveny-cartesian", 0.1, 0.5},
                    Case{"cerveny-raycentred", 0.1, 0.5}, Case{"tables-and-pattern", 0.1, 0.5},
                    Case{"swell-surface", 0.1, 0.5}, Case{"wedge-gauss", 0.1, 0.5}));

}  // namespace
}  // namespace asdic::detail
