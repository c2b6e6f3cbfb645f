#include "core/fields_viewer.h"

namespace asdic::detail {

FieldsViewer::~FieldsViewer() = default;

void FieldsViewer::table(const Setting&, const Structure& inner) { inner.describe(*this); }

void FieldsViewer::perhaps(const Setting&, const Perhaps& inner) {
  if (inner.present) inner.get().describe(*this);
}

void FieldsViewer::number_or_table(const Setting& s, const Quantity& q, double& value,
                                   const Perhaps& instead) {
  if (instead.present)
    table(s, instead.get());
  else
    number(s, q, value, nullptr);
}

void FieldsViewer::tables(const Setting&, const List& list, const ListRules&) {
  for (std::size_t i = 0; i < list.size(); ++i) list.at(i).describe(*this);
}

void FieldsViewer::alternatives(const Setting&, const OneOf& one) { one.chosen().describe(*this); }

}  // namespace asdic::detail
