#include "study/plan/study.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"
#include "study/reader/study_reader.h"

// A study file, with the files that its seeds name beside it: its scenario, casts, modes.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace asdic::detail;
  static const fuzz::Scratch folder(ASDIC_FUZZ_COMPANIONS);
  const auto path = folder.write("fuzz.toml", data, size);
  study::Study study;
  if (fuzz::refuses([&] { study = study::read_study(path, {}); })) return 0;
  fuzz::insist(study.realisations > 0, "a study has realisations");
  return 0;
}
