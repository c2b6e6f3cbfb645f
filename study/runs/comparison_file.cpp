#include "study/runs/comparison_file.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/files/digest.h"
#include "io/hdf5/scale.h"
#include "study/runs/summary_writer.h"

namespace asdic::detail::study {

void write_comparison_file(OutputFile& output, const std::vector<ComparedFile>& studies,
                           const Comparison& comparison, const std::string& answers,
                           const Provenance& made, const std::string& stopped_by) {
  Hdf5File file = Hdf5File::create(output.part());
  write_filetype(file, "asdic comparison", "1.1");
  std::vector<std::string> names, titles, identities, files;
  for (const ComparedFile& one : studies) {
    names.push_back(one.name);
    titles.push_back(one.fingerprint.title);
    identities.push_back(one.fingerprint.identity);
    files.push_back(one.path);
  }
  file.set_attribute("", "names", names);
  file.set_attribute("", "titles", titles);
  file.set_attribute("", "identities", identities);
  file.set_attribute("", "files", files);
  file.set_attribute("", "seed", std::to_string(studies.front().fingerprint.seed));
  file.set_attribute("", "design", studies.front().fingerprint.design);
  file.set_attribute("", "realisations", static_cast<std::int64_t>(comparison.rows));
  if (!stopped_by.empty()) file.set_attribute("", "stopped_by", stopped_by);
  const auto list = [&](const char* key, const std::vector<std::string>& words) {
    if (!words.empty()) file.set_attribute("", key, words);
  };
  list("common_inputs", comparison.inputs);
  list("unlike_inputs", comparison.unlike_inputs);
  file.set_attribute("", "program_version", made.program_version);
  file.set_attribute("", "build", made.build);
  file.make_group("studies");
  for (const ComparedFile& one : studies) {
    const std::string path = "studies/" + one.name;
    file.make_group(path);
    file.write_text(path + "/study", one.fingerprint.text);
    describe(file, path + "/study", "the study file, verbatim");
    file.write_text(path + "/scenario", one.fingerprint.scenario_text);
    describe(file, path + "/scenario", "the scenario file, verbatim");
    if (!one.fingerprint.overrides.empty())
      file.set_attribute(path, "overrides", one.fingerprint.overrides);
    if (!one.fingerprint.warnings.empty())
      file.set_attribute(path, "warnings", one.fingerprint.warnings);
  }
  file.write_text("answers", answers);
  describe(file, "answers", "what the comparison says, for people");
  nlohmann::json datasets = nlohmann::json::object();
  write_summary(file, comparison.summary,
                [&](const std::string& dataset, const std::vector<double>& values) {
                  Digest digest;
                  digest.add(std::span<const double>(values));
                  datasets[dataset] = {{"shape", {values.size()}}, {"sha256", digest.text()}};
                });
  file.write_text("manifest", nlohmann::json{{"datasets", datasets}}.dump());
  describe(file, "manifest", "JSON: SHA-256 of each dataset of the summary");
  file.make_group("run");
  file.set_attribute("run", "host", made.host);
  file.set_attribute("run", "cpu", made.cpu);
  file.set_attribute("run", "started", made.started);
  file.set_attribute("run", "threads", std::to_string(made.threads));
  file.set_attribute("run", "library_versions", made.library_versions);
  file.close();
  output.finish();
}

std::string read_comparison(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  if (file.attribute_or("", "filetype", "") != "asdic comparison" ||
      !file.attribute_or("", "version", "").starts_with("1."))
    throw InputError({.where = path.string(),
                      .got = "a file of another kind or version",
                      .expected = "one of asdic study --compare, version 1"});
  try {
    const auto manifest = nlohmann::json::parse(file.read_text("manifest"));
    for (const auto& [dataset, told] : manifest.at("datasets").items()) {
      if (!file.has(dataset))
        throw InputError({.where = path.string() + ": " + dataset,
                          .got = "no such dataset",
                          .expected = "what the manifest lists"});
      Digest digest;
      digest.add(std::span<const double>(file.read<double>(dataset)));
      if (digest.text() != told.at("sha256").get<std::string>())
        throw InputError({.where = path.string() + ": " + dataset,
                          .got = "data that have changed since they were written",
                          .expected = "those of the manifest"});
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError({.where = path.string() + ": manifest",
                      .got = std::string("no list of datasets (") + error.what() + ")",
                      .expected = "JSON with the SHA-256 of each"});
  }
  return file.read_text("answers");
}

}  // namespace asdic::detail::study
