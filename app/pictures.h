#pragma once
#include <string>
#include <vector>

namespace asdic::detail::app {

/// Runs the pictures' script (python/asdic_plot.py) with these arguments. Python and its packages
/// are looked for first. \return its exit status: 0 drawn, 1 could not be written, 2 the input is
/// wrong \throws RunError where the script, Python or a package is missing
[[nodiscard]] int draw_pictures(const std::vector<std::string>& arguments);

}  // namespace asdic::detail::app
