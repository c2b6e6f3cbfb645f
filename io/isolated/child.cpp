#include "io/isolated/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "io/isolated/pack.h"

namespace asdic::detail::isolated {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;  // it takes terabytes of addresses, and says what it finds
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

Limits usual_limits;

/// What a message is: an answer, or what was thrown instead.
enum class Kind : std::uint64_t { answer, input_error, run_error, logic_error, no_memory };

struct Head {
  Kind kind = Kind::answer;
  std::uint64_t bytes = 0;
};

/// Sends all of it. \return whether the other side took it
bool send_all(int socket, const void* data, std::size_t bytes) noexcept {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t sent = send(socket, at, bytes, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool send_message(int socket, Kind kind, std::string_view body) noexcept {
  const Head head{kind, body.size()};
  return send_all(socket, &head, sizeof head) && send_all(socket, body.data(), body.size());
}

bool receive_all(int socket, void* data, std::size_t bytes) noexcept {
  auto* at = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t got = recv(socket, at, bytes, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Bytes of address space that this process has now.
std::size_t address_space() noexcept {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  unsigned long pages = 0;
  const int read = std::fscanf(file, "%lu", &pages);
  static_cast<void>(std::fclose(file));
  return read == 1 ? pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

// What follows runs in the child alone.

void close_all_but(int kept) noexcept {
  const auto from_to = [](unsigned first, unsigned last) {
    if (first <= last && close_range(first, last, 0) != 0)  // a kernel before 5.9
      for (unsigned fd = first; fd <= std::min(last, 65535U); ++fd) close(static_cast<int>(fd));
  };
  from_to(3, static_cast<unsigned>(kept) - 1);
  from_to(static_cast<unsigned>(kept) + 1, ~0U);
}

void forget_the_parent(int socket) noexcept {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP})
    std::signal(signal, SIG_IGN);  // the parent ends as it likes, and this with it
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF})
    if (!sanitized || signal == SIGPROF) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (const int nowhere = open("/dev/null", O_RDWR); nowhere >= 0)
    for (const int fd : {0, 1, 2})
      if (!sanitized || fd != 2) dup2(nowhere, fd);  // malloc writes of a broken heap
  close_all_but(socket);
}

void obey(const Limits& limits) noexcept {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (sanitized || limits.memory == 0) return;
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) != 0) return;
  space.rlim_cur = std::min<rlim_t>(space.rlim_max, address_space() + limits.memory);
  setrlimit(RLIMIT_AS, &space);
}

/// From here on the next answer may take so long; then SIGPROF ends the process.
void start_clock(const Limits& limits) noexcept {
  const auto ms = limits.processor.count();
  const itimerval timer{.it_interval = {0, 0},
                        .it_value = {.tv_sec = ms / 1000, .tv_usec = ms % 1000 * 1000}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

/// Does something and sends what came of it. \return whether it can go on
bool answer_with(int socket, const std::function<std::string()>& work) noexcept {
  try {
    return send_message(socket, Kind::answer, work());
  } catch (const InputError& error) {
    Packed fault;
    fault.put(error.fault().where);
    fault.put(error.fault().got);
    fault.put(error.fault().expected);
    return send_message(socket, Kind::input_error, fault.bytes());
  } catch (const std::bad_alloc&) {
    return send_message(socket, Kind::no_memory, "");
  } catch (const std::length_error&) {
    return send_message(socket, Kind::no_memory, "");
  } catch (const std::logic_error& error) {
    return send_message(socket, Kind::logic_error, error.what());
  } catch (const std::exception& error) {
    return send_message(socket, Kind::run_error, error.what());
  } catch (...) {
    return send_message(socket, Kind::run_error, "an unknown fault");
  }
}

[[noreturn]] void live(int socket, const std::function<Child::Answer()>& open,
                       const Limits& limits) noexcept {
  forget_the_parent(socket);
  obey(limits);
  start_clock(limits);
  Child::Answer answer;
  bool good = answer_with(socket, [&] {
    answer = open();
    return std::string();
  });
  std::string question;
  for (Head head; good && answer && receive_all(socket, &head, sizeof head);) {
    start_clock(limits);
    good = answer_with(socket, [&] {
      question.resize(head.bytes);
      if (!receive_all(socket, question.data(), question.size()))
        throw RunError("a question that broke off");
      return answer(question);
    });
  }
  _exit(0);  // nothing of the parent's is flushed, closed or told twice
}

}  // namespace

void set_limits(const Limits& limits) noexcept { usual_limits = limits; }

Child::Child(std::filesystem::path file, std::string library, const std::function<Answer()>& open)
    : Child(std::move(file), std::move(library), open, usual_limits) {}

Child::Child(std::filesystem::path file, std::string library, const std::function<Answer()>& open,
             const Limits& limits)
    : file_(std::move(file)), library_(std::move(library)), limits_(limits) {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw RunError(file_.string() + ": no socket to read it by: " + std::strerror(errno));
  process_ = fork();
  if (process_ == 0) live(ends[1], open, limits_);
  const int error = errno;
  close(ends[1]);
  socket_ = ends[0];
  if (process_ < 0) {
    close(socket_);
    throw RunError(file_.string() + ": no process to read it in: " + std::strerror(error));
  }
  try {
    static_cast<void>(receive());
  } catch (...) {  // there is no destructor of what was not built
    if (socket_ >= 0) close(socket_);
    if (process_ > 0) wait_for_end();
    throw;
  }
}

Child::~Child() {
  if (socket_ >= 0) close(socket_);  // the child reads the end of its questions
  if (process_ > 0) wait_for_end();
}

int Child::wait_for_end() noexcept {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0)
    if (errno != EINTR) {  // somebody else has waited for it
      status = 0;
      break;
    }
  process_ = -1;
  return status;
}

std::string Child::ask(std::string_view question) {
  if (socket_ < 0) given_up(false);
  if (!send_message(socket_, Kind::answer, question)) given_up(false);
  return receive();
}

std::string Child::receive() {
  const auto end = std::chrono::steady_clock::now() + limits_.wall;
  const auto take = [&](void* data, std::size_t bytes) {
    auto* at = static_cast<char*>(data);
    while (bytes > 0) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      pollfd ready{.fd = socket_, .events = POLLIN, .revents = 0};
      const int count =
          poll(&ready, 1, static_cast<int>(std::clamp<long long>(left.count(), 0, 1 << 30)));
      if (count < 0 && errno == EINTR) continue;
      if (count == 0) given_up(true);
      const ssize_t got = recv(socket_, at, bytes, 0);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) given_up(false);
      at += got;
      bytes -= static_cast<std::size_t>(got);
    }
  };
  Head head;
  take(&head, sizeof head);
  std::string body(head.bytes, '\0');
  take(body.data(), body.size());
  switch (head.kind) {
    case Kind::answer:
      return body;
    case Kind::input_error: {
      Unpacked fault(body);
      InputFault words;
      words.where = fault.get<std::string>();
      words.got = fault.get<std::string>();
      words.expected = fault.get<std::string>();
      throw InputError(words);
    }
    case Kind::logic_error:
      throw std::logic_error(body);
    case Kind::no_memory:
      throw InputError({.where = file_.string(),
                        .got = "a damaged file: reading it asks for more than " +
                               std::to_string(limits_.memory >> 20U) + " MB",
                        .expected = "a whole one"});
    case Kind::run_error:
      break;
  }
  throw RunError(body);
}

void Child::given_up(bool killed) {
  std::string got = "a file on which the " + library_ + " library has failed before";
  if (socket_ >= 0) {
    // It still holds the other end, or its end is not yet waited for: the number is its own.
    if (killed && process_ > 0) kill(process_, SIGKILL);
    close(std::exchange(socket_, -1));
    const int status = wait_for_end();
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (killed || signal == SIGPROF)
      got = "a damaged file: the " + library_ + " library does not come to an end with it";
    else
      got = "a damaged file: the " + library_ + " library crashes on it" +
            (signal != 0 ? " (" + std::string(strsignal(signal)) + ")" : "");
  }
  throw InputError({.where = file_.string(), .got = got, .expected = "a whole one"});
}

void run(const std::filesystem::path& file, const std::string& library,
         const std::function<void()>& work, const Limits& limits) {
  const Child child(
      file, library,
      [&]() -> Child::Answer {
        work();
        return {};
      },
      limits);
}

}  // namespace asdic::detail::isolated
