#include "io/compare/fields.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/units.h"

namespace asdic::detail::compare {
namespace {

using Complex = std::complex<double>;

/// Two coordinates name one place: within a millimetre, or the grain of float32 far away.
bool same_place(double x, double y) { return std::abs(x - y) <= 1e-3 + 1e-6 * std::abs(y); }

bool same_axis(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same_place);
}

std::string axis_text(const std::vector<double>& axis, const char* unit = " m") {
  std::ostringstream text;
  text << axis.size();
  if (!axis.empty()) text << " from " << axis.front() << " to " << axis.back() << unit;
  return text.str();
}

InputError grids_differ(const std::string& axis, const std::vector<double>& a,
                        const std::vector<double>& b) {
  return InputError({.where = "grid: " + axis,
                     .got = axis_text(a) + " in A, " + axis_text(b) + " in B",
                     .expected = "the same places (or --resample, when A has all those of B)"});
}

/// Fields of one map, plane for plane. One plane of a map is comparable with a field that tells
/// nothing of a map.
void check_map(const bellhop::MapPlaces& a, const bellhop::MapPlaces& b) {
  if (a.planes() == 1 && b.planes() == 1 && (!a.is_map() || !b.is_map())) return;
  const auto check = [](const char* axis, const std::vector<double>& x,
                        const std::vector<double>& y, const char* unit) {
    if (same_axis(x, y)) return;
    throw InputError({.where = std::string("grid: ") + axis,
                      .got = axis_text(x, unit) + " in A, " + axis_text(y, unit) + " in B",
                      .expected = "the same in both"});
  };
  check("azimuths", a.azimuths_deg, b.azimuths_deg, " degrees");
  check("source x", a.source_x, b.source_x, " m");
  check("source y", a.source_y, b.source_y, " m");
}

/// Index in `have` of every place that is wanted.
std::vector<std::size_t> pick(const std::string& axis, const std::vector<double>& have,
                              const std::vector<double>& wanted) {
  std::vector<std::size_t> index;
  for (const double place : wanted) {
    const auto nearest = std::min_element(have.begin(), have.end(), [&](double x, double y) {
      return std::abs(x - place) < std::abs(y - place);
    });
    if (nearest == have.end() || !same_place(*nearest, place)) {
      std::ostringstream where, got;
      got << "none at " << place << " m in A, which has " << axis_text(have);
      throw InputError(
          {.where = "grid: " + axis, .got = got.str(), .expected = "every place of B"});
    }
    index.push_back(static_cast<std::size_t>(nearest - have.begin()));
  }
  return index;
}

bool finite(Complex p) { return std::isfinite(p.real()) && std::isfinite(p.imag()); }

/// −20·log₁₀|p|, +∞ for silence.
double tl(Complex p) { return -20.0 * std::log10(std::abs(p)); }

double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0.0, my = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return x.size() > 2 && xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 1.0;
}

}  // namespace

AlignedFields align(const bellhop::ShadeFile& a, const bellhop::ShadeFile& b, bool resample) {
  AlignedFields all{.source_depths = b.source_depths,
                    .receiver_depths = b.receiver_depths,
                    .receiver_ranges = b.receiver_ranges,
                    .irregular = b.irregular,
                    .b = b.pressure};
  check_map(a.map, b.map);
  const bool same = a.irregular == b.irregular && same_axis(a.source_depths, b.source_depths) &&
                    same_axis(a.receiver_depths, b.receiver_depths) &&
                    same_axis(a.receiver_ranges, b.receiver_ranges);
  if (same) {
    all.a = a.pressure;
    return all;
  }
  if (a.irregular != b.irregular)
    throw InputError({.where = "grid",
                      .got = "scattered receivers in one file, a rectangular grid in the other",
                      .expected = "the same receivers in both"});
  if (!resample || a.irregular) {
    if (!same_axis(a.source_depths, b.source_depths))
      throw grids_differ("source depths", a.source_depths, b.source_depths);
    if (!same_axis(a.receiver_depths, b.receiver_depths))
      throw grids_differ("receiver depths", a.receiver_depths, b.receiver_depths);
    throw grids_differ("receiver ranges", a.receiver_ranges, b.receiver_ranges);
  }
  const auto source = pick("source depths", a.source_depths, b.source_depths);
  const auto depth = pick("receiver depths", a.receiver_depths, b.receiver_depths);
  const auto range = pick("receiver ranges", a.receiver_ranges, b.receiver_ranges);
  all.a.reserve(b.pressure.size());
  for (std::size_t plane = 0; plane < a.map.planes(); ++plane)
    for (const std::size_t s : source)
      for (const std::size_t z : depth)
        for (const std::size_t r : range)
          all.a.push_back(a.pressure[((plane * a.source_depths.size() + s) * a.rows() + z) *
                                         a.receiver_ranges.size() +
                                     r]);
  return all;
}

FieldDifference compare_fields(const AlignedFields& fields, const FieldOptions& options) {
  FieldDifference result{.cells = fields.b.size()};
  const std::size_t ranges = fields.receiver_ranges.size();
  std::size_t either = 0;
  std::vector<double> ta, tb, dtl, dphi;
  Complex inner = 0.0;                          // ⟨b, a⟩ = Σ r a b*
  double aa = 0.0, bb = 0.0, difference = 0.0;  // Σ r |·|²
  for (std::size_t i = 0; i < fields.b.size(); ++i) {
    const Complex a(fields.a[i]), b(fields.b[i]);
    const double range = fields.receiver_ranges[i % ranges];
    if (range < options.min_range) continue;
    if (!finite(a) || !finite(b)) {
      ++result.not_finite;
      continue;
    }
    const double tl_a = tl(a), tl_b = tl(b);
    const bool in_a = tl_a < options.floor_db, in_b = tl_b < options.floor_db;
    if (in_a || in_b) ++either;
    if (in_a != in_b) ++result.one_sided;
    if (!in_a || !in_b) continue;
    const double r = std::max(std::abs(range), 1e-9);
    ta.push_back(tl_a);
    tb.push_back(tl_b);
    dtl.push_back(tl_a - tl_b);
    dphi.push_back(degrees(std::arg(a * std::conj(b))));
    inner += r * a * std::conj(b);
    aa += r * std::norm(a);
    bb += r * std::norm(b);
    difference += r * std::norm(a - b);
  }
  result.compared = dtl.size();
  if (either > 0) result.one_sided_pct = share_pct(result.one_sided, either);
  if (dtl.empty()) return result;
  const auto n = static_cast<double>(dtl.size());
  for (std::size_t k = 0; k < result.within_pct.size(); ++k)
    result.within_pct[k] =
        100.0 / n * static_cast<double>(std::count_if(dtl.begin(), dtl.end(), [&](double d) {
          return std::abs(d) <= FieldDifference::within_db[k];
        }));
  result.tl_correlation = pearson(ta, tb);
  result.relative_error = std::sqrt(difference / bb);
  result.complex_correlation = std::abs(inner) / std::sqrt(aa * bb);
  result.mean_phase_deg = degrees(std::arg(inner));
  result.level_db = 10.0 * std::log10(aa / bb);
  result.tl_db = spread_of(std::move(dtl));
  result.phase_deg = spread_of(std::move(dphi));
  return result;
}

FieldDifference compare_fields(const bellhop::ShadeFile& a, const bellhop::ShadeFile& b,
                               const FieldOptions& options) {
  return compare_fields(align(a, b, options.resample), options);
}

}  // namespace asdic::detail::compare
