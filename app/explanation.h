#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/compare_output.h"
#include "io/bellhop/case_reader.h"
#include "raytrace/bellhop_emulation/bellhop_emulation.h"

namespace asdic::detail::app {

/// What one of BELLHOP's habits changes in its answer.
struct Effect {
  std::string name;       ///< "step"
  std::string setting;    ///< "500 m -> 25 m"
  Comparison difference;  ///< BELLHOP as asked, against the same with this alone improved
};

/// A case as BELLHOP does it, as it should be, and what lies between.
struct Explanation {
  std::string title, kind;      ///< "coherent field, hat beams"
  double frequency = 0.0;       ///< [Hz]
  double step = 0.0;            ///< BELLHOP's [m]
  std::size_t beams = 0;        ///< BELLHOP's
  std::string truth;            ///< what is taken for it
  Comparison total;             ///< BELLHOP as asked, against the truth
  std::vector<Effect> effects;  ///< each alone
  std::optional<Effect> rest;   ///< BELLHOP with all of them improved, against the truth
  struct OnDisk {
    std::string file;
    /// By what ROOT.prt beside it says; without one a file is taken for BELLHOP's.
    enum class Writer { unknown, bellhop, asdic, asdic_bellhop_emulation } writer = Writer::unknown;
    Comparison bellhop_emulation;  ///< the file against BELLHOP as asked, run here
    Comparison truth;              ///< the file against the truth
  };
  std::optional<OnDisk> on_disk;
  std::vector<std::string> advice, notes;
};

/// How much finer the improved runs are.
struct ExplainOptions {
  double finer_step = 10.0;  ///< divides BELLHOP's step
  double denser_fan = 4.0;   ///< multiplies BELLHOP's number of beams
};

/// Runs the case as often as it takes. \param root  where a .shd, .arr or .ray may lie
/// \param progress  called with the share that is done; false stops (Interrupted)
[[nodiscard]] Explanation explain(const bellhop::Input& input, const std::filesystem::path& root,
                                  const ExplainOptions& options, const Progress& progress);

/// What the figures mean for somebody who has such files.
[[nodiscard]] std::vector<std::string> advice_on(const Explanation& explanation);

[[nodiscard]] std::string explanation_table(const Explanation& explanation);
[[nodiscard]] std::string explanation_json(const Explanation& explanation);

}  // namespace asdic::detail::app
