#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "study/journal/journal.h"
#include "study/runs/study_file.h"

namespace asdic::detail::study {

/// What [summary] asks for, out of the rows.
using Summarise = std::function<Summary(const Table& table)>;

/// Makes a file of the rows in journals. An index that lies in several is taken from the first.
/// \param fingerprint    of the study; its `realisations` and the range go into the file as they
/// are \param range      that the file is to hold; rows outside of it are left out \return whether
/// every index of the range is there \param warnings  gets the summary's \throws RunError
bool assemble(OutputFile& output, const Fingerprint& fingerprint, IndexRange range,
              const std::vector<const Journal*>& journals, const Summarise& summarise,
              const std::string& stopped_by = "", std::vector<std::string>* warnings = nullptr);

/// Which journal holds which indices, in their order.
struct Segment {
  IndexRange range;
  std::size_t journal = 0;
};
[[nodiscard]] std::vector<Segment> segments(const std::vector<const Journal*>& journals,
                                            IndexRange range);

}  // namespace asdic::detail::study
