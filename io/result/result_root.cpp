#include "io/result/result_root.h"

#include "io/files/digest.h"
#include "io/hdf5/environment_group.h"
#include "io/hdf5/scale.h"
#include "io/ping/provenance.h"
#include "io/result/result_file.h"

namespace asdic::detail {

ResultOrigin origin_of(const Scenario& scenario) {
  return {.title = scenario.title,
          .path = scenario.path,
          .text = scenario.text,
          .overrides = scenario.overrides,
          .warnings = scenario.notes,
          .origin = scenario.origin};
}

void write_root(Hdf5File& file, const std::string& filetype, const ResultOrigin& origin) {
  const Provenance made = provenance(1);
  write_filetype(file, filetype, result_version);
  file.set_attribute("", "title", origin.title);
  file.set_attribute("", "program_version", made.program_version);
  file.set_attribute("", "build", made.build);
  file.set_attribute("", "scenario_sha256", sha256(origin.text));
  if (!origin.overrides.empty()) file.set_attribute("", "overrides", origin.overrides);
  if (!origin.warnings.empty()) file.set_attribute("", "warnings", origin.warnings);
  write_origin(file, attributes_of(origin.origin));
  file.write_text("scenario", origin.text);
  describe(file, "scenario", "the scenario file, verbatim");
}

}  // namespace asdic::detail
