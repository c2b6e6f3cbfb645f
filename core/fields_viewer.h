#pragma once
#include "core/fields.h"

namespace asdic::detail {

/// A walk that looks at every setting, those of inner structs too, and does nothing with any: what
/// is interested in a few kinds of settings alone overrides those.
class FieldsViewer : public Fields {
 public:
  ~FieldsViewer() override;
  void axis(SettingKey, std::vector<double>&, const Quantity&, std::string_view) override {}
  void file(SettingKey, std::string&, std::string_view, std::string_view) override {}
  void columns(std::initializer_list<Column>, const ColumnRules&) override {}
  void sound(SettingKey, const Sound&, std::string_view) override {}
  void name(std::string&, std::string_view) override {}
  void reference(SettingKey, int&, std::string_view, std::string_view) override {}
  void derived(double&) override {}

 protected:
  void number(const Setting&, const Quantity&, double&, bool*) override {}
  void angle(const Setting&, const AngleQuantity&, double&, bool*) override {}
  void integer(const Setting&, std::int64_t, std::int64_t, std::int64_t&, bool*) override {}
  void flag(const Setting&, bool&) override {}
  void text(const Setting&, std::string&) override {}
  void numbers(const Setting&, const Quantity&, std::vector<double>&) override {}
  void angles(const Setting&, const AngleQuantity&, std::vector<double>&) override {}
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>&) override {}
  void vector(const Setting&, const Quantity&, std::span<double>, std::string_view) override {}
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>&) override {}
  void choice(const Setting&, std::span<const std::string_view>, std::size_t&) override {}
  void table(const Setting&, const Structure& inner) override;
  void perhaps(const Setting&, const Perhaps& inner) override;
  void number_or_table(const Setting& s, const Quantity& q, double& value,
                       const Perhaps& instead) override;
  void tables(const Setting&, const List& list, const ListRules&) override;
  void alternatives(const Setting&, const OneOf& one) override;
};

}  // namespace asdic::detail
