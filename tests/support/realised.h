#pragma once
#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

#include "study/measures/realisation.h"

namespace asdic::detail::support {

/// All rows of a study that needs neither a journal nor a file.
inline study::Table realised(const study::Study& study) {
  const study::Realiser realiser(study);
  std::vector<study::Row> rows(study.realisations);
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i] = realiser.realise(i); });
  study::Table table{.columns = columns(study), .index = {}, .valid = {}, .values = {}};
  table.values.resize(table.columns.size());
  for (const study::Row& row : rows) {
    table.index.push_back(row.index);
    table.valid.push_back(row.valid ? 1 : 0);
    for (std::size_t c = 0; c < row.values.size(); ++c) table.values[c].push_back(row.values[c]);
  }
  return table;
}

}  // namespace asdic::detail::support
