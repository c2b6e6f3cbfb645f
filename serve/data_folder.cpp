#include "serve/data_folder.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

DataFolder::DataFolder(const std::filesystem::path& folder) {
  std::error_code error;
  folder_ = std::filesystem::canonical(folder, error);
  if (error || !std::filesystem::is_directory(folder_, error))
    throw InputError({.where = "--data-dir",
                      .got = in_quotes(folder.string()),
                      .expected = "a directory that can be read"});
}

std::filesystem::path DataFolder::file(const std::string& name, const std::string& where,
                                       std::size_t most_bytes) const {
  const auto refuse = [&](const std::string& expected) {
    return Refusal("file", refusal_text(where, "no such file", expected));
  };
  if (folder_.empty())
    throw Refusal("file",
                  refusal_text(where, "a file", "none: the server was started without --data-dir"));
  const std::filesystem::path asked(name);
  const bool climbs = std::find(asked.begin(), asked.end(), "..") != asked.end();
  const std::string inside = "the name of a file inside the server's data directory";
  if (name.empty() || name.find('\0') != std::string::npos || asked.is_absolute() || climbs)
    throw refuse(inside);
  std::error_code error;
  std::filesystem::path real = std::filesystem::canonical(folder_ / asked, error);
  // Missing, not to be read, or elsewhere: one message, so that nothing is learnt of other places.
  if (error) throw refuse(inside);
  const auto [end, rest] = std::mismatch(folder_.begin(), folder_.end(), real.begin(), real.end());
  if (end != folder_.end() || rest == real.end()) throw refuse(inside);
  if (!std::filesystem::is_regular_file(real, error)) throw refuse(inside);
  if (std::filesystem::file_size(real, error) > most_bytes || error)
    throw Refusal("limit", refusal_text(where, "a larger file",
                                        "at most " + std::to_string(most_bytes) + " bytes"));
  return real;
}

}  // namespace asdic::detail::serve
