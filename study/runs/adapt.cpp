#include "study/runs/adapt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "core/text.h"
#include "io/text/toml_writer.h"
#include "study/measures/realisation.h"
#include "study/measures/sampler.h"
#include "study/runs/run.h"

namespace asdic::detail::study {
namespace {

constexpr double part_of_rows = 0.04;  // that those which are fitted are worth
constexpr std::size_t enough = 5;      // rows of the event, where levels come no nearer

/// Of a level: no other study's, nor this one's own.
std::uint64_t seed_of_level(const Study& study, int level) {
  const auto words =
      RandomStream(study.seed, Draw::study_input, 0xFFFFFFF0U, static_cast<std::uint64_t>(level))
          .block(0);
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

/// The mixture that the reader makes of components.
Proposal mixture_of(const std::vector<ProposalPart>& components, const RarePlan& plan) {
  if (components.empty()) return {};
  std::vector<ProposalPart> parts{{.name = "laws", .share = plan.share, .guards = true}};
  if (plan.wide > 0.0) {
    ProposalPart wide{.name = "wide", .share = plan.wide, .guards = true};
    wide.draws.assign(components.front().draws.size(), ScoreLaw{0.0, plan.spread});
    parts.push_back(std::move(wide));
  }
  double sum = 0.0;
  for (const ProposalPart& part : components) sum += part.share;
  for (ProposalPart part : components) {
    part.share *= (1.0 - plan.share - plan.wide) / sum;
    parts.push_back(std::move(part));
  }
  return Proposal(std::move(parts));
}

/// The columns of the event where rows have weights, which stand before the measures.
void place_event(Study& study) {
  const std::vector<Column> all = columns(study);
  RareEvent& event = *study.rare.event;
  event.columns.clear();
  for (const std::string& name : event.excess.names())
    event.columns.push_back(static_cast<std::size_t>(
        std::find_if(all.begin(), all.end(),
                     [&](const Column& column) { return column.name == name; }) -
        all.begin()));
}

/// A few digits: it is to be looked at.
std::string short_text_of(double x) {
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.3g", x);
  return {text.data(), static_cast<std::size_t>(length)};
}

/// One level's rows. \param known  those whose event is known
std::vector<LevelRow> rows_of(const Study& study, std::uint64_t& made,
                              const std::stop_token& stop) {
  const Realiser realiser(study);
  const Sampler sampler(study);
  const std::size_t weight = [&] {
    const std::vector<Column>& all = sampler.columns();
    return static_cast<std::size_t>(
        std::find_if(all.begin(), all.end(),
                     [](const Column& column) { return column.name == log_weight_column; }) -
        all.begin());
  }();
  std::vector<LevelRow> rows;
  std::uint64_t next = 0;
  made =
      run([&](std::uint64_t index) { return realiser.realise(index); },
          [&]() -> std::optional<std::uint64_t> {
            if (next == study.realisations) return {};
            return next++;
          },
          [&](Row&& row) {
            const double excess = row.valid ? study.rare.event->excess_of(row.values) : no_value;
            if (std::isnan(excess)) return true;
            LevelRow one{.scores = std::vector<double>(sampler.dimensions()),
                         .log_weight = weight < sampler.columns().size() ? row.values[weight] : 0.0,
                         .excess = excess};
            static_cast<void>(sampler.point(row.index, one.scores));
            for (double& u : one.scores) u = normal_score(u);
            rows.push_back(std::move(one));
            return true;
          },
          {.stop = stop});
  if (stop.stop_requested())
    throw RunError("interrupted: nothing is written, the same command begins anew");
  return rows;
}

InputError not_reached(const Study& study, const std::string& got) {
  return InputError({.where = study.path.string() + ": rare.event",
                     .got = got,
                     .expected = "an event that rows come nearer to from level to level: of a "
                                 "measure that varies by degrees (detection_signal_excess_db > 0, "
                                 "not detected > 0); more rare.levels or rare.rows_per_level"});
}

}  // namespace

std::vector<ProposalPart> adapt(const Study& study,
                                const std::function<void(const AdaptedLevel&)>& tell,
                                const std::stop_token& stop) {
  if (!study.rare.event)
    throw InputError({.where = study.path.string() + ": rare",
                      .got = "no event",
                      .expected = "[rare] with event = \"echo_to_background_db > 12\", or another "
                                  "comparison of columns, beside --adapt"});
  if (is_weighted(study))
    throw InputError({.where = study.path.string() + ": rare",
                      .got = study.rare.has_components ? "[[rare.component]]" : "a proposal",
                      .expected = "none beside --adapt, which finds it"});
  if (study.design == Design::grid || study.design == Design::saltelli)
    throw InputError({.where = study.path.string() + ": study.design",
                      .got = in_quotes(name(study.design)),
                      .expected = "\"random\", \"latin_hypercube\" or \"sobol\" beside --adapt"});
  if (Sampler(study).dimensions() == 0)
    throw InputError({.where = study.path.string() + ": vary",
                      .got = "no input that is drawn",
                      .expected = "at least one, from elsewhere than its law"});
  Study of_level = study;
  of_level.design = Design::random;
  of_level.design_options = {};
  of_level.realisations = static_cast<std::uint64_t>(study.rare.rows_per_level);
  of_level.measure.series_every = 0;
  std::vector<ProposalPart> components;
  double best = -std::numeric_limits<double>::infinity();
  int idle = 0;  // levels that came no nearer
  for (int number = 1; number <= study.rare.levels; ++number) {
    of_level.seed = seed_of_level(study, number);
    of_level.proposal = mixture_of(components, study.rare);
    place_event(of_level);
    AdaptedLevel told{.number = number};
    const std::vector<LevelRow> rows = rows_of(of_level, told.made, stop);
    told.known = rows.size();
    if (rows.empty())
      throw not_reached(
          study, "no row of " + std::to_string(told.made) + " in which its columns are known");
    const auto count = static_cast<double>(told.made);
    told.level = next_level(rows, count, part_of_rows * count, of_level.seed);
    if (tell) tell(told);
    components = told.level.parts;
    if (told.level.there()) break;
    idle = told.level.reached > best ? 0 : idle + 1;
    best = std::max(best, told.level.reached);
    const bool last = idle == 3 || number == study.rare.levels;
    if (last && told.level.hits >= enough) break;  // some are there: the study tells how good it is
    if (last)
      throw not_reached(study, "rows that stay " + short_text_of(-best) + " below it after " +
                                   std::to_string(number) + " levels");
  }
  return components;
}

std::string with_components(const Study& study, const std::vector<ProposalPart>& components,
                            const std::string& note) {
  std::string text = study.text;
  if (!text.empty() && text.back() != '\n') text += '\n';
  text += "\n" + note;
  for (const ProposalPart& part : components) {
    text += "\n[[rare.component]]\nweight = " + toml_number(part.share) + "\n";
    for (const bool centre : {true, false}) {
      std::string entries;
      std::size_t first = 0;
      for (const Variable& variable : study.variables) {
        const std::size_t n = dimensions_of(variable, false);
        std::string values;
        bool any = false;
        for (std::size_t i = first; i < first + n; ++i) {
          const auto* score = std::get_if<ScoreLaw>(&part.draws[i]);
          const double usual = centre ? 0.0 : 1.0;
          const double x = score == nullptr ? usual : centre ? score->centre : score->deviation;
          any = any || x != usual;
          values += (values.empty() ? "" : ", ") + toml_number(x);
        }
        first += n;
        if (any)
          entries += (entries.empty() ? "" : ", ") + toml_key(variable.name) + " = " +
                     (n > 1 ? "[" + values + "]" : values);
      }
      if (!entries.empty())
        text += std::string(centre ? "centre" : "deviation") + " = { " + entries + " }\n";
    }
  }
  return text;
}

}  // namespace asdic::detail::study
