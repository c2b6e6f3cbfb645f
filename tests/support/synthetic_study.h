#pragma once
#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "study/reader/study_reader.h"
#include "study/runs/run_study.h"
#include "support/program.h"

namespace asdic::detail::support {

/// A study without a sea: rows that cost next to nothing, so that what carries them can be tested
/// with 10⁵ of them. x is uniform, y = x + noise, every 7th row is skipped if asked for, and
/// every `series_every`-th keeps a short time series whose length differs from row to row; every
/// `kept_every`-th spectra of as many lengths, and detections of which there may be none.
struct SyntheticStudy {
  std::uint64_t realisations = 100;
  bool skips = false;
  std::uint64_t series_every = 0;  ///< 0: none
  std::uint64_t kept_every = 0;
  std::string identity = "synthetic";

  [[nodiscard]] study::Row row(std::uint64_t index) const {
    RandomStream stream(1, Draw::ambient_noise, static_cast<std::uint32_t>(index), 0);
    study::Row row{.index = index};
    const double x = stream.uniform();
    row.values = {x, x + 0.1 * stream.normal(), static_cast<double>(index % 3)};
    if (skips && index % 7 == 3) {
      row.valid = false;
      row.fault = "the target lies below the bottom";
      row.values[1] = std::nan("");
    }
    if (series_every > 0 && index % series_every == 0) {
      row.pressure_shape = {2, 3 + index % 4};
      row.timing = {.sample_rate = 100.0 / 3.0 + static_cast<double>(index),
                    .start = 0.1 * static_cast<double>(index),
                    .carrier = 1e3,
                    .epoch = -0.7};
      for (std::size_t i = 0; i < row.pressure_shape[0] * row.pressure_shape[1]; ++i)
        row.pressure.push_back(static_cast<float>(stream.normal()));
    }
    if (row.valid && study::keeps(kept_every, index)) {
      row.kept = {{.name = "spectra", .shape = {2, 3 + index % 4}, .head = {1.5, 0.1, 7.0}},
                  {.name = "detections",
                   .shape = {index / kept_every % 3, study::detections_kind().values.size()}}};
      row.kept[0].head[1] *= static_cast<double>(index + 1);
      for (study::KeptArray& array : row.kept)
        for (std::size_t i = 0; i < array.shape[0] * array.shape[1]; ++i)
          array.values.push_back(stream.normal());
      for (std::size_t i = 0; i < row.kept[1].values.size(); ++i)
        if (study::detections_kind().values[i % row.kept[1].shape[1]].type == ElementType::int32)
          row.kept[1].values[i] = static_cast<double>(i % 5) - 2.0;
    }
    return row;
  }

  [[nodiscard]] study::Work work() const {
    using study::Column;
    study::Work work;
    work.fingerprint = {
        .identity = identity,
        .title = "synthetic",
        .seed = 1,
        .realisations = realisations,
        .design = "random",
        .text = "[study]\n",
        .scenario_text = "seed = 1\n",
        .columns = {
            {.name = "x", .unit = "m", .meaning = "input", .role = Column::Role::input},
            {.name = "y", .unit = "m", .meaning = "measure"},
            {.name = "reused", .unit = "1", .meaning = "how", .role = Column::Role::reuse}}};
    work.realise = [*this](std::uint64_t index) { return row(index); };
    work.summarise = [](const study::Table& table) {
      double sum = 0.0;
      for (std::size_t i = 0; i < table.index.size(); ++i)
        if (table.valid[i] != 0) sum += table.values[1][i];
      return study::Summary{.tables = {{.name = "sum",
                                        .title = "of y",
                                        .columns = {{.name = "sum", .unit = "m", .meaning = "sum"}},
                                        .values = {{sum}}}}};
    };
    work.estimate = [] { return estimate(); };
    return work;
  }

  /// Of the mean of y, the first measure: a real study with as many inputs gives its kind.
  [[nodiscard]] static study::RunningEstimate estimate() {
    static const study::RunningEstimate empty = [] {
      const TemporaryDirectory folder;
      const auto path = folder.write("study.toml", std::string(small_scenario) + R"(
[study]
realisations = 100
[vary]
"target.0.strength_db" = { law = "uniform", low = 0, high = 10 }
[measure]
echo_level = true
)");
      return study::RunningEstimate(study::read_study(path));
    }();
    return empty;
  }
};

}  // namespace asdic::detail::support
