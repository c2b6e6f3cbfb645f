#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/quantity.h"
#include "core/units.h"

namespace asdic::detail {

class Fields;
class Only;

/// A setting's name in files, and what else holds of it.
struct SettingKey {
  std::string_view name;
  bool required = false;  ///< it has no default
  bool live = false;      ///< a running server takes changes of it
  bool seldom = false;    ///< files are written without it where it is false, 0 or empty
  std::string_view inherits =
      {};                      ///< a known setting that is its default: "environment.wind_speed"
  std::string_view word = {};  ///< stands for "none" of what may be absent: "auto"
  std::string_view otherwise =
      {};  ///< what holds without it, where other settings decide: "of the wind"

  constexpr SettingKey(const char* text) : name(text) {}       // NOLINT: a text is a key
  constexpr SettingKey(std::string_view text) : name(text) {}  // NOLINT
};
constexpr SettingKey required(SettingKey key) {
  key.required = true;
  return key;
}
constexpr SettingKey live(SettingKey key, bool is = true) {
  key.live = is;
  return key;
}
constexpr SettingKey seldom(SettingKey key) {
  key.seldom = true;
  return key;
}
constexpr SettingKey or_word(SettingKey key, std::string_view word) {
  key.word = word;
  return key;
}
constexpr SettingKey inherited(SettingKey key, std::string_view from) {
  key.inherits = from;
  return key;
}

/// \param otherwise  what holds without the key, in words of the manual's: no value is its default
constexpr SettingKey by_default(SettingKey key, std::string_view otherwise) {
  key.otherwise = otherwise;
  return key;
}

/// A struct that lists its settings.
template <class T>
concept Described = requires(T& object, Fields& field) {
  object.describe(field);
};

/// An element of a list that is held against the one before it: null for the first.
template <class T>
concept DescribedAfter = requires(T& object, Fields& field, const T* before) {
  object.describe(field, before);
};

/// An enumeration whose values are 0, 1, 2 … and have words: `words(E)` beside it, in its order.
template <class E>
concept Worded = std::is_enum_v<E> && requires(E value) {
  { words(value) } -> std::convertible_to<std::span<const std::string_view>>;
};
template <Worded E>
constexpr std::string_view word_of(E value) {
  return std::span<const std::string_view>(words(value))[static_cast<std::size_t>(value)];
}

/// A walk over the settings of structs: it reads them, writes them, adds them to a key, lists them.
///
/// A struct describes itself once, in `void describe(Fields& field)`, by calling field(…) for every
/// setting in the order that files have; what is done with it is the walker's. describe() is no
/// template: it is compiled once, and a new kind of walk compiles no struct again.
///
///   void Lfm::describe(Fields& field) {
///     field(required("duration"), duration, quantity::duration, "from edge to edge");
///     field("window", window, "how the edges rise and fall");
///     if (const auto only = field.only("window", window, PulseWindow::tukey))
///       field("tukey_fraction", tukey_fraction, share, "of the duration in the tapers");
///   }
///
/// The default of a setting is what the struct holds when it is shown. Angles are radians in the
/// struct, and "heading" is the key heading_deg of a file. A walker that does not read() must not
/// change what it is shown: constant objects are shown to it.
class Fields {
 public:
  // What walkers see.
  struct Setting {
    SettingKey key;
    std::string_view help;  ///< a phrase for the manual, without the unit
  };
  /// A struct whose type is forgotten.
  struct Structure {
    void* object;
    void (*function)(void*, Fields&);
    void describe(Fields& field) const { function(object, field); }
  };
  /// A list of structs.
  struct List {
    void* list;
    std::size_t (*size_of)(void*);
    void (*resize_to)(void*, std::size_t);
    Structure (*element)(void*, std::size_t);
    [[nodiscard]] std::size_t size() const { return size_of(list); }
    void resize(std::size_t n) const { resize_to(list, n); }
    [[nodiscard]] Structure at(std::size_t i) const { return element(list, i); }
  };
  /// A struct that may be absent.
  struct Perhaps {
    void* optional;
    bool present;
    void (*emplace)(void*);
    void (*reset)(void*);
    Structure (*value)(void*);
    void make() const { emplace(optional); }
    void clear() const { reset(optional); }
    [[nodiscard]] Structure get() const { return value(optional); }
  };
  /// One of a closed list of structs.
  struct OneOf {
    void* variant;
    std::span<const std::string_view> names;
    std::size_t index;  ///< of the one that there is
    void (*emplace)(void*, std::size_t);
    Structure (*value)(void*);
    void choose(std::size_t i) const { emplace(variant, i); }  ///< with its own defaults
    [[nodiscard]] Structure chosen() const { return value(variant); }
  };
  // What structs say about lists.
  struct ListRules {
    bool one_or_more = false;     ///< [x] or [[x]]; without either there is one, of defaults
    std::string_view named = {};  ///< they have names, no two alike: by default this and a number
  };
  struct Column {
    std::string_view key;
    std::vector<double>* values;
    Quantity quantity;   ///< of what stands in files
    bool angle = false;  ///< the values are radians, the file's NAME_deg
    std::string_view help;
    Column(std::string_view k, std::vector<double>& v, const Quantity& q, std::string_view h)
        : key(k), values(&v), quantity(q), help(h) {}
    Column(std::string_view k, std::vector<double>& radians, const AngleQuantity& q,
           std::string_view h)
        : key(k), values(&radians), quantity(q.in_degrees()), angle(true), help(h) {}
    [[nodiscard]] Quantity in_radians() const {
      return AngleQuantity{quantity.noun, quantity.low, quantity.high}.in_radians();
    }
  };
  struct ColumnRules {
    bool increasing = true;  ///< the first column
    bool file = false;       ///< or the columns of the CSV that the key `file` names
    bool steps = false;      ///< the first column does not fall: two equal values are a step
  };
  /// Samples of a sound, which files keep in a file of their own.
  struct Sound {
    std::string* file;
    std::vector<double>* samples;
    double* sample_rate;  ///< [Hz]
  };
  /// Which of several ways to say one thing has been found.
  struct Ways {
    std::vector<std::string_view> chosen = {};  ///< its keys
    std::vector<std::string_view> passed = {};  ///< keys of others before it
  };

  virtual ~Fields();

  // Settings, by what they are. help: a phrase of the manual's.
  void operator()(SettingKey key, double& value, const Quantity& q, std::string_view help) {
    number({key, help}, q, value, nullptr);
  }
  void operator()(SettingKey key, double& radians, const AngleQuantity& q, std::string_view help) {
    angle({key, help}, q, radians, nullptr);
  }
  void operator()(SettingKey key, std::optional<double>& value, const Quantity& q,
                  std::string_view help);
  void operator()(SettingKey key, std::optional<double>& radians, const AngleQuantity& q,
                  std::string_view help);
  void operator()(SettingKey key, bool& value, std::string_view help) { flag({key, help}, value); }
  void operator()(SettingKey key, std::string& value, std::string_view help) {
    text({key, help}, value);
  }
  void operator()(SettingKey key, std::vector<double>& values, const Quantity& q,
                  std::string_view help) {
    numbers({key, help}, q, values);
  }
  void operator()(SettingKey key, std::vector<double>& radians, const AngleQuantity& q,
                  std::string_view help) {
    angles({key, help}, q, radians);
  }
  /// Rows of numbers, each as long as the first.
  void operator()(SettingKey key, std::vector<std::vector<double>>& values, const Quantity& q,
                  std::string_view help) {
    rows({key, help}, q, values);
  }
  void operator()(SettingKey key, Vec3& value, const Quantity& q, std::string_view help,
                  std::string_view axes = "[east, north, depth]") {
    vector({key, help}, q, {value.data(), 3}, axes);
  }
  void operator()(SettingKey key, Vec2& value, const Quantity& q, std::string_view help,
                  std::string_view axes = "[east, north]") {
    vector({key, help}, q, {value.data(), 2}, axes);
  }
  void operator()(SettingKey key, std::vector<Vec3>& values, const Quantity& q,
                  std::string_view help) {
    vectors({key, help}, q, values);
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) void operator()(SettingKey key, T& value, std::int64_t low,
                                                   std::int64_t high, std::string_view help) {
    auto whole = static_cast<std::int64_t>(value);
    integer({key, help}, low, high, whole, nullptr);
    if (reads()) value = static_cast<T>(whole);
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) void operator()(SettingKey key, std::optional<T>& value,
                                                   std::int64_t low, std::int64_t high,
                                                   std::string_view help) {
    bool given = value.has_value();
    auto whole = static_cast<std::int64_t>(value.value_or(T{}));
    integer({key, help}, low, high, whole, &given);
    if (reads()) value = given ? std::optional(static_cast<T>(whole)) : std::nullopt;
  }
  template <Worded E>
  void operator()(SettingKey key, E& value, std::string_view help) {
    auto index = static_cast<std::size_t>(value);
    choice({key, help}, words(value), index);
    if (reads()) value = static_cast<E>(index);
  }
  template <Described T>
  void operator()(SettingKey key, T& value, std::string_view help) {
    table({key, help}, structure(value));
  }
  template <Described T>
  void operator()(SettingKey key, std::optional<T>& value, std::string_view help) {
    perhaps({key, help}, possible(value));
  }
  /// A number, or a table in its place: the number then stays as it is.
  template <Described T>
  void operator()(SettingKey key, double& value, const Quantity& q, std::optional<T>& instead,
                  std::string_view help) {
    number_or_table({key, help}, q, value, possible(instead));
  }
  template <class T>
  requires(Described<T> || DescribedAfter<T>) void operator()(SettingKey key, std::vector<T>& value,
                                                              std::string_view help,
                                                              const ListRules& rules) {
    using V = std::vector<T>;
    tables({key, help},
           {.list = &value,
            .size_of = [](void* l) { return static_cast<V*>(l)->size(); },
            .resize_to = [](void* l, std::size_t n) { static_cast<V*>(l)->resize(n); },
            .element = [](void* l, std::size_t i) { return element(*static_cast<V*>(l), i); }},
           rules);
  }
  template <class T>
  requires(Described<T> || DescribedAfter<T>) void operator()(SettingKey key, std::vector<T>& value,
                                                              std::string_view help) {
    (*this)(key, value, help, ListRules{});
  }
  /// A word, `T::name`, and in the same table the settings of the struct that it chooses.
  template <Described... T>
  void one_of(SettingKey key, std::variant<T...>& value, std::string_view help) {
    using V = std::variant<T...>;
    static constexpr std::array<std::string_view, sizeof...(T)> names{T::name...};
    static constexpr std::array<void (*)(V&), sizeof...(T)> make{
        +[](V& v) { v.template emplace<T>(); }...};
    const auto emplace = [](void* v, std::size_t i) { make[i](*static_cast<V*>(v)); };
    const auto chosen = [](void* v) {
      return std::visit([](auto& one) { return structure(one); }, *static_cast<V*>(v));
    };
    alternatives({key, help}, {.variant = &value,
                               .names = names,
                               .index = value.index(),
                               .emplace = emplace,
                               .value = chosen});
  }
  /// Numbers along an axis: one, a list, or evenly spaced ones, { first, last, count }.
  virtual void axis(SettingKey key, std::vector<double>& values, const Quantity& q,
                    std::string_view help) = 0;
  /// A file that is there, by its path. \param what  it is: "a WAV or CSV file of the pulse"
  virtual void file(SettingKey key, std::string& path, std::string_view what,
                    std::string_view help) = 0;
  /// Lists of numbers that belong together, row by row.
  virtual void columns(std::initializer_list<Column> all, const ColumnRules& rules) = 0;
  /// A sound in a WAV or CSV file. \param what  "the pulse"
  virtual void sound(SettingKey key, const Sound& sound, std::string_view what) = 0;
  /// Keys that no file has beside what it has said. \param beside  "a vertical line"
  virtual void excludes(std::string_view /*beside*/,
                        std::initializer_list<std::string_view> /*keys*/) {}
  /// The name that a list's element has for others (ListRules::named).
  virtual void name(std::string& value, std::string_view help) = 0;
  /// One of a list that was shown before, by its name there: its index.
  virtual void reference(SettingKey key, int& index, std::string_view list,
                         std::string_view help) = 0;
  /// Of the struct and of its identity, and of no file: others have worked it out.
  virtual void derived(double& value) = 0;

  /// Under which there are settings: what another one is, or that it is there.
  struct Condition {
    std::string_view key;
    std::span<const std::string_view> words = {};  ///< it is one of them; none: it is there
    bool other = false;                            ///< it is none of them
  };
  /// Settings that there are with some words of another alone: if (const auto only =
  /// field.only(…)).
  template <Worded E>
  [[nodiscard]] Only only(std::string_view key, E is, E wanted);
  template <Worded E>
  [[nodiscard]] Only only(std::string_view key, E is, std::initializer_list<E> wanted);
  /// Settings that there are but with one word of another, of a choice by one_of(), say.
  [[nodiscard]] Only unless(std::string_view key, std::string_view is, std::string_view unwanted);
  /// One of several ways to say something, of which a file has exactly one. The last of them is
  /// otherwise(). \param keys  the first of them tells it   \param is  how the struct has it now
  [[nodiscard]] Only way(Ways& ways, std::initializer_list<std::string_view> keys, bool is);
  [[nodiscard]] Only otherwise(Ways& ways, std::initializer_list<std::string_view> keys);

  /// For people who read a written file: a comment at this place.
  virtual void remark(std::string_view /*text*/) {}

  [[nodiscard]] virtual bool reads() const { return false; }       ///< sets what it is shown
  [[nodiscard]] virtual bool checks() const { return false; }      ///< looks for faults
  [[nodiscard]] virtual bool exhaustive() const { return false; }  ///< lists all that may be
  /// Where it checks(): \throws InputError at a key. \param got  by default what stands there
  virtual void fault(std::string_view /*key*/, const std::string& /*expected*/,
                     std::optional<std::string> /*got*/ = std::nullopt) {}
  /// Where it reads: whether a key is there, for settings that depend on others' being there.
  [[nodiscard]] virtual bool finds(std::string_view /*key*/) const { return false; }
  /// What the user should know of the values: "noise.wind_speed: …".
  virtual void note(const std::string& /*text*/) {}
  /// Numbers that settings further on refer to: "environment.wind_speed", "frequency".
  virtual void know(std::string_view /*setting*/, double /*value*/) {}
  [[nodiscard]] virtual double known(std::string_view /*setting*/) const { return 0.0; }

  template <Described T>
  [[nodiscard]] static Structure structure(T& object) {
    return {&object, [](void* o, Fields& field) { static_cast<T*>(o)->describe(field); }};
  }
  template <Described T>
  [[nodiscard]] static Structure element(std::vector<T>& list, std::size_t i) {
    return structure(list[i]);
  }
  template <DescribedAfter T>
  [[nodiscard]] static Structure element(std::vector<T>& list, std::size_t i) {
    const auto first = [](void* o, Fields& field) { static_cast<T*>(o)->describe(field, nullptr); };
    const auto other = [](void* o, Fields& field) {
      static_cast<T*>(o)->describe(field, static_cast<T*>(o) - 1);
    };
    if (i == 0) return {&list[i], first};
    return {&list[i], other};
  }
  template <Described T>
  [[nodiscard]] static Perhaps possible(std::optional<T>& value) {
    using O = std::optional<T>;
    return {.optional = &value,
            .present = value.has_value(),
            .emplace = [](void* o) { static_cast<O*>(o)->emplace(); },
            .reset = [](void* o) { static_cast<O*>(o)->reset(); },
            .value = [](void* o) { return structure(**static_cast<O*>(o)); }};
  }

 protected:
  friend class Only;
  /// \param given  null, or whether there is one: it may be absent
  virtual void number(const Setting&, const Quantity&, double& value, bool* given) = 0;
  virtual void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) = 0;
  virtual void integer(const Setting&, std::int64_t low, std::int64_t high, std::int64_t& value,
                       bool* given) = 0;
  virtual void flag(const Setting&, bool& value) = 0;
  virtual void text(const Setting&, std::string& value) = 0;
  virtual void numbers(const Setting&, const Quantity&, std::vector<double>& values) = 0;
  virtual void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) = 0;
  virtual void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) = 0;
  virtual void vector(const Setting&, const Quantity&, std::span<double> value,
                      std::string_view axes) = 0;
  virtual void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) = 0;
  virtual void choice(const Setting&, std::span<const std::string_view> words,
                      std::size_t& index) = 0;
  virtual void table(const Setting&, const Structure&) = 0;
  virtual void perhaps(const Setting&, const Perhaps&) = 0;
  virtual void number_or_table(const Setting&, const Quantity&, double& value, const Perhaps&) = 0;
  virtual void tables(const Setting&, const List&, const ListRules&) = 0;
  virtual void alternatives(const Setting&, const OneOf&) = 0;
  /// Whether settings of one way come now. \param last  of the ways
  virtual bool takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool last);
  /// About settings that there are under a condition: of another key, or of a way's first key.
  virtual void begin(const Condition& /*condition*/) {}
  virtual void end() {}
};

/// Whether settings of a condition come now, and the time in which they do.
class [[nodiscard]] Only {
 public:
  Only(Fields& field, bool holds, const Fields::Condition& condition)
      : field_(field), holds_(holds) {
    if (holds_) field_.begin(condition);
  }
  ~Only() {
    if (holds_) field_.end();
  }
  Only(const Only&) = delete;
  Only& operator=(const Only&) = delete;
  explicit operator bool() const { return holds_; }

 private:
  Fields& field_;
  bool holds_;
};

template <Worded E>
Only Fields::only(std::string_view key, E is, E wanted) {
  return only(key, is, {wanted});
}

template <Worded E>
Only Fields::only(std::string_view key, E is, std::initializer_list<E> wanted) {
  std::vector<std::string_view> words;
  for (const E one : wanted) words.push_back(word_of(one));
  const bool holds = std::find(wanted.begin(), wanted.end(), is) != wanted.end();
  return Only(*this, holds || exhaustive(), {.key = key, .words = words});
}

/// The name in files of the struct that there is, of a closed list.
template <class... T>
[[nodiscard]] std::string_view name_of(const std::variant<T...>& one_of) noexcept {
  return std::visit([](const auto& one) { return std::string_view(one.name); }, one_of);
}

/// Shows a struct that stays as it is. \param walker  which does not read()
template <Described T>
void look(const T& object, Fields& walker) {
  const_cast<T&>(object).describe(walker);
}

}  // namespace asdic::detail
