#include <cmath>

#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"
#include "io/text/csv_table.h"

// Numbers in columns: what is read is finite, and every column is as long as there are lines.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  static const fuzz::Scratch folder;
  const auto path = folder.write("fuzz.csv", data, size);
  CsvTable table;
  if (fuzz::refuses([&] { table = read_csv(path); })) return 0;
  fuzz::insist(!table.lines.empty() && table.columns.size() == table.names.size(),
               "a table has rows, and a column for every name");
  for (const auto& column : table.columns) {
    fuzz::insist(column.size() == table.lines.size(), "a column has a number for every line");
    for (const double x : column) fuzz::insist(std::isfinite(x), "numbers are finite");
  }
  return 0;
}
