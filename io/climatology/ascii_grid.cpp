#include "io/climatology/ascii_grid.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/words.h"
#include "io/files/files_read.h"
#include "io/files/input_file.h"

namespace asdic::detail {
namespace {

/// Words of a text, one after the other, with the line that they are in.
class AsciiWords {
 public:
  explicit AsciiWords(std::string_view text) : text_(text) {}

  [[nodiscard]] std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] std::size_t place() const { return at_; }
  void back_to(std::size_t place) { at_ = place; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::optional<double> number_of_word(std::string_view word) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// All of a grid's values, rows from north to south.
class PlaneInMemory : public GridSource {
 public:
  PlaneInMemory(std::vector<double> x, std::vector<double> y, std::vector<double> values)
      : columns_(x.size()), values_(std::move(values)) {
    variable_.found = true;
    variable_.name = "elevation";
    variable_.units = "m";
    variable_.dimensions = {
        {.name = "y", .known = true, .axis = GridAxis::latitude, .values = std::move(y)},
        {.name = "x", .known = true, .axis = GridAxis::longitude, .values = std::move(x)}};
  }

  const GridVariable& variable() const noexcept override { return variable_; }

  std::vector<double> read(const GridPart& part) const override {
    std::vector<double> some;
    for (std::size_t j = part.start[0]; j < part.start[0] + part.count[0]; ++j) {
      const auto begin =
          values_.begin() + static_cast<std::ptrdiff_t>(j * columns_ + part.start[1]);
      some.insert(some.end(), begin, begin + static_cast<std::ptrdiff_t>(part.count[1]));
    }
    return some;
  }

 private:
  std::size_t columns_;
  std::vector<double> values_;
  GridVariable variable_;
};

}  // namespace

std::optional<DataGrid> read_ascii_grid(const std::filesystem::path& path) {
  if (climatology::lower(InputFile(path, "a file of bathymetry").read(5)) != "ncols")
    return std::nullopt;
  note_read(path);
  const std::string text = read_input(path, "a grid of ESRI's");
  AsciiWords words(text);
  const auto wrong = [&](const std::string& got, const std::string& expected) {
    return InputError({.where = path.string() + ":" + std::to_string(words.line()),
                       .got = got,
                       .expected = expected});
  };
  std::map<std::string, double> head;
  for (std::size_t place = 0;;) {
    const std::string key = climatology::lower(words.next());
    if (key.empty() || key[0] < 'a' || key[0] > 'z' || key == "nan") {
      words.back_to(place);
      break;
    }
    const std::string value(words.next());
    const auto number = number_of_word(value);
    if (!number) throw wrong(in_quotes(value), "a number of " + in_quotes(key));
    head[key] = *number;
    place = words.place();
  }
  const auto of = [&](const char* key, const char* other) {
    for (const char* name : {key, other})
      if (head.count(name) != 0) return head[name];
    throw wrong("no line of " + in_quotes(key), "one in the head of the grid");
  };
  const double columns = of("ncols", "ncols"), rows = of("nrows", "nrows");
  const double dx = of("cellsize", "dx"), dy = of("cellsize", "dy");
  if (!(columns >= 1.0 && rows >= 1.0 && columns * rows <= 2.5e7 && dx > 0.0 && dy > 0.0))
    throw wrong(to_text(columns) + " by " + to_text(rows) + " cells",
                "1 to 2.5e7 cells of a size above 0; netCDF may have more");
  const double west = of("xllcorner", "xllcenter") + (head.count("xllcorner") != 0 ? dx / 2 : 0.0);
  const double south = of("yllcorner", "yllcenter") + (head.count("yllcorner") != 0 ? dy / 2 : 0.0);
  const auto n = static_cast<std::size_t>(columns), m = static_cast<std::size_t>(rows);
  if (!(std::abs(west) <= 360.0 && south >= -90.0 && south + dy * (rows - 1.0) <= 90.0))
    throw wrong("a corner at " + to_text(west) + ", " + to_text(south), "degrees east and north");
  std::vector<double> x(n), y(m), values(n * m);
  for (std::size_t i = 0; i < n; ++i) x[i] = west + dx * static_cast<double>(i);
  for (std::size_t j = 0; j < m; ++j) y[j] = south + dy * static_cast<double>(m - 1 - j);
  const double none =
      head.count("nodata_value") != 0 ? head["nodata_value"] : -9999.0;  // ESRI's default
  for (double& value : values) {
    const std::string_view word = words.next();
    const auto number = number_of_word(word);
    if (!number)
      throw wrong(word.empty() ? "the end of the file" : in_quotes(word),
                  std::to_string(n * m) + " numbers in all");
    value = *number == none ? std::numeric_limits<double>::quiet_NaN() : *number;
  }
  return DataGrid::of(
      path, std::make_unique<const PlaneInMemory>(std::move(x), std::move(y), std::move(values)));
}

}  // namespace asdic::detail
