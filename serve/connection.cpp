#include "serve/connection.h"

#include <sys/socket.h>

#include <array>
#include <asio.hpp>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>
#include <deque>
#include <thread>

#include "core/error.h"
#include "serve/command_queue.h"
#include "serve/line_splitter.h"
#include "serve/token.h"

namespace asdic::serve {

static_assert(std::endian::native == std::endian::little, "samples go out as they lie in memory");

namespace {

constexpr double linger = 1.0;       // for a client to read the last line [s]
constexpr double last_words = 10.0;  // to take what is left when the server stops [s]
constexpr std::size_t longest_handshake = 4096;

std::string bytes_of(Answer&& answer) {
  std::string bytes = std::move(answer.line);
  bytes += '\n';
  const std::size_t line = bytes.size(), size = answer.samples.size() * sizeof(float);
  bytes.resize(line + size);
  if (size > 0) std::memcpy(bytes.data() + line, answer.samples.data(), size);
  return bytes;
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
        queue_(limits_.queued_pings),
        active_(engine.clock()) {}

  void start() {
    tick();
    process();
  }

  void turn_away(const std::string& code, const std::string& message) {
    tick();
    end_with(refusal_answer("null", code, message, true));
  }

  void stop() {
    if (stopping_) return;
    end_waiting(stopping_);
    active_ = engine_.clock();
    reading_is_over();
  }

 private:
  // In: bytes, lines, commands ---------------------------------------------------------------

  [[nodiscard]] bool paused() const {
    return outgoing_bytes_ > limits_.answer_bytes || (waits_ && queue_.full());
  }

  /// Takes the lines that are there, then reads on. Called whenever one of them may have become
  /// possible.
  void process() {
    while (!deaf_ && !pending_.empty() && !paused())
      if (auto line = splitter_.take(pending_)) take(*line);
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
      pending_ = {buffer_.data(), n};
      process();
      close_when_done();
    });
  }

  void take(const LineSplitter::Line& line) {
    active_ = engine_.clock();
    if (!worker_.joinable()) return shake_hands(line);
    try {
      if (line.too_long)
        throw Refusal("limit", refusal_text("", "a longer line",
                                            "at most " + std::to_string(limits_.line_bytes) +
                                                " bytes a line"));
      Command command = read_command(line.text, limits_);
      command.received = active_;
      const std::string id = command.id;
      ++in_hand_;
      if (queue_.push(std::move(command))) return;
      --in_hand_;
      send(refusal_answer(id, "busy",
                          "found " + std::to_string(limits_.queued_pings) +
                              " commands waiting, expected fewer: wait for an answer"));
    } catch (const Refusal& refusal) {
      send(refusal_answer(line.too_long ? "null" : id_of(line.text, limits_), refusal.code(),
                          refusal.what()));
    }
  }

  void shake_hands(const LineSplitter::Line& line) {
    try {
      const Handshake shake = read_handshake(line.text);
      if (!ends_.token.empty() && !same_secret(shake.token, ends_.token))
        throw Refusal("token", "expected the server's token");
      waits_ = shake.waits;
    } catch (const Refusal& refusal) {
      return end_with(refusal_answer("null", refusal.code(), refusal.what(), true));
    }
    splitter_.set_longest(limits_.line_bytes);
    worker_ = std::jthread([this] { serve(); });
  }

  /// No more is read; what was read is still carried out, unless the server stops.
  void reading_is_over() {
    deaf_ = true;
    queue_.close();
    if (!worker_.joinable()) closing_ = true;
    std::error_code ignored;
    if (reading_) in_.cancel(ignored);
    close_when_done();
  }

  // The session's thread ---------------------------------------------------------------------

  void serve() {
    try {
      Session session(engine_.settings, engine_.clock);
      deliver(session.greeting());
      while (auto command = queue_.pop()) {
        asio::post(io_, [this] { process(); });  // there is room again
        bool last = false;
        if (wait_for(session.wait(*command)) && wait_for_the_reader()) {
          const std::lock_guard lock(engine_.busy);
          Answer answer = session.execute(*command);
          last = answer.last;
          deliver(std::move(answer));
        } else {
          deliver(refusal_answer(command->id, "closing", "the server is being stopped"));
        }
        --in_hand_;
        if (last) break;
      }
      queue_.close();
      while (const auto late = queue_.pop())
        deliver(refusal_answer(late->id, "closing", "the session has ended"));
    } catch (const std::exception& error) {
      engine_.settings.report(error.what());
      deliver(refusal_answer("null", "run",
                             "the session could not begin; the server's log says why", true));
    }
    asio::post(io_, [this] {
      worker_done_ = closing_ = deaf_ = true;
      close_when_done();
    });
  }

  /// \return false if the server stops, or the client is gone, before that
  bool wait_for(double seconds) {
    std::unique_lock lock(mutex_);
    if (seconds > 0.0)
      wake_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return over(); });
    return !over();
  }

  bool wait_for_the_reader() {
    std::unique_lock lock(mutex_);
    while (!over() && outgoing_bytes_ > limits_.answer_bytes)
      wake_.wait_for(lock, std::chrono::milliseconds(100));
    return !over();
  }

  /// Sets a reason not to wait, and wakes who does.
  void end_waiting(std::atomic<bool>& reason) {
    const std::lock_guard lock(mutex_);
    reason = true;
    wake_.notify_all();
  }

  [[nodiscard]] bool over() const { return stopping_ || dropped_; }

  void deliver(Answer answer) {
    outgoing_bytes_ += answer.line.size() + answer.samples.size() * sizeof(float) + 1;
    asio::post(io_, [this, answer = std::move(answer)]() mutable { queue_up(std::move(answer)); });
  }

  // Out ----------------------------------------------------------------------------------------

  void send(Answer answer) {
    outgoing_bytes_ += answer.line.size() + answer.samples.size() * sizeof(float) + 1;
    queue_up(std::move(answer));
  }

  void queue_up(Answer&& answer) {
    active_ = engine_.clock();
    outgoing_.push_back(bytes_of(std::move(answer)));
    if (outgoing_.size() == 1) write();
  }

  void end_with(Answer answer) {
    deaf_ = closing_ = true;
    send(std::move(answer));
  }

  void write() {
    if (dropped_) return forget_answers();
    const std::string& front = outgoing_.front();
    out_.async_write_some(asio::buffer(front.data() + written_, front.size() - written_),
                          [this](std::error_code error, std::size_t n) {
                            if (error) {
                              drop();
                              return forget_answers();
                            }
                            active_ = engine_.clock();
                            written_ += n;
                            if (written_ == outgoing_.front().size()) {
                              outgoing_bytes_ -= written_;
                              written_ = 0;
                              outgoing_.pop_front();
                              wake_.notify_all();
                              process();
                            }
                            if (!outgoing_.empty()) return write();
                            close_when_done();
                          });
  }

  void forget_answers() {
    for (const std::string& one : outgoing_) outgoing_bytes_ -= one.size();
    outgoing_.clear();
    written_ = 0;
    close_when_done();
  }

  // The end ------------------------------------------------------------------------------------

  /// The client is gone, or does not read: nothing more is done for it.
  void drop() {
    closing_ = true;
    end_waiting(dropped_);
    reading_is_over();
  }

  void close_when_done() {
    if (!closing_ || over_ || !outgoing_.empty() || (worker_.joinable() && !worker_done_)) return;
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
      const double silent = engine_.clock() - active_;
      if (over_) {
        if (engine_.clock() > leaves_at_) return close();
      } else if (stopping_ && !outgoing_.empty() && silent > last_words) {
        give_up();
      } else if (ends_.socket && !worker_.joinable() && !closing_) {
        if (silent > double(limits_.handshake_seconds))
          end_with(refusal_answer("null", "handshake", "expected a handshake sooner", true));
      } else if (ends_.socket && silent > double(limits_.idle_seconds)) {
        if (!outgoing_.empty())
          give_up();
        else if (in_hand_ == 0 && !closing_)
          say_idle();
      }
      tick();
    });
  }

  void give_up() {
    drop();
    std::error_code ignored;
    out_.cancel(ignored);
  }

  void say_idle() {
    send(refusal_answer("null", "idle", "expected a command sooner", true));
    reading_is_over();
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
  CommandQueue queue_;
  std::deque<std::string> outgoing_;
  std::size_t written_ = 0;  // of the first
  double active_;            // when the client was last heard of, or took something [s]
  double leaves_at_ = 0.0;

  bool waits_ = false;    // the client would rather wait than be told "busy"
  bool reading_ = false;  // a read is under way
  bool ended_ = false;    // the client has sent its last byte
  bool deaf_ = false;     // nothing more is read
  bool closing_ = false;  // when the answers are out, it is over
  bool over_ = false, gone_ = false;
  bool worker_done_ = false;

  std::atomic<std::size_t> outgoing_bytes_ = 0, in_hand_ = 0;
  std::atomic<bool> stopping_ = false, dropped_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::jthread worker_;  // last: joined before what it uses goes
};

Connection::Connection(asio::io_context& io, Engine& engine, const Ends& ends,
                       std::function<void()> closed)
    : impl_(std::make_unique<Impl>(io, engine, ends, std::move(closed))) {}
Connection::~Connection() = default;

void Connection::start() { impl_->start(); }
void Connection::turn_away(const std::string& code, const std::string& message) {
  impl_->turn_away(code, message);
}
void Connection::stop() { impl_->stop(); }

}  // namespace asdic::serve
