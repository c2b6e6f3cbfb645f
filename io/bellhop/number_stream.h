#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace asdic::detail::bellhop {

/// No file says of anything that it has more: what would not fit in an int is no count.
inline constexpr std::int64_t most_of_a_count = 2'000'000'000;

/// The numbers of a long text one after another, wherever its lines end: what list-directed WRITEs
/// of BELLHOP leave. Blanks and commas part them; `3*0.5` is three.
class NumberStream {
 public:
  /// \param text  must outlive the stream   \param file  its name, for messages
  NumberStream(std::string_view text, std::string file);

  // \throws InputError  what stands there is something else, or the file ends
  [[nodiscard]] double real(const char* item);
  [[nodiscard]] std::int64_t integer(const char* item, std::int64_t least, std::int64_t most);
  /// A word as it stands; "" at the end.
  [[nodiscard]] std::string_view word() { return token(); }
  /// The rest of the line.
  [[nodiscard]] std::string_view rest_of_line();

  [[nodiscard]] bool at_end();
  [[nodiscard]] std::size_t bytes_left() const noexcept { return text_.size() - position_; }
  [[noreturn]] void fail(const char* item, std::string got, std::string expected) const;

 private:
  void skip_blanks() noexcept;
  [[nodiscard]] std::string_view token() noexcept;

  std::string_view text_;
  std::string file_;
  std::size_t position_ = 0, line_ = 1;
  std::int64_t repeats_ = 0, most_repeats_ = 0;
  double repeated_ = 0.0;
};

/// A word without the quotes around it.
[[nodiscard]] std::string_view unquoted(std::string_view word) noexcept;

}  // namespace asdic::detail::bellhop
