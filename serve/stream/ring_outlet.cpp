#include "serve/stream/ring_outlet.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include "core/error.h"
#include "io/files/output_lock.h"
#include "serve/stream/descriptor.h"
#include "serve/stream/stream_turn.h"

namespace asdic::detail::serve {
namespace {

constexpr std::array<char, 8> ring_magic = {'A', 'S', 'D', 'I', 'C', 'R', 'N', 'G'};
constexpr std::uint32_t ring_version = 1;
constexpr std::size_t page = 4096, least_slots = 4;

/// The first page of the file, as docs/formats/stream.md has it.
struct RingHeader {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t state;         // RingState
  std::uint64_t stream;        // odd while the layout changes, two more for each stream
  std::uint64_t written;       // blocks of this stream
  std::uint64_t slots;         // that take turns
  std::uint64_t slot_bytes;    // from one to the next
  std::uint64_t slots_offset;  // of the first, in the file
  std::uint64_t text_offset;   // of the descriptor
  std::uint64_t text_room;
  std::uint64_t text_turn;   // odd while the descriptor changes
  std::uint64_t text_bytes;  // of it
};
static_assert(sizeof(RingHeader) == 88);
enum RingState : std::uint32_t { silent = 0, streaming = 1, gone = 2 };

/// Before the samples of a block.
struct RingSlot {
  std::uint64_t before;   // 1 + how many blocks were written before it
  std::uint64_t after;    // the same, once the samples are there
  std::int64_t number;    // of the block, in its session
  double time;            // of its first sample [s]
  std::uint64_t samples;  // of a phone
  std::uint64_t bytes;
  std::array<std::uint64_t, 2> unused;
};
static_assert(sizeof(RingSlot) == 64);

template <class T>
void release(T& to, T value) {
  std::atomic_ref<T>(to).store(value, std::memory_order_release);
}

/// What is written after it is not seen before it.
void announce(std::uint64_t& to, std::uint64_t value) {
  std::atomic_ref<std::uint64_t>(to).store(value, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
}

std::size_t slot_bytes_of(std::size_t block) { return (sizeof(RingSlot) + block + 63) / 64 * 64; }

}  // namespace

class RingOutlet::File {
 public:
  File(std::filesystem::path path, std::size_t bytes) : path_(std::move(path)), bytes_(bytes) {
    make_room();
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (descriptor_ < 0) fail(errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && !says_no_locks(errno)) fail(errno);
    if (const int error = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes_)))
      fail(error);
    void* const at = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (at == MAP_FAILED) fail(errno);
    map_ = static_cast<char*>(at);
    RingHeader& head = header();
    head.version = ring_version;
    head.text_offset = page;
    head.text_room = std::max<std::uint64_t>(bytes_ / 8 / page, 4) * page;
    head.slots_offset = head.text_offset + head.text_room;
    std::atomic_thread_fence(std::memory_order_release);
    head.magic = ring_magic;  // last: what has it is whole
  }
  ~File() {
    if (map_ != nullptr) {
      release(header().state, std::uint32_t{gone});
      ::munmap(map_, bytes_);
    }
    struct stat mine {
    }, there{};
    if (::fstat(descriptor_, &mine) == 0 && ::lstat(path_.c_str(), &there) == 0 &&
        mine.st_dev == there.st_dev && mine.st_ino == there.st_ino)
      ::unlink(path_.c_str());
    ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] RingHeader& header() { return *reinterpret_cast<RingHeader*>(map_); }
  [[nodiscard]] std::size_t longest_block() {
    return (bytes_ - header().slots_offset) / least_slots - 2 * sizeof(RingSlot);
  }
  [[nodiscard]] std::size_t most_channels() { return (header().text_room - 2048) / 96; }

  /// \return false if another stream has it
  bool begin(std::size_t block_bytes) {
    if (!turn_.take()) return false;
    RingHeader& head = header();
    announce(head.stream, head.stream + 1);
    head.slot_bytes = slot_bytes_of(block_bytes);
    head.slots = (bytes_ - head.slots_offset) / head.slot_bytes;
    head.written = 0;
    head.text_bytes = 0;
    for (std::uint64_t i = 0; i < head.slots; ++i) {
      RingSlot& slot = slot_of(i);
      slot.before = slot.after = 0;
    }
    release(head.stream, head.stream + 1);
    return true;
  }
  void end() {
    release(header().state, std::uint32_t{silent});
    turn_.give_back();
  }

  void describe(const std::string& text) {
    RingHeader& head = header();
    const std::size_t bytes = std::min<std::size_t>(text.size(), head.text_room);
    announce(head.text_turn, head.text_turn + 1);
    std::memcpy(map_ + head.text_offset, text.data(), bytes);
    head.text_bytes = bytes;
    release(head.text_turn, head.text_turn + 1);
  }

  void put(const Listening::Block& block) {
    RingHeader& head = header();
    RingSlot& slot = slot_of(head.written);
    const std::uint64_t turn = head.written + 1;
    announce(slot.before, turn);
    slot.number = block.number;
    slot.time = block.time;
    slot.samples = block.samples;
    slot.bytes = block.pressure.size() * sizeof(float);
    std::memcpy(&slot + 1, block.pressure.data(), slot.bytes);
    release(slot.after, turn);
    release(head.written, turn);
    release(head.state, std::uint32_t{streaming});
  }

 private:
  [[nodiscard]] RingSlot& slot_of(std::uint64_t written) {
    const RingHeader& head = header();
    return *reinterpret_cast<RingSlot*>(map_ + head.slots_offset +
                                        (written % head.slots) * head.slot_bytes);
  }

  [[noreturn]] void fail(int error) {
    if (descriptor_ >= 0) {
      ::unlink(path_.c_str());
      ::close(descriptor_);
    }
    throw RunError("--ring " + path_.string() + ": " + std::strerror(error));
  }

  /// A ring that a server which is gone has left is removed; anything else stays.
  void make_room() {
    const auto refuse = [&](const std::string& got, const std::string& expected) {
      throw InputError({.where = "--ring " + path_.string(), .got = got, .expected = expected});
    };
    constexpr const char* free = "a name that is free, or a ring that a server has left";
    struct stat there {};
    if (::lstat(path_.c_str(), &there) != 0) return;
    if (!S_ISREG(there.st_mode)) refuse("something that is no file", free);
    const int old = ::open(path_.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    std::array<char, ring_magic.size()> begin{};
    const bool ours = old >= 0 &&
                      ::read(old, begin.data(), begin.size()) == ssize_t(begin.size()) &&
                      begin == ring_magic;
    const bool used = ours && ::flock(old, LOCK_EX | LOCK_NB) != 0 && !says_no_locks(errno);
    if (ours && !used) {  // whoever still maps it is told
      const std::uint32_t over = gone;
      static_cast<void>(!::pwrite(old, &over, sizeof over, offsetof(RingHeader, state)));
      ::unlink(path_.c_str());
    }
    if (old >= 0) ::close(old);
    if (!ours) refuse("a file that is no ring of asdic", free);
    if (used) refuse("a ring that another server writes", "a name that is free");
  }

  std::filesystem::path path_;
  std::size_t bytes_;
  int descriptor_ = -1;
  char* map_ = nullptr;
  StreamTurn turn_;
};

class RingOutlet::Sink : public BlockSink {
 public:
  Sink(std::shared_ptr<File> file, std::size_t samples) : file_(std::move(file)), about_(samples) {}
  ~Sink() override { file_->end(); }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void take(const Listening::Block& block) override {
    if (const auto text = about_.before(block)) file_->describe(*text);
    file_->put(block);
  }

 private:
  std::shared_ptr<File> file_;
  DescribedStream about_;
};

RingOutlet::RingOutlet(const std::filesystem::path& path, std::size_t bytes)
    : file_(std::make_shared<File>(std::filesystem::absolute(path), bytes)) {}
RingOutlet::~RingOutlet() = default;

std::size_t RingOutlet::longest_block() const { return file_->longest_block(); }
std::size_t RingOutlet::most_channels() const { return file_->most_channels(); }

std::shared_ptr<BlockSink> RingOutlet::open(const BlockShape& shape) {
  if (!file_->begin(shape.bytes())) return nullptr;
  return std::make_shared<Sink>(file_, shape.samples);
}

}  // namespace asdic::detail::serve
