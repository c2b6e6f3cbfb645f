#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"
#include "app/explanation.h"

namespace asdic::detail::app {
namespace {

using compare::ArrivalDifference;
using compare::FieldDifference;
using compare::RayDifference;

constexpr double same_db = 0.1, same_us = 0.5;  // how near two builds of BELLHOP are, at 95 %

/// One number by which effects are ranked: dB, µs or m at 95 %.
double size_of(const Comparison& difference) {
  if (const auto* field = std::get_if<FieldDifference>(&difference)) return field->tl_db.p95;
  if (const auto* list = std::get_if<ArrivalDifference>(&difference)) return list->delay_us.p95;
  return std::get<RayDifference>(difference).inside_m.p95;
}

const Effect* largest(const Explanation& e) {
  const auto i =
      std::max_element(e.effects.begin(), e.effects.end(), [](const Effect& a, const Effect& b) {
        return size_of(a.difference) < size_of(b.difference);
      });
  return i == e.effects.end() ? nullptr : &*i;
}

double step_effect(const Explanation& e) {
  for (const Effect& effect : e.effects)
    if (effect.name == "step") return size_of(effect.difference);
  return 0.0;
}

void on_field(const Explanation& e, const FieldDifference& d, std::vector<std::string>& out) {
  const bool coherent = e.kind.rfind("coherent", 0) == 0;
  if (d.tl_db.p95 <= 0.5)
    out.push_back(fmt::format("trust this field: 95 % of its cells are within {} dB of the truth",
                              number(d.tl_db.p95, 2)));
  else if (d.tl_db.median <= 0.5)
    out.push_back(
        fmt::format("trust its larger features (median {} dB off), not single cells (95 %: {} dB; "
                    "cells that are "
                    "weak beside their neighbours are the worst)",
                    number(d.tl_db.median, 2), number(d.tl_db.p95, 1)));
  else
    out.push_back(
        fmt::format("do not trust single cells: half of them are more than {} dB off, one "
                    "in twenty more than {} dB",
                    number(d.tl_db.median, 2), number(d.tl_db.p95, 1)));
  if (std::abs(d.level_db) <= 0.5)
    out.push_back(fmt::format("trust its mean level: {} dB off", number(d.level_db, 2)));
  else
    out.push_back(fmt::format("its mean level too is {} dB off", number(d.level_db, 2)));
  if (coherent && d.phase_deg.median > 10.0)
    out.push_back(fmt::format(
        "its phases are wrong by {} degrees in the middle: do not beamform or match fields with it",
        number(d.phase_deg.median, 0)));
}

void on_arrivals(const Explanation& e, const ArrivalDifference& d, std::vector<std::string>& out) {
  const double period_us = 1e6 / e.frequency;
  if (d.delay_us.p95 < 0.02 * period_us)
    out.push_back(
        fmt::format("trust the delays, also for phases: 95 % within {} us, {} % of a period",
                    number(d.delay_us.p95, 2), number(100.0 * d.delay_us.p95 / period_us, 1)));
  else
    out.push_back(fmt::format("trust the delays to {} us (95 %), which is {} periods: {}",
                              number(d.delay_us.p95, 1), number(d.delay_us.p95 / period_us, 2),
                              d.delay_us.p95 < 0.25 * period_us
                                  ? "sums of arrivals are only roughly right"
                                  : "do not add these arrivals coherently"));
  if (d.amplitude_db.p95 <= 0.5)
    out.push_back(
        fmt::format("trust the amplitudes: 95 % within {} dB", number(d.amplitude_db.p95, 2)));
  else
    out.push_back(
        fmt::format("amplitudes: half within {} dB, but one in twenty is more than {} dB off",
                    number(d.amplitude_db.median, 2), number(d.amplitude_db.p95, 1)));
  if (d.matched < d.paths_b)
    out.push_back(
        fmt::format("{} of {} paths are missing ({} of those within 20 dB of the strongest)",
                    d.paths_b - d.matched, d.paths_b, d.strong_b - d.strong_matched));
  if (d.rows_a > d.paths_a + d.paths_a / 10)
    out.push_back(
        fmt::format("{} rows for {} paths: a path comes as several rows; join them before counting",
                    d.rows_a, d.paths_a));
}

void on_rays(const RayDifference& d, std::vector<std::string>& out) {
  out.push_back(fmt::format("rays are {} m off at the median, {} m at 95 %",
                            number(d.inside_m.median, 1), number(d.inside_m.p95, 1)));
  if (d.paired < d.rays_b)
    out.push_back(fmt::format("{} of {} have no partner: other bounces, or another angle",
                              d.rays_b - d.paired, d.rays_b));
}

/// Two digits.
std::string rounded(double x) {
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(x))));
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return number(std::round(x / unit) * unit, decimals);
}

/// Whether a file is what BELLHOP makes of this input.
bool same(const Comparison& difference) {
  if (const auto* field = std::get_if<FieldDifference>(&difference))
    return field->tl_db.p95 <= same_db;
  if (const auto* list = std::get_if<ArrivalDifference>(&difference))
    return list->delay_us.p95 <= same_us && list->amplitude_db.p95 <= same_db &&
           list->matched == list->paths_b;
  const auto& rays = std::get<RayDifference>(difference);
  return rays.paired == rays.rays_b && rays.inside_m.max <= 0.01;
}

/// Whose file it is and whether it is of this input.
std::string about_file(const Explanation::OnDisk& old) {
  using Writer = Explanation::OnDisk::Writer;
  if (old.writer == Writer::asdic)
    return old.file + " is asdic's own (its .prt says so): nothing here is about BELLHOP's file";
  std::string whose;
  if (old.writer == Writer::unknown) whose = " (taken for BELLHOP's: no .prt tells)";
  if (old.writer == Writer::asdic_bellhop_emulation) whose = " (written by asdic --like-bellhop)";
  if (same(old.bellhop_emulation))
    return old.file + whose + " is what BELLHOP makes of this input: all of this is true of it";
  return old.file + whose +
         " is not what BELLHOP (2022 in its repaired Fortran) makes of this input: another "
         "version, "
         "or another input";
}

}  // namespace

std::vector<std::string> advice_on(const Explanation& e) {
  std::vector<std::string> out;
  if (const auto* field = std::get_if<FieldDifference>(&e.total))
    on_field(e, *field, out);
  else if (const auto* list = std::get_if<ArrivalDifference>(&e.total))
    on_arrivals(e, *list, out);
  else
    on_rays(std::get<RayDifference>(e.total), out);

  const bool arrivals = std::holds_alternative<ArrivalDifference>(e.total);
  const bool field = std::holds_alternative<FieldDifference>(e.total);
  const double small = arrivals ? 2.0 * same_us : field ? 2.0 * same_db : 1.0;
  if (const Effect* most = largest(e); most != nullptr && size_of(most->difference) > small)
    out.push_back(fmt::format("most of it is the {} ({})", most->name, most->setting));
  // The method is of second order: delays and paths come nearer with the square of the step.
  if (const double error = step_effect(e); !field && error > small)
    out.push_back(
        fmt::format("with BELLHOP, a step of about {} m would bring its share below {:g} {}",
                    rounded(e.step * std::sqrt(small / error)), small, arrivals ? "us" : "m"));
  if (e.on_disk) out.push_back(about_file(*e.on_disk));
  return out;
}

}  // namespace asdic::detail::app
