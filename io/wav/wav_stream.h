#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace asdic::detail {

/// A WAV file of one channel that is written while it is heard, also into a pipe: then its header
/// says that it has no end.
class WavStream {
 public:
  enum class Sample { int16, float32 };
  struct Form {
    double sample_rate = 8000.0;  ///< the header rounds it to whole Hz
    Sample sample = Sample::float32;
    double full_scale = 1.0;  ///< pressure that is 1, or 32767 [Pa]
  };

  /// \param file  descriptor, that stays open   \param name  for messages \throws RunError
  WavStream(int file, std::string name, const Form& form);

  /// \param pressure  [Pa]; beyond full scale int16 stays at it \throws RunError
  void put(std::span<const float> pressure);
  /// Says how long it was, where the file can be sought. \throws RunError
  void finish();

  [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::uint64_t clipped() const noexcept { return clipped_; }  ///< beyond full scale
  [[nodiscard]] bool closed() const noexcept { return closed_; }  ///< the pipe's reader has gone

 private:
  [[nodiscard]] std::string header(std::uint32_t data) const;
  void write(const void* bytes, std::size_t count);

  int file_;
  std::string name_;
  Form form_;
  std::uint64_t samples_ = 0, clipped_ = 0;
  bool closed_ = false;
  std::vector<char> bytes_;
};

}  // namespace asdic::detail
