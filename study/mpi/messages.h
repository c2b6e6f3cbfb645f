#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/measures/realisation.h"
#include "study/sampling/index_set.h"

// What ranks say to one another.
namespace asdic::detail::study::mpi {

enum class Tag : int {
  more = 1,  ///< to rank 0: give me indices
  block,     ///< from rank 0: an IndexRange
  no_more,   ///< from rank 0: there are none left
  stop,      ///< from rank 0: finish those in hand
  rows,      ///< to rank 0: rows without their time series; none of them: I am alive
  fault,     ///< to rank 0: why I end
  bye,       ///< to rank 0: my journal is closed
};

struct Message {
  int rank = 0;
  Tag tag = Tag::rows;
  std::vector<std::byte> bytes{};
};

void send(int rank, Tag tag, const std::vector<std::byte>& bytes = {});
/// A message if one has come.
[[nodiscard]] std::optional<Message> receive();

[[nodiscard]] std::vector<std::byte> packed(const std::vector<Row>& rows);
[[nodiscard]] std::vector<Row> rows_of(const std::vector<std::byte>& bytes);
[[nodiscard]] std::vector<std::byte> packed(const IndexRange& range);
[[nodiscard]] IndexRange range_of(const std::vector<std::byte>& bytes);
[[nodiscard]] std::vector<std::byte> packed(const std::string& text);
[[nodiscard]] std::string text_of(const std::vector<std::byte>& bytes);

}  // namespace asdic::detail::study::mpi
