// What rows keep beside their columns, of StudyFileWriter: spectra, detections.
#include <cmath>

#include "core/error.h"
#include "study/runs/study_file_writer.h"

namespace asdic::detail::study {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t lines_of_chunk = 512, lines_in_hand = 4096;

std::vector<std::int32_t> whole(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// A dataset that grows, of one type or the other.
void grow(Hdf5File& file, const std::string& path, const KeptColumn& column, const Shape& row,
          const Shape& chunk) {
  if (column.type == ElementType::int32)
    file.create_growing<std::int32_t>(path, row, chunk);
  else
    file.create_growing<double>(path, row, chunk);
}

}  // namespace

void StudyFileWriter::write_kept(std::size_t kind, const KeptSource& kept) {
  const KeptHeads& told = kept.told;
  if (told.index.empty()) return;
  const std::string group = std::string(kept.kind->name) + '/', scale = group + "index";
  const auto of = [kind](const CataloguePart& part) { return part.kept[kind].heads; };
  const std::vector<std::int64_t> index(told.index.begin(), told.index.end());
  column<std::int64_t>(scale, index, -1, of);
  describe(file_, scale, "realisation, counted from 0");
  file_.make_scale(scale, "kept");
  const auto numbers = [&](const KeptColumn& one, const std::vector<double>& values) {
    const std::string path = group + one.name;
    if (one.type == ElementType::int32)
      column<std::int32_t>(path, whole(values), 0, of);
    else
      column<double>(path, values, none, of);
    describe(file_, path, one.long_name, one.units, one.meaning);
    file_.attach_scales(path, {scale});
  };
  std::vector<double> values;
  for (const Shape& shape : told.shapes)
    values.push_back(static_cast<double>(shape[kept.kind->axis()]));
  numbers(kept.kind->count, values);
  for (std::size_t i = 0; i < kept.kind->head.size(); ++i) {
    values.clear();
    for (const std::vector<double>& head : told.heads) values.push_back(head.at(i));
    numbers(kept.kind->head[i], values);
  }
  if (kept.kind->layout == KeptKind::Layout::padded)
    write_padded(kind, kept);
  else
    write_ragged(kind, kept);
}

/// Each row's in a chunk of its own, one after the other: they are never held together.
void StudyFileWriter::write_padded(std::size_t kind, const KeptSource& kept) {
  const KeptKind& of = *kept.kind;
  const std::string group = std::string(of.name) + '/', path = group + of.values[0].name;
  const std::vector<Shape>& shapes = kept.told.shapes;
  const std::size_t lines = shapes.front()[0];
  std::size_t most = 0;
  for (const Shape& shape : shapes) {
    if (shape[0] != lines)
      throw RunError(std::string(of.name) + " of different numbers of " + std::string(of.line) +
                     "s cannot lie in one dataset");
    most = std::max(most, shape[1]);
  }
  const Shape all{shapes.size(), lines, most};
  if (catalogue_.empty())
    grow(file_, path, of.values[0], {lines, most}, {1, lines, most});
  else
    file_.write_virtual<double>(
        path, all, shown(path, [kind](const CataloguePart& p) { return p.kept[kind].values; }),
        none);
  Digest digest;
  std::vector<double> padded;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const KeptArray array = kept.array(k);
    padded.assign(lines * most, none);
    for (std::size_t line = 0; line < lines; ++line)
      std::copy_n(array.values.begin() + static_cast<std::ptrdiff_t>(line * shapes[k][1]),
                  shapes[k][1], padded.begin() + static_cast<std::ptrdiff_t>(line * most));
    if (catalogue_.empty()) file_.append<double>(path, padded);
    digest.add(std::span<const double>(padded));
  }
  note(path, all, digest.text());
  describe(file_, path, of.values[0].long_name, of.values[0].units, of.values[0].meaning);
  const std::string line = group + std::string(of.line), number = group + std::string(of.number);
  file_.make_dimension(line, lines);
  describe(file_, line, std::string(of.line_says));
  file_.make_dimension(number, most);
  describe(file_, number, std::string(of.number_says));
  file_.attach_scales(path, {group + "index", line, number});
}

/// A column for each number of a line, and one for the realisation that the line is of: CF's
/// "contiguous ragged array".
void StudyFileWriter::write_ragged(std::size_t kind, const KeptSource& kept) {
  const KeptKind& of = *kept.kind;
  const std::string group = std::string(of.name) + '/', link = group + std::string(of.line);
  std::size_t lines = 0;
  for (const Shape& shape : kept.told.shapes) lines += shape[0];
  const Shape chunk{lines_of_chunk};
  const auto make = [&](const std::string& path, const KeptColumn& column) {
    // Where no part has a line there is nothing to show.
    if (catalogue_.empty() || lines == 0) return grow(file_, path, column, {}, chunk);
    const auto parts =
        shown(path, [kind](const CataloguePart& part) { return part.kept[kind].values; });
    if (column.type == ElementType::int32)
      file_.write_virtual<std::int32_t>(path, {lines}, parts, -1);
    else
      file_.write_virtual<double>(path, {lines}, parts, none);
  };
  std::vector<std::int64_t> realisation;
  for (std::size_t k = 0; k < kept.told.index.size(); ++k)
    realisation.insert(realisation.end(), kept.told.shapes[k][0],
                       static_cast<std::int64_t>(kept.told.index[k]));
  column<std::int64_t>(link, realisation, -1,
                       [kind](const CataloguePart& part) { return part.kept[kind].values; });
  describe(file_, link, "of which it is, counted from 0");
  file_.make_scale(link, std::string(of.line));
  file_.set_attribute(group + of.count.name, "sample_dimension", std::string(of.line));
  for (const KeptColumn& one : of.values) {
    make(group + one.name, one);
    describe(file_, group + one.name, one.long_name, one.units, one.meaning);
    file_.attach_scales(group + one.name, {link});
  }
  const std::size_t width = of.values.size();
  std::vector<Digest> digests(width);
  std::vector<std::vector<double>> waiting(width);
  const auto flush = [&] {
    for (std::size_t i = 0; i < width; ++i) {
      const auto put = [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if (catalogue_.empty()) file_.append<T>(group + of.values[i].name, values);
        digests[i].add(std::span<const T>(values));
      };
      if (of.values[i].type == ElementType::int32)
        put(whole(waiting[i]));
      else
        put(waiting[i]);
      waiting[i].clear();
    }
  };
  for (std::size_t k = 0; k < kept.told.index.size(); ++k) {
    const KeptArray array = kept.array(k);
    for (std::size_t n = 0; n < array.values.size(); ++n)
      waiting[n % width].push_back(array.values[n]);
    if (waiting[0].size() >= lines_in_hand) flush();
  }
  flush();
  for (std::size_t i = 0; i < width; ++i)
    note(group + of.values[i].name, {lines}, digests[i].text());
}

}  // namespace asdic::detail::study
