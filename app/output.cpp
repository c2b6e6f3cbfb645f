#include "app/output.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "app/provenance.h"
#include "core/error.h"
#include "io/ping/growing_table.h"

namespace asdic::app {
namespace {

std::filesystem::path part_of(const std::filesystem::path& path) { return path.string() + ".part"; }

void give_name(const std::filesystem::path& part, const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw RunError(path.string() + ": " + error.message());
}

void remove_quietly(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

}  // namespace

void check_output(const std::filesystem::path& path, const std::filesystem::path& input) {
  std::error_code ignored;
  const auto wrong = [&](const std::string& got) {
    return InputError({.where = "--output", .got = got, .expected = "the name of a file to write"});
  };
  if (path.empty() || path.filename().empty() || std::filesystem::is_directory(path, ignored))
    throw wrong("the folder \"" + path.string() + '"');
  if (!input.empty() && std::filesystem::equivalent(path, input, ignored))
    throw wrong("the input itself, \"" + path.string() + '"');
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), ignored))
    throw InputError({.where = "--output",
                      .got = "no folder \"" + path.parent_path().string() + '"',
                      .expected = "a file in a folder that is there"});
}

Hdf5Output::Hdf5Output(const std::filesystem::path& path)
    : path_(path), part_(part_of(path)), file_(Hdf5File::create(part_)) {}

Hdf5Output::~Hdf5Output() {
  if (finished_) return;
  try {
    file_.close();
  } catch (const std::exception&) {
    // the file is thrown away
  }
  remove_quietly(part_);
}

void Hdf5Output::finish() {
  file_.close();
  give_name(part_, path_);
  finished_ = true;
}

ResultOrigin origin_of(const Scenario& scenario) {
  return {.title = scenario.title,
          .path = scenario.path,
          .text = scenario.text,
          .overrides = scenario.overrides};
}

void write_root(Hdf5File& file, const std::string& filetype, const ResultOrigin& origin) {
  const Provenance made = provenance(1);
  file.set_attribute("", "filetype", filetype);
  file.set_attribute("", "version", "1.0");
  file.set_attribute("", "title", origin.title);
  file.set_attribute("", "program_version", made.program_version);
  file.set_attribute("", "build", made.build);
  file.set_attribute("", "scenario_sha256", sha256(origin.text));
  if (!origin.overrides.empty()) file.set_attribute("", "overrides", origin.overrides);
  file.write_text("scenario", origin.text);
  describe(file, "scenario", "the scenario file, verbatim");
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path part = part_of(path);
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "it cannot be written";
    remove_quietly(part);
    throw RunError(path.string() + ": " + reason);
  }
  give_name(part, path);
}

}  // namespace asdic::app
