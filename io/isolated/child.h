#pragma once
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace asdic::detail::isolated {

/// What a child may use before it is given up.
struct Limits {
  /// Of the processor, for one answer. A library that runs in circles uses it; one that waits for a
  /// slow disk does not.
  std::chrono::milliseconds processor{2'000};
  std::chrono::milliseconds wall{120'000};    ///< for one answer
  std::size_t memory = std::size_t{2} << 30;  ///< beside what the parent had [bytes]
  bool operator==(const Limits&) const = default;
};

/// Those of every child that is started from now on (the fuzz targets', who cannot wait).
void set_limits(const Limits& limits) noexcept;

/// A child process that handles one file for us, with a library that a damaged or hostile file can
/// crash or send round in circles (HDF5 and netCDF do both). It opens the file, answers questions
/// about it one by one, and dies with this object; if it dies before, that is an InputError about
/// the file.
///
/// The child is a fork of this process, not another program: a program that links asdic's libraries
/// has no executable of ours to start, and a fork takes 1 ms where loading the libraries takes 20.
/// Of the other threads nothing is there: HDF5 must be at rest (Hdf5File: one thread at a time), as
/// it always is here, and malloc must survive a fork (glibc's does; oneTBB's as long as no other
/// thread is inside: programs of ours open files while no tasks run). All descriptors but one are
/// closed, standard error is /dev/null, and signals that a terminal sends to all are left to the
/// parent.
class Child {
 public:
  using Answer = std::function<std::string(std::string_view question)>;

  /// \param file     for messages   \param library  what reads it: "HDF5"
  /// \param open     run in the child: opens the file
  /// \throws whatever InputError, RunError, std::bad_alloc or std::logic_error `open` throws;
  /// InputError if the child dies; RunError if there is none to be had
  Child(std::filesystem::path file, std::string library, const std::function<Answer()>& open);
  Child(std::filesystem::path file, std::string library, const std::function<Answer()>& open,
        const Limits& limits);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  /// \throws as the constructor; of a child that died, from then on
  [[nodiscard]] std::string ask(std::string_view question);

 private:
  std::string receive();
  [[noreturn]] void given_up(bool killed);
  int wait_for_end() noexcept;

  std::filesystem::path file_;
  std::string library_;
  Limits limits_;
  pid_t process_ = -1;
  int socket_ = -1;
};

/// Of writing: a disk may be slow.
inline constexpr Limits patience{
    .processor = std::chrono::minutes(10), .wall = std::chrono::hours(1), .memory = 0};

/// Does something to a file in a child: what it changes in memory is lost, what it writes stays.
/// \throws as Child
void run(const std::filesystem::path& file, const std::string& library,
         const std::function<void()>& work, const Limits& limits);

}  // namespace asdic::detail::isolated
