#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail::app {

/// A subject of `asdic help`: short paragraphs, and where to read on.
struct Topic {
  std::string name, brief;
  std::vector<std::string> paragraphs;  ///< one that begins with spaces is something to type
};

[[nodiscard]] const std::vector<Topic>& topics();
/// "begin, scenario, units"
[[nodiscard]] std::string joined_topics();
/// A footer's lines: how to begin, with a scenario that is there.
[[nodiscard]] std::string example_of_beginning();
[[nodiscard]] std::string topic_text(const Topic& topic, std::size_t width);

}  // namespace asdic::detail::app
