#include "app/program.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "core/error.h"
#include "core/instruction_level.h"
#include "core/printable.h"
#include "io/files/files_read.h"

namespace asdic::detail::app {

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDWR) != stream)
      std::_Exit(failure);  // without /dev/null nothing is safe to open
}

void complain(const std::string& program, const std::string& message) {
  std::fflush(stdout);
  tell(program + ": " + printable_lines(message));
}

int guarded(const std::function<void()>& act, std::string& said) {
  try {
    act();
    return success;
  } catch (const InputError& error) {
    said = error.what();
    return bad_input;
  } catch (const UsageError& error) {
    said = error.what();
    return bad_input;
  } catch (const std::bad_alloc&) {
    said = "not enough memory for this run";
  } catch (const std::exception& error) {
    said = error.what();
  }
  return failure;
}

int run_program(const std::string& program, const std::function<int()>& act) {
  open_standard_streams();
  end_cleanly_on_signals();
  signal(SIGXFSZ, SIG_IGN);  // a file over its limit is a failed write, told as any other
  std::string said;
  int status = success;
  const int fault = guarded(
      [&] {
        check_instruction_level();
        const FilesRead files;
        status = act();
        flush_output();
      },
      said);
  if (fault == success) return status;
  complain(program, said);
  return fault;
}

}  // namespace asdic::detail::app
