#include "study/expression/expression.h"

#include <muParserDLL.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "core/error.h"
#include "core/text.h"
#include "study/expression/names.h"

namespace asdic::detail::study {
namespace {

/// A parser of muParser's C interface: its exceptions stay inside, and so may the program load it
/// when it is first called.
class Parser {
 public:
  explicit Parser(const std::string& text) : handle_(mupCreate(0)) {  // 0: double
    mupSetErrorHandler(handle_, [](muParserHandle_t) {});             // we ask ourselves
    mupClearConst(handle_);                                           // its pi has 13 digits
    mupDefineConst(handle_, "pi", std::numbers::pi);
    mupDefineConst(handle_, "e", std::numbers::e);
    mupDefineFun1(
        handle_, "floor", [](double x) { return std::floor(x); }, 1);
    mupDefineFun1(
        handle_, "ceil", [](double x) { return std::ceil(x); }, 1);
    mupDefineFun1(
        handle_, "round", [](double x) { return std::round(x); }, 1);
    mupSetExpr(handle_, text.c_str());
  }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
  ~Parser() { mupRelease(handle_); }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    const int count = mupGetExprVarNum(handle_);
    for (int i = 0; i < count && mupError(handle_) == 0; ++i) {
      const char* name = nullptr;
      double* place = nullptr;
      mupGetExprVar(handle_, static_cast<unsigned>(i), &name, &place);
      all.emplace_back(name);
    }
    std::sort(all.begin(), all.end());
    return all;
  }
  /// What is wrong with the text; "": nothing.
  [[nodiscard]] std::string fault() const {
    if (mupError(handle_) == 0) return "";
    std::string text = mupGetErrorMsg(handle_);
    while (!text.empty() && (text.back() == '.' || text.back() == '!')) text.pop_back();
    return text;
  }
  void define(const std::string& name, double* value) {
    mupDefineVar(handle_, name.c_str(), value);
  }
  /// Of the first of its values. \param count  how many stand there, between commas
  [[nodiscard]] double value(int& count) const {
    const double* values = mupEvalMulti(handle_, &count);
    return values == nullptr ? std::nan("") : values[0];
  }

 private:
  muParserHandle_t handle_;
};

/// x = 3 would set x.
bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
    const bool compares = i > 0 && std::string_view("<>!=").find(text[i - 1]) != std::string::npos;
    if (!doubled && !compares) return true;
  }
  return false;
}

}  // namespace

std::string list_of(std::span<const std::string> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + in_quotes(names[i]);
  return text;
}

struct Expression::Impl {
  Impl(const std::string& text, std::size_t names) : parser(text), values(names) {}
  std::mutex mutex;
  Parser parser;
  std::vector<double> values;  // [names], where the parser looks
};

Expression::Expression(const std::string& text, std::span<const std::string> known,
                       std::string where)
    : text_(text) {
  const auto refuse = [&](const std::string& got, const std::string& expected) {
    throw InputError({.where = std::move(where), .got = got, .expected = expected});
  };
  const std::string expected = "a formula such as \"0.5 * wind_speed + 3\"";
  if (assigns(text)) refuse(in_quotes(text) + ", which sets what stands before =", "== to compare");
  {
    const Parser parser(text);
    names_ = parser.names();
    if (const std::string fault = parser.fault(); !fault.empty())
      refuse(in_quotes(text) + " (" + fault + ")",
             expected + ", of numbers, names, pi, e and " + list_of(expression_functions()));
  }
  for (const std::string& name : names_) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = nearest_name(name, known);
    refuse("the name " + in_quotes(name),
           known.empty()
               ? "numbers alone: there is no name to be had here"
               : "one of " + list_of(known) +
                     (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)"));
  }
  impl_ = std::make_shared<Impl>(text, names_.size());
  for (std::size_t i = 0; i < names_.size(); ++i)
    impl_->parser.define(names_[i], &impl_->values[i]);
  int count = 1;
  static_cast<void>(impl_->parser.value(count));
  if (const std::string fault = impl_->parser.fault(); !fault.empty())
    refuse(in_quotes(text) + " (" + fault + ")", expected);
  if (count != 1) refuse(in_quotes(text) + ", " + std::to_string(count) + " values", "one value");
}

double Expression::at(std::span<const double> values) const {
  const std::lock_guard lock(impl_->mutex);
  std::copy(values.begin(), values.end(), impl_->values.begin());
  int count = 1;
  return impl_->parser.value(count);
}

std::vector<std::string> names_in(const std::string& text) {
  const Parser parser(text);
  std::vector<std::string> names = parser.names();
  return parser.fault().empty() ? names : std::vector<std::string>{};
}

const std::vector<std::string>& expression_functions() {
  static const std::vector<std::string> all{
      "abs",   "acos",  "asin", "atan", "atan2", "avg",  "ceil", "cos", "cosh",
      "exp",   "floor", "ln",   "log",  "log10", "log2", "max",  "min", "rint",
      "round", "sign",  "sin",  "sinh", "sqrt",  "sum",  "tan",  "tanh"};
  return all;
}

}  // namespace asdic::detail::study
