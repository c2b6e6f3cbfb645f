#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "core/error.h"
#include "io/files/output_file.h"
#include "io/hdf5/own_files.h"
#include "io/wav/audible.h"
#include "io/wav/wav_stream.h"
#include "serve/stream/stream_receiver.h"
#include "serve/stream/udp_outlet.h"

namespace asdic::detail::app {
namespace {

struct ListenOptions {
  std::string udp, interface, wav, format = "float";
  int phone = 1;
  std::optional<double> tone, full_scale, seconds;
  bool force = false;
};

/// A descriptor that is closed.
struct File {
  explicit File(int descriptor) : descriptor(descriptor) {}
  ~File() {
    if (descriptor > STDERR_FILENO) ::close(descriptor);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int descriptor;
};

/// One phone of a stream as a WAV file.
class Recorder {
 public:
  Recorder(const ListenOptions& options, const serve::Descriptor& about)
      : options_(options), stream_(about.stream), channels_(about.channels) {
    if (options.phone > static_cast<int>(about.channels))
      throw InputError({.where = "--phone",
                        .got = std::to_string(options.phone),
                        .expected = fmt::format("a phone from 1 to {}", about.channels)});
    if (about.carrier) {
      const double tone = options.tone.value_or(Audible::usual_tone(about.sample_rate));
      if (tone < 0.5 * about.sample_rate)
        throw InputError({.where = "--tone",
                          .got = fmt::format("{:g} Hz", tone),
                          .expected = fmt::format(
                              "at least {:g} Hz, half the rate of the baseband: its band would "
                              "overlap with its mirror image",
                              0.5 * about.sample_rate)});
      audible_.emplace(about.sample_rate, tone);
    } else if (options.tone) {
      throw InputError({.where = "--tone",
                        .got = "a stream of pressure",
                        .expected = "one of complex baseband, which is not heard without a tone"});
    }
    components_ = about.components();
    block_samples_ = about.block_samples;
    source_rate_ = about.sample_rate;
    rate_ = audible_ ? audible_->rate() : about.sample_rate;
    if (options.full_scale) scale_ = *options.full_scale;
    open();
    tell(fmt::format(
        "asdic listen: phone {} of {}, {:.6g} Hz{}", options.phone, channels_, rate_,
        about.carrier ? fmt::format(": a carrier of {:g} Hz as a tone of {:g} Hz", *about.carrier,
                                    options.tone.value_or(Audible::usual_tone(about.sample_rate)))
                      : ""));
  }

  [[nodiscard]] std::uint64_t stream() const { return stream_; }
  [[nodiscard]] double heard() const { return static_cast<double>(samples_) / source_rate_; }
  [[nodiscard]] bool closed() const { return wav_ && wav_->closed(); }

  /// What was lost is silent.
  void take(const serve::StreamReceiver::Block& block) {
    std::size_t missing = static_cast<std::size_t>(block.lost) * block_samples_;
    constexpr std::size_t at_once = 65536;
    while (missing > 0 && more()) {
      const std::size_t n = std::min(missing, at_once);
      put(std::vector<float>(n * components_, 0.0F));
      missing -= n;
    }
    const auto first = block.pressure.begin() + std::ptrdiff_t((std::size_t(options_.phone) - 1) *
                                                               block.samples * components_);
    put({first, first + std::ptrdiff_t(block.samples * components_)});
  }
  [[nodiscard]] bool more() const {
    return !closed() && (!options_.seconds || heard() < *options_.seconds);
  }

  void finish() {
    if (audible_) write(audible_->rest());
    if (!waiting_.empty()) begin();
    if (!wav_) return;
    wav_->finish();
    if (sound_) {
      const nlohmann::json about{{"pascal_per_unit", scale_},
                                 {"sample_rate_hz", rate_},
                                 {"channels", 1},
                                 {"samples", wav_->samples()}};
      scale_file_->write(about.dump(2) + '\n');
      sound_->finish();
    }
    tell(fmt::format("asdic listen: {:.6g} s, full scale {:.6g} Pa{}", heard(), scale_,
                     wav_->clipped() > 0
                         ? fmt::format("; {} louder than that{}",
                                       count_of(std::size_t(wav_->clipped()), "sample"),
                                       options_.format == "16" ? ": clipped" : "")
                         : ""));
  }

 private:
  void open() {
    if (options_.wav == "-") {
      file_ = std::make_unique<File>(STDOUT_FILENO);
      return;
    }
    OutputRules of_sound{.force = options_.force, .option = "--wav"}, of_scale = of_sound;
    of_sound.own = own::sound;
    of_scale.own = own::sound_scale;
    sound_.emplace(options_.wav, of_sound);
    scale_file_.emplace(options_.wav + ".json", of_scale);
    file_ = std::make_unique<File>(::open(sound_->part().c_str(), O_RDWR | O_CLOEXEC));
    if (file_->descriptor < 0) throw RunError(options_.wav + ": cannot be written");
  }

  void put(std::vector<float> samples) {
    if (options_.seconds) {
      const auto most = static_cast<std::uint64_t>(std::llround(*options_.seconds * source_rate_));
      samples.resize(std::min<std::size_t>(
          samples.size(), std::size_t(most - std::min(most, samples_)) * components_));
    }
    samples_ += samples.size() / components_;
    write(audible_ ? audible_->take(samples) : std::move(samples));
  }

  /// Without a full scale of the user's the first second says how loud it is.
  void write(const std::vector<float>& heard) {
    if (wav_) return wav_->put(heard);
    waiting_.insert(waiting_.end(), heard.begin(), heard.end());
    if (options_.full_scale || double(waiting_.size()) >= rate_) begin();
  }
  void begin() {
    if (!options_.full_scale) {
      float peak = 0.0F;
      for (const float p : waiting_) peak = std::max(peak, std::abs(p));
      constexpr double room = 10.0;  // for what is louder than the first second
      scale_ = peak > 0.0F ? room * static_cast<double>(peak) : 1.0;
    }
    wav_.emplace(file_->descriptor, options_.wav,
                 WavStream::Form{.sample_rate = rate_,
                                 .sample = options_.format == "16" ? WavStream::Sample::int16
                                                                   : WavStream::Sample::float32,
                                 .full_scale = scale_});
    wav_->put(waiting_);
    waiting_.clear();
  }

  const ListenOptions& options_;
  std::uint64_t stream_;
  std::size_t channels_ = 1, components_ = 1, block_samples_ = 1;
  double source_rate_ = 1.0, rate_ = 1.0, scale_ = 1.0;
  std::uint64_t samples_ = 0;
  std::optional<Audible> audible_;
  std::optional<OutputFile> sound_, scale_file_;
  std::unique_ptr<File> file_;
  std::optional<WavStream> wav_;
  std::vector<float> waiting_;
};

int listen(const ListenOptions& options) {
  if (options.wav == "-" && stdout_is_terminal())
    throw UsageError("--wav - is for a pipe or a file: asdic listen … --wav - | aplay");
  signal(SIGPIPE, SIG_IGN);  // a player that ends is the end
  serve::UdpReceiver socket(options.udp, options.interface);
  serve::StreamReceiver receiver;
  std::optional<Recorder> recorder;
  const StopOnInterrupt interrupt;
  tell("asdic listen: waiting for a stream at " + options.udp);
  const auto stopped = [&] { return interrupt.token().stop_requested(); };
  constexpr double a_while = 0.1;  // [s]
  bool another = false;
  while (!stopped() && !another && !receiver.ended() && (!recorder || recorder->more())) {
    const serve::Datagram packet = socket.next(a_while);
    if (packet.bytes.empty()) continue;
    receiver.take(packet, [&](serve::StreamReceiver::Block&& block) {
      if (!recorder) recorder.emplace(options, *receiver.about());
      another = another || receiver.about()->stream != recorder->stream();
      if (!another && recorder->more()) recorder->take(block);
    });
  }
  const auto& counts = receiver.counts();
  if (!recorder)
    throw RunError("--udp " + options.udp + ": no block came" +
                   (counts.foreign > 0
                        ? ", but " + count_of(counts.foreign, "packet") + " of something else"
                        : ""));
  recorder->finish();
  tell(fmt::format("asdic listen: {} of {} lost ({} of {})",
                   counts.lost_blocks == 0 ? "none" : std::to_string(counts.lost_blocks),
                   count_of(counts.blocks + counts.lost_blocks, "block"),
                   counts.lost == 0 ? "none" : std::to_string(counts.lost),
                   count_of(counts.packets + counts.lost, "packet")));
  if (counts.others > 0)
    tell("asdic listen: " + count_of(counts.others, "packet") + " of other senders left aside");
  return 0;
}

}  // namespace

void add_listen_command(Program& program) {
  program.add_command(
      "listen", "Hear a phone of a server's block stream: a WAV file, or a pipe into a player.",
      [](const Command& command) {
        auto options = std::make_shared<ListenOptions>();
        command
            .add_option("--udp", options->udp,
                        "where asdic serve --udp sends: an address of this machine, or a group, "
                        "which is joined")
            .type_name("HOST:PORT")
            .required();
        command
            .add_option("--udp-interface", options->interface,
                        "address of the interface on which a group is joined")
            .type_name("ADDRESS");
        command.add_option("--wav", options->wav, "file to write; -: standard output, for a player")
            .type_name("FILE")
            .required();
        command.add_option("--phone", options->phone, "which, from 1")
            .type_name("N")
            .check(above_zero())
            .show_default();
        command
            .add_option("--tone", options->tone,
                        "what the carrier of complex baseband becomes [Hz]; default: 1000, or half "
                        "its rate")
            .type_name("HZ")
            .check(above_zero());
        command.add_option("--format", options->format, "of the samples: float, or 16 bits")
            .one_of({"float", "16"})
            .show_default();
        command
            .add_option("--full-scale", options->full_scale,
                        "pressure that is full scale [Pa]; default: ten times the loudest of the "
                        "first second")
            .type_name("PA")
            .check(above_zero());
        command
            .add_option("--seconds", options->seconds,
                        "of the stream; default: until it ends, or Ctrl-C")
            .type_name("S")
            .check(above_zero());
        add_force_option(command, options->force);
        command.footer(
            "Ctrl-C ends it; the file is whole. What was lost is silent, and told.\n"
            "Example:  asdic listen --udp 239.1.2.3:4711 --phone 3 --format 16 --wav - | aplay");
        command.runs([options] { return listen(*options); });
      });
}

}  // namespace asdic::detail::app
