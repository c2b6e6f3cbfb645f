#pragma once
#include <string>
#include <vector>

#include "io/scenario/materials/form.h"

namespace asdic::detail::scenario {

/// One reflection curve: lists of one length.
struct RowsTable {
  ReflectionTable rows = {};

  void describe(Fields& field);
};

/// One of several curves.
struct CurveTable {
  double frequency = 0.0;
  RowsTable rows = {};

  void describe(Fields& field);
};

/// One curve, or with frequencies several: [[…curve]], or a file with a column for them.
struct ReflectionForm {
  static constexpr std::string_view name = ReflectionTable::name;
  std::string file = {};
  std::vector<CurveTable> curves = {};
  RowsTable one = {};

  void describe(Fields& field);
  [[nodiscard]] BoundaryMaterial build(const MaterialPlace& place) const;
  [[nodiscard]] static ReflectionForm of(const ReflectionTable& rows);
  [[nodiscard]] static ReflectionForm of(const ReflectionCurves& curves);
};
static_assert(FormOf<ReflectionForm, ReflectionTable> && FormOf<ReflectionForm, ReflectionCurves>);

}  // namespace asdic::detail::scenario
