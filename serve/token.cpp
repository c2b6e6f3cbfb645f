#include "serve/token.h"

#include <random>

#include "core/error.h"
#include "core/text.h"
#include "io/files/input_file.h"

namespace asdic::detail::serve {

bool same_secret(std::string_view a, std::string_view b) noexcept {
  if (b.empty()) return false;
  unsigned differ = a.size() == b.size() ? 0U : 1U;
  // As many steps as the one who asks has sent: the length of the secret shows as little as its
  // text.
  for (std::size_t i = 0; i < a.size(); ++i)
    differ |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^
                                    static_cast<unsigned char>(b[i % b.size()]));
  return differ == 0U;
}

std::string new_token() {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string token;
  try {
    std::random_device source("/dev/urandom");
    for (int i = 0; i < 8; ++i) {
      const auto word = source();
      for (unsigned shift = 0; shift < 32; shift += 4) token += hex[(word >> shift) & 15U];
    }
  } catch (const std::exception&) {
    throw RunError("the system has no random numbers for a token");
  }
  return token;
}

void check_token(const std::string& token, const std::string& where) {
  constexpr std::size_t shortest = 16;
  if (token.size() < shortest)
    throw InputError({.where = where,
                      .got = std::to_string(token.size()) + " characters",
                      .expected = "a token of at least 16 characters"});
}

std::string read_token(const std::filesystem::path& path) {
  constexpr std::size_t longest = 4096;  // of which the first line is the token
  std::error_code error;
  const auto permissions = std::filesystem::status(path, error).permissions();
  std::string text;
  try {
    text = InputFile(path, "").read(longest);
  } catch (const InputError& fault) {
    throw InputError({.where = "--token-file",
                      .got = in_quotes(path.string()) + ", " + fault.fault().got,
                      .expected = "a file that can be read"});
  }
  using std::filesystem::perms;
  if ((permissions & (perms::group_all | perms::others_all)) != perms::none)
    throw InputError({.where = "--token-file",
                      .got = in_quotes(path.string()) + ", which others may use",
                      .expected = "a file for its owner alone (chmod 600)"});
  std::string token = text.substr(0, text.find('\n'));
  check_token(token, "--token-file");
  return token;
}

}  // namespace asdic::detail::serve
