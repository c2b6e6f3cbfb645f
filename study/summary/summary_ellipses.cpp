// Part of summary_parts.h: ellipses of errors of place.
#include <array>
#include <cmath>

#include "core/units.h"
#include "study/plan/no_value.h"
#include "study/summary/axis.h"
#include "study/summary/error_ellipse.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

constexpr std::string_view north_error = "north_error";

/// Of what components, and what tables and columns are called by them: east_bias, north_bias;
/// across_bias, away_bias.
struct Frame {
  std::string table, x, y, title, bearing;
};
const std::array<Frame, 2> frames{
    {{"ellipses", "east", "north", "Ellipses of errors of place", "true bearing of the long axis"},
     {"sight_ellipses", "across", "away", "Ellipses of errors of place about the line of sight",
      "of the long axis, from away to the right of the line of sight"}}};

std::string percent(double confidence) {
  const double value = 100.0 * confidence;
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void begin(SummaryTable& made, const Frame& frame, double confidence) {
  const Column metres{.name = "", .unit = "m", .meaning = ""};
  const Column angle{.name = "", .unit = "degrees", .meaning = ""};
  const Column share{.name = "", .unit = "1", .meaning = ""};
  const auto with_interval = [&](const Column& like, const std::string& name,
                                 const std::string& meaning) {
    add_column(made, like, name, meaning);
    add_column(made, like, name + "_low", "confidence interval");
    add_column(made, like, name + "_high", "confidence interval");
  };
  add_column(made, share, "found", "realisations in which the receiver has a place");
  add_column(made, metres, "target_east", "mean place of the found targets, from the array");
  add_column(made, metres, "target_north", "mean place of the found targets, from the array");
  with_interval(metres, frame.x + "_bias", "mean error " + frame.x);
  with_interval(metres, frame.y + "_bias", "mean error " + frame.y);
  const std::string whose =
      " of the ellipse about the mean error that holds " + percent(confidence) + " %";
  with_interval(metres, "major", "half the long axis" + whose);
  with_interval(metres, "minor", "half the short axis" + whose);
  with_interval(angle, "axis_deg", frame.bearing);
  add_column(made, share, "inside", "share of these errors within the ellipse");
  add_column(made, metres, "rms", "root of the mean square of the errors");
}

}  // namespace

std::vector<SummaryTable> ellipse_tables(const Study& study, const Cells& cells,
                                         const std::string& suffix, const std::string& along,
                                         const Table& table) {
  std::vector<SummaryTable> all;
  if (!study.measure.wants("localisation_ellipse") || is_weighted(table)) return all;
  const double confidence = study.summary.confidence;
  for (const Column& column : table.columns) {
    if (!column.name.starts_with(north_error) || column.role != Column::Role::measure) continue;
    const std::string whose = column.name.substr(north_error.size());
    const auto at = [&](const std::string& name) { return column_of(table, name + whose); };
    for (const Frame& frame : frames) {
      SummaryTable made = cells.table(frame.table + whose + suffix, frame.title + along);
      made.intervals =
          "of the bias by the normal distribution, of axes and bearing by fourth moments, of rows "
          "taken for independent; the ellipse is for the next of normal errors (Hotelling)";
      begin(made, frame, confidence);
      const std::size_t x_column = at(frame.x + "_error"), y_column = at(frame.y + "_error");
      const std::size_t east = at("target_east"), north = at("target_north");
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        std::vector<double> x, y;
        Moments of_east, of_north;
        double valid = 0.0;
        for (const std::size_t row : cells.rows(cell)) {
          valid += table.valid[row] != 0 ? 1.0 : 0.0;
          if (!counts(table, row, x_column) || !counts(table, row, y_column)) continue;
          x.push_back(table.values[x_column][row]);
          y.push_back(table.values[y_column][row]);
          of_east.add(table.values[east][row]);
          of_north.add(table.values[north][row]);
        }
        const ErrorEllipse e = error_ellipse(x, y, confidence);
        const double bearing = degrees(e.bearing), half = degrees(e.bearing_half);
        cells.start_row(made, cell, valid);
        put(made, {e.count,
                   of_east.mean(),
                   of_north.mean(),
                   e.mean_x,
                   e.mean_x_interval.low,
                   e.mean_x_interval.high,
                   e.mean_y,
                   e.mean_y_interval.low,
                   e.mean_y_interval.high,
                   e.major,
                   e.major_interval.low,
                   e.major_interval.high,
                   e.minor,
                   e.minor_interval.low,
                   e.minor_interval.high,
                   bearing,
                   bearing - half,
                   bearing + half,
                   e.inside,
                   e.rms});
      }
      all.push_back(std::move(made));
    }
  }
  return all;
}

}  // namespace asdic::detail::study
