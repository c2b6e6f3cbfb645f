#include "io/scenario/document.h"

#include "core/error.h"
#include "core/text.h"
#include "io/settings/reader.h"
#include "io/text/csv_table.h"
#include "io/text/toml_table.h"

namespace asdic::detail::scenario {

void make_files_absolute(TomlValue& value, const std::filesystem::path& folder) {
  if (auto* array = std::get_if<TomlValue::Array>(&value.data))
    for (TomlValue& item : *array) make_files_absolute(item, folder);
  if (TomlValue::Table* table = value.table())
    for (TomlEntry& entry : *table) {
      make_files_absolute(entry.value, folder);
      if (entry.key != "file") continue;
      if (auto* name = std::get_if<std::string>(&entry.value.data))
        *name = std::filesystem::absolute(folder / *name).string();
    }
}

namespace {

std::string file_named(const TomlValue& value) {
  const auto* text = std::get_if<std::string>(&value.data);
  return text == nullptr ? "" : *text;
}

/// `include = "ocean.toml"`: a file with an [environment] and nothing else, whose values stand
/// where the scenario gives none.
void merge_include(TomlValue& root, const std::filesystem::path& folder) {
  const TomlValue* include = root.find("include");
  if (include == nullptr) return;
  TomlTable table(root);
  KnownSettings known{.folder = folder};
  TomlReader reader(table, known);
  std::string file;
  describe_include(reader, file);
  const std::filesystem::path path = file;
  TomlValue fragment = parse_toml(read_text_file(path), path.string());
  for (const TomlEntry& entry : std::get<TomlValue::Table>(fragment.data))
    if (entry.key != "environment")
      throw InputError({.where = entry.value.origin + ": " + entry.key,
                        .got = "a key of the whole scenario in an included file",
                        .expected = root.find("study") == nullptr
                                        ? "[environment] alone"
                                        : "[environment] alone; a study names a whole scenario by "
                                          "scenario = \"" +
                                              file_named(*include) + "\" in [study]"});
  make_files_absolute(fragment, path.parent_path());
  merge_defaults(root, fragment);
}

}  // namespace

void describe_include(Fields& field, std::string& file) {
  field.file("include", file, "a TOML file with an [environment]",
             "whose settings hold where this file has none");
}

TomlValue read_document(std::string_view text, const std::filesystem::path& path,
                        std::span<const std::string> overrides) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError({.where = path.string(),
                      .got = "an empty file",
                      .expected = "a scenario (docs/formats/scenario.md)"});
  if (text.starts_with("\x89HDF"))
    throw InputError(
        {.where = path.string(),
         .got = "an HDF5 file",
         .expected = "a scenario (docs/formats/scenario.md); asdic info tells of HDF5"});
  TomlValue document = parse_toml(text, path.string());
  for (const std::string& assignment : overrides)  // which file to include comes first …
    if (assignment.starts_with("include=")) apply_override(document, assignment);
  merge_include(document, path.parent_path());
  for (const std::string& assignment : overrides)  // … for the others may change what it says
    apply_override(document, assignment);
  return document;
}

}  // namespace asdic::detail::scenario
