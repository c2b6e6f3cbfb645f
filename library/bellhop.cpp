#include "asdic/bellhop.h"

#include "io/bellhop/case_reader.h"
#include "io/bellhop/map_scenario.h"
#include "io/hdf5/own_files.h"
#include "io/result/write_result.h"
#include "io/scenario/writer.h"
#include "library/propagation.h"
#include "library/watched.h"

namespace asdic {

BellhopCase read_bellhop(const std::filesystem::path& root, const std::filesystem::path& maps) {
  std::filesystem::path name = root;
  if (name.extension() == ".env") name.replace_extension();
  return translated(
      [&] {
        namespace bellhop = detail::bellhop;
        const bellhop::Input input = bellhop::read_case(name);
        const bellhop::MapScenario made = bellhop::map_scenario(input, maps.string());
        if (made.maps) {
          if (maps.empty())
            throw detail::InputError(
                {.where = input.file,
                 .got = "a case of BELLHOP3D, over a map",
                 .expected = "\"maps\", the name of a file (.nc) where its maps go"});
          bellhop::write_maps(
              detail::OutputFile(maps, {.own = detail::own::hdf5, .worth = detail::own::pings}),
              input);
        }
        std::vector<std::string> notes = input.notes;
        notes.insert(notes.end(), made.notes.begin(), made.notes.end());
        return BellhopCase{
            .scenario = Scenario::parse(detail::to_toml(made.run_case), name.string() + ".toml"),
            .notes = std::move(notes)};
      },
      {root, maps});
}

std::vector<std::string> write_run(const std::filesystem::path& path, const Scenario& scenario,
                                   const Watch& watch) {
  return watched(watch,
                 [&] {
                   detail::OutputRules rules = detail::rules_for(path, false);
                   rules.option = "path";
                   detail::OutputFile output(path, rules);
                   std::vector<std::string> notes;
                   const detail::PropagationCase run = run_case_of(scenario, notes);
                   detail::PropagationResult found = run_of(scenario, run);
                   notes.insert(notes.end(), found.notes.begin(), found.notes.end());
                   detail::write_result(std::move(output),
                                        detail::propagation_file(run, std::move(found)), {},
                                        detail::EarthLine(run));
                   return notes;
                 },
                 {path});
}

void convert_result(const std::filesystem::path& from, const std::filesystem::path& to) {
  translated(
      [&] {
        detail::OutputRules rules = detail::rules_for(to, false, from);
        rules.option = "to";
        detail::PropagationFile result = detail::read_result(from);
        detail::write_result(detail::OutputFile(to, rules), std::move(result));
      },
      {from, to});
}

}  // namespace asdic
