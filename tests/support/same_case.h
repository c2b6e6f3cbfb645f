#pragma once
#include <sstream>
#include <string>

#include "raytrace/cases/propagation_case.h"

namespace asdic::detail::support {

/// Tells the first thing in which two cases differ; "" if every number is the same.
class CaseComparison {
 public:
  static std::string difference(const PropagationCase& a, const PropagationCase& b) {
    CaseComparison comparison;
    comparison.cases(a, b);
    return comparison.first_;
  }

 private:
  template <class T>
  void same(const char* what, const T& a, const T& b) {
    if (a == b || !first_.empty()) return;
    std::ostringstream text;
    text.precision(17);
    text << what;
    if constexpr (std::is_arithmetic_v<T>) text << ": " << a << " and " << b;
    first_ = text.str();
  }
  template <class Range>
  void list(const char* what, const Range& a, const Range& b) {
    same((std::string(what) + " size").c_str(), a.size(), b.size());
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      same((std::string(what) + '[' + std::to_string(i) + ']').c_str(), a[i], b[i]);
  }
  void function(const char* what, const DepthFunction& a, const DepthFunction& b) {
    list(what, a.depths(), b.depths());
    list(what, a.values(), b.values());
    same(what, a.at(0.0), b.at(0.0));
  }
  void material(const char* what, const BoundaryMaterial& a, const BoundaryMaterial& b) {
    same(what, a.index(), b.index());
    if (a.index() != b.index()) return;
    if (const auto* x = std::get_if<FluidHalfSpace>(&a)) {
      const auto& y = std::get<FluidHalfSpace>(b);
      same(what, x->speed, y.speed);
      same(what, x->density, y.density);
      same(what, x->attenuation_db_per_wavelength, y.attenuation_db_per_wavelength);
    } else if (const auto* s = std::get_if<ElasticHalfSpace>(&a)) {
      const auto& t = std::get<ElasticHalfSpace>(b);
      same(what, s->speed, t.speed);
      same(what, s->shear_speed, t.shear_speed);
      same(what, s->density, t.density);
      same(what, s->attenuation_db_per_wavelength, t.attenuation_db_per_wavelength);
      same(what, s->shear_attenuation_db_per_wavelength, t.shear_attenuation_db_per_wavelength);
    } else if (const auto* r = std::get_if<ReflectionTable>(&a)) {
      const auto& u = std::get<ReflectionTable>(b);
      list(what, r->grazing, u.grazing);
      list(what, r->magnitude, u.magnitude);
      list(what, r->phase, u.phase);
    }
  }
  void boundary(const char* what, const Boundary& a, const Boundary& b) {
    same(what, a.depth, b.depth);
    material(what, a.material, b.material);
    same(what, a.shape.has_value(), b.shape.has_value());
    if (!a.shape || !b.shape) return;
    list(what, a.shape->ranges(), b.shape->ranges());
    list(what, a.shape->depths(), b.shape->depths());
    same(what, a.shape->interpolation(), b.shape->interpolation());
    same(what, a.shape->materials().size(), b.shape->materials().size());
    for (std::size_t i = 0; i < std::min(a.shape->materials().size(), b.shape->materials().size());
         ++i)
      material(what, a.shape->materials()[i], b.shape->materials()[i]);
  }
  void environment(const Environment& a, const Environment& b) {
    list("water depth", a.water.depths(), b.water.depths());
    list("water speed", a.water.speeds(), b.water.speeds());
    same("water law", a.water.interpolation(), b.water.interpolation());
    same("Munk", a.water.munk_parameters().has_value(), b.water.munk_parameters().has_value());
    same("section", a.section.has_value(), b.section.has_value());
    if (a.section && b.section) {
      list("section range", a.section->ranges(), b.section->ranges());
      list("section depth", a.section->depths(), b.section->depths());
      list("section speed", a.section->speeds(), b.section->speeds());
    }
    function("density", a.water_density, b.water_density);
    function("attenuation", a.attenuation_db_per_km, b.attenuation_db_per_km);
    boundary("surface", a.surface, b.surface);
    boundary("bottom", a.bottom, b.bottom);
    same("spreading", spreading_across(a), spreading_across(b));
    same("absorption", a.absorption.index(), b.absorption.index());
    same("absorption at 1 kHz", absorption_db_per_km(a.absorption, 1000.0),
         absorption_db_per_km(b.absorption, 1000.0));
    same("layers of fish", a.biology.size(), b.biology.size());
  }
  void cases(const PropagationCase& a, const PropagationCase& b) {
    same("title", a.title, b.title);
    same("frequency", a.frequency, b.frequency);
    environment(a.environment, b.environment);
    same("dimension", a.dimension, b.dimension);
    same("off_transect", a.off_transect, b.off_transect);
    list("source depth", a.source_depths, b.source_depths);
    list("receiver depth", a.receivers.depths, b.receivers.depths);
    list("receiver range", a.receivers.ranges, b.receivers.ranges);
    same("irregular", a.receivers.irregular, b.receivers.irregular);
    same("task", a.task, b.task);
    same("field", a.field, b.field);
    same("beam kind", a.beams.kind, b.beams.kind);
    same("source kind", a.beams.source, b.beams.source);
    same("displacement", a.beams.displacement, b.beams.displacement);
    same("lowest", a.beams.lowest, b.beams.lowest);
    same("highest", a.beams.highest, b.beams.highest);
    list("elevation", a.beams.elevations, b.beams.elevations);
    same("count", a.beams.count, b.beams.count);
    same("pattern", a.beams.pattern.has_value(), b.beams.pattern.has_value());
    if (a.beams.pattern && b.beams.pattern) {
      list("pattern elevation", a.beams.pattern->elevation, b.beams.pattern->elevation);
      list("pattern amplitude", a.beams.pattern->amplitude, b.beams.pattern->amplitude);
    }
    same("cerveny", a.beams.cerveny.has_value(), b.beams.cerveny.has_value());
    if (a.beams.cerveny && b.beams.cerveny) {
      const CervenyBeams &x = *a.beams.cerveny, &y = *b.beams.cerveny;
      same("width", x.width, y.width);
      same("curvature", x.curvature, y.curvature);
      same("width multiplier", x.width_multiplier, y.width_multiplier);
      same("loop range", x.loop_range, y.loop_range);
      same("images", x.images, y.images);
      same("window", x.window, y.window);
      same("component", x.component, y.component);
    }
    same("box range", a.box_range, b.box_range);
    same("box depth", a.box_depth, b.box_depth);
    same("step", a.literal.step, b.literal.step);
    same("beams", a.literal.beams, b.literal.beams);
    same("single beam", a.literal.single_beam.value_or(-1), b.literal.single_beam.value_or(-1));
  }

  std::string first_;
};

}  // namespace asdic::detail::support
