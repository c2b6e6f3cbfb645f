#include "study/journal/journal.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"

// A study's journal, a database of SQLite's: rows that are taken have the width that the journal
// says, and their time series and arrays the shape that they say.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  static const fuzz::Scratch folder;
  study::remove_journal(folder / "fuzz.journal");
  const auto path = folder.write("fuzz.journal", data, size);
  try {
    const study::Journal journal(path);
    std::size_t width = 0;
    bool first = true;
    constexpr study::IndexRange all{0, std::uint64_t{1} << 62};
    journal.rows(all, true, [&](study::Row&& row) {
      fuzz::insist(first || row.values.size() == width, "rows are of one width");
      first = false;
      width = row.values.size();
      std::size_t samples = row.pressure_shape.empty() ? 0 : 1;
      for (const std::size_t n : row.pressure_shape) samples *= n;
      fuzz::insist(samples == row.pressure.size(), "a time series fills its shape");
      for (const study::KeptArray& array : row.kept) {
        std::size_t numbers = array.shape.empty() ? 0 : 1;
        for (const std::size_t n : array.shape) numbers *= n;
        fuzz::insist(numbers == array.values.size(), "an array fills its shape");
      }
    });
    static_cast<void>(journal.sessions());
  } catch (const InputError& error) {
    fuzz::last_refusal = error.what();
  } catch (const RunError& error) {
    fuzz::last_refusal = error.what();
  }
  return 0;
}
