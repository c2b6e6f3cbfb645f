#include "reverb/power/reverberation_streams.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/mixed_bits.h"
#include "raytrace/parallel/parallel.h"
#include "reverb/power/delay_bins.h"
#include "reverb/power/received_places.h"

namespace asdic::detail {
namespace {

using StreamBlock = ReverberationStreams::Block;
using Listener = ReverberationStreams::Listener;

/// The longest axis of points about their middles, up to its sign: x, y or z, whichever it is most
/// along, is positive.
Vec3 long_axis(std::span<const std::vector<Vec3>> shapes) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::vector<Vec3>& shape : shapes) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : shape) middle += x / static_cast<double>(shape.size());
    for (const Vec3& x : shape) spread += (x - middle) * (x - middle).transpose();
  }
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  Eigen::Index most = 0;
  axis.cwiseAbs().maxCoeff(&most);
  return axis[most] < 0.0 ? Vec3(-axis) : axis;
}

/// How far a shape reaches along an axis, the longest of all.
double length_along(const Vec3& axis, std::span<const std::vector<Vec3>> shapes) {
  double longest = 0.0;
  for (const std::vector<Vec3>& shape : shapes) {
    double least = infinity, most = -infinity;
    for (const Vec3& x : shape) {
      least = std::min(least, axis.dot(x));
      most = std::max(most, axis.dot(x));
    }
    longest = std::max(longest, most - least);
  }
  return longest;
}

/// Blocks of a quarter of a pulse and, later, of an eighth of the delay: no direction depends on
/// them, but each asks for transforms that are a pulse longer.
std::vector<StreamBlock> blocks_of(std::size_t bins, double pulse_bins) {
  const auto least = static_cast<std::size_t>(std::max(2.0, 0.25 * pulse_bins));
  std::vector<StreamBlock> found;
  for (std::size_t begin = 0; begin < bins;) {
    const std::size_t end = std::min(bins, begin + std::max(least, begin / 8));
    found.push_back({.begin = begin, .end = end});
    begin = end;
  }
  return found;
}

using Directions = std::array<std::int16_t, 3>;  // along the axes of an array

/// The cell of a part: parts 3k − 1, 3k, 3k + 1 are cell k.
std::int16_t cell_of(std::int16_t part) noexcept {
  const int shifted = part + 1;
  return static_cast<std::int16_t>(shifted >= 0 ? shifted / 3 : -((2 - shifted) / 3));
}
Directions cells_of(Directions parts) noexcept {
  for (std::int16_t& part : parts) part = cell_of(part);
  return parts;
}

/// What array and pulse cannot resolve. Along each of its axes the array's ends are half[i] from
/// its middle: powers of its beams are correlations over no more than 2·half, and a sum over
/// directions at steps of 2π·f·s·half below π is the integral. Doppler spectra are of correlations
/// no longer than the pulse: so are sums at steps of less than 1/T. Cells are 2 rad and 0.75/T, or
/// as wide as a sweep tolerates: a shift by ν delays it by νT/B, far less than a bin.
class Resolution {
 public:
  explicit Resolution(const Listener& to)
      : frequency_(to.frequency),
        dopplers_(to.frequency / std::max(0.75 / to.pulse_duration, to.doppler_tolerance)) {
    constexpr double step = 2.0;  // [rad]
    for (std::size_t i = 0; i < 3; ++i) {
      scale_[i] = pi * to.frequency / step * to.extents[i];
      half_ = std::max(half_, 0.5 * to.extents[i].norm());
    }
  }

  /// Cells of directions all round, in bearing.
  /// \param speed  of the faster end, at which cells of Doppler factors follow each other [m/s]
  [[nodiscard]] double bearings(double speed) const noexcept {
    double widest = 0.0;
    for (const Vec3& s : scale_) widest = std::max(widest, s.head<2>().norm());
    return 2.0 * pi * (widest + 0.75 * dopplers_ * speed) / slowest_sea;
  }
  /// The part of a direction, a third of a cell wide along each axis.
  [[nodiscard]] Directions direction(const Vec3& slowness) const noexcept {
    Directions part{};
    for (std::size_t i = 0; i < 3; ++i) part[i] = rounded(3.0 * scale_[i].dot(slowness));
    return part;
  }
  /// Of a front's bend: its ends lie πf·half²·|s|/R behind its middle.
  [[nodiscard]] std::int16_t bend(const Vec3& slowness, double radius) const noexcept {
    constexpr double step = 0.5;  // [rad]
    return rounded(pi * frequency_ * half_ * half_ * slowness.norm() / radius / step);
  }
  /// The part of a Doppler factor, a third of a cell wide.
  [[nodiscard]] std::int16_t doppler(double factor) const noexcept {
    return rounded(3.0 * (factor - 1.0) * dopplers_);
  }

 private:
  static std::int16_t rounded(double cells) noexcept {
    constexpr double most = 32'000.0;
    return static_cast<std::int16_t>(
        static_cast<int>(std::clamp(cells, -most, most) + (most + 0.5)) - static_cast<int>(most));
  }
  std::array<Vec3, 3> scale_;  // cells to a slowness [m/s]
  double half_ = 0.0;          // of the array [m]
  double frequency_;           // [Hz]
  double dopplers_;            // cells to a change of the factor by 1
};

/// Three directions and a part of the Doppler factor in one word.
std::uint64_t word_of(const Directions& of, std::int16_t more) noexcept {
  std::uint64_t w = static_cast<std::uint16_t>(more);
  for (const std::int16_t i : of) w = w << 16 | static_cast<std::uint16_t>(i);
  return w;
}

/// A cell of a block: directions of one sound, or of two that are one noise, and Doppler factors.
class Cell {
 public:
  Cell() = default;
  /// \param other  of the second sound, if there are two
  Cell(const Directions& one, const std::optional<Directions>& other, std::int16_t bend,
       std::int16_t doppler) noexcept
      : one_(word_of(one, doppler)),
        other_(word_of(other.value_or(Directions{}), bend)),
        two_(other) {}

  [[nodiscard]] Cell lasting(bool lasts) const noexcept {
    Cell cell = *this;
    cell.lasts_ = lasts;
    return cell;
  }
  [[nodiscard]] bool lasts() const noexcept { return lasts_; }
  [[nodiscard]] Cell in_block(std::uint32_t block) const noexcept {
    Cell cell = *this;
    cell.block_ = block;
    return cell;
  }
  [[nodiscard]] std::uint32_t block() const noexcept { return block_; }
  [[nodiscard]] bool operator==(const Cell&) const = default;
  [[nodiscard]] std::uint64_t entity() const noexcept {
    constexpr std::uint64_t one = 1;
    return mixed(mixed(one_, other_),
                 std::uint64_t{block_} << 1 | (two_ ? one : 0) | (lasts_ ? one << 40 : 0));
  }

 private:
  std::uint64_t one_ = 0, other_ = 0;
  std::uint32_t block_ = 0;
  bool two_ = false, lasts_ = false;
};

struct CellHash {
  std::size_t operator()(const Cell& cell) const noexcept { return cell.entity(); }
};

/// What is received of a part of a cell: powers, the two sounds' product, sums weighted with the
/// powers.
struct PartSum {
  double one = 0.0, other = 0.0, doppler = 0.0;
  std::complex<double> both = 0.0;
  Vec3 one_slowness = Vec3::Zero(), other_slowness = Vec3::Zero();
  double one_norm = 0.0, other_norm = 0.0;
  double one_curvature = 0.0, other_curvature = 0.0;

  [[nodiscard]] double power() const noexcept { return one + other; }
  /// \param share  of what is received   \param norm  of its first slowness
  void add(const Received& h, double share, double norm) noexcept {
    const double power = share * std::norm(h.one);
    one += power;
    one_slowness += power * h.one_slowness;
    one_norm += power * norm;
    one_curvature += power / h.one_length;
    doppler += power * (h.doppler - 1.0);
    if (h.other == 0.0) return;
    const double more = share * std::norm(h.other);
    other += more;
    other_slowness += more * h.other_slowness;
    other_norm += more * h.other_slowness.norm();
    other_curvature += more / h.other_length;
    doppler += more * (h.doppler - 1.0);
    both += share * h.one * std::conj(h.other);
  }
  void add(const PartSum& more) noexcept {
    one += more.one;
    other += more.other;
    doppler += more.doppler;
    both += more.both;
    one_slowness += more.one_slowness;
    other_slowness += more.other_slowness;
    one_norm += more.one_norm;
    other_norm += more.other_norm;
    one_curvature += more.one_curvature;
    other_curvature += more.other_curvature;
  }
};

struct CellSum {
  Cell cell;
  std::size_t first = 0;             // of its bins
  std::vector<std::uint64_t> words;  // word_of() the direction and Doppler part of each part
  std::vector<PartSum> parts;

  [[nodiscard]] double power() const noexcept {
    double sum = 0.0;
    for (const PartSum& part : parts) sum += part.power();
    return sum;
  }
  [[nodiscard]] std::size_t part(std::uint64_t word) {
    const auto known = std::find(words.begin(), words.end(), word);
    const auto place = static_cast<std::size_t>(known - words.begin());
    if (known == words.end()) {
      words.push_back(word);
      parts.emplace_back();
    }
    return place;
  }
};

/// Sums by cell, in the order in which cells were met.
class CellSums {
 public:
  explicit CellSums(std::span<const StreamBlock> blocks) : blocks_(blocks) {}

  /// Its number.
  [[nodiscard]] std::size_t at(const Cell& cell) {
    const auto [place, is_new] = index_.try_emplace(cell, sums_.size());
    if (is_new) {
      sums_.push_back({.cell = cell, .first = power_.size()});
      power_.resize(power_.size() + bins(cell));
    }
    return place->second;
  }
  [[nodiscard]] CellSum& operator[](std::size_t number) noexcept { return sums_[number]; }
  [[nodiscard]] std::size_t bins(const Cell& cell) const noexcept {
    return blocks_[cell.block()].end - blocks_[cell.block()].begin;
  }
  [[nodiscard]] std::span<float> power(const CellSum& sum) {
    return std::span(power_).subspan(sum.first, bins(sum.cell));
  }
  [[nodiscard]] std::span<const CellSum> all() const noexcept { return sums_; }
  void add(CellSums&& more) {
    if (sums_.empty()) {
      std::swap(*this, more);
      return;
    }
    for (const CellSum& theirs : more.sums_) {
      CellSum& ours = sums_[at(theirs.cell)];
      for (std::size_t i = 0; i < theirs.parts.size(); ++i)
        ours.parts[ours.part(theirs.words[i])].add(theirs.parts[i]);
      const std::span<const float> from = more.power(theirs);
      const std::span<float> to = power(ours);
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
    }
  }

 private:
  std::span<const StreamBlock> blocks_;
  std::unordered_map<Cell, std::size_t, CellHash> index_;
  std::vector<CellSum> sums_;
  std::vector<float> power_;
};

/// The ground around a receiver, cut into circles half a bin of two-way delay apart, but no more
/// than a quarter of their distance from it or, further out, a 256th of their radius, and those
/// into sectors; near a source that is elsewhere, finer.
struct GroundAround {
  const ScatteringField& field;
  Vec2 middle;
  std::vector<double> edges{0.0};  // [m]
  int sectors;

  GroundAround(const ScatteringField& f, double bin, double bearings)
      : field(f), middle(f.sheet.ends().receiver.position.head<2>()) {
    const SheetEnds& ends = field.sheet.ends();
    const double reach =
        field.grid.rings * field.grid.spacing + (middle - field.grid.anchor).norm();
    const double height = std::abs(field.depth - ends.receiver.position.z());
    while (edges.back() < reach) {
      const double inner = edges.back(), most = 0.25 * std::hypot(height, inner);
      const double width = std::clamp(0.25 * slowest_sea * bin, 1.0, std::max(1.0, most));
      edges.push_back(std::min(reach, inner + std::max(width, inner / 256.0)));
    }
    sectors = static_cast<int>(std::ceil(std::max<double>(bearings, field.bearings)));
  }

  /// Adds what is received of one circle.
  void receive(std::size_t circle, const AudibleLimits& limits,
               const PathInterference& interference, ReceptionMemory& memory,
               std::vector<Received>& received) const {
    const double inner = edges[circle], outer = edges[circle + 1], range = 0.5 * (inner + outer);
    const double ring = field.received_area(static_cast<std::uint32_t>(range / field.grid.spacing));
    const double width = 2.0 * pi / sectors;
    const int pieces = (sectors + together(range) - 1) / together(range);
    std::vector<Vec2> places;
    for (int piece = 0; piece < pieces; ++piece) {
      const int first = piece * sectors / pieces, last = (piece + 1) * sectors / pieces;
      const double bearing = field.grid.first_bearing + 0.5 * (first + last) * width;
      const double whole = width * (last - first);
      // No piece is longer than half its distance from the source.
      const Vec2 place = middle + range * outward(bearing);
      const double half = 0.5 * distance_from_source(place);
      const auto cut = [&](double size) {
        constexpr double most = 64.0;
        const double largest = std::min(
            half, field.sheet.largest_piece(place, field.depth, std::max(size, range * whole)));
        return static_cast<int>(std::clamp(std::ceil(size / largest), 1.0, most));
      };
      const int parts = cut(range * whole), along = cut(outer - inner);
      const bool shared = last - first > 1 && parts == 1;
      const int around = shared ? 1 : std::max(last - first, parts);
      for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
          const double length = (outer - inner) / along, r = inner + (i + 0.5) * length;
          const double towards = bearing + ((j + 0.5) / around - 0.5) * whole;
          const double wide = r * whole / around;
          places.clear();
          for (int sector = first; sector < last && shared; ++sector)
            places.push_back(middle +
                             r * outward(field.grid.first_bearing + (sector + 0.5) * width));
          const auto number = static_cast<std::uint64_t>((piece * along + i) * around + j);
          asdic::detail::receive(field,
                                 {.middle = middle + r * outward(towards),
                                  .outward = outward(towards),
                                  .length = length,
                                  .width = wide,
                                  .area = field.share * field.share * length * wide,
                                  .ring = ring,
                                  .chance = mixed(mixed(circle, field.boundary), number),
                                  .places = places},
                                 limits, interference, false, memory, received);
        }
    }
  }

 private:
  /// Number of sectors of a circle that are received by the same pairs of paths: as many as keep
  /// bearings from either end, distances from the source and interference of paths alike.
  [[nodiscard]] int together(double range) const noexcept {
    constexpr double most = 6.0;
    constexpr double narrow = 0.125;  // over the distance from the source
    if (!field.sheet.depends_on_range_alone()) return 1;
    const SheetEnds& ends = field.sheet.ends();
    const double apart = (ends.source.position.head<2>() - middle).norm();
    const double nearest =
        std::min(range, std::hypot(range - apart, ends.source.position.z() - field.depth));
    return static_cast<int>(std::clamp(narrow * nearest * sectors / (2.0 * pi * range), 1.0, most));
  }
  [[nodiscard]] double distance_from_source(const Vec2& place) const noexcept {
    const Vec3& source = field.sheet.ends().source.position;
    return std::hypot((place - source.head<2>()).norm(), source.z() - field.depth);
  }
  [[nodiscard]] static Vec2 outward(double bearing) noexcept {
    return {std::sin(bearing), std::cos(bearing)};
  }
};

/// Puts what is received into the cells of the blocks in which it is received.
class Gatherer {
 public:
  Gatherer(const Resolution& resolution, std::span<const StreamBlock> blocks,
           std::span<const std::uint32_t> block_of, double bin, CellSums& sums)
      : resolution_(resolution), blocks_(blocks), block_of_(block_of), bin_(bin), sums_(sums) {}

  /// \param lasts  from ping to ping
  void add(const Received& h, bool lasts) {
    const double bins = static_cast<double>(block_of_.size());
    double first = std::max(0.0, (h.delay - 0.5 * h.extent) / bin_);
    const double last = std::min(bins, (h.delay + 0.5 * h.extent) / bin_);
    if (!(first < bins) || last < first) return;
    if (h.one_slowness != from_.slowness || h.one_length != from_.length) look(h);
    const std::int16_t shift = resolution_.doppler(h.doppler);
    std::optional<Directions> other;
    if (h.other != 0.0) other = cells_of(resolution_.direction(h.other_slowness));
    const Cell cell = Cell(from_.cells, other, from_.bend, cell_of(shift)).lasting(lasts);
    const std::uint64_t word = word_of(from_.direction, shift);
    const double whole = std::max(last - first, 1e-9);
    do {
      const auto at = std::min(static_cast<std::size_t>(first), block_of_.size() - 1);
      const StreamBlock& block = blocks_[block_of_[at]];
      const double until = std::min(last, static_cast<double>(block.end));
      const double share = last > first ? (until - first) / whole : 1.0;
      find(cell.in_block(block_of_[at]), word);
      CellSum& sum = sums_[sum_];
      sum.parts[part_].add(h, share, from_.norm);
      spread(share * (std::norm(h.one) + std::norm(h.other)),
             first - static_cast<double>(block.begin), until - static_cast<double>(block.begin),
             sums_.power(sum));
      first = until;
    } while (first < last);
  }

 private:
  /// The direction from which sound came last: that of one place along one path comes at once.
  struct From {
    Vec3 slowness = Vec3::Constant(infinity);
    double length = 0.0, norm = 0.0;
    Directions direction{}, cells{};
    std::int16_t bend = 0;
  };
  void look(const Received& h) {
    from_ = {.slowness = h.one_slowness,
             .length = h.one_length,
             .norm = h.one_slowness.norm(),
             .direction = resolution_.direction(h.one_slowness),
             .bend = resolution_.bend(h.one_slowness, h.one_length)};
    from_.cells = cells_of(from_.direction);
  }
  void find(const Cell& cell, std::uint64_t word) {
    if (known_ && cell == cell_ && word == word_) return;
    if (!known_ || !(cell == cell_)) sum_ = sums_.at(cell);
    part_ = sums_[sum_].part(word);
    cell_ = cell;
    word_ = word;
    known_ = true;
  }

  const Resolution& resolution_;
  std::span<const StreamBlock> blocks_;
  std::span<const std::uint32_t> block_of_;
  double bin_;
  CellSums& sums_;
  From from_;
  bool known_ = false;  // what follows: the cell and its part that were met last
  Cell cell_;
  std::uint64_t word_ = 0;
  std::size_t sum_ = 0, part_ = 0;
};

/// [one both; both* other] = F F^H, a noise for each column of F; over the power of both.
ReverberationStreams::Part finished(const PartSum& sum) {
  constexpr double nothing = 1e-6;
  const double all = sum.power();
  ReverberationStreams::Part part{.slowness = {sum.one_slowness / sum.one, Vec3::Zero()},
                                  .length = {sum.one_norm / sum.one, 0.0},
                                  .curvature = {sum.one_curvature / sum.one, 0.0},
                                  .doppler = 1.0 + sum.doppler / all};
  part.weight[0][0] = std::sqrt(sum.one / all);
  if (!(sum.other > 0.0)) return part;
  part.slowness[1] = sum.other_slowness / sum.other;
  part.length[1] = sum.other_norm / sum.other;
  part.curvature[1] = sum.other_curvature / sum.other;
  part.weight[0][1] = std::conj(sum.both) / std::sqrt(sum.one * all);
  const double rest = sum.other / all - std::norm(part.weight[0][1]);
  if (rest > nothing) part.weight[1][1] = std::sqrt(rest);
  return part;
}

/// Steps of direction and Doppler factor all round.
double bearings_of(const Resolution& resolution, const ScatteringField& field) {
  return resolution.bearings(field.sheet.fastest_ends() + 2.0 * field.field.motion.current.norm());
}

/// Cells of a block, roughly: there are some three directions to a bearing.
double streams_of_block(const Listener& listener, const ScatteringField& field) {
  constexpr double directions = 3.0, fewest = 8.0;
  return directions * std::max(fewest, bearings_of(Resolution(listener), field));
}

}  // namespace

MemoryNeed ReverberationStreams::need(std::span<const ScatteringField* const> fields,
                                      const Listener& listener) {
  constexpr double parts = 4.0;  // of a cell, in the mean
  const double bin = delay_bin(listener.pulse_duration, listener.latest);
  const std::vector<StreamBlock> blocks = blocks_of(
      static_cast<std::size_t>(std::ceil(listener.latest / bin)), listener.pulse_duration / bin);
  double streams = 0.0, fastest = 0.0;
  for (const ScatteringField* field : fields) {
    streams += streams_of_block(listener, *field);
    fastest = std::max(fastest, field->sheet.fastest_ends());
  }
  // Kept, and while they are sorted as cells and as those of the tasks, too.
  const double a_stream =
      static_cast<double>(blocks.size()) *
      (sizeof(Stream) + sizeof(CellSum) + parts * (sizeof(Part) + sizeof(PartSum)));
  const double intensities = listener.latest / bin * sizeof(float);
  // A block's sound is a pulse longer than the block.
  constexpr double wider = 2.0;  // than the 99 % band
  const double samples =
      (listener.latest + 2.0 * static_cast<double>(blocks.size()) * listener.pulse_duration) *
      (wider * listener.bandwidth + 2.0 * fastest / slowest_sea * listener.frequency);
  const double sound = samples * static_cast<double>(listener.phones) * sizeof(std::complex<float>);
  return {.where = "array",
          .what = std::to_string(std::llround(streams * static_cast<double>(blocks.size()))) +
                  " streams of reverberation",
          .bytes = streams * (a_stream + 3.0 * intensities) + sound,
          .remedy =
              "a shorter array, a slower platform, a shorter record (pings.recording_duration) or "
              "reverberation.synthesis = \"scatterers\""};
}

std::array<Vec3, 3> ReverberationStreams::extents_of(std::span<const std::vector<Vec3>> shapes,
                                                     double frequency) {
  // Phases of sound along the array, between its ends and the middle [rad].
  constexpr double alike = 0.1;                       // an array so short receives one direction
  constexpr double least = 0.9;                       // else at least: yet one cell
  constexpr double askew = 0.5;                       // of an end beside a rounded axis
  constexpr double finest = 8.0;                      // lengths to an octave
  const double phase = pi * frequency / slowest_sea;  // of a metre
  Vec3 along = long_axis(shapes);
  const double all = phase * length_along(along, shapes);
  if (all > alike) {
    const double step = std::exp2(std::floor(std::log2(std::min(1.0, askew / all))));
    for (double& x : along) x = step * std::round(x / step);
    along.normalize();
  }
  const Vec3 aside = std::abs(along.z()) > 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 second = aside.cross(along).normalized();
  std::array<Vec3, 3> extents = {along, second, along.cross(second)};
  for (Vec3& axis : extents) {
    const double rad = phase * length_along(axis, shapes);
    const double octaves = std::ceil(finest * std::log2(rad / least) - 1e-9) / finest;
    axis *= rad < alike ? 0.0 : least / phase * std::exp2(std::max(0.0, octaves));
  }
  return extents;
}

bool ReverberationStreams::serves(const ScatteringField& field) noexcept {
  const ScattererField& f = field.field;
  return field.sheet.ends().band.empty() && f.motion.kind != ScattererMotion::Kind::spread &&
         (f.statistics.coherence_time == 0.0 || field.stays) && !f.statistics.k_shape;
}

double ReverberationStreams::worth(const Listener& listener, const ScatteringField& field) {
  // Samples of streams against those of pulses' impulses, each at every phone; a stream has its
  // noise and transforms, and there are some three directions to a bearing.
  constexpr double a_sample = 2.0, a_return = 25.0;
  const double phones = static_cast<double>(listener.phones);
  return streams_of_block(listener, field) * listener.latest * (listener.bandwidth + 10.0) *
         (a_sample + 0.1 * phones) / (a_return * (1.0 + 0.2 * phones));
}

ReverberationStreams::ReverberationStreams(std::span<const ScatteringField* const> fields,
                                           const AudibleLimits& limits, const Listener& listener) {
  bin = delay_bin(listener.pulse_duration, listener.latest);
  const auto bins = static_cast<std::size_t>(std::ceil(listener.latest / bin));
  if (bins == 0) return;
  blocks = blocks_of(bins, listener.pulse_duration / bin);
  std::vector<std::uint32_t> block_of(bins);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    std::fill(block_of.begin() + static_cast<std::ptrdiff_t>(blocks[b].begin),
              block_of.begin() + static_cast<std::ptrdiff_t>(blocks[b].end),
              static_cast<std::uint32_t>(b));
  const Resolution resolution(listener);

  constexpr std::size_t together = 16;  // circles of a task
  CellSums sums(blocks);
  for (const ScatteringField* field : fields) {
    const GroundAround ground(*field, bin, 1.5 * bearings_of(resolution, *field));
    const PathInterference interference(listener.places, field->sheet.ends().frequency,
                                        *listener.coherence, false);
    const std::size_t circles = ground.edges.size() - 1;
    std::vector<CellSums> parts((circles + together - 1) / together, CellSums(blocks));
    in_parallel(parts.size(), [&](std::size_t part) {
      Gatherer gatherer(resolution, blocks, block_of, bin, parts[part]);
      ReceptionMemory memory;
      std::vector<Received> received;
      for (std::size_t i = part * together; i < std::min(circles, (part + 1) * together); ++i) {
        received.clear();
        ground.receive(i, limits, interference, memory, received);
        for (const Received& h : received) gatherer.add(h, field->stays);
      }
    });
    for (CellSums& part : parts) sums.add(std::move(part));
  }

  // Of each block the faintest, a hundred-thousandth of its power together, are left out.
  constexpr double left_out = 1e-5;
  std::vector<std::vector<std::size_t>> of_block(blocks.size());
  for (std::size_t i = 0; i < sums.all().size(); ++i)
    of_block[sums.all()[i].cell.block()].push_back(i);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto power = [&](std::size_t i) { return sums.all()[i].power(); };
    std::vector<std::size_t>& cells = of_block[b];
    std::stable_sort(cells.begin(), cells.end(),
                     [&](std::size_t i, std::size_t j) { return power(i) > power(j); });
    double total = 0.0, rest = 0.0;
    for (const std::size_t i : cells) total += power(i);
    while (!cells.empty() && (rest += power(cells.back())) <= left_out * total) cells.pop_back();
    blocks[b].first = streams.size();
    for (const std::size_t i : cells) {
      const CellSum& sum = sums.all()[i];
      const std::size_t first_part = parts.size();
      double before = 0.0;
      for (const PartSum& part : sum.parts) {
        if (!(part.power() > 0.0)) continue;  // without sound it has no direction
        parts.push_back(finished(part));
        parts.back().chance = (before += part.power()) / sum.power();
      }
      streams.push_back({.entity = sum.cell.entity(),
                         .lasts = sum.cell.lasts(),
                         .first = intensity.size(),
                         .first_part = first_part,
                         .parts = parts.size() - first_part});
      for (const float in_bin : sums.power(sum))
        intensity.push_back(in_bin / static_cast<float>(bin));
    }
    blocks[b].last = streams.size();
  }
}

const ReverberationStreams::Part& ReverberationStreams::part_of(const Stream& stream,
                                                                std::uint64_t seed,
                                                                std::uint32_t ping) const noexcept {
  const double drawn = uniform_of_bits(mixed(mixed(stream.entity, seed), ping));
  std::size_t i = stream.first_part;
  while (i + 1 < stream.first_part + stream.parts && parts[i].chance < drawn) ++i;
  return parts[i];
}

std::size_t ReverberationStreams::bytes() const noexcept {
  return sizeof *this + blocks.capacity() * sizeof(StreamBlock) +
         streams.capacity() * sizeof(Stream) + parts.capacity() * sizeof(Part) +
         intensity.capacity() * sizeof(float);
}

}  // namespace asdic::detail
