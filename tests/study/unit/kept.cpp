#include "study/measures/kept_array.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/units.h"
#include "io/scenario/scenario_reader.h"
#include "study/measures/measures.h"
#include "study/reader/study_reader.h"
#include "study/runs/merge.h"
#include "study/runs/run_study.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// What rows keep beside their columns: spectra and detections of the plain sea.
namespace asdic::detail::study {
namespace {

const std::vector<std::string> loud{"transmitter.source_level_db=225", "array.phones=8"},
    silent{"transmitter.source_level_db=60"};

class Kept : public testing::Test {
 protected:
  Study read(const std::string& measure, std::vector<std::string> overrides = loud) {
    return read_study(
        folder_.write("study.toml", "[study]\nrealisations = " + std::to_string(realisations_) +
                                        "\n" + measure + support::plain_sea),
        overrides);
  }
  /// Runs a range of it. \return its file
  std::filesystem::path run(const Study& study, const std::string& name, IndexRange range) {
    const Realiser realiser(study);
    run_study(work_of(study, realiser), {.output = folder_ / name, .range = range});
    return folder_ / name;
  }

  support::TemporaryDirectory folder_;
  int realisations_ = 4;
};

const KeptArray& kept_of(const Row& row, const KeptKind& kind) {
  for (const KeptArray& array : row.kept)
    if (array.name == kind.name) return array;
  throw std::runtime_error("not kept: " + std::string(kind.name));
}

/// What is no number in both is the same.
void expect_same(const KeptArray& a, const KeptArray& b) {
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.head, b.head);
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    EXPECT_TRUE(a.values[i] == b.values[i] || (std::isnan(a.values[i]) && std::isnan(b.values[i])))
        << a.name << ' ' << i;
}

double value(const Study& study, const Row& row, const std::string& name) {
  const std::vector<Column> all = columns(study);
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name) return row.values.at(c);
  throw std::runtime_error("no column " + name);
}

/// Of each detection one of its numbers.
std::vector<double> numbers(const KeptArray& detections, const std::string& name) {
  const std::vector<KeptColumn>& all = detections_kind().values;
  std::vector<double> found;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name)
      for (std::size_t i = 0; i < detections.shape[0]; ++i)
        found.push_back(detections.values.at(i * all.size() + c));
  return found;
}

const std::string by_receiver =
    "[measure]\ndetection = { by = \"receiver\", false_alarm_probability = 1e-4 }\n"
    "localisation_error = true\ndetections = 2\n[measure.receiver]\ntarget_depth = 100.0\n";

// The receiver's own answers to the same ping, number by number.
TEST_F(Kept, DetectionsAreTheReceivers) {
  const Study study = read(by_receiver);
  const PingSimulator simulator(scenario_of(study.scenario, study.scenario_path));
  EXPECT_TRUE(
      measure(read("[measure]\necho_level = true\n"), simulator).receiver.places.owner.empty());
  const Measured made = measure(study, simulator, all_measures, nullptr, nullptr, true);
  const ReceiverAnswers answers =
      receiver_answers(simulator, made.record, study.measure.receiver, 0);
  const KeptArray kept = kept_detections(made.receiver);
  ASSERT_EQ(kept.shape,
            (std::vector<std::size_t>{answers.detections.size(), detections_kind().values.size()}));
  ASSERT_GT(answers.detections.size(), 0U);
  for (std::size_t i = 0; i < answers.detections.size(); ++i) {
    const Detection& one = answers.detections[i];
    EXPECT_EQ(numbers(kept, "time")[i], one.time);
    EXPECT_EQ(numbers(kept, "doppler_factor")[i], one.doppler);
    EXPECT_EQ(numbers(kept, "snr_db")[i], one.snr_db);
    EXPECT_EQ(numbers(kept, "excess_db")[i], one.excess_db);
    EXPECT_EQ(numbers(kept, "level_db")[i], one.level_db);
    EXPECT_EQ(numbers(kept, "target")[i], answers.places.owner[i]);
    ASSERT_FALSE(one.locations.empty());
    EXPECT_EQ(numbers(kept, "range")[i], one.locations[0].range);
    EXPECT_EQ(numbers(kept, "bearing_deg")[i], compass_degrees(one.locations[0].bearing));
    EXPECT_EQ(numbers(kept, "range_rate")[i], one.locations[0].range_rate);
  }
}

// The columns of a row and what it keeps are of one receiver: the loudest detection of target 0 is
// the one that is told, and all that are nobody's are false alarms.
TEST_F(Kept, DetectionsAgreeWithTheColumns) {
  realisations_ = 12;
  const Study study = read(by_receiver);
  const Realiser realiser(study);
  EXPECT_TRUE(realiser.realise(1).kept.empty());
  double alarms = 0.0;
  for (const std::uint64_t index : {0U, 2U, 4U, 6U, 8U, 10U}) {
    const Row row = realiser.realise(index);
    const KeptArray& kept = kept_of(row, detections_kind());
    const std::vector<double> snr = numbers(kept, "snr_db"), target = numbers(kept, "target"),
                              range = numbers(kept, "range");
    double loudest = -infinity, far = 0.0, nobodys = 0.0;
    for (std::size_t i = 0; i < snr.size(); ++i) {
      if (target[i] == -1.0) ++nobodys;
      if (target[i] == 0.0 && snr[i] > loudest) loudest = snr[i], far = range[i];
    }
    EXPECT_EQ(value(study, row, "detected"), 1.0);
    EXPECT_EQ(value(study, row, "detection_snr_db"), loudest);
    EXPECT_EQ(value(study, row, "false_alarms"), nobodys);
    EXPECT_NEAR(value(study, row, "range_error"), far - 3000.0, 1e-6);
    alarms += nobodys;
  }
  EXPECT_GT(alarms, 0.0);  // some 10⁴ cells a row: there is something to tell apart
}

// Without a measure of the receiver the same detections are kept, and there are no more columns:
// the receiver listens in these rows alone.
TEST_F(Kept, DetectionsAloneAddNoColumns) {
  const std::string receiver =
      "[measure.receiver]\ntarget_depth = 100.0\nfalse_alarm_probability = 1e-4\n";
  const Study plain = read("[measure]\necho_level = true\n"),
              study = read("[measure]\necho_level = true\ndetections = \"all\"\n" + receiver);
  EXPECT_EQ(to_json(columns(plain)), to_json(columns(study)));
  const Row row = Realiser(study).realise(2);
  EXPECT_EQ(row.values, Realiser(plain).realise(2).values);
  expect_same(kept_of(row, detections_kind()),
              kept_of(Realiser(read(by_receiver)).realise(2), detections_kind()));
}

// A row in which nothing is detected is there, with none; one that was not asked for is not.
TEST_F(Kept, ARowWithoutDetectionsIsToldFromOneThatKeepsNone) {
  const Study study = read(
      "[measure]\ndetections = 3\n[measure.receiver]\nfalse_alarm_probability = 1e-15\n", silent);
  const auto a = run(study, "a.h5", {0, 2}), b = run(study, "b.h5", {2, 4});
  for (const bool copy : {true, false}) {
    const auto all = folder_ / (copy ? "copy.h5" : "catalogue.h5");
    merge({a, b}, all, [](const Fingerprint&, const Table&) { return Summary{}; }, {.copy = copy});
    const StudyFile file(all);
    EXPECT_NO_THROW(file.verify());
    const Hdf5File& data = file.file();
    EXPECT_EQ(data.read<std::int64_t>("detections/index"), (std::vector<std::int64_t>{0, 3}));
    EXPECT_EQ(data.read<std::int32_t>("detections/count"), (std::vector<std::int32_t>{0, 0}));
    EXPECT_EQ(data.info("detections/time").shape, Shape{0});
    EXPECT_EQ(KeptReader(file, detections_kind()).at(1).shape[0], 0U);
    EXPECT_FALSE(data.has("spectra/index"));
  }
}

// The file, its merged parts, and one that was continued have what the rows have.
TEST_F(Kept, FilesHaveWhatRowsHave) {
  realisations_ = 5;
  const Study study = read(
      "[vary]\n\"pings.baseband_rate\" = { law = \"list\", values = [300, 500] }\n"
      "\"transmitter.source_level_db\" = { law = \"list\", values = [225, 60, 225] }\n"
      "[measure]\nspectra = { resolution = 20.0, phones = \"each\" }\ndetections = \"all\"\n"
      "[measure.receiver]\nfalse_alarm_probability = 1e-12\n");
  const auto a = run(study, "a.h5", {0, 2}), b = run(study, "b.h5", {2, 5});
  run(study, "grown.h5", {0, 2});
  run(study, "grown.h5", {0, 5});
  const auto merged = [&](const std::string& name, bool copy) {
    merge({b, a}, folder_ / name, [](const Fingerprint&, const Table&) { return Summary{}; },
          {.copy = copy});
    return folder_ / name;
  };
  const Realiser realiser(study);
  for (const auto& path :
       {merged("copy.h5", true), merged("shown.h5", false), folder_ / "grown.h5"}) {
    const StudyFile file(path);
    EXPECT_NO_THROW(file.verify());
    for (const KeptKind& kind : kept_kinds()) {
      KeptReader reader(file, kind);
      ASSERT_EQ(reader.told().index, (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
      for (const std::size_t k : {3U, 0U, 1U, 2U, 4U}) {
        const Row row = realiser.realise(k);
        expect_same(reader.at(k), kept_of(row, kind));
      }
    }
    const Hdf5File& data = file.file();
    EXPECT_EQ(data.read<std::int32_t>("detections/count"),
              (std::vector<std::int32_t>{1, 0, 1, 1, 0}));
    EXPECT_EQ(data.read<std::int64_t>("detections/realisation"),
              (std::vector<std::int64_t>{0, 2, 3}));
    EXPECT_EQ(data.read<std::int32_t>("detections/target"), (std::vector<std::int32_t>{0, 0, 0}));
    const auto time = data.read<double>("detections/time");
    for (const double t : time) EXPECT_NEAR(t, 4.0, 0.02);  // 3 km there and back at 1500 m/s
    // Shorter spectra are padded with what is no number.
    const auto power = data.read<double>("spectra/power");
    const auto valid = data.read<std::int32_t>("spectra/valid_frequencies");
    const Shape shape = data.info("spectra/power").shape;
    EXPECT_EQ(shape[1], 8U);
    EXPECT_LT(valid[0], valid[1]);
    EXPECT_EQ(shape[2], static_cast<std::size_t>(valid[1]));
    EXPECT_FALSE(std::isnan(power[static_cast<std::size_t>(valid[0]) - 1]));
    EXPECT_TRUE(std::isnan(power[static_cast<std::size_t>(valid[0])]));
  }
}

// White noise of 40 dB re 1 µPa²/Hz, 10⁻⁸ Pa²/Hz: in the middle half of the band, far from the
// filters' edges. 8 s at a step of 4 Hz are 63 segments of two phones; the mean of n bins, each of
// which shares with its neighbours, scatters by less than √(3/(63·2·n)).
TEST_F(Kept, SpectrumOfWhiteNoiseHasItsLevel) {
  for (const bool baseband : {true, false}) {
    std::vector<std::string> overrides = silent;
    if (!baseband)
      overrides.insert(overrides.end(), {"pings.samples=pressure", "pings.sample_rate=4000.0"});
    const Study study = read("[measure]\nspectra = { every = 2, resolution = 4.0 }\n", overrides);
    const Realiser realiser(study);
    EXPECT_TRUE(realiser.realise(1).kept.empty());
    const KeptArray kept = kept_of(realiser.realise(2), spectra_kind());
    ASSERT_EQ(kept.shape[0], 1U);
    const double first = kept.head[0], step = kept.head[1];
    EXPECT_LE(step, 4.0);
    EXPECT_GT(step, 3.0);
    EXPECT_GE(kept.head[2], 60.0);
    const std::size_t n = kept.shape[1];
    const double last = first + step * static_cast<double>(n - 1);
    if (baseband)
      EXPECT_NEAR(0.5 * (first + last + step), 1000.0, 1e-6);  // about the carrier
    else
      EXPECT_TRUE(first == 0.0 && std::abs(last - 2000.0) < 1e-6);
    const double mean =
        std::accumulate(kept.values.begin() + static_cast<std::ptrdiff_t>(n / 4),
                        kept.values.begin() + static_cast<std::ptrdiff_t>(3 * n / 4), 0.0) /
        static_cast<double>(3 * n / 4 - n / 4);
    EXPECT_NEAR(mean / 1e-8, 1.0, 5.0 * std::sqrt(3.0 / (126.0 * static_cast<double>(n / 2))));
  }
}

// Each phone's own, in the order of the time series that the row keeps: Σ S Δf is half the mean of
// Σ w²|x|²/Σ w² of that phone (Parseval), and the mean of all is their mean. Samples are float.
TEST_F(Kept, SpectraAreOfThePhones) {
  const Study
      each = read(
          "[measure]\ntime_series = \"all\"\nspectra = { resolution = 2.0, phones = \"each\" }\n"),
      mean = read("[measure]\nspectra = { resolution = 2.0 }\n");
  const Row row = Realiser(each).realise(3);
  const KeptArray &all = kept_of(row, spectra_kind()),
                  one = kept_of(Realiser(mean).realise(3), spectra_kind());
  ASSERT_EQ(all.shape[0], 8U);
  const std::size_t n = all.shape[1], samples = row.pressure_shape[1];
  EXPECT_EQ(one.shape, (std::vector<std::size_t>{1, n}));
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0.0;
    for (std::size_t phone = 0; phone < 8; ++phone) sum += all.values[phone * n + k] / 8.0;
    EXPECT_NEAR(one.values[k] / sum, 1.0, 1e-12);
  }
  for (std::size_t phone = 0; phone < 8; ++phone) {
    double power = 0.0, weight = 0.0, density = 0.0;
    for (std::size_t first = 0; first + n <= samples; first += n / 2)
      for (std::size_t i = 0; i < n; ++i) {
        const float* x = row.pressure.data() + 2 * (phone * samples + first + i);
        const double w = std::pow(std::sin(pi * double(i) / double(n)), 4);
        power += 0.5 * w * (double(x[0]) * double(x[0]) + double(x[1]) * double(x[1]));
        weight += w;
      }
    for (std::size_t k = 0; k < n; ++k) density += all.values[phone * n + k] * all.head[1];
    EXPECT_NEAR(density * weight / power, 1.0, 1e-9);
  }
}

TEST_F(Kept, ARecordTooShortForTheResolutionSaysSo) {
  const Study study = read("[measure]\nspectra = { resolution = 0.01 }\n");
  try {
    static_cast<void>(Realiser(study).realise(0));
    FAIL() << "it was made";
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("measure.spectra.resolution"), std::string::npos) << said;
    EXPECT_NE(said.find("0.01 Hz"), std::string::npos) << said;
  }
  // Left to the record it is 1 Hz, or what eight segments half over one another allow.
  const KeptArray by_default =
      kept_of(Realiser(read("[measure]\nspectra = \"all\"\n")).realise(0), spectra_kind());
  EXPECT_LE(by_default.head[1], 1.0);
  EXPECT_GT(by_default.head[1], 0.8);
  const KeptArray shorter = kept_of(
      Realiser(read("[measure]\nspectra = \"all\"\n",
                    {"pings.recording_duration=1.0", "target.0.position=[300.0,0.0,100.0]"}))
          .realise(0),
      spectra_kind());
  EXPECT_NEAR(shorter.head[1], 4.5, 0.5);
  EXPECT_GE(shorter.head[2], 8.0);
}

// A study of noise alone keeps what the receiver takes for an echo.
TEST_F(Kept, FalseAlarmsOfASeaWithoutTargetsAreKept) {
  std::string sea = support::plain_sea;
  const auto target = sea.find("[[target]]");
  sea.erase(target, sea.find("[noise]") - target);
  const Study study = read_study(folder_.write(
      "noise.toml",
      "[study]\nrealisations = 2\n[measure]\ndetections = \"all\"\n[measure.receiver]\n"
      "false_alarm_probability = 1e-2\n" +
          sea));
  const KeptArray kept = kept_of(Realiser(study).realise(0), detections_kind());
  EXPECT_GT(kept.shape[0], 0U);
  for (const double target_of : numbers(kept, "target")) EXPECT_EQ(target_of, -1.0);
}

}  // namespace
}  // namespace asdic::detail::study
