#include "study/expression/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "core/error.h"

namespace asdic::detail::study {
namespace {

const std::vector<std::string> known{"wind_speed", "depth", "range"};

double value(const std::string& text, const std::vector<double>& values = {}) {
  return Expression(text, known, "here").at(values);
}

std::string fault_of(const std::string& text, const std::vector<std::string>& names = known) {
  try {
    static_cast<void>(Expression(text, names, "study.toml:3: vary.x.value"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(Expression, IsWhatItSays) {
  const Expression formula("0.5 * wind_speed + depth ^ 2", known, "here");
  EXPECT_EQ(formula.names(), (std::vector<std::string>{"depth", "wind_speed"}));
  EXPECT_EQ(formula.at(std::vector<double>{3.0, 8.0}), 13.0);
  EXPECT_EQ(formula.at(std::vector<double>{1.0, 2.0}), 2.0);
  const Expression copy = formula;
  EXPECT_EQ(copy.at(std::vector<double>{3.0, 8.0}), 13.0);
}

TEST(Expression, FunctionsAreThoseOfTheBooks) {
  EXPECT_EQ(value("pi"), std::numbers::pi);  // all digits
  EXPECT_EQ(value("e"), std::numbers::e);
  EXPECT_EQ(value("log(10) - ln(10)"), 0.0);
  EXPECT_NEAR(value("log(e)"), 1.0, 1e-15);
  EXPECT_EQ(value("log10(1000)"), std::log10(1000.0));
  EXPECT_EQ(value("2 ^ 3 ^ 2"), 512.0);
  EXPECT_EQ(value("-2 ^ 2"), -4.0);
  EXPECT_EQ(value("floor(-2.5) + 10 * ceil(-2.5) + 100 * round(2.5)"), 277.0);
  EXPECT_EQ(value("min(3, 1, 2) + max(3, 1, 2)"), 4.0);
  EXPECT_EQ(value("depth > 10 && depth <= 20 ? 1 : 2", {20.0}), 1.0);
  EXPECT_EQ(value("depth > 10 && depth <= 20 ? 1 : 2", {10.0}), 2.0);
  EXPECT_TRUE(std::isnan(value("sqrt(0 - depth)", {1.0})));
  for (const std::string& name : expression_functions())
    EXPECT_EQ(fault_of(name + "(0.5" + (name == "atan2" ? ", 1" : "") + ")"), "no fault") << name;
}

TEST(Expression, FaultsAreTold) {
  const std::string at = "study.toml:3: vary.x.value: found ";
  EXPECT_EQ(fault_of("0.5 * wind_sped"),
            at + "the name \"wind_sped\", expected one of \"wind_speed\", \"depth\" or \"range\" "
                 "(did you mean \"wind_speed\"?)");
  EXPECT_EQ(fault_of("2 * x", {}),
            at + "the name \"x\", expected numbers alone: there is no name to be had here");
  EXPECT_EQ(fault_of("depth = 3"),
            at + "\"depth = 3\", which sets what stands before =, expected == to compare");
  EXPECT_EQ(fault_of("depth, range"), at + "\"depth, range\", 2 values, expected one value");
  EXPECT_TRUE(fault_of("depth +").starts_with(
      at +
      "\"depth +\" (Unexpected end of expression at position 8), expected a formula such as "
      "\"0.5 * wind_speed + 3\", of numbers, names, pi, e and \"abs\", "))
      << fault_of("depth +");
  for (const char* text :
       {"", "(depth", "depth range", "foo(depth)", "\"text\"", "depth; 3", "2depth"})
    EXPECT_TRUE(fault_of(text).starts_with(at)) << text << ": " << fault_of(text);
}

TEST(Expression, NamesAreFoundBeforeTheyAreKnown) {
  EXPECT_EQ(names_in("a + b * sin(a)"), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(names_in("a +").empty());
  EXPECT_TRUE(names_in("pi + e").empty());
}

// Several threads make rows of one study.
TEST(Expression, ThreadsComputeTheSame) {
  const Expression formula("depth * 1000 + range", known, "here");
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20000; ++i) {
        const double x = double(t), y = double(i);
        wrong[t] += formula.at(std::vector<double>{x, y}) != x * 1000.0 + y;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4));
}

}  // namespace
}  // namespace asdic::detail::study
