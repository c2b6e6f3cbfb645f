#include "app/output.h"

#include "core/error.h"

namespace asdic::detail::app {

void check_kind(const std::filesystem::path& path, std::string_view own) {
  const std::string ending = path.extension().string();
  for (const auto& [other, command] :
       {std::pair{".arr", "arrivals of a [run]"}, std::pair{".ray", "asdic rays"},
        std::pair{".shd", "asdic field"}})
    if (ending == other && ending != own)
      throw InputError(
          {.where = "--output",
           .got = path.string() + ", a name for " + command,
           .expected = (own.empty() ? std::string() : "a name in " + std::string(own) + ", or ") +
                       "another, say .h5, for HDF5"});
}

}  // namespace asdic::detail::app
