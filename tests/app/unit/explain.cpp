#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/program.h"

// asdic explain: what it says of cases whose answers are known (tests/data/bellhop).

namespace asdic::detail {
namespace {

using nlohmann::json;
using support::asdic;

const std::string data = ASDIC_TEST_DATA "/bellhop/";

json explanation(const std::string& words) {
  const support::TemporaryDirectory folder;
  const auto outcome = asdic(folder, "explain " + words + " --json -q");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

json effect(const json& all, const std::string& name) {
  for (const json& one : all["effects"])
    if (one["what"] == name) return one["difference"];
  ADD_FAILURE() << "no effect " << name;
  return {};
}

// The default step of 500 m, not the fan, makes these eigenrays leave their paths; the file on disk
// is BELLHOP's own, to rounding.
TEST(Explain, SaysWhatTheStepDoes) {
  const json all = explanation("'" + data + "rays-upslope/case'");
  EXPECT_EQ(all["filetype"], "asdic explanation");
  EXPECT_EQ(all["beams"], 21);
  EXPECT_NEAR(all["step_m"].get<double>(), 100.0, 1e-9);
  // 11.4 m at 95 % against the converged file (its README)
  EXPECT_NEAR(all["total"]["inside_m"]["p95"].get<double>(), 11.4, 0.5);
  EXPECT_NEAR(effect(all, "step")["inside_m"]["p95"].get<double>(), 11.4, 0.5);
  EXPECT_LT(all["rest"]["difference"]["inside_m"]["p95"].get<double>(), 0.2);
  EXPECT_LT(all["on_disk"]["against_bellhop"]["inside_m"]["max"].get<double>(), 1e-6);
  EXPECT_FALSE(all["advice"].empty());
}

// In this shallow water it is the number of beams: 1.4 dB of 1.4 at 95 %, the step 0.01 (README of
// the reference).
TEST(Explain, SaysWhatTheFanDoes) {
  const json all = explanation("'" + data + "grain-semicoherent/case'");
  EXPECT_NEAR(all["total"]["tl_db"]["p95"].get<double>(), 1.43, 0.1);
  EXPECT_GT(effect(all, "number of beams")["tl_db"]["p95"].get<double>(), 1.0);
  EXPECT_LT(effect(all, "step")["tl_db"]["p95"].get<double>(), 0.05);
  EXPECT_LT(effect(all, "single precision")["tl_db"]["p95"].get<double>(), 1e-4);
  EXPECT_LT(all["on_disk"]["against_bellhop"]["tl_db"]["p95"].get<double>(), 1e-4);
}

TEST(Explain, ToldForPeopleIsATableAndAdvice) {
  const support::TemporaryDirectory folder;
  const auto outcome = asdic(folder, "explain '" + data + "eigenrays-channel/case' -q");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("step 500 m, 1001 beams"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("number of beams"), std::string::npos);
  EXPECT_NE(outcome.out.find("is what BELLHOP makes of this input"), std::string::npos);
}

// A file beside the case is BELLHOP's unless the .prt is signed by asdic.
TEST(Explain, SaysWhoseFileItIs) {
  const support::TemporaryDirectory folder;
  for (const char* name : {"case.env", "case.bty", "case.ray"})
    std::filesystem::copy_file(data + "rays-upslope/" + name, folder.path() / name);
  const auto writer = [&] {
    const auto outcome = asdic(folder, "explain case --json -q");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["on_disk"]["written_by"];
  };
  EXPECT_EQ(writer(), "unknown");
  std::ofstream(folder.path() / "case.prt") << " BELLHOP/BELLHOP3D\n rays, upslope\n";
  EXPECT_EQ(writer(), "BELLHOP");
  EXPECT_EQ(asdic(folder, "bellhop case -q").status, 0);
  EXPECT_EQ(writer(), "asdic");
  EXPECT_EQ(asdic(folder, "bellhop case --like-bellhop -q").status, 0);
  EXPECT_EQ(writer(), "asdic --like-bellhop");
}

TEST(Explain, ACaseThatIsNotThereIsAFault) {
  const support::TemporaryDirectory folder;
  const auto outcome = asdic(folder, "explain nowhere");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("nowhere.env"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace asdic::detail
