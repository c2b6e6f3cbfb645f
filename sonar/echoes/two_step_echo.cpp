#include "sonar/echoes/two_step_echo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "core/geometry.h"
#include "core/mixed_bits.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/echoes/one_leg.h"
#include "sonar/echoes/outer_phones.h"
#include "sonar/echoes/target_response.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/fft.h"
#include "sonar/synthesis/sound_synthesis.h"

namespace asdic::detail {
namespace {

constexpr double tangent_phase = 0.02;    // by which a segment's delays may be off [rad]
constexpr double turning_segment = 0.25;  // longest segment for a receiver that turns [s]

/// A segment of a sound: all of it at its middle, fading out over so much before and after [s].
struct Segment {
  double middle = 0.0, before = 0.0, after = 0.0;

  [[nodiscard]] double share(double since) const {
    const double reach = since < 0.0 ? before : after;
    if (since == 0.0) return 1.0;
    return std::abs(since) < reach ? std::pow(std::cos(0.5 * pi * since / reach), 2) : 0.0;
  }
};

/// Segments whose shares add up to 1 between two times. They do not reach across turns.
std::vector<Segment> segments(double begin, double end, std::vector<double> course_changes,
                              double longest) {
  std::erase_if(course_changes, [&](double t) { return t <= begin || t >= end; });
  course_changes.push_back(end);
  std::vector<Segment> found;
  for (const double change : course_changes) {
    const auto n = static_cast<int>(std::ceil((change - begin) / longest));
    const double step = (change - begin) / n;
    for (int i = 0; i <= n; ++i)
      found.push_back({begin + i * step, i > 0 ? step : 0.0, i < n ? step : 0.0});
    begin = change;
  }
  return found;
}

/// A sound on the clock of what sends it, and where it is.
struct Sound {
  BandLimitedPulse wave;  // peak about 1
  double middle = 0.0;    // of the wave, since the ping [s]
  double scale = 1.0;     // what it is over the wave
};

/// What a segment lets through of it, about the segment's middle. \param step  longest of all
/// segments: all waves alike   \return none where there is next to nothing
std::optional<BandLimitedPulse> cut(const Sound& sound, const Segment& segment, double step) {
  // cos² over 2·step has nothing above −85 dB of it further than this.
  const double half_band = sound.wave.half_band() + 8.0 / step;
  const double rate = 4.2 * half_band;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(step * rate));
  std::vector<std::complex<double>> samples;
  const double cycles =
      sound.wave.centre_frequency() * std::fmod(segment.middle - sound.middle, 1e6);
  const std::complex<double> rotation = std::polar(1.0, 2.0 * pi * (cycles - std::round(cycles)));
  double largest = 0.0;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i) {
    const double since = static_cast<double>(i) / rate, share = segment.share(since);
    samples.push_back(share > 0.0
                          ? share * rotation * sound.wave.at(segment.middle - sound.middle + since)
                          : 0.0);
    largest = std::max(largest, std::abs(samples.back()));
  }
  constexpr double inaudible = 3e-5;  // of the peak, −90 dB
  if (largest < inaudible) return std::nullopt;
  return BandLimitedPulse({samples, -static_cast<double>(reach) / rate, rate},
                          sound.wave.centre_frequency(), step + 12.0 / rate, half_band);
}

/// \param more  of the same grid, or nothing
void add_to(Baseband& all, Baseband&& more) {
  if (all.channels == 0)
    all = std::move(more);
  else
    std::transform(more.values.begin(), more.values.end(), all.values.begin(), all.values.begin(),
                   std::plus<>{});
}

/// Sum of sounds, each synthesised in the part of a record that it reaches.
class SumOfSounds {
 public:
  SumOfSounds(const Recording& recording, double max_doppler, std::span<const Vec3> phones)
      : recording_(recording), max_doppler_(max_doppler), phones_(phones) {}

  void add(const BandLimitedPulse& wave, std::span<const Return> returns) {
    if (!wave_) wave_ = wave;
    Baseband piece = baseband_of(wave, reached(wave, returns), max_doppler_, returns, phones_);
    const auto same = std::find_if(parts_.begin(), parts_.end(), [&](const Baseband& part) {
      return part.start == piece.start && part.recorded == piece.recorded &&
             part.samples == piece.samples && part.sample_rate == piece.sample_rate &&
             part.carrier == piece.carrier;
    });
    if (same == parts_.end())
      parts_.push_back(std::move(piece));
    else
      add_to(*same, std::move(piece));
  }
  /// \return all of them over the whole record; without channels: nothing was added
  [[nodiscard]] Baseband whole() const {
    if (!wave_) return {};
    Baseband all = baseband_of(*wave_, recording_, max_doppler_, {}, phones_);
    for (const Baseband& part : parts_)
      if (part.start == all.start && part.samples == all.samples && part.carrier == all.carrier)
        add_to(all, Baseband(part));
      else
        add_resampled(part, all);
    return all;
  }

 private:
  /// Part of the record in which phones receive a wave, in steps, so that sounds of about the same
  /// time share it; all of the record if that is hardly longer.
  [[nodiscard]] Recording reached(const BandLimitedPulse& wave,
                                  std::span<const Return> returns) const {
    double first = infinity, last = -infinity;
    const auto at = [&](const Return& r, const Vec3& phone) {
      const double delay = r.delay + r.slowness.dot(phone);
      first = std::min(first, delay);
      last = std::max(last, delay);
    };
    for (const Return& r : returns)
      if (r.channel == Return::all_channels)
        for (const Vec3& phone : phones_) at(r, phone);
      else
        at(r, phones_[static_cast<std::size_t>(r.channel)]);
    const double half = wave.half_duration() / (1.0 - max_doppler_), rate = recording_.sample_rate;
    const double step = std::ceil(0.25 * half * rate), total = double(recording_.samples);
    constexpr double worth = 0.6;  // of the record
    const double begin = std::floor((first - half - recording_.start) * rate / step) * step,
                 end = std::ceil((last + half - recording_.start) * rate / step + 1.0) * step;
    const double from = std::clamp(begin, 0.0, total - 1.0),
                 to = std::clamp(end, from + 1.0, total);
    if (!(to - from < worth * total)) return recording_;
    Recording part = recording_;
    part.start += from / rate;
    part.samples = static_cast<std::size_t>(to - from);
    return part;
  }

  Recording recording_;
  double max_doppler_;
  std::span<const Vec3> phones_;
  std::optional<BandLimitedPulse> wave_;  // the first: all are on one grid
  std::vector<Baseband> parts_;
};

/// One path of a leg, for what leaves at one moment.
struct LegPath {
  EchoPath received;  // delay since the ping
  Vec3 lag;           // of a point of the sender at x from its reference point, lag·x [s/m]
  SeenAside aside;    // of such a point
};

/// A leg of the way, from something that moves to something else that moves.
class MovingLeg {
 public:
  using Place = std::function<Kinematics(double since)>;

  /// \param with_waves  whether paths may be waves
  MovingLeg(const EchoContext& context, const MovingPaths& moving, bool with_waves, Place sender,
            Carried receiver, std::uint64_t ends, SeaDraws& draws)
      : context_(context),
        moving_(moving),
        with_waves_(with_waves),
        sender_(std::move(sender)),
        receiver_(std::move(receiver)),
        ends_(ends),
        draws_(draws) {}

  /// All its paths for what leaves then. \param sent  since the ping [s]
  std::vector<LegPath> at(double sent) {
    const Kinematics from = sender_(sent);
    // Rays become waves on the way and waves rays, which following a path does not show.
    if (with_waves_) known_.clear();
    Way way = moving_.way(from.position, sent, receiver_.track, receiver_.offset, known_);
    known_ = std::exchange(way.leg.arrivals, {});
    std::vector<LegPath> found;
    std::vector<EchoPath> scattered;
    const double c = context_.paths.speed_at(from.position);
    for (const Arrival& path : known_) {
      const MetPath met =
          moving_.meet(from.position, sent, receiver_.track, receiver_.offset, way, path);
      const Vec3 out = leaving_slowness(met.way.leg.bearing, met.path, c),
                 at_receiver = arriving_slowness(met.way.leg.bearing, met.path,
                                                 context_.paths.speed_at(met.way.end.position));
      const Vec3 lag = BodyLag{.out = out,
                               .at_phone = at_receiver,
                               .body_velocity = from.velocity,
                               .phone_velocity = met.way.end.velocity}
                           .per_offset();
      const SeenAside aside(at_receiver, met.path);
      found.push_back({received_along(context_, from, met), lag, aside});
      scattered.clear();
      scatter_along(context_, from, sent, met, ends_, found.back().received, draws_, scattered);
      for (EchoPath& part : scattered) found.push_back({std::move(part), lag, aside});
    }
    return found;
  }

  /// Longest segment over which its delays are straight in time [s].
  double straight_for(double begin, double end, double frequency, double aperture) const {
    const Kinematics from = sender_(begin);
    const Kinematics to = receiver_.at(context_.geometry.time() + begin);
    const double speed = (to.velocity - from.velocity).norm(),
                 length = std::max(1.0, (to.position - from.position).norm()),
                 c = context_.paths.speed_at(from.position);
    // A segment's delays are off by an eighth of the curvature, where two of them are as loud. Its
    // directions are off by as much as the next one's the other way: there the phases' mean is
    // right, and in between it is off by |t/T − sin²(πt/2T)| of their difference at most.
    const auto off = [&](double duration) {
      const double bent = curvature_phase(frequency, duration, speed, length, c, 0.0),
                   turned = curvature_phase(frequency, duration, speed, length, c, aperture) - bent;
      return 0.25 * bent + 0.105 * turned + 0.125 * turned * turned;
    };
    double longest = end - begin;
    while (longest > 1e-3 && off(longest) > tangent_phase) longest *= 0.8;
    return longest;
  }

  [[nodiscard]] const Carried& receiver() const { return receiver_; }

 private:
  const EchoContext& context_;
  const MovingPaths& moving_;
  bool with_waves_;
  Place sender_;
  Carried receiver_;
  std::uint64_t ends_;
  SeaDraws& draws_;
  Arrivals known_;  // of the last moment
};

class TwoSteps {
 public:
  TwoSteps(const EchoContext& context, const ManyEchoes& many, const TwoStepReceivers& receivers,
           const Recording& recording, double max_doppler, const TwoStepBand& band, SeaDraws& draws)
      : context_(context),
        geometry_(context.geometry),
        scenario_(context.scenario()),
        target_(scenario_.targets[static_cast<std::size_t>(many.target)]),
        index_(many.target),
        receivers_(receivers),
        recording_(recording),
        max_doppler_(max_doppler),
        latest_(end_of_record(scenario_)),
        limits_(limits_of(scenario_.propagation, many.followed)),
        band_(band),
        draws_(draws),
        places_(target_.highlights.empty() ? 1 : target_.highlights.size()) {}

  Baseband receive() {
    const Baseband there = at_target();
    if (there.channels == 0) return {};
    group_phones(there.start + 0.5 * static_cast<double>(there.recorded) / there.sample_rate);
    SumOfSounds received(recording_, max_doppler_, receivers_.phones);
    if (band_.home.empty()) add(sounds_of(there), context_.frequency, received);
    for (const BandPart& part : band_.home)
      add(sounds_of(through(there, part.filter)), part.frequency, received);
    return received.whole();
  }

 private:
  [[nodiscard]] MovingPaths paths_at(double frequency) const {
    return {context_.paths, limits_, frequency, geometry_.time(), 1e-7, context_.reuse};
  }
  [[nodiscard]] bool with_waves() const { return context_.paths.layered() && limits_.diffraction; }
  [[nodiscard]] double highest() const {
    return context_.pulse->centre_frequency() + 0.5 * context_.pulse->bandwidth_40db();
  }
  [[nodiscard]] std::vector<double> course_changes(const Track& track) const {
    return course_changes_of(track, geometry_.time());
  }
  [[nodiscard]] Kinematics target_at(double since) const {
    return geometry_.target_at(index_, since);
  }
  [[nodiscard]] Vec3 offset(std::size_t place, double since) const {
    if (target_.highlights.empty()) return Vec3::Zero();
    return from_body(target_.highlights[place].offset,
                     heading_of(target_, geometry_.time() + since));
  }
  [[nodiscard]] double body_radius() const {
    double furthest = 0.0;
    for (const Highlight& one : target_.highlights)
      furthest = std::max(furthest, one.offset.norm());
    return furthest;
  }
  [[nodiscard]] double array_radius() const {
    double furthest = 0.0;
    if (!receivers_.by_themselves)
      for (const Vec3& phone : receivers_.phones) furthest = std::max(furthest, phone.norm());
    return furthest;
  }

  /// Phones that receive the paths to one of them, as plane waves.
  struct Group {
    int leader = -1;  // number of a phone; −1: the reference point
    std::vector<int> members = {Return::all_channels};  // channels
  };

  /// Finds out which phones may share paths: those that would each have paths of their own, because
  /// waves change over the array's depths, but lie at one depth and receive alike to −30 dB.
  /// \param sent  time at which the sound leaves the target, since the ping [s]
  void group_phones(double sent) {
    groups_.clear();
    if (!receivers_.by_themselves) {
      groups_.emplace_back();
      return;
    }
    const std::size_t all =
        std::min(receivers_.phones.size(), geometry_.phones(context_.array).size());
    if (receivers_.phones.size() > all)
      groups_.push_back({.leader = -1, .members = {static_cast<int>(all)}});
    std::vector<int> left(all);
    std::iota(left.begin(), left.end(), 0);
    const auto depth = [&](int n) { return receivers_.phones[static_cast<std::size_t>(n)].z(); };
    const bool exact = scenario_.propagation.exact_per_phone || !context_.paths.layered();
    std::stable_sort(left.begin(), left.end(), [&](int a, int b) { return depth(a) < depth(b); });
    for (auto first = left.begin(), last = first; first != left.end(); first = last) {
      constexpr double level = 1e-6;  // [m]
      last = std::find_if(first, left.end(), [&](int n) {
        return exact ? n != *first : depth(n) - depth(*first) > level;
      });
      group(sent, {first, last});
    }
  }

  /// Groups phones at one depth, halving them along their greatest extent until they are alike.
  void group(double sent, std::vector<int> phones) {
    const auto place = [&](int n) { return receivers_.phones[static_cast<std::size_t>(n)]; };
    const auto extent = [&](int axis) {
      const auto [least, most] =
          std::minmax_element(phones.begin(), phones.end(),
                              [&](int a, int b) { return place(a)[axis] < place(b)[axis]; });
      return std::array{*least, *most};
    };
    const std::array east = extent(0), north = extent(1);
    const bool along =
        place(east[1]).x() - place(east[0]).x() > place(north[1]).y() - place(north[0]).y();
    std::stable_sort(phones.begin(), phones.end(), [&](int a, int b) {
      return along ? place(a).x() < place(b).x() : place(a).y() < place(b).y();
    });
    const auto middle = phones.begin() + std::ssize(phones) / 2;
    if (phones.size() < 2 || share_paths(sent, *middle, {east[0], east[1], north[0], north[1]})) {
      groups_.push_back({*middle, phones});
      return;
    }
    group(sent, {phones.begin(), middle});
    group(sent, {middle, phones.end()});
  }

  /// Whether others move with a phone and receive as it does.
  bool share_paths(double sent, int leader, std::set<int> others) const {
    others.erase(leader);
    const Carried receiver = geometry_.receiver(context_.array, leader);
    const MovingPaths moving = paths_at(context_.frequency);
    const auto arrived = [&](const Carried& at) {
      Way way = moving.way(target_at(sent).position, sent, at.track, at.offset);
      return ArrivedLeg{std::move(way.leg), way.end.position};
    };
    const auto beside = [&](const Carried& at, double since) -> Vec3 {
      const double time = geometry_.time() + since;
      return at.at(time).position - receiver.at(time).position;
    };
    const ArrivedLeg reference = arrived(receiver);
    return std::all_of(others.begin(), others.end(), [&](int n) {
      constexpr double stays = 1e-6;  // [m]
      const Carried phone = geometry_.receiver(context_.array, n);
      const Vec3 apart = receivers_.phones[static_cast<std::size_t>(n)] -
                         receivers_.phones[static_cast<std::size_t>(leader)];
      return (beside(phone, sent) - apart).norm() < stays &&
             (beside(phone, latest_) - apart).norm() < stays &&
             is_alike(context_, reference, arrived(phone));
    });
  }

  /// Segments of a sound along legs of one sender; none: it need not be cut.
  static std::vector<Segment> cuts(std::span<const MovingLeg> legs, const Sound& sound,
                                   std::vector<double> course_changes, bool receiver_course_changes,
                                   double frequency, double aperture) {
    const double begin = sound.middle - sound.wave.half_duration(),
                 end = sound.middle + sound.wave.half_duration();
    double longest = receiver_course_changes ? turning_segment : infinity;
    for (const MovingLeg& leg : legs)
      longest = std::min(longest, leg.straight_for(begin, end, frequency, aperture));
    std::erase_if(course_changes, [&](double t) { return t <= begin || t >= end; });
    if (course_changes.empty() && longest >= end - begin) return {};
    return segments(begin, end, std::move(course_changes), longest);
  }

  /// The moment for which a segment's paths are found: within its own side of a turn.
  static double moment_of(const Segment& segment) {
    constexpr double aside = 1e-6;
    return segment.middle + (segment.before == 0.0 ? aside : 0.0) -
           (segment.after == 0.0 ? aside : 0.0);
  }

  /// Calls with every piece of a sound that is carried along a leg, and the moment that its paths
  /// are found for.
  template <class Carry>
  static void for_each_piece(const std::vector<Sound>& sounds, const std::vector<Segment>& cut_at,
                             const Carry& carry) {
    if (cut_at.empty()) {
      std::vector<std::optional<BandLimitedPulse>> whole;
      for (const Sound& sound : sounds) whole.emplace_back(sound.wave);
      return carry(whole, sounds.front().middle, sounds.front().middle);
    }
    double step = 0.0;
    for (const Segment& s : cut_at) step = std::max({step, s.before, s.after});
    for (const Segment& s : cut_at) {
      std::vector<std::optional<BandLimitedPulse>> pieces;
      bool any = false;
      for (const Sound& sound : sounds) {
        pieces.push_back(cut(sound, s, step));
        any = any || pieces.back();
      }
      if (any) carry(pieces, s.middle, moment_of(s));
    }
  }

  /// A path's return of what leaves at a segment's middle, its paths found for another moment.
  static Return leaving_at(const LegPath& path, double middle, double moment) {
    Return r = path.received.received;
    r.delay += (middle - moment) / r.doppler;
    return r;
  }

  struct Piece {
    BandLimitedPulse wave;
    Returns returns;
  };
  /// Adds what carries the pulse to the target's places.
  /// \param part  of the pulse's band; null: amplitudes at the centre serve all of it
  void carry(const BandPart* part, std::vector<Piece>& pieces) const {
    const Synthesizer whole(*context_.pulse, recording_, max_doppler_,
                            part != nullptr ? part->filter : std::function<double(double)>());
    const Sound pulse{.wave = filtered_pulse(whole), .middle = 0.5 * context_.pulse->duration()};
    const MovingPaths moving = paths_at(part != nullptr ? part->frequency : context_.frequency);
    MovingLeg leg(
        context_, moving, with_waves(), [&](double since) { return geometry_.source_at(since); },
        {.track = target_.track},
        mixed(static_cast<std::uint64_t>(geometry_.sent().transmitter),
              mixed(1, target_identity(scenario_, index_))),
        draws_);
    for_each_piece({pulse},
                   cuts({&leg, 1}, pulse, course_changes(geometry_.sender().track),
                        !course_changes(target_.track).empty(), highest(), 2.0 * body_radius()),
                   [&](const std::vector<std::optional<BandLimitedPulse>>& wave, double middle,
                       double moment) {
                     Piece& piece = pieces.emplace_back(Piece{*wave.front(), {}});
                     for (const LegPath& path : leg.at(moment)) {
                       Return r = leaving_at(path, middle, moment);
                       if (r.delay > latest_) continue;
                       r.amplitude = sent_along(path.received, part);
                       for (std::size_t p = 0; p < places_; ++p) {
                         r.channel = static_cast<int>(p);
                         Return& one = piece.returns.emplace_back(r);
                         one.delay += r.slowness.dot(offset(p, r.delay));
                         one.slowness = Vec3::Zero();
                       }
                     }
                   });
  }

  /// The sound that strikes the target's places. \return [places]; without channels: nothing
  /// strikes it in time
  Baseband at_target() const {
    std::vector<Piece> pieces;
    if (band_.out.empty()) carry(nullptr, pieces);
    for (const BandPart& part : band_.out) carry(&part, pieces);
    double first = infinity, last = -infinity, longest = 0.0;
    for (const Piece& piece : pieces) {
      longest = std::max(longest, piece.wave.half_duration() / (1.0 - max_doppler_));
      for (const Return& r : piece.returns) {
        first = std::min(first, r.delay);
        last = std::max(last, r.delay);
      }
    }
    if (!(first <= last)) return {};
    longest += body_radius() / 1000.0;
    if (!band_.home.empty()) longest += delay_of_response(*context_.pulse);
    Recording there = recording_;
    there.start = first - longest;
    there.samples = static_cast<std::size_t>(
        std::ceil((last - first + 2.0 * longest) * recording_.sample_rate));
    const std::vector<Vec3> no_offsets(places_, Vec3::Zero());
    Baseband all;
    for (const Piece& piece : pieces)
      add_to(all, baseband_of(piece.wave, there, max_doppler_, piece.returns, no_offsets));
    return all;
  }

  /// All channels through a filter of the band. \param filter  over the frequency from the pulse's
  /// centre [Hz]
  Baseband through(Baseband all, const std::function<double(double)>& filter) const {
    const auto n = static_cast<std::ptrdiff_t>(all.samples);
    const ComplexFft<float> fft(all.samples);
    std::vector<float> factors;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double f = all.carrier + static_cast<double>(2 * i < n ? i : i - n) * all.sample_rate /
                                         static_cast<double>(n);
      factors.push_back(static_cast<float>(filter(f - context_.pulse->centre_frequency()) /
                                           static_cast<double>(n)));
    }
    for (std::size_t channel = 0; channel < all.channels; ++channel) {
      std::complex<float>* const row = all.values.data() + channel * all.samples;
      fft.forward(row);
      for (std::size_t i = 0; i < all.samples; ++i) row[i] *= factors[i];
      fft.inverse(row);
    }
    return all;
  }

  /// What was synthesised, channel by channel, as sounds of peak 1.
  static std::vector<Sound> sounds_of(const Baseband& all) {
    const double half = 0.5 * static_cast<double>(all.recorded) / all.sample_rate;
    const double middle = all.start + half;
    const double cycles = all.carrier * middle;
    const std::complex<double> rotation = std::polar(1.0, 2.0 * pi * (cycles - std::round(cycles)));
    std::vector<Sound> sounds;
    double peak = 0.0;
    for (std::size_t n = 0; n < all.channels; ++n) peak = std::max(peak, largest_envelope(all, n));
    if (!(peak > 0.0)) return {};
    const double rate = 2.0 * all.sample_rate;
    for (std::size_t n = 0; n < all.channels; ++n) {
      const SampledSignal row = signal_of(all, n);
      const auto reach = static_cast<std::ptrdiff_t>(std::ceil(half * rate));
      std::vector<std::complex<double>> samples;
      for (std::ptrdiff_t i = -reach; i <= reach; ++i)
        samples.push_back(rotation / peak * row.at(middle + static_cast<double>(i) / rate));
      const double half_band = 0.5 * all.sample_rate / all.oversampling;
      sounds.push_back(
          {.wave = BandLimitedPulse({samples, -static_cast<double>(reach) / rate, rate},
                                    all.carrier, half + 12.0 / rate, half_band),
           .middle = middle,
           .scale = peak});
    }
    return sounds;
  }

  /// Adds what is received of the sounds at the target: by paths of each phone's own, or by those
  /// of the reference point.
  void add(const std::vector<Sound>& struck, double frequency, SumOfSounds& received) const {
    if (struck.empty()) return;
    const MovingPaths moving = paths_at(frequency);
    const int array = context_.array;
    const std::uint64_t ends =
        mixed(target_identity(scenario_, index_), mixed(2, static_cast<std::uint64_t>(array)));
    std::vector<MovingLeg> legs;
    for (const Group& group : groups_)
      legs.emplace_back(
          context_, moving, with_waves(), [&](double since) { return target_at(since); },
          geometry_.receiver(array, group.leader), ends, draws_);
    for_each_piece(
        struck,
        cuts(legs, struck.front(), course_changes(target_.track),
             !course_changes(legs.front().receiver().track).empty(), highest(),
             std::max(array_radius(), 2.0 * body_radius())),
        [&](const std::vector<std::optional<BandLimitedPulse>>& waves, double middle,
            double moment) {
          std::vector<Returns> of_place(waves.size());
          for (std::size_t n = 0; n < legs.size(); ++n) {
            const std::vector<LegPath> paths = legs[n].at(moment);
            if (paths.empty()) continue;
            const int leader = groups_[n].leader;
            const Vec3 x = leader < 0 ? Vec3(Vec3::Zero())
                                      : receivers_.phones[static_cast<std::size_t>(leader)];
            for (const Glint& glint : seen(paths.front().received.response.bearing, moment)) {
              const auto place = static_cast<std::size_t>(std::max(glint.highlight, 0));
              if (!waves[place]) continue;
              for (const LegPath& path : paths) {
                Return r = leaving_at(path, middle, moment);
                r.slowness += path.aside.of(glint.offset);
                r.delay += path.lag.dot(glint.offset) - r.slowness.dot(x);
                r.amplitude =
                    path.received.response.without_pattern * glint.amplitude * struck[place].scale;
                for (const int channel : groups_[n].members) {
                  r.channel = channel;
                  of_place[place].push_back(r);
                }
              }
            }
          }
          for (std::size_t place = 0; place < waves.size(); ++place)
            if (!of_place[place].empty()) received.add(*waves[place], of_place[place]);
        });
  }

  /// What answers at a moment: paths there and back lie in vertical planes, and the strength
  /// depends on their bearings alone. \param home  bearing of the way back [rad]
  [[nodiscard]] std::vector<Glint> seen(double home, double since) const {
    const double there = separation(geometry_.source().position, target_at(since).position).bearing;
    return glints(scenario_, index_, context_.look(), slowness_vector(there, 0.0, 1.0),
                  slowness_vector(home, 0.0, 1.0), geometry_.time() + since);
  }

  /// Amplitude of a path with the transmitter's pattern.
  static std::complex<double> sent_along(const EchoPath& path, const BandPart* part) {
    if (part == nullptr) return path.received.amplitude;
    const PathResponse& response = path.response;
    return response.without_pattern * part->pattern.towards(response.bearing, response.elevation);
  }

  const EchoContext& context_;
  const PingGeometry& geometry_;
  const Scenario& scenario_;
  const Target& target_;
  int index_;
  TwoStepReceivers receivers_;
  Recording recording_;
  double max_doppler_;
  double latest_;  // end of the record [s]
  PathLimits limits_;
  const TwoStepBand& band_;
  SeaDraws& draws_;  // of both legs
  std::vector<Group> groups_;
  std::size_t places_;  // number of the target's highlights, or 1
};

}  // namespace

Baseband two_step_echo(const EchoContext& context, const ManyEchoes& many,
                       const TwoStepReceivers& receivers, const Recording& recording,
                       double max_doppler, SeaDraws& draws, const TwoStepBand& band) {
  return TwoSteps(context, many, receivers, recording, max_doppler, band, draws).receive();
}

TwoStepSound two_step_sound(const EchoContext& context, const ManyEchoes& many,
                            const Recording& recording, double max_doppler,
                            const TwoStepBand& band) {
  const std::vector<Vec3>& phones = context.geometry.phones(context.array);
  const bool own_peak = context.scenario().propagation.exact_per_phone;
  SeaDraws draws(context.scenario().seed);
  const auto received_at = [&](std::vector<Vec3> places, bool by_themselves) {
    return two_step_echo(context, many, {places, by_themselves}, recording, max_doppler, draws,
                         band);
  };
  const auto peak_of = [](const Baseband& sound, std::size_t channel) {
    return sound.channels > 0 ? largest_envelope(sound, channel) : 0.0;
  };
  TwoStepSound found;
  if (!context.listens) {
    found.peak = peak_of(
        own_peak ? received_at({phones.front()}, true) : received_at({Vec3::Zero()}, false), 0);
    return found;
  }
  // The reference point is one phone more.
  std::vector<Vec3> places = phones;
  if (!own_peak) places.emplace_back(Vec3::Zero());
  found.received = received_at(places, many.at_phones || own_peak);
  Baseband& all = found.received;
  found.peak = peak_of(all, own_peak ? 0 : phones.size());
  if (all.channels > 0) {
    all.channels = phones.size();
    all.values.resize(all.channels * all.samples);
  }
  return found;
}

}  // namespace asdic::detail
