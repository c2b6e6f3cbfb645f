#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail {

using Shape = std::vector<std::size_t>;

enum class ElementType { int8, int32, int64, float32, float64, text, other };
[[nodiscard]] std::string_view name(ElementType type) noexcept;

struct DatasetInfo {
  std::string path;  ///< "/arrivals/delay"
  ElementType type = ElementType::other;
  Shape shape;  ///< empty: a scalar
};

/// Rows of a dataset of another file that a virtual dataset shows as its own.
struct VirtualRows {
  std::filesystem::path file;  ///< relative: to the folder of the file that shows them
  std::string dataset;
  Shape shape;            ///< of that dataset; its rows may be smaller than those that show it
  std::size_t first = 0;  ///< its first row to show
  std::size_t rows = 0;
};

/// An HDF5 file: the only place that knows the C library.
///
/// Elements are std::int8_t, int32_t, int64_t, float or double; what is read is converted to the
/// type asked for. Paths may start with "/" or not; missing groups are made. Failures of the
/// library throw RunError with file, dataset and HDF5's own message; a file that is not (whole)
/// HDF5 throws InputError when opened.
///
/// The library is not thread-safe: all Hdf5File objects of a process belong to one thread at a
/// time.
class Hdf5File {
 public:
  /// An empty file, in place of any that is there.
  [[nodiscard]] static Hdf5File create(const std::filesystem::path& path);
  /// For reading.
  [[nodiscard]] static Hdf5File open(const std::filesystem::path& path);
  /// The same for a look that does not make the file an input of the run (FilesRead).
  [[nodiscard]] static Hdf5File peek(const std::filesystem::path& path);
  /// For reading and changing what is there.
  [[nodiscard]] static Hdf5File edit(const std::filesystem::path& path);
  Hdf5File(Hdf5File&&) noexcept;
  Hdf5File& operator=(Hdf5File&&) noexcept;
  ~Hdf5File();  ///< closes; faults are lost (call close() to receive of them)

  void flush();  ///< all that was written can be read even if the program dies
  void close();
  [[nodiscard]] const std::filesystem::path& path() const noexcept;

  /// A whole dataset at once. \param values  [product of shape] row-major
  template <class T>
  void write(const std::string& dataset, std::span<const T> values, const Shape& shape);
  /// A dataset that shows rows of others, one part after the other; `fill` where they have none.
  /// \param shape  {sum of the parts' rows, …}
  template <class T>
  void write_virtual(const std::string& dataset, const Shape& shape,
                     std::span<const VirtualRows> parts, T fill);
  /// A scalar string, of any length (UTF-8).
  void write_text(const std::string& dataset, std::string_view text);

  /// A dataset whose first dimension grows by append(). Its chunks carry checksums (Fletcher-32):
  /// no reader takes damaged ones for data.
  /// \param row    shape of one row, {} for a column   \param chunk_rows  rows stored together
  /// \param deflate  compression level 1..9, 0: none (faster)
  template <class T>
  void create_growing(const std::string& dataset, const Shape& row, std::size_t chunk_rows,
                      int deflate = 0);
  /// The same with the whole shape of a chunk given: {rows, …}.
  template <class T>
  void create_growing(const std::string& dataset, const Shape& row, const Shape& chunk,
                      int deflate = 0);
  /// \param values  [rows × product of row shape]
  template <class T>
  void append(const std::string& dataset, std::span<const T> values);
  /// Appends one row of which only the first part of every line of the last dimension is given;
  /// the rest is 0. \param values  [product of the other dimensions × length]
  template <class T>
  void append_padded(const std::string& dataset, std::span<const T> values, std::size_t length);

  /// A dimension that has a length but no values, as netCDF keeps its dimensions without a
  /// variable: a scale that takes no room in the file, and reads as zeros.
  void make_dimension(const std::string& dataset, std::size_t size);
  /// Whether a dataset's first dimension grows, and takes rows off its end.
  [[nodiscard]] bool grows(const std::string& dataset) const;
  void shrink(const std::string& dataset, std::size_t rows);
  /// Whether its chunks carry checksums.
  [[nodiscard]] bool has_checksums(const std::string& dataset) const;

  /// Makes a dataset the scale of a dimension, and hangs scales on the axes of another.
  void make_scale(const std::string& dataset, const std::string& dimension);
  void attach_scales(const std::string& dataset, const std::vector<std::string>& scales);

  /// Attribute of a dataset or group ("" or "/": the file). Replaces one of that name.
  void set_attribute(const std::string& object, const std::string& key, std::string_view value);
  void set_attribute(const std::string& object, const std::string& key, double value);
  void set_attribute(const std::string& object, const std::string& key, std::int64_t value);
  void set_attribute(const std::string& object, const std::string& key,
                     const std::vector<std::string>& values);
  /// CF's flag_values, of the type of an int8 dataset, and flag_meanings: words between spaces.
  void set_flags(const std::string& dataset, const std::vector<std::int8_t>& values,
                 std::string_view meanings);
  void make_group(const std::string& group);
  /// Takes a dataset or a whole group away, if it is there.
  void remove(const std::string& object);

  [[nodiscard]] bool has(const std::string& object) const;
  [[nodiscard]] std::vector<DatasetInfo> datasets() const;  ///< all, sorted by path
  [[nodiscard]] DatasetInfo info(const std::string& dataset) const;
  /// The files of whose rows a virtual dataset is made, each once, in its order, as they are named
  /// there; {} for one that holds its own.
  [[nodiscard]] std::vector<std::filesystem::path> virtual_files(const std::string& dataset) const;
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& dataset) const;
  /// A block. \param start, count  one number per dimension
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& dataset, const Shape& start,
                                    const Shape& count) const;
  [[nodiscard]] std::string read_text(const std::string& dataset) const;

  [[nodiscard]] std::vector<std::string> attributes(const std::string& object) const;  ///< names
  [[nodiscard]] bool has_attribute(const std::string& object, const std::string& key) const;
  /// Strings, or numbers in their shortest form; one for a scalar.
  [[nodiscard]] std::vector<std::string> attribute_texts(const std::string& object,
                                                         const std::string& key) const;
  /// As one text, whatever it is: numbers in their shortest form, lists joined by ", ".
  [[nodiscard]] std::string attribute_text(const std::string& object, const std::string& key) const;
  /// The same, or something else where there is no such object or attribute.
  [[nodiscard]] std::string attribute_or(const std::string& object, const std::string& key,
                                         std::string_view otherwise) const;
  [[nodiscard]] double attribute_number(const std::string& object, const std::string& key) const;

 private:
  struct Impl;
  explicit Hdf5File(std::unique_ptr<Impl> impl);
  static std::unique_ptr<Impl> open_existing(const std::filesystem::path& path, bool change);
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail
