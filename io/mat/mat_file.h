#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/files/output_file.h"

namespace asdic::detail {

/// A matrix of doubles, column by column.
struct MatMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values{};  ///< [columns × rows]
};
struct MatField;
/// What a variable may hold: numbers, a text (UTF-8), a column of texts (a cell array), a struct.
using MatValue =
    std::variant<MatMatrix, std::string, std::vector<std::string>, std::vector<MatField>>;
struct MatField {
  std::string name;
  MatValue value;
};
using MatStruct = std::vector<MatField>;

/// A matrix of float32 that is asked for column by column.
struct MatColumns {
  std::size_t rows = 0, columns = 0;
  bool is_complex = false;
  /// \return [rows], of complex numbers [rows × 2], real and imaginary parts in turn. Complex
  /// columns are asked for twice.
  std::function<std::vector<float>(std::size_t column)> column{};
};

/// The most bytes of a variable: MATLAB and Octave count them in 31 bits.
inline constexpr std::uint64_t most_mat_bytes = (std::uint64_t{1} << 31) - 1;
[[nodiscard]] std::uint64_t bytes_of(const MatColumns& matrix) noexcept;

/// Writes a MAT-file of level 5, little-endian, not compressed: what MATLAB writes with `save -v6`.
/// Format: The MathWorks, MAT-File Format (2010 and later), chapter 1.
///
/// Names are at most 31 letters, digits and "_"; that is the caller's to keep. Texts are stored in
/// UTF-16, as MATLAB does.
class MatFile {
 public:
  /// \throws InputError for a file that is there and not ours (`rules` may force it), RunError
  explicit MatFile(const std::filesystem::path& path, OutputRules rules = {});

  /// One variable. \throws InputError for more than most_mat_bytes, RunError
  void write(std::string_view name, const MatValue& value);
  void write(std::string_view name, const MatColumns& matrix);
  /// Gives the file its name. \throws RunError
  void finish();

 private:
  void put(std::string_view bytes);
  void check_size(std::string_view name, std::uint64_t bytes) const;

  OutputFile output_;
  std::ofstream file_;
};

}  // namespace asdic::detail
