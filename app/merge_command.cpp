#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "core/error.h"
#include "io/files/files_read.h"
#include "io/hdf5/own_files.h"
#include "io/scenario/embedded.h"
#include "io/text/csv_table.h"
#include "study/plan/study.h"
#include "study/reader/study_reader.h"
#include "study/runs/merge.h"

namespace asdic::detail::app {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output, study;
  study::MergeOptions merge;
  bool force = false, quiet = false;
};

/// The study file that the parts were made of: the one that is named, or the one that they name,
/// which must not have changed.
std::filesystem::path find_study(const MergeOptions& options, const study::StudyFile& part) {
  if (!options.study.empty()) return options.study;
  const std::filesystem::path name = [&] {
    const auto sessions = part.sessions();
    return std::filesystem::path(sessions.empty() ? "" : sessions.front().study_path);
  }();
  std::error_code error;
  const std::filesystem::path beside = part.path().parent_path() / name.filename();
  for (const std::filesystem::path& path : {name, beside, name.filename()})
    if (!path.empty() && std::filesystem::is_regular_file(path, error)) return path;
  throw InputError({.where = part.path().string(),
                    .got = "parts of " + name.string() + ", which is not there",
                    .expected = "the study file, for its [summary]; --study says where it is"});
}

/// Reads it as the parts did.
study::Study study_of(const MergeOptions& options) {
  const study::StudyFile part(options.parts.front());
  const std::filesystem::path path = find_study(options, part);
  if (options.study.empty()) {  // nothing but the part says so: it must not lead to other files
    scenario::check_names(part.fingerprint().overrides, path.parent_path(),
                          "--study names the study");
    if (read_text_file(path, "a study file") != part.fingerprint().text)
      throw InputError({.where = path.string(),
                        .got = "a file that has changed since the parts were made, if only in what "
                               "is made of the rows",
                        .expected = "as it was; --study " + path.string() + " takes it as it is"});
  }
  study::Study study = study::read_study(path, part.fingerprint().overrides);
  if (study::identity(study) != part.fingerprint().identity)
    throw InputError({.where = path.string(),
                      .got = "another study (identity " + study::identity(study) + ")",
                      .expected = "that of " + part.path().string() + " (identity " +
                                  part.fingerprint().identity + "); --study names another file"});
  return study;
}

/// Nothing but results of the same study is written over.
void check_existing(const std::filesystem::path& output, const std::string& identity) {
  std::error_code error;
  if (!std::filesystem::exists(output, error)) return;
  std::string got = "a file that is no study's";
  try {
    const study::StudyFile there(output);
    forget_read(output);  // the earlier result is not an input
    if (there.fingerprint().identity == identity) return;
    got = "results of another study (identity " + there.fingerprint().identity + ")";
  } catch (const InputError&) {
  }
  throw InputError({.where = output.string(),
                    .got = got,
                    .expected = "no such file, or results of this study (identity " + identity +
                                "); another output"});
}

int merge(const MergeOptions& options) {
  const study::Study study = study_of(options);
  std::vector<std::filesystem::path> parts(options.parts.begin(), options.parts.end());
  OutputFile output(
      options.output,
      {.own = own::hdf5, .worth = own::pings, .force = options.force, .inputs = parts});
  if (!options.force) check_existing(options.output, study::identity(study));
  study::MergeOptions how = options.merge;
  if (!options.study.empty()) how.text = study.text;
  const study::MergeReport report = study::merge(
      parts, output,
      [&](const study::Fingerprint&, const study::Table& table) {
        return study::summary_of(study, table);
      },
      how);
  for (const std::string& warning : report.warnings) print("warning: " + warning + '\n');
  if (options.quiet) return 0;
  print(fmt::format("{}: {} of {}", options.output, count_of(report.rows, "realisation"),
                    count_of(parts.size(), "part")));
  if (!report.missing.empty())
    print(fmt::format(", not complete: without {}", study::index_text(report.missing)));
  print(options.merge.copy ? "\n" : "; the rows stay in the parts: keep them together\n");
  return 0;
}

}  // namespace

void add_merge_command(Program& program) {
  program.add_command(
      "merge", "Put the parts of a study together: a catalogue of them, or one file.",
      [](const Command& command) {
        auto options = std::make_shared<MergeOptions>();
        command
            .add_option("PARTS", options->parts, "files of asdic study --realisations or --shard")
            .required();
        command.add_option("-o,--output", options->output, "file to write")
            .type_name("FILE.h5")
            .required();
        command.add_flag("--copy", options->merge.copy,
                         "copy the rows: one file that needs no parts any more");
        command.add_flag("--allow-gaps", options->merge.allow_gaps,
                         "parts may be missing; the file says so");
        command
            .add_option("--study", options->study,
                        "study file; default: where it was when the parts were made")
            .type_name("STUDY.toml");
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        add_force_option(command, options->force);
        command.footer("Example:  asdic merge part_*.h5 -o study.h5");
        command.runs([options] { return merge(*options); });
      });
}

}  // namespace asdic::detail::app
