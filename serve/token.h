#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace asdic::detail::serve {

/// Whether two secrets are the same, in a time that does not tell where they differ.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b) noexcept;

/// 32 random bytes in hexadecimal, of the system's source. \throws RunError
[[nodiscard]] std::string new_token();

/// The first line of a file that its owner alone may read.
/// \throws InputError{where: "--token-file"} also for fewer than 16 characters
[[nodiscard]] std::string read_token(const std::filesystem::path& path);

/// \throws InputError naming `where` if a token is too short to keep a secret
void check_token(const std::string& token, const std::string& where);

}  // namespace asdic::detail::serve
