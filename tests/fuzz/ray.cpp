#include "fuzz/fuzz_target.h"
#include "io/bellhop/bellhop_files.h"

// .ray: what can be read is written, and the same bytes come of it from then on.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  std::string first, second;
  if (fuzz::refuses([&] {
        first = bellhop::ray_file_bytes(bellhop::parse_ray_file(fuzz::text(data, size), "file"));
      }))
    return 0;
  fuzz::insist(!fuzz::refuses([&] {
    second = bellhop::ray_file_bytes(bellhop::parse_ray_file(first, "again"));
  }),
               "a file that was written can be read");
  fuzz::insist(first == second, "a file that is read and written stays the same");
  return 0;
}
