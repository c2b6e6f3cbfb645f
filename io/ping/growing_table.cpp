#include "io/ping/growing_table.h"

#include <numeric>
#include <stdexcept>

namespace asdic::detail {

GrowingTable::GrowingTable(Hdf5File& file, const std::string& group, const std::string& dimension,
                           std::vector<Column> columns)
    : file_(&file),
      group_(group),
      dimension_(group + "/" + dimension),
      columns_(std::move(columns)),
      pending_(columns_.size()) {
  constexpr std::size_t chunk = 512;
  file.create_growing<std::int32_t>(dimension_, {}, chunk);
  describe(file, dimension_, "row");
  file.make_scale(dimension_, dimension);
  for (const Column& column : columns_) {
    const std::string path = group_ + "/" + column.name;
    if (column.type == ElementType::int32)
      file.create_growing<std::int32_t>(path, {}, chunk);
    else if (column.type == ElementType::int8)
      file.create_growing<std::int8_t>(path, {}, chunk);
    else
      file.create_growing<double>(path, {}, chunk);
    describe(file, path, column.long_name, column.units, column.meaning);
    file.attach_scales(path, {dimension_});
  }
}

void GrowingTable::row(const std::vector<double>& values) {
  if (values.size() != columns_.size()) throw std::logic_error(group_ + ": a row of another width");
  for (std::size_t i = 0; i < values.size(); ++i) pending_[i].push_back(values[i]);
  ++rows_;
}

void GrowingTable::write() {
  std::vector<std::int32_t> index(rows_ - written_);
  std::iota(index.begin(), index.end(), static_cast<std::int32_t>(written_));
  file_->append<std::int32_t>(dimension_, index);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::string path = group_ + "/" + columns_[i].name;
    std::vector<double>& values = pending_[i];
    if (columns_[i].type == ElementType::int32)
      file_->append<std::int32_t>(path, std::vector<std::int32_t>(values.begin(), values.end()));
    else if (columns_[i].type == ElementType::int8)
      file_->append<std::int8_t>(path, std::vector<std::int8_t>(values.begin(), values.end()));
    else
      file_->append<double>(path, values);
    values.clear();
  }
  written_ = rows_;
}

}  // namespace asdic::detail
