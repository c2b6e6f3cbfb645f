#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/units.h"
#include "io/text/toml_value.h"
#include "study/expression/expression.h"
#include "study/sampling/law.h"
#include "study/sampling/proposal.h"

namespace asdic::detail::study {

/// A number of a continuous law, the same at all keys.
struct NumberLaw {
  CutLaw law;
};

/// A continuous law some of whose parameters are formulae of what others draw, the same at all
/// keys: given them, it is a law as any other.
struct ParametricLaw {
  struct Parameter {
    std::string name;                     ///< "mean", "max"
    double number = 0.0;                  ///< …
    std::optional<Expression> formula{};  ///< … unless it is one
    std::vector<std::size_t> names{};     ///< [formula names] which of Variable::given
  };
  std::string kind;  ///< "rayleigh"
  std::vector<Parameter> parameters{};
};

/// A law by its name in the study file and its parameters; nothing where they make none (a
/// deviation that is not above 0).
struct NamedNumber {
  std::string_view name;
  double number = 0.0;
};
[[nodiscard]] std::optional<CutLaw> law_of(std::string_view kind,
                                           std::span<const NamedNumber> parameters);

/// One of several values, each of any kind a scenario knows.
struct ChoiceLaw {
  enum class Kind {
    weighted,  ///< drawn, by weights; an axis of the grid
    in_turn,   ///< realisation i takes value i mod n; an axis of the grid
  };
  Kind kind = Kind::weighted;
  std::vector<std::vector<TomlValue>> values;    ///< [choices][keys]
  std::vector<double> cumulative;                ///< [choices] of the weights, the last one 1
  bool by_row = false;                           ///< keys have values of their own, and columns
  std::vector<std::vector<std::string>> labels;  ///< [columns][choices]; [columns][0] of numbers
  std::vector<std::string> names{};  ///< [columns] where they are not called after their keys
};

/// Where something starts and how it goes: `position` and `velocity` below its key. Drawn evenly in
/// range, or over the area.
struct TrackLaw {
  Vec2 centre = Vec2::Zero();  ///< east, north [m]
  Span range, bearing;         ///< from the centre [m], [rad]
  bool even_in_area = false;   ///< range as r², not as r
  Span depth;                  ///< [m]
  std::optional<Span> speed;   ///< [m/s]; none: velocity stays as it is
  Span course{0.0, 2.0 * pi};  ///< [rad]
};

/// A mean profile and modes with independent normal amplitudes: c(z) = c̄(z) + Σ a_k φ_k(z).
struct ModesLaw {
  std::vector<double> depth;               ///< [levels] [m]
  std::vector<double> mean;                ///< [levels] [m/s]
  std::vector<std::vector<double>> modes;  ///< [modes][levels]
  std::vector<CutLaw> amplitudes;          ///< [modes]
  std::string interpolation;               ///< of the table that is made
};

/// A formula of what others draw, the same at all keys.
struct ExpressionLaw {
  Expression expression;
  std::vector<std::size_t> names{};  ///< [expression.names()] which of Variable::given
};

/// Rows of measured numbers; a few of their columns. Copies of laws share them.
struct DataRows {
  std::vector<std::string> names;            ///< [columns] what they are called behind the input's
  std::vector<std::vector<double>> columns;  ///< [columns][rows]
  /// [columns] of texts, which rows count into; {} of numbers, as where there are none at all
  std::vector<std::vector<std::string>> labels{};
  [[nodiscard]] const std::vector<std::string>& labels_of(std::size_t column) const {
    static const std::vector<std::string> none;
    return column < labels.size() ? labels[column] : none;
  }
  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
};

/// A row of a table, drawn whole. Its first columns go to the keys, one each; the others are drawn
/// for whoever looks at them.
struct TableLaw {
  std::shared_ptr<const DataRows> data;
  std::vector<double> cumulative;  ///< [rows] of the weights, the last one 1; empty: all alike
};

/// What a series of measurements was at a time drawn evenly. Columns as of TableLaw, or those of a
/// track (east, north, depth), which writes `position` and `velocity` below its keys.
struct TimeSeriesLaw {
  std::shared_ptr<const DataRows> data;
  std::vector<double> time;  ///< [rows] rising
  std::vector<bool> angles;  ///< [columns] degrees, which are turned by the shorter way
  Span span;                 ///< from which the time is drawn
  bool by_row = false;       ///< each row holds until the next; else straight between them
  bool track = false;
  std::string unit;      ///< of the time, "h"
  double seconds = 1.0;  ///< of one unit of it
};

struct Branch;

/// What a column of an input is called and counted in.
struct InputColumn {
  std::string name, unit, meaning;
  std::vector<std::string> labels;
  /// Between which its values are drawn; infinite where the law has no end.
  Span ends{-infinity, infinity};
};

/// A law for each value, or interval of values, of what another input draws.
struct ConditionalLaw {
  std::size_t given = 0;         ///< which of Variable::given decides
  std::vector<double> edges{};   ///< branch i is from edges[i − 1] up to below edges[i] …
  std::vector<double> values{};  ///< … or, without edges, those that it can have
  std::vector<std::size_t> branch_of{};  ///< [values] which branch each leads to
  std::vector<Branch> branches{};
  std::vector<InputColumn> columns{};  ///< of all branches
};

using AnyLaw = std::variant<NumberLaw, ChoiceLaw, TrackLaw, ModesLaw, TableLaw, TimeSeriesLaw,
                            ExpressionLaw, ParametricLaw, ConditionalLaw>;

struct Branch {
  std::string name;  ///< "winter", "from 5 to 10"
  AnyLaw law;
  /// [columns][labels of its own] which label of the whole each is; empty for numbers
  std::vector<std::vector<std::size_t>> label_of{};
};

/// What the number at a key is: "depth of the sources" [m].
struct NumberAtKey {
  std::string unit = "1", meaning;
  bool whole = false;  ///< whole numbers alone may stand there
};

/// One input that varies from realisation to realisation: a key of the scenario (or several that
/// move together) and the law that its values follow.
struct Variable {
  std::string name;                       ///< of its column, or what its columns' names begin with
  std::vector<std::string> keys;          ///< "target.0.strength_db"; paths as in --set
  std::vector<NumberAtKey> numbers = {};  ///< [keys]; none: nothing is known of them
  std::string origin;                     ///< where it was written, "study.toml:12"
  AnyLaw law;
  std::vector<std::string> given = {};  ///< columns of others that its law looks at
  std::string text = {};                ///< the law, as the study file has it
  std::string digest = {};              ///< of files that its law was read from, for the identity
  std::vector<std::string> notes = {};  ///< what the user should know of them
  CoordinateDraw proposal = {};         ///< from what its coordinate is drawn instead
};

/// A whole or real number as such; none for anything else.
[[nodiscard]] std::optional<double> number_of(const TomlValue& value);

[[nodiscard]] std::vector<InputColumn> input_columns(const Variable& variable);
/// Between which the values of a column are drawn; infinite where it is none of an input.
[[nodiscard]] Span ends_of(std::span<const Variable> variables, std::string_view column);

/// The values that a column of a variable can have, in order; none where they are not counted.
[[nodiscard]] std::vector<double> values_of_column(const Variable& variable, std::size_t column);

/// Coordinates of the unit cube that a variable takes. \param on_grid  choices are axes
[[nodiscard]] std::size_t dimensions_of(const Variable& variable, bool on_grid);
/// Values that it has to choose from, whatever others draw; 0: it is no choice.
[[nodiscard]] std::size_t choices_of(const Variable& variable);
/// Whether a coordinate becomes a number by the inverse of a continuous law, whatever others draw.
[[nodiscard]] bool is_continuous(const AnyLaw& law);
/// Whether it puts what stands at its keys somewhere, position and velocity.
[[nodiscard]] bool places(const AnyLaw& law);

/// Which of its values the coordinates choose, 0 where there is nothing to choose.
/// \param u  [dimensions] each in (0, 1)   \param given  [Variable::given] what others drew
[[nodiscard]] std::size_t chosen(const Variable& variable, std::span<const double> u,
                                 std::span<const double> given);
/// The values of its columns. \param choice  as chosen
void append_values(const Variable& variable, std::span<const double> u,
                   std::span<const double> given, std::size_t choice, std::vector<double>& values);
/// Whether parameters of its law, or of one for a case, are formulae.
[[nodiscard]] bool has_formulae(const AnyLaw& law);
/// dP(X ≤ x)/dx of its column given what others drew; NaN where its law has none.
/// \param given  [Variable::given]
[[nodiscard]] double density_given(const Variable& variable, std::span<const double> given,
                                   double x);
/// Writes them where its keys lead. \param values  [columns] \throws InputError
void apply(const Variable& variable, std::span<const double> values, std::size_t choice,
           TomlValue& scenario);

/// In which order variables can be drawn: each after those that it looks at, else as they stand.
/// Shorter than `variables` where some wait for one another, or for a column that there is not.
[[nodiscard]] std::vector<std::size_t> drawing_order(std::span<const Variable> variables);

}  // namespace asdic::detail::study
