#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace asdic::detail::study {

/// A formula of named numbers, "0.5 * wind_speed + 3", read once and computed often.
///
/// Numbers, names, pi and e; + − * / ^ and brackets; < <= > >= == != && || and a ? b : c; the
/// functions of expression_functions(). A copy shares what was read; threads may compute with one
/// at a time. By muParser. docs/formats/study.md
class Expression {
 public:
  /// \param known  names that may stand in it   \param where  of the text: "study.toml:12: vary.x"
  /// \throws InputError for what is no formula, or a name that is not known
  Expression(const std::string& text, std::span<const std::string> known, std::string where);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// Those that stand in it, in alphabetical order.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// Its value, which may be infinite or not a number. \param values  [names()]
  [[nodiscard]] double at(std::span<const double> values) const;

 private:
  struct Impl;
  std::string text_;
  std::vector<std::string> names_;
  std::shared_ptr<Impl> impl_;
};

/// Names of numbers in a text, known or not; none where it is no formula.
[[nodiscard]] std::vector<std::string> names_in(const std::string& text);

/// "abs", "acos", …
[[nodiscard]] const std::vector<std::string>& expression_functions();

}  // namespace asdic::detail::study
