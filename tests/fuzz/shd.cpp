#include "fuzz/fuzz_target.h"
#include "io/bellhop/bellhop_files.h"

// .shd: what can be read can be written and read again. (Nothing in the file tells its dialect, so
// the bytes of one with senseless ranges may change.)

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  std::string first;
  if (fuzz::refuses([&] {
        first =
            bellhop::shade_file_bytes(bellhop::parse_shade_file(fuzz::text(data, size), "file"));
      }))
    return 0;
  fuzz::insist(!fuzz::refuses([&] { (void)bellhop::parse_shade_file(first, "again"); }),
               "a file that was written can be read");
  return 0;
}
