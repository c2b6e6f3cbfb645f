#include "io/processing/process_pings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "core/units.h"
#include "processing/matched_filter.h"
#include "processing/owned_tracks.h"
#include "raytrace/propagation.h"
#include "sonar/scenario/carried.h"

namespace asdic::detail {
namespace {

/// "0.5", one digit behind the point.
std::string tenths(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// "2.5", six digits at most.
std::string six_digits(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// What a user should know of a record with next to no noise: the threshold is relative to a
/// background of rounding and of the filters' own tails, and these are no Rayleigh background.
/// Empty where all that was found is within what a recorder of 20 bits takes.
std::string rounding(const ProcessedArray& made, const ArrayRecording& received) {
  constexpr double span_db = 120.0;
  float loudest = 0.0F;
  for (const float sample : received.pressure) loudest = std::max(loudest, std::abs(sample));
  for (const std::complex<float> sample : received.envelope)
    loudest = std::max(loudest, std::abs(sample));
  const double faintest = db_from_amplitude(static_cast<double>(loudest) / micropascal) - span_db;
  const std::vector<Detection>& all = made.result.detections;
  const auto faint = std::count_if(all.begin(), all.end(),
                                   [&](const Detection& d) { return d.level_db < faintest; });
  if (faint == 0) return "";
  return "ping " + std::to_string(received.ping) + ", array " + std::to_string(received.array) +
         ": " + std::to_string(faint) + " of " + std::to_string(all.size()) +
         " detections are more than 120 dB below the loudest sample: with so little noise in the "
         "record, rounding and the filters' own tails stand out of the background";
}

/// What a user should know of a towed line that bends while it listens: beams are formed for the
/// shape in the middle of the record. Empty if no phone moves by an eighth of a wavelength from
/// there. \param end  of the record, since the ping [s]
std::string bending(const PingProcessor& processor, const ProcessedArray& made,
                    const ArrayRecording& received, double end) {
  const ArrayMotion motion(processor.scenario(), received.array);
  if (!motion.deforms()) return "";
  const auto phones = [&](double time) { return motion.phones(received.ping, time); };
  const std::vector<Vec3> middle = phones(received.ping_time + 0.5 * (received.start + end)),
                          later = phones(received.ping_time + end);
  double moved = 0.0, turned = 0.0;
  for (std::size_t n = 0; n < middle.size(); ++n) {
    const double off = (later[n] - middle[n]).norm();
    moved = std::max(moved, off);
    turned = std::max(turned, off / std::max(middle[n].norm(), 0.25 * made.shape.length));
  }
  const double wavelength =
      made.sound_speed / processor.replica(received.transmitter).centre_frequency();
  if (moved < 0.125 * wavelength) return "";
  return "array " + std::to_string(received.array) + ", ping " + std::to_string(received.ping) +
         ": the line turns and bends by up to " + tenths(moved) +
         " m while it receives; beams are those of its shape in the middle of the record, and "
         "bearings may be up to " +
         tenths(degrees(std::min(turned, pi))) + " degrees off";
}

/// What was taken out of a record before anything else, and what goes with it; "" of nothing.
std::string cancelled(const PingProcessor& processor, const ProcessedArray& made) {
  const BlastCancellation& blast = made.blast;
  if (blast.cancelled == 0) return "";
  std::string text = "ping " + std::to_string(made.ping) + ", " +
                     processor.scenario().arrays[static_cast<std::size_t>(made.array)].name +
                     ": the direct blast of " + std::to_string(blast.cancelled) +
                     (blast.cancelled == 1 ? " transmission is " : " transmissions is ") +
                     tenths(blast.lowered_db()) + " dB lower, " + tenths(blast.after_db) +
                     " dB re 1 uPa with all that is left; echoes within " +
                     six_digits(std::ceil(blast.blind_ms())) +
                     " ms of its delays, along the ridge, go with it";
  if (blast.narrowed) text += "; its faintest paths are left, for they are too many";
  return text;
}

/// What sub-bands cost, and what is told of them; "" of one.
std::string cut(const PingProcessor& processor, const ProcessedArray& made, int transmitter) {
  const DetectorSettings& settings = processor.settings().detector;
  const int parts = settings.sub_bands;
  if (parts < 2) return "";
  const double p = settings.normaliser.false_alarm_probability;
  const double whole = cfar_multiplier(p, infinity) - 1.0,
               mean = parts * (cfar_multiplier(p, infinity, parts) - 1.0);
  return std::to_string(parts) + " sub-bands of " +
         processor.scenario().transmitters[static_cast<std::size_t>(transmitter)].name +
         ": each has " + tenths(db_from_power(parts)) +
         " dB less processing gain, the mean of all asks for an echo " +
         tenths(db_from_power(mean / whole)) + " dB louder than one filter; a cell is " +
         six_digits(std::round(1e4 * made.result.time_cell) / 10.0) + " ms, " +
         six_digits(std::round(0.5 * made.sound_speed * made.result.time_cell)) + " m of range";
}

void track_array(const PingProcessor& processor, const std::vector<const ProcessedPing*>& pings,
                 const std::vector<int>& first_rows, ProcessedRun& run) {
  std::vector<TrackedPing> tracked;
  bool sides = false, bearings = true;
  for (const ProcessedPing* ping : pings) {
    tracked.push_back(tracked_ping(processor, ping->array, ping->ping_time, ping->score.owner));
    sides |= tracked.back().two_sides;
    bearings &= tracked.back().bearings;
  }
  for (OwnedTrack& one :
       owned_tracks(tracked, processor.scenario(), processor.settings().tracker)) {
    ProcessedTrack made{.array = pings.front()->array.array,
                        .side = one.side,
                        .ambiguous = sides,
                        .has_bearing = bearings,
                        .track = std::move(one.track),
                        .error = std::move(one.error),
                        .target = one.target};
    for (TrackPoint& p : made.track.points) {
      const auto k = static_cast<std::size_t>(p.ping);
      made.rows.push_back(p.detection < 0 ? -1 : first_rows[k] + p.detection);
      p.ping = pings[k]->array.ping;
    }
    run.tracks.push_back(std::move(made));
  }
}

/// A pulse whose filter answers within 3 dB beside an echo: what stands there may be told instead.
std::string nails(const PingProcessor& processor, int transmitter) {
  const Replica& pulse = processor.replica(transmitter);
  const std::span<const double> factors = processor.dopplers(transmitter);
  const NormaliserSettings& settings = processor.settings().detector.normaliser;
  const double cell = 1.0 / pulse.noise_bandwidth();
  if (reach_of_answer(pulse, settings.guard_cells * cell,
                      (settings.guard_cells + settings.reference_cells) * cell) == 0.0)
    return "";  // a tone, a sweep
  const Nail late = nail_in_delay(pulse),
             fast = nail_in_doppler(pulse, factors.back() - factors.front());
  char in_delay[80] = "", in_doppler[80] = "";
  if (late.power > 0.5)
    std::snprintf(in_delay, sizeof in_delay, "%.3g s off its delay at %.1f dB", late.offset,
                  db_from_power(late.power));
  if (fast.power > 0.5)
    std::snprintf(in_doppler, sizeof in_doppler, "%.3g m/s off its range rate at %.1f dB",
                  750.0 * fast.offset, db_from_power(fast.power));
  if (*in_delay == 0 && *in_doppler == 0) return "";
  return "pulse: its filter answers an echo " + std::string(in_delay) +
         (*in_delay != 0 && *in_doppler != 0 ? " and " : "") + in_doppler +
         ": a detection may be told there, further paths or noise decide" +
         (*in_doppler != 0 ? "; a lower max_speed searches less of it" : "");
}

}  // namespace

ProcessedRun process_pings(const ReceivedPings& recordings, const PingProcessor& processor,
                           std::optional<int> ping, const std::function<void(int)>& done,
                           const std::function<bool()>& proceed) {
  ProcessedRun run;
  run.warnings = recordings.scenario().notes;
  run.earth = EarthPlaces(recordings.scenario().origin, recordings.scenario().area.get());
  const std::size_t first = ping ? recordings.row_of(*ping) : 0;
  const std::size_t end = ping ? first + 1 : recordings.pings();
  const int arrays = static_cast<int>(recordings.scenario().arrays.size());
  double last_end = 0.0;
  for (std::size_t row = first; row < end; ++row)
    last_end = std::max(last_end, recordings.end(row));
  if (const double from = processor.settings().detector.first_time.value_or(0.0); from >= last_end)
    throw InputError(
        {.where = "from",
         .got = six_digits(from) + " s",
         .expected = "a time before the record's end, " + six_digits(last_end) + " s"});
  for (std::size_t row = first; row < end; ++row) {
    for (int array = 0; array < arrays; ++array) {
      if (!proceed()) throw Interrupted();
      ProcessedPing made{.transmitter = recordings.transmitter(row),
                         .ping_time = recordings.ping_time(row)};
      std::vector<TrueEcho> echoes = recordings.echoes(row, array);
      const ArrayRecording received = recordings.recording(row, array);
      if (recordings.not_finite() > 0)
        run.warnings.push_back("pressure of ping " + std::to_string(received.ping) + ", array " +
                               std::to_string(array) + ": " +
                               std::to_string(recordings.not_finite()) +
                               " samples are not finite and were taken as silence");
      made.array = processor.process(received, proceed, echoes);
      if (const std::string bends = bending(processor, made.array, received, recordings.end(row));
          !bends.empty())
        run.warnings.push_back(bends);
      if (const std::string faint = rounding(made.array, received); !faint.empty())
        run.warnings.push_back(faint);
      if (const std::string blast = cancelled(processor, made.array); !blast.empty())
        run.notes.push_back(blast);
      if (const std::string note = cut(processor, made.array, made.transmitter);
          !note.empty() && std::find(run.notes.begin(), run.notes.end(), note) == run.notes.end())
        run.notes.push_back(note);
      for (std::size_t i = 0; i < echoes.size(); ++i)
        echoes[i].threshold_db = made.array.result.thresholds_db[i];
      made.truth = recordings.targets(row, echoes);
      made.score = score_detections(made.array.result.detections, echoes, made.truth,
                                    made.array.shape, made.array.places.array,
                                    processor.resolution(made.array), made.array.searched_from,
                                    std::min(made.array.searched_until, recordings.end(row)));
      if (row == first)
        made.map_range =
            processor.ranges_at(made.array, made.transmitter, made.array.result.maps.time);
      run.pings.push_back(std::move(made));
    }
    done(static_cast<int>(row - first) + 1);
  }
  for (int array = 0; array < arrays; ++array) {
    std::vector<const ProcessedPing*> of_array;
    std::vector<int> rows;
    for (std::size_t k = 0; k < run.pings.size(); ++k)
      if (run.pings[k].array.array == array) {
        of_array.push_back(&run.pings[k]);
        rows.push_back(first_row(run, k));
      }
    if (of_array.size() > 1) track_array(processor, of_array, rows, run);
  }
  std::set<int> senders;
  for (const ProcessedPing& made : run.pings)
    if (senders.insert(made.transmitter).second)
      if (const std::string found = nails(processor, made.transmitter); !found.empty())
        run.warnings.push_back(found);
  if (const std::string lack = processor.lack(); !lack.empty()) run.warnings.push_back(lack);
  return run;
}

}  // namespace asdic::detail
