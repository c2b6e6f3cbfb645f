#include "serve/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <asio.hpp>
#include <chrono>

#include "serve/commands/cancel.h"
#include "serve/connection_words.h"
#include "serve/line_splitter.h"
#include "serve/outbox.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

namespace {

constexpr double linger = 1.0;       // for a client to read the last line [s]
constexpr double last_words = 10.0;  // to take what is left when the server stops [s]
constexpr std::size_t longest_handshake = 4096;
constexpr std::size_t little =
    1 << 20;  // that each may have to take when all have too much [bytes]

bool is_tcp(int socket) {
  int domain = 0;
  socklen_t size = sizeof domain;
  return ::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 && domain == AF_INET;
}

}  // namespace

class Connection::Impl {
 public:
  Impl(asio::io_context& io, Engine& engine, const Ends& ends, std::function<void()> closed)
      : engine_(engine),
        limits_(engine.settings.limits),
        ends_(ends),
        closed_(std::move(closed)),
        io_(io),
        work_(asio::make_work_guard(io)),
        in_(io, ends.in),
        out_(io, ends.out),
        timer_(io),
        splitter_(longest_handshake),
        outbox_(engine.owed),
        active_(engine.clock()) {}

  void start() {
    tick();
    process();
  }

  [[nodiscard]] const std::string& refused() const noexcept { return refused_; }
  [[nodiscard]] std::error_code unwritten() const noexcept { return unwritten_; }

  void turn_away() {
    tick();
    end_with(no_place(limits_));
  }

  void displace() {
    give_up();
    close();
  }

  void stop() {
    if (stopping_) return;
    stopping_ = true;
    if (worker_) worker_->stop();
    active_ = engine_.clock();
    reading_is_over();
  }

 private:
  // In: bytes, lines, commands ---------------------------------------------------------------

  [[nodiscard]] bool behind() const {
    return outbox_.bytes() > limits_.answer_bytes ||
           (engine_.owed > limits_.total_answer_bytes && outbox_.bytes() > little);
  }
  [[nodiscard]] bool paused() const {
    return behind() || (worker_ && (!worker_->has_begun() || (waits_ && worker_->full())));
  }

  /// Takes the lines that are there, then reads on. Called whenever one of them may have become
  /// possible.
  void process() {
    while (!deaf_ && !pending_.empty()) {
      if (paused()) return;  // what is pending lies where the next bytes would come
      if (auto line = splitter_.take(pending_)) take(*line);
    }
    if (deaf_ || paused() || reading_) return;
    if (ended_) {  // a last line may lack its end
      if (auto line = splitter_.rest()) take(*line);
      reading_is_over();
      return;
    }
    reading_ = true;
    in_.async_read_some(asio::buffer(buffer_), [this](std::error_code error, std::size_t n) {
      reading_ = false;
      ended_ = bool(error);
      if (error == asio::error::connection_reset) return give_up();
      pending_ = {buffer_.data(), n};
      process();
      close_when_done();
    });
  }

  void take(const LineSplitter::Line& line) {
    active_ = engine_.clock();
    if (!worker_) return shake_hands(line);
    if (line.too_long) return send(line_too_long(limits_));
    try {
      Command command = read_command(line.text, limits_);
      command.received = active_;
      if (command.name == CancelCommand::name)  // it overtakes those that it means
        return send(CancelCommand::answer(command, worker_->cancel(CancelCommand::meant(command))));
      const std::string id = command.id;
      if (worker_->offer(std::move(command))) return;
      send(queue_full(id, limits_));
    } catch (const Refusal& refusal) {
      send(refusal_answer(id_of(line.text, limits_), refusal.code(), refusal.what()));
    }
  }

  void shake_hands(const LineSplitter::Line& line) {
    try {
      waits_ = checked_handshake(line.text, ends_.token).waits;
    } catch (const Refusal& refusal) {
      refused_ = refusal.what();
      return end_with(refusal_answer("null", refusal.code(), refusal.what(), true));
    }
    if (ends_.admits && !ends_.admits()) return end_with(no_place(limits_));
    splitter_.set_longest(limits_.line_bytes);
    worker_ = std::make_unique<SessionWorker>(
        engine_,
        SessionWorker::Ways{.deliver = [this](Answer answer) { deliver(std::move(answer)); },
                            .goes_on = [this] { asio::post(io_, [this] { process(); }); },
                            .behind = [this] { return behind(); },
                            .reserve =
                                [this](std::size_t bytes) {
                                  return outbox_.reserve(bytes, limits_.answer_bytes,
                                                         limits_.total_answer_bytes);
                                },
                            .release = [this](std::size_t bytes) { outbox_.release(bytes); },
                            .waits = waits_,
                            .done = [this] { asio::post(io_, [this] { session_is_over(); }); }});
  }

  void deliver(Answer answer) {
    outbox_.expect(answer);
    asio::post(io_, [this, answer = std::move(answer)]() mutable { queue_up(std::move(answer)); });
  }

  void session_is_over() {
    session_over_ = closing_ = deaf_ = true;
    close_when_done();
  }

  /// No more is read; what was read is still carried out, unless the server stops.
  void reading_is_over() {
    deaf_ = true;
    if (worker_)
      worker_->finish();
    else
      closing_ = true;
    std::error_code ignored;
    if (reading_) in_.cancel(ignored);
    close_when_done();
  }

  // Out ----------------------------------------------------------------------------------------

  void send(Answer answer) {
    outbox_.expect(answer);
    queue_up(std::move(answer));
  }

  void queue_up(Answer&& answer) {
    active_ = engine_.clock();
    outbox_.add(std::move(answer));
    if (!writing_) write();
  }

  void end_with(Answer answer) {
    deaf_ = closing_ = true;
    send(std::move(answer));
  }

  void write() {
    if (dropped_) return forget_answers();
    writing_ = true;
    const std::string_view bytes = outbox_.front();
    out_.async_write_some(asio::buffer(bytes.data(), bytes.size()),
                          [this](std::error_code error, std::size_t n) { written(error, n); });
  }

  void written(std::error_code error, std::size_t bytes) {
    writing_ = false;
    if (error) {
      if (error != asio::error::broken_pipe && error != asio::error::operation_aborted)
        unwritten_ = error;
      drop();
      return forget_answers();
    }
    active_ = engine_.clock();
    if (outbox_.wrote(bytes)) {
      if (worker_) worker_->wake();
      process();  // which may write by itself
    }
    if (!outbox_.empty() && !writing_) return write();
    close_when_done();
  }

  void forget_answers() {
    outbox_.clear();
    close_when_done();
  }

  // The end ------------------------------------------------------------------------------------

  /// The client is gone, or does not read: nothing more is done for it.
  void drop() {
    dropped_ = closing_ = true;
    if (worker_) worker_->abandon();
    reading_is_over();
  }

  /// Whether the client has closed its socket, in both directions: nobody will read an answer. Who
  /// has ended its own half only still waits for them.
  [[nodiscard]] bool has_hung_up() {
    if (!ends_.socket || !worker_ || gone_) return false;
    const int socket = out_.native_handle();
    pollfd asked{.fd = socket, .events = 0, .revents = 0};
    if (::poll(&asked, 1, 0) == 1 && (asked.revents & (POLLHUP | POLLERR)) != 0) return true;
    // By TCP both look alike, until something is sent: a byte beside the stream, which who is there
    // does not see in it.
    if (ended_ && !probed_ && !worker_->idle() && is_tcp(socket)) {
      probed_ = true;
      static_cast<void>(::send(socket, "", 1, MSG_OOB | MSG_NOSIGNAL | MSG_DONTWAIT));
    }
    return false;
  }

  void close_when_done() {
    if (!closing_ || over_ || !outbox_.empty() || (worker_ && !session_over_)) return;
    over_ = true;
    deaf_ = true;
    if (ends_.socket && !dropped_) {  // a close with bytes unread would take the last line back
      ::shutdown(out_.native_handle(), SHUT_WR);
      leaves_at_ = engine_.clock() + linger;
      return swallow();
    }
    close();
  }

  void swallow() {
    if (reading_) return;
    reading_ = true;
    in_.async_read_some(asio::buffer(buffer_), [this](std::error_code error, std::size_t) {
      reading_ = false;
      if (error || engine_.clock() > leaves_at_) return close();
      swallow();
    });
  }

  void close() {
    if (gone_) return;
    gone_ = true;
    std::error_code ignored;
    timer_.cancel();
    in_.close(ignored);
    out_.close(ignored);
    work_.reset();
    asio::post(io_, closed_);  // which destroys this: after the handlers that were cancelled
  }

  /// Looks once in a while whether the client has been silent, or deaf, for too long.
  void tick() {
    timer_.expires_after(std::chrono::milliseconds(200));
    timer_.async_wait([this](std::error_code error) {
      if (error || gone_) return;
      if (worker_) worker_->check_time();
      if (!dropped_ && !over_ && has_hung_up()) give_up();
      const double silent = engine_.clock() - active_;
      if (over_) {
        if (engine_.clock() > leaves_at_) return close();
      } else if (stopping_ && !outbox_.empty() && silent > last_words) {
        give_up();
      } else if (ends_.socket && !worker_ && !closing_) {
        if (silent > double(limits_.handshake_seconds)) end_with(handshake_too_late(limits_));
      } else if (ends_.socket && silent > double(limits_.idle_seconds)) {
        if (!outbox_.empty()) {
          give_up();
        } else if (worker_->idle() && !closing_) {
          send(idle_too_long(limits_));
          reading_is_over();
        }
      }
      tick();
    });
  }

  void give_up() {
    drop();
    std::error_code ignored;
    out_.cancel(ignored);
  }

  Engine& engine_;
  const SessionLimits& limits_;
  Ends ends_;
  std::function<void()> closed_;
  asio::io_context& io_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  asio::posix::stream_descriptor in_, out_;
  asio::steady_timer timer_;

  LineSplitter splitter_;
  std::array<char, 65536> buffer_{};
  std::string_view pending_;  // read, but not yet taken
  Outbox outbox_;
  double active_;  // when the client last sent or took something [s]
  double leaves_at_ = 0.0;

  std::error_code unwritten_;
  std::string refused_;    // why the handshake was
  bool waits_ = false;     // the client would rather wait than be told "busy"
  bool reading_ = false;   // a read is under way
  bool writing_ = false;   // a write is
  bool ended_ = false;     // the client has sent its last byte
  bool probed_ = false;    // whether it is there nevertheless
  bool deaf_ = false;      // nothing more is read
  bool stopping_ = false;  // the server is
  bool dropped_ = false;   // nothing more is written
  bool closing_ = false;   // when the answers are out, it is over
  bool session_over_ = false, over_ = false, gone_ = false;

  std::unique_ptr<SessionWorker> worker_;  // from the handshake on; goes before what it calls
};

Connection::Connection(asio::io_context& io, Engine& engine, const Ends& ends,
                       std::function<void()> closed)
    : impl_(std::make_unique<Impl>(io, engine, ends, std::move(closed))) {}
Connection::~Connection() = default;

void Connection::start() { impl_->start(); }
void Connection::turn_away() { impl_->turn_away(); }
void Connection::displace() { impl_->displace(); }
void Connection::stop() { impl_->stop(); }
const std::string& Connection::refused() const noexcept { return impl_->refused(); }
std::error_code Connection::unwritten() const noexcept { return impl_->unwritten(); }

}  // namespace asdic::detail::serve
