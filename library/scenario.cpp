#include "asdic/scenario.h"

#include "core/utf8.h"
#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "io/text/csv_table.h"
#include "io/text/toml_document.h"
#include "library/physics.h"

namespace asdic {
namespace {

using detail::TomlValue;

std::shared_ptr<Scenario::Data> empty_document() {
  auto data = std::make_shared<Scenario::Data>();
  data->document = {.data = TomlValue::Table{}, .origin = set_in_program};
  data->path = "scenario.toml";
  return data;
}

/// A document of its own, in which something may be changed. What an include brought is in it.
std::shared_ptr<Scenario::Data> changed(const Scenario::Data& data) {
  auto copy = std::make_shared<Scenario::Data>();
  copy->document = data.document;
  copy->path = data.path;
  detail::erase_key(copy->document, "include");
  return copy;
}

/// The place of a setting. \throws InputError naming its path
TomlValue& place_at(Scenario::Data& data, std::string_view path) {
  if (!detail::is_utf8(path)) throw InputError("path", std::string(path), "a text in UTF-8");
  try {
    return detail::value_at(data.document, path, set_in_program);
  } catch (const detail::InputError& error) {
    throw InputError(path.empty() ? "path" : std::string(path), error.fault().got,
                     error.fault().expected);
  }
}

}  // namespace

std::string document_text(const Scenario::Data& data) {
  return data.text ? *data.text : detail::toml_text(data.document);
}

Scenario Access::document(TomlValue tree, std::filesystem::path path) {
  auto data = std::make_shared<Scenario::Data>();
  data->document = std::move(tree);
  data->path = std::move(path);
  detail::erase_key(data->document, "include");
  Scenario scenario;
  scenario.data_ = std::move(data);
  return scenario;
}

Scenario Access::parsed(std::string_view text, const std::filesystem::path& name,
                        std::span<const std::string> changes) {
  return translated([&] {
    auto data = std::make_shared<Scenario::Data>();
    data->document = detail::scenario::read_document(text, name, changes);
    data->path = name;
    if (changes.empty()) data->text = std::string(text);
    Scenario scenario;
    scenario.data_ = std::move(data);
    return scenario;
  });
}

Scenario::Scenario() : data_(empty_document()) {}
Scenario::Scenario(const Scenario&) noexcept = default;
Scenario& Scenario::operator=(const Scenario&) noexcept = default;
Scenario::~Scenario() = default;

Scenario Scenario::read(const std::filesystem::path& file, std::span<const std::string> changes) {
  const std::string text =
      translated([&] { return detail::read_text_file(file, "a scenario file"); }, {file});
  return Access::parsed(text, file, changes);
}

Scenario Scenario::parse(std::string_view text, const std::filesystem::path& name) {
  return Access::parsed(text, name, {});
}

Scenario& Scenario::set(std::string_view path, const Value& value) {
  const auto data = changed(*data_);
  place_at(*data, path) = Access::given(value);
  data_ = data;
  return *this;
}

Scenario& Scenario::set(std::string_view path, std::initializer_list<double> numbers) {
  return set(path, Value(std::vector<double>(numbers)));
}

Scenario& Scenario::set(std::string_view path, std::initializer_list<const char*> texts) {
  return set(path, Value(std::vector<std::string>(texts.begin(), texts.end())));
}

Scenario& Scenario::add(std::string_view path, const Value& table) {
  const auto data = changed(*data_);
  const bool first = detail::find_at(data->document, path) == nullptr;
  TomlValue& place = place_at(*data, path);
  if (first) place = {.data = TomlValue::Array{}, .origin = set_in_program};
  if (place.table() != nullptr)  // one that stands alone: [target]
    place = {.data = TomlValue::Array{TomlValue(place)}, .origin = place.origin};
  auto* items = std::get_if<TomlValue::Array>(&place.data);
  if (items == nullptr) throw InputError(std::string(path), place.describe(), "a list of tables");
  items->push_back(Access::given(table));
  data_ = data;
  return *this;
}

Scenario& Scenario::erase(std::string_view path) {
  const auto data = changed(*data_);
  detail::erase_at(data->document, path);
  data_ = data;
  return *this;
}

bool Scenario::has(std::string_view path) const {
  return detail::find_at(data_->document, path) != nullptr;
}

Value Scenario::get(std::string_view path) const {
  const TomlValue* found = detail::find_at(data_->document, path);
  if (found == nullptr)
    throw InputError(std::string(path), "nothing", "a setting that was read or set");
  return Access::made(*found);
}

std::string Scenario::to_toml() const { return document_text(*data_); }

std::filesystem::path Scenario::path() const { return data_->path; }

std::vector<std::string> Scenario::validate(const Watch& watch) const {
  return translated([&] {
    if (detail::has_sonar(data_->document))
      return Access::physics(*this).ready_to_ping(watch).scenario().notes;
    return warnings();
  });
}

std::vector<std::string> Scenario::warnings() const {
  return translated([&] {
    if (detail::has_sonar(data_->document)) return Access::physics(*this).warnings();
    const std::scoped_lock lock(data_->mutex);
    if (!data_->notes) {
      std::vector<std::string> notes;
      static_cast<void>(detail::propagation_case_of(data_->document, data_->path, notes));
      data_->notes = std::move(notes);
    }
    return *data_->notes;
  });
}

}  // namespace asdic
