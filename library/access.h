#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "asdic/error.h"
#include "asdic/scenario.h"
#include "core/error.h"
#include "io/text/toml_value.h"
#include "raytrace/parallel/progress.h"

// How the public classes (include/asdic) and the rest of the project see one another.
namespace asdic {

class Physics;

/// Where values come from that no file holds.
inline constexpr const char* set_in_program = "set in the program";

struct Value::Data {
  detail::TomlValue value;
};

struct Scenario::Data {
  detail::TomlValue document{};       ///< with its include and overrides in it
  std::filesystem::path path{};       ///< files it names are relative to its folder
  std::optional<std::string> text{};  ///< of the file, as long as nothing was changed
  mutable std::mutex mutex{};
  mutable std::shared_ptr<Physics> physics{};               ///< made of it when it is first needed
  mutable std::optional<std::vector<std::string>> notes{};  ///< of a run's, once it was read
};

struct Access {
  [[nodiscard]] static Value made(detail::TomlValue value);
  [[nodiscard]] static const detail::TomlValue& tree(const Value& value);
  /// The same of a value that a document is to hold. \throws InputError for nothing
  [[nodiscard]] static const detail::TomlValue& given(const Value& value);
  [[nodiscard]] static const Scenario::Data& data(const Scenario& scenario) {
    return *scenario.data_;
  }
  /// As Scenario::parse(), with changes as of --set.
  [[nodiscard]] static Scenario parsed(std::string_view text, const std::filesystem::path& name,
                                       std::span<const std::string> changes);
  /// A scenario of a document that was read and checked. \param path  files it names lie beside it
  [[nodiscard]] static Scenario document(detail::TomlValue tree, std::filesystem::path path);
  [[nodiscard]] static Physics& physics(const Scenario& scenario);
};

/// A scenario as a file.
[[nodiscard]] std::string document_text(const Scenario::Data& data);

/// An error of the project's as one of asdic/error.h. \param files  that it may be about
[[nodiscard]] InputError shown(const detail::InputError& error,
                               const std::vector<std::filesystem::path>& files);

/// Does work of the project's, whose errors leave as those of asdic/error.h.
template <class Work>
auto translated(const Work& work, const std::vector<std::filesystem::path>& files = {}) {
  try {
    return work();
  } catch (const detail::InputError& error) {
    throw shown(error, files);
  } catch (const detail::Interrupted&) {
    throw Stopped();
  } catch (const detail::RunError& error) {
    throw RunError(error.what());
  }
}

}  // namespace asdic
