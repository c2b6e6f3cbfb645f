#include "io/bellhop/map_run.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "core/units.h"
#include "raytrace/cases/memory.h"

namespace asdic::detail::bellhop {
namespace {

/// What no beam of the fan reaches.
PropagationResult silence(const PropagationCase& run_case) {
  const std::size_t n = run_case.source_depths.size() * run_case.receivers.size();
  PropagationResult result;
  if (run_case.task == Task::arrivals)
    result.arrivals.resize(n);
  else
    result.field.resize(n);
  return result;
}

/// A run in three dimensions whose source shines between two azimuths: of all paths those that are
/// launched there, and a field as their sum, as run_volume() makes it.
PropagationResult run_between_azimuths(const PropagationCase& run_case, const MapInput& map,
                                       double azimuth_deg, const Progress& progress,
                                       const MemoryBudget& budget) {
  PropagationCase paths = run_case;
  paths.task = Task::arrivals;
  PropagationResult found = run(paths, progress, budget);
  for (Arrivals& here : found.arrivals)
    std::erase_if(here, [&](const Arrival& a) {
      return !map.shines_at(azimuth_deg - degrees(a.launch_deflection));
    });
  if (run_case.task == Task::arrivals) return found;
  const double omega = 2.0 * pi * run_case.frequency;
  const bool coherent = run_case.field == FieldKind::coherent;
  for (const Arrivals& here : found.arrivals) {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : here) {
      const std::complex<double> p = a.amplitude * std::polar(1.0, -omega * a.delay);
      sum += coherent ? p : std::complex<double>(std::norm(p));
    }
    found.field.emplace_back(coherent ? sum : std::sqrt(sum));
  }
  found.arrivals.clear();
  return found;
}

template <class T>
void append_plane(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Notes of the planes, each once, with how many planes it is of. Those that differ by their
/// numbers alone are one: that of the first plane is told.
class PlaneNotes {
 public:
  void add(const std::vector<std::string>& notes) {
    for (const std::string& text : notes) {
      const std::string words = without_numbers(text);
      const auto known = std::find_if(all_.begin(), all_.end(),
                                      [&](const Note& one) { return one.words == words; });
      if (known == all_.end()) {
        all_.push_back({words, text, 1, true});
      } else {
        ++known->planes;
        known->alike = known->alike && known->text == text;
      }
    }
  }
  [[nodiscard]] std::vector<std::string> told(std::size_t planes) const {
    std::vector<std::string> lines;
    for (const Note& note : all_) {
      const std::string where =
          note.planes == planes
              ? "in all planes"
              : "in " + std::to_string(note.planes) + " of " + std::to_string(planes) + " planes";
      if (!note.alike)
        lines.push_back(where + ", with other numbers in each; of the first: " + note.text);
      else
        lines.push_back(note.planes == planes ? note.text : where + ": " + note.text);
    }
    return lines;
  }

 private:
  struct Note {
    std::string words, text;
    std::size_t planes;
    bool alike;
  };
  static std::string without_numbers(std::string text) {
    std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
    return text;
  }

  std::vector<Note> all_;
};

}  // namespace

PropagationResult run_all_planes(const Input& input, bool like_bellhop, const Progress& progress,
                                 const MemoryBudget& budget) {
  const auto run_one = [&](const PropagationCase& run_case, const Progress& of_it) {
    return like_bellhop ? run_bellhop_emulation(run_case, of_it, budget)
                        : run(run_case, of_it, budget);
  };
  if (!input.map) return run_one(input.run_case, progress);
  const MapInput& map = *input.map;
  const std::size_t planes = map.planes();
  const auto run_on_area = [&](const PropagationCase& run_case, std::size_t i,
                               const Progress& of_it) {
    if (run_case.dimension == 3 && !like_bellhop && !map.shines_all_around())
      return run_between_azimuths(run_case, map, map.azimuth_deg(i), of_it, budget);
    return run_one(run_case, of_it);
  };
  if (planes == 1 && map.area) return run_on_area(on_plane(input, 0), 0, progress);
  PropagationCase all = input.run_case;  // as much memory as of so many sources
  all.source_depths.assign(planes * all.source_depths.size(), all.source_depths.front());
  static_cast<void>(run_memory(all, budget));

  PropagationResult result{.beam_error_bounded = true};
  PlaneNotes notes;
  PropagationResult alike;  // of an ocean that is the same everywhere
  bool known = false;
  for (std::size_t i = 0; i < planes; ++i) {
    const PropagationCase plane = on_plane(input, i);
    const Progress of_it = [&](double share) {
      return !progress || progress((double(i) + share) / double(planes));
    };
    PropagationResult found;
    if (map.area) {
      found = run_on_area(plane, i, of_it);
    } else if (plane.dimension == 3 && !map.shines_at(map.azimuth_deg(i))) {
      found = silence(plane);
    } else {
      if (!known) alike = run_one(plane, of_it);
      known = true;
      found = alike;
    }
    append_plane(result.field, std::move(found.field));
    append_plane(result.arrivals, std::move(found.arrivals));
    append_plane(result.rays, std::move(found.rays));
    append_plane(result.beam_errors, std::move(found.beam_errors));
    result.beams = std::max(result.beams, found.beams);
    result.waves = result.waves || found.waves;
    result.beam_error_db = std::max(result.beam_error_db, found.beam_error_db);
    result.beam_error_bounded = result.beam_error_bounded && found.beam_error_bounded;
    notes.add(found.notes);
  }
  // errors of some planes alone tell nothing of the others
  if (result.beam_errors.size() != result.field.size()) result.beam_errors.clear();
  result.notes = notes.told(planes);
  return result;
}

}  // namespace asdic::detail::bellhop
