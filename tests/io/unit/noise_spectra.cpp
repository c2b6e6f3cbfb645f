#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>

#include "core/fields_viewer.h"
#include "core/settings_words.h"
#include "io/settings/reader.h"
#include "sonar/scenario/noise_settings.h"
#include "support/member_count.h"
#include "support/pink_noise.h"

namespace asdic::detail {
namespace {

template <class Variant>
struct LawsOf;
template <class... Law>
struct LawsOf<std::variant<Law...>> {
  using Types = testing::Types<Law..., PinkNoise>;
};
template <class Law>
class EveryNoiseSpectrum : public testing::Test {};
TYPED_TEST_SUITE(EveryNoiseSpectrum, LawsOf<AnyNoise>::Types);

TYPED_TEST(EveryNoiseSpectrum, IsFiniteAtAnyFrequency) {
  const TypeParam law{};
  for (const double f : {0.0, 1e-3, 1.0, 33.0, 1000.0, 47e3, 1e6})
    EXPECT_TRUE(std::isfinite(law.level_at(f))) << f;
  EXPECT_FALSE(law.text().empty());
  EXPECT_FALSE(TypeParam::name.empty());
}

/// Counts the settings of a struct, each column of a table one.
class MembersSeen final : public FieldsViewer {
 public:
  int seen = 0;
  void columns(std::initializer_list<Column> all, const ColumnRules&) override {
    seen += static_cast<int>(all.size());
  }

 private:
  void number(const Setting&, const Quantity& q, double& value, bool*) override {
    ++seen;
    EXPECT_TRUE(q.holds(value)) << "the default of " << q.noun;
  }
};
TYPED_TEST(EveryNoiseSpectrum, EveryMemberIsDescribedAndItsDefaultAllowed) {
  MembersSeen members;
  look(TypeParam{}, members);
  EXPECT_EQ(members.seen, support::member_count<TypeParam>());
}

// What docs/develop/recipes.md promises of a law: its file and its name in a list are all.
TEST(NoiseSpectrumRecipe, AFileAndAWordAreALawThatFilesMayName) {
  std::variant<WhiteNoise, PinkNoise> law;
  const TomlValue file = parse_toml("kind = \"pink\"\nlevel_db = 50\n", "s.toml");
  TomlTable table(file);
  KnownSettings known;
  TomlReader(table, known).one_of("kind", law, "the law");
  table.finish();
  const auto& pink = std::get<PinkNoise>(law);
  EXPECT_NEAR(pink.level_at(100.0), 60.0, 1e-12);
  EXPECT_NE(settings_words(pink), settings_words(PinkNoise{}));
  EXPECT_EQ(pink.text(), "pink, 50 dB at 1 kHz");
}

TEST(NoiseSpectrumRecipe, ThePageHasTheExampleThatIsCompiledHere) {
  const std::filesystem::path root = std::filesystem::path(ASDIC_TEST_DATA) / ".." / "..";
  const auto text_of = [&](const char* name) {
    std::ostringstream text;
    text << std::ifstream(root / name).rdbuf();
    return text.str();
  };
  const std::string example = text_of("tests/support/pink_noise.h");
  const std::size_t begin = example.find("/// A level that falls"),
                    end = example.find("\n}  // namespace asdic::detail");
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  EXPECT_NE(text_of("docs/develop/recipes.md").find(example.substr(begin, end - begin)),
            std::string::npos);
}

// The key of what is remembered of a field of noise: all of what its kind looks at, and no more.
TEST(NoiseField, WordsAreThoseOfItsKind) {
  const NoiseField sheet{.coherence = NoiseCoherence::surface, .directions = {}};
  NoiseField steeper = sheet;
  steeper.directions.dipole_exponent = 2.0;
  EXPECT_NE(settings_words(sheet), settings_words(steeper));
  NoiseField profile{
      .coherence = NoiseCoherence::profile,
      .directions = {.dipole_exponent = 1.0, .elevation = {-0.5, 0.5}, .level_db = {0.0, 1.0}}};
  EXPECT_NE(settings_words(sheet), settings_words(profile));
  NoiseField other = profile;
  other.directions.elevation[1] = 0.25;
  EXPECT_NE(settings_words(profile), settings_words(other));
  other = profile;
  other.directions.level_db[1] = 0.5;
  EXPECT_NE(settings_words(profile), settings_words(other));
  other = profile;
  other.directions.dipole_exponent = 2.0;  // of the sheet alone
  EXPECT_EQ(settings_words(profile), settings_words(other));
}

}  // namespace
}  // namespace asdic::detail
