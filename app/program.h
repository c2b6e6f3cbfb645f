#pragma once
#include <functional>
#include <string>

// How a program of ours starts and ends: asdic, asdic-mpi.
namespace asdic::detail::app {

enum ExitStatus : int { success = 0, failure = 1, bad_input = 2 };

/// A line on standard error, after all that was printed: "asdic: message".
void complain(const std::string& program, const std::string& message);

/// Does something that may go wrong. \return the exit status; what went wrong is in `said`
int guarded(const std::function<void()>& act, std::string& said);

/// Standard input, output and error are open from here on, to /dev/null where they were closed:
/// a result must not get one of their numbers, or what is said there goes into it.
void open_standard_streams();

/// main() of a program: does it, says what went wrong. \return the exit status
int run_program(const std::string& program, const std::function<int()>& act);

}  // namespace asdic::detail::app
