#include "io/hdf5/hdf5_output.h"

#include <initializer_list>
#include <string>
#include <utility>

#include "io/hdf5/own_files.h"

namespace asdic::detail {

Hdf5Output::Hdf5Output(OutputFile&& output)
    : output_(std::move(output)), file_(Hdf5File::create(output_.part())) {}

void Hdf5Output::finish() {
  file_.close();
  output_.finish();
}

OutputRules rules_for(const std::filesystem::path& path, bool force,
                      const std::filesystem::path& input) {
  OutputRules rules{.own = own::hdf5, .worth = own::pings, .force = force};
  const std::string ending = path.extension().string();
  const std::initializer_list<std::pair<const char*, Recognise>> kinds = {
      {".arr", own::arrivals_file},
      {".ray", own::ray_file},
      {".shd", own::shade_file},
      {".env", own::case_file},
      {".toml", own::scenario}};
  for (const auto& [other, own] : kinds)
    if (ending == other) rules.own = own, rules.worth = nullptr;
  if (!input.empty()) rules.inputs = {input};
  return rules;
}

}  // namespace asdic::detail
