#pragma once

/// \file
/// A scenario: everything that a simulation needs, as a document of settings. It is read from a
/// file or built here, setting by setting, under the names that files have
/// (docs/formats/scenario.md); `asdic validate` and the library check it alike.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.set("environment.bottom", asdic::Bottom{.depth = 200.0})
///     .set("environment.sound_speed", asdic::SoundSpeed{.depth = {0.0}, .speed = {1500.0}})
///     .set("platform.position", {0.0, 0.0, 50.0})
///     .set("transmitter", asdic::Transmitter{.source_level_db = 215.0, .beamwidth_deg = 20.0})
///     .set("pulse", asdic::Cw{.frequency = 2000.0, .duration = 0.1})
///     .set("array", asdic::LineArray{.phones = 8, .spacing = 0.375})
///     .set("pings.recording_duration", 4.0)
///     .set("pings.sample_rate", 8000.0);
/// for (const std::string& warning : scenario.validate()) std::cout << warning << '\n';
/// std::cout << scenario.to_toml();
/// ```

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "asdic/export.h"
#include "asdic/value.h"
#include "asdic/watch.h"

namespace asdic {

/// A copy is cheap, and shares what was computed (the ocean, its paths) until one of them is
/// changed. Functions take scenarios from several threads at once; set() and its like want one.
///
/// Paths are those of --set and of study files: "pulse.duration", "target.0.strength_db". What is
/// wrong with a value is found by validate(), or by the first function that needs it.
class ASDIC_API Scenario {
 public:
  Scenario();  ///< no setting at all
  // To move is to copy: what was moved from stays as it was.
  Scenario(const Scenario&) noexcept;
  Scenario& operator=(const Scenario&) noexcept;
  ~Scenario();

  /// \param changes  "key.path=value" each, as of --set   \throws InputError, RunError
  [[nodiscard]] static Scenario read(const std::filesystem::path& file,
                                     std::span<const std::string> changes = {});
  /// \param name  of the text in messages; files that it names lie in the folder of `name`
  [[nodiscard]] static Scenario parse(std::string_view text,
                                      const std::filesystem::path& name = "scenario.toml");

  /// Sets what stands at a path, in place of what was there; tables on the way are made.
  /// \throws InputError for a path through what is no table, or past a list's end   \return this
  Scenario& set(std::string_view path, const Value& value);
  Scenario& set(std::string_view path, std::initializer_list<double> numbers);
  Scenario& set(std::string_view path, std::initializer_list<const char*> texts);
  /// One more table of a list: add("target", Target{…}). \return this
  Scenario& add(std::string_view path, const Value& table);
  /// Takes a setting out, if it is there. \return this
  Scenario& erase(std::string_view path);

  [[nodiscard]] bool has(std::string_view path) const;
  /// What stands at a path: what was read or set, no defaults. \throws InputError for nothing
  [[nodiscard]] Value get(std::string_view path) const;

  /// As a scenario file. One that was read and not changed: that file's text, letter by letter.
  [[nodiscard]] std::string to_toml() const;
  /// The file that it was read from, or the name that parse() was given: the folder of files that
  /// it names.
  [[nodiscard]] std::filesystem::path path() const;

  /// Checks everything, as `asdic validate` does. \return warnings: what to know before trusting a
  /// number   \throws InputError at the first fault, with file, line, key, found and expected
  ///
  /// What it finds on the way, pings find again: the ocean, and the paths to scatterers. Where the
  /// ocean varies with range these may take minutes.
  std::vector<std::string> validate(const Watch& watch = {}) const;

  /// Of these warnings those that are known by now: what reading it says, and after validate() or a
  /// ping all. \throws InputError at a fault that reading finds
  [[nodiscard]] std::vector<std::string> warnings() const;

  struct Data;  ///< of the library alone

 private:
  friend struct Access;
  std::shared_ptr<const Data> data_;
};

}  // namespace asdic
