#include "study/reader/vary_given.h"

#include <algorithm>
#include <charconv>

#include "core/text.h"
#include "io/text/toml_writer.h"
#include "study/expression/names.h"

namespace asdic::detail::study {
namespace {

/// A column of an input that is read already.
struct KnownColumn {
  const Variable* variable = nullptr;
  std::size_t column = 0;
  InputColumn what{};
};

std::vector<KnownColumn> known_columns(const Others& others) {
  std::vector<KnownColumn> all;
  for (const Variable* other : others) {
    const std::vector<InputColumn> columns = input_columns(*other);
    for (std::size_t c = 0; c < columns.size(); ++c) all.push_back({other, c, columns[c]});
  }
  return all;
}

/// Which of Variable::given a column is; it is added to them if need be.
std::size_t looks_at(Variable& variable, const std::string& name) {
  const auto it = std::find(variable.given.begin(), variable.given.end(), name);
  const auto at = static_cast<std::size_t>(it - variable.given.begin());
  if (it == variable.given.end()) variable.given.push_back(name);
  return at;
}

/// "below 5", "from 5 to 10", "from 10"
std::string interval_name(const std::vector<double>& edges, std::size_t i) {
  if (i == 0) return "below " + to_text(edges.front());
  return "from " + to_text(edges[i - 1]) +
         (i < edges.size() ? " to below " + to_text(edges[i]) : "");
}

/// What the values of the column are called in `laws`.
std::vector<std::string> names_of(const KnownColumn& parent, const std::vector<double>& values) {
  if (!parent.what.labels.empty()) return parent.what.labels;
  std::vector<std::string> names;
  for (const double x : values) names.push_back(to_text(x));
  return names;
}

/// "7" and "7.0" are one number.
std::size_t place_of(const std::string& key, const std::vector<std::string>& names,
                     const std::vector<double>& values, bool labelled) {
  if (const auto it = std::find(names.begin(), names.end(), key); it != names.end())
    return static_cast<std::size_t>(it - names.begin());
  double x = 0.0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), x);
  if (labelled || error != std::errc{} || end != key.data() + key.size()) return names.size();
  return static_cast<std::size_t>(std::find(values.begin(), values.end(), x) - values.begin());
}

/// Columns of all branches as one: the same names, and the labels of all.
void join(ConditionalLaw& law, const Variable& variable, TomlTable& table) {
  for (std::size_t b = 0; b < law.branches.size(); ++b) {
    Branch& branch = law.branches[b];
    Variable alone = variable;
    alone.law = branch.law;
    const std::vector<InputColumn> own = input_columns(alone);
    if (b == 0) {
      law.columns = own;
      for (const InputColumn& column : own) {
        branch.label_of.emplace_back();
        for (std::size_t i = 0; i < column.labels.size(); ++i) branch.label_of.back().push_back(i);
      }
      continue;
    }
    const auto alike = [](const InputColumn& a, const InputColumn& c) {
      return a.name == c.name && a.labels.empty() == c.labels.empty();
    };
    if (own.size() != law.columns.size() ||
        !std::equal(own.begin(), own.end(), law.columns.begin(), alike))
      throw table.fault("laws", "laws that draw the same columns, all numbers or all with labels",
                        "other columns in " + in_quotes(branch.name) + " than in " +
                            in_quotes(law.branches.front().name));
    for (std::size_t c = 0; c < own.size(); ++c) {
      InputColumn& all = law.columns[c];
      all.ends = {std::min(all.ends.low, own[c].ends.low),
                  std::max(all.ends.high, own[c].ends.high)};
      branch.label_of.emplace_back();
      for (std::size_t i = 0; i < own[c].labels.size(); ++i) {
        // One label may stand for different things in two branches; it is one where it does not.
        const auto text = [&](const Branch& of, std::size_t label) {
          const auto* choice = std::get_if<ChoiceLaw>(&of.law);
          if (choice == nullptr || label >= choice->values.size()) return std::string();
          const auto& row = choice->values[label];
          return inline_toml(row[choice->by_row ? c : 0]);
        };
        std::string label = own[c].labels[i];
        std::optional<std::size_t> same;
        bool taken = false;
        for (std::size_t other = 0; other < b && !same; ++other)
          for (std::size_t k = 0; k < law.branches[other].label_of[c].size() && !same; ++k) {
            const std::size_t at = law.branches[other].label_of[c][k];
            if (all.labels[at] != label) continue;
            taken = true;
            const std::string what = text(branch, i);
            if (!what.empty() && what == text(law.branches[other], k)) same = at;
          }
        if (!same) {
          same = all.labels.size();
          all.labels.push_back(taken ? branch.name + ": " + label : label);
        }
        branch.label_of.back().push_back(*same);
      }
    }
  }
}

}  // namespace

std::vector<std::string> looked_at(const TomlValue& entry) {
  std::vector<std::string> names;
  const auto text = [&](const char* key) {
    const TomlValue* value = entry.find(key);
    const auto* word = value == nullptr ? nullptr : std::get_if<std::string>(&value->data);
    return word == nullptr ? std::string() : *word;
  };
  if (const std::string given = text("given"); !given.empty()) names.push_back(given);
  if (text("law") == "expression")
    for (const std::string& name : names_in(text("value"))) names.push_back(name);
  for (const std::string& key : parameter_keys())
    for (const std::string& name : names_in(text(key.c_str()))) names.push_back(name);
  const auto add = [&](const TomlValue& branch) {
    for (const std::string& name : looked_at(branch)) names.push_back(name);
  };
  if (const TomlValue* laws = entry.find("laws")) {
    if (const TomlValue::Table* table = laws->table())
      for (const TomlEntry& branch : *table) add(branch.value);
    if (const auto* array = std::get_if<TomlValue::Array>(&laws->data))
      for (const TomlValue& branch : *array) add(branch);
  }
  return names;
}

ConditionalLaw read_conditional(TomlTable& table, const TomlValue& value, Variable& variable,
                                const Study& study, const Others& others) {
  if (table.has("law"))
    throw table.fault("law", "no \"law\" beside given: \"laws\" has one for each case");
  const std::string name = table.text("given");
  const std::vector<KnownColumn> known = known_columns(others);
  const auto parent = std::find_if(known.begin(), known.end(),
                                   [&](const KnownColumn& one) { return one.what.name == name; });
  if (parent == known.end()) throw table.fault("given", "the column of another input");
  ConditionalLaw law{.given = looks_at(variable, name)};
  const auto read_branch = [&](TomlTable branch, const TomlValue& at, const std::string& called) {
    law.branches.push_back(
        {.name = called, .law = read_law(branch, at, variable, study, others, true)});
    branch.finish();
  };
  const TomlValue* laws = table.has("laws") ? value.find("laws") : nullptr;
  const auto* array = laws == nullptr ? nullptr : std::get_if<TomlValue::Array>(&laws->data);
  std::vector<std::string> names;
  if (table.has("edges")) {
    if (!parent->what.labels.empty())
      throw table.fault("edges", "no \"edges\": the values of " + in_quotes(name) + " are " +
                                     list_of(parent->what.labels));
    law.edges = table.numbers("edges", {});
    for (std::size_t i = 1; i < law.edges.size(); ++i)
      if (!(law.edges[i] > law.edges[i - 1]))
        throw table.fault("edges[" + std::to_string(i) + "]",
                          "an edge above the one before it, " + to_text(law.edges[i - 1]));
    for (std::size_t i = 0; i <= law.edges.size(); ++i)
      names.push_back(interval_name(law.edges, i));
    if (array == nullptr)
      throw table.fault("laws", "an array of laws, one more than there are edges");
  } else {
    law.values = values_of_column(*parent->variable, parent->column);
    if (law.values.empty())
      throw table.fault(
          "edges", "edges of intervals: the values of " + in_quotes(name) + " cannot be counted");
    names = names_of(*parent, law.values);
  }
  if (array != nullptr) {
    if (array->size() != names.size())
      throw table.fault("laws", count_of(names.size(), "law") + ", for " + list_of(names));
    std::vector<TomlTable> each = table.tables("laws");
    for (std::size_t i = 0; i < each.size(); ++i) {
      read_branch(each[i], (*array)[i], names[i]);
      law.branch_of.push_back(i);
    }
  } else {
    const TomlValue::Table* by_name = laws == nullptr ? nullptr : laws->table();
    if (by_name == nullptr)
      throw table.fault("laws", "a table of laws for " + list_of(names) + ", or an array of them");
    TomlTable each = table.table("laws");
    std::vector<const TomlEntry*> of(names.size(), nullptr);
    const TomlEntry* otherwise = nullptr;
    for (const TomlEntry& entry : *by_name) {
      const std::size_t at = place_of(entry.key, names, law.values, !parent->what.labels.empty());
      if (at >= names.size() && entry.key != "otherwise")
        throw each.fault(
            entry.key,
            "a value of " + in_quotes(name) + ", " + list_of(names) + ", or \"otherwise\"",
            in_quotes(entry.key));
      (at < names.size() ? of[at] : otherwise) = &entry;
    }
    std::optional<std::size_t> rest;  // the branch of "otherwise"
    for (std::size_t i = 0; i < names.size(); ++i) {
      const TomlEntry* entry = of[i] != nullptr ? of[i] : otherwise;
      if (entry == nullptr)
        throw table.fault("laws", "a law for " + in_quotes(names[i]) + ", or one \"otherwise\"",
                          "none for it");
      law.branch_of.push_back(of[i] == nullptr && rest ? *rest : law.branches.size());
      if (of[i] == nullptr && rest) continue;
      if (of[i] == nullptr) rest = law.branches.size();
      read_branch(each.table(entry->key), entry->value, entry->key);
    }
    if (otherwise != nullptr && !rest)
      throw each.fault("otherwise", "no \"otherwise\": each of " + list_of(names) + " has a law");
  }
  join(law, variable, table);
  return law;
}

Expression read_formula(TomlTable& table, const std::string& key, Variable& variable,
                        const Others& others, std::vector<std::size_t>& names) {
  std::vector<std::string> numbers;
  for (const KnownColumn& known : known_columns(others))
    if (known.what.labels.empty()) numbers.push_back(known.what.name);
  const std::string text = table.text(key);
  for (const KnownColumn& known : known_columns(others)) {
    const std::vector<std::string> there = names_in(text);
    if (!known.what.labels.empty() &&
        std::find(there.begin(), there.end(), known.what.name) != there.end())
      throw table.fault(key,
                        "a formula of numbers; a law for each of " + list_of(known.what.labels) +
                            " is had by given = " + in_quotes(known.what.name),
                        in_quotes(known.what.name) + ", which is no number");
  }
  Expression formula(text, numbers, table.where(key));
  for (const std::string& name : formula.names()) names.push_back(looks_at(variable, name));
  return formula;
}

const std::vector<std::string>& parameter_keys() {
  static const std::vector<std::string> all{"low",       "high",  "mode",   "mean",
                                            "deviation", "scale", "median", "log_deviation",
                                            "shape",     "min",   "max"};
  return all;
}

ExpressionLaw read_expression(TomlTable& table, Variable& variable, const Others& others) {
  std::vector<std::size_t> names;
  Expression formula = read_formula(table, "value", variable, others, names);
  return {.expression = std::move(formula), .names = std::move(names)};
}

}  // namespace asdic::detail::study
