#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace asdic::detail::serve {

/// Lines out of bytes that come in pieces of any size. Memory is bounded: of a line that is too
/// long nothing is kept.
class LineSplitter {
 public:
  /// \param longest  bytes of a line without its end
  explicit LineSplitter(std::size_t longest) : longest_(longest) {}

  struct Line {
    std::string text;
    bool too_long = false;  ///< text is empty then
  };

  void set_longest(std::size_t bytes) noexcept { longest_ = bytes; }

  /// Takes bytes up to the end of a line at most, away from the front of `bytes`.
  /// \return the line that they complete, if they do
  std::optional<Line> take(std::string_view& bytes) {
    const std::size_t end = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, end);
    if (too_long_ || partial_.size() + piece.size() > longest_) {
      too_long_ = true;
      partial_ = {};
    } else {
      partial_ += piece;
    }
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
    if (end == std::string_view::npos) return std::nullopt;
    return finish();
  }

  /// What came after the last end of a line; none if nothing did.
  std::optional<Line> rest() {
    if (partial_.empty() && !too_long_) return std::nullopt;
    return finish();
  }

 private:
  Line finish() {
    Line line{.text = std::move(partial_), .too_long = too_long_};
    partial_ = {};
    too_long_ = false;
    return line;
  }

  std::size_t longest_;
  std::string partial_;
  bool too_long_ = false;
};

}  // namespace asdic::detail::serve
