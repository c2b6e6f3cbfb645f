#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/fields.h"
#include "io/text/toml_value.h"

namespace asdic::detail::scenario {

/// `include`, which names a file with an [environment].
void describe_include(Fields& field, std::string& file);

/// The tree of a scenario file with its `include` merged in and `--set` overrides applied.
/// \param path  named in messages; an included file is relative to its folder \throws InputError
[[nodiscard]] TomlValue read_document(std::string_view text, const std::filesystem::path& path,
                                      std::span<const std::string> overrides);

/// Files that are named anywhere in a tree are relative to a folder: then they are not any more.
void make_files_absolute(TomlValue& value, const std::filesystem::path& folder);

}  // namespace asdic::detail::scenario
