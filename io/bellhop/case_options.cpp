// Part of case_parts.h: the head of an .env file, and its letters of options.
#include <cmath>

#include "core/utf8.h"
#include "io/bellhop/case_parts.h"

namespace asdic::detail::bellhop {
namespace {

std::string letter(std::size_t at) { return "letter " + std::to_string(at + 1); }

/// What is behind a boundary. \param at  of its letter, from 0
char boundary_letter(ListReader& env, const std::string& letters, std::size_t at) {
  if (std::string_view("VRAFG").find(letters[at]) > 4)
    env.fail(letter(at), shown(letters.substr(at, 1)),
             "V (vacuum), R (rigid), A (half space), F (table) or G (grain size)");
  return letters[at];
}

/// Whether a boundary has a file of its shape. \param what  that is called
bool has_shape(ListReader& env, const std::string& letters, std::size_t at,
               const std::string& what) {
  if (std::string_view("~*-_ ").find(letters[at]) > 4)
    env.fail(letter(at), shown(letters.substr(at, 1)), "~ or * (" + what + "), or -, _ or a blank");
  return letters[at] == '~' || letters[at] == '*';
}

void read_letters(CaseReading& reading, std::string letters) {
  ListReader& env = reading.env;
  CaseOptions& options = reading.options;
  letters.resize(std::max<std::size_t>(letters.size(), 6), ' ');

  options.profile = letters[0];
  if (std::string_view("NCPSQAH").find(options.profile) > 6)
    env.fail("letter 1", shown(letters.substr(0, 1)),
             "N (1/c^2 linear), C (c linear), P (PCHIP), S (spline), Q (range-dependent), A (Munk) "
             "or, over a map, H (hexahedral)");
  options.surface = boundary_letter(env, letters, 1);
  const auto unit = attenuation_unit(letters[2]);
  if (!unit)
    env.fail("letter 3", shown(letters.substr(2, 1)), "an attenuation unit: N, F, M, W, Q or L");
  options.unit = *unit;
  options.volume = letters[3];
  if (std::string_view(" TFB").find(options.volume) > 3)
    env.fail("letter 4", shown(letters.substr(3, 1)),
             "a blank, T (Thorp), F (Francois-Garrison) or B (biology)");
  options.altimetry = has_shape(env, letters, 4, "altimetry");
  if (letters[5] == 'B')
    env.fail("letter 6", "\"B\" (several frequencies)", "a blank or I (a single beam)");
  options.single_beam = letters[5] == 'I';
  if (letters[5] != ' ' && letters[5] != 'I')
    reading.note("top option 6, " + shown(letters.substr(5, 1)) + ", means nothing");
}

void read_francois_garrison(CaseReading& reading) {
  ListReader& env = reading.env;
  FrancoisGarrison law;
  env.begin("Francois-Garrison");
  law.temperature = env.need_real("temperature");
  law.salinity = env.need_real("salinity");
  if (law.salinity < 0.0) env.fail("salinity", shown(law.salinity), "at least 0 psu");
  law.ph = env.need_real("pH");
  law.depth = env.need_real("depth");
  env.end();
  if (law.temperature == 20.0)
    reading.note(
        "Francois-Garrison at exactly 20 degC: the lower branch is used, BELLHOP has the upper");
  reading.ocean().absorption = law;
  const double loss = absorption_db_per_km(law, reading.run_case().frequency);
  if (!(loss >= 0.0 && loss < 1e6))
    env.fail("", "an absorption of " + shown(loss) + " dB/km", "sea water");
}

void read_biology(CaseReading& reading) {
  ListReader& env = reading.env;
  env.begin("biological layers");
  const std::int64_t n = env.need_integer("number", 0, 1000);
  env.end();
  for (std::int64_t i = 0; i < n; ++i) {
    env.begin("biological layer " + std::to_string(i + 1));
    BiologicalLayer layer;
    layer.top = env.need_real("upper depth");
    layer.bottom = env.need_real("lower depth");
    if (layer.bottom < layer.top)
      env.fail("lower depth", shown(layer.bottom), "not above " + shown(layer.top));
    layer.resonance = env.need_real("resonance frequency");
    if (layer.resonance < 0.0)
      env.fail("resonance frequency", shown(layer.resonance), "at least 0 Hz");
    layer.quality = env.need_real("Q");
    if (!(layer.quality > 0.0)) env.fail("Q", shown(layer.quality), "a number above 0");
    layer.strength = env.need_real("strength");
    if (layer.strength < 0.0) env.fail("strength", shown(layer.strength), "at least 0 dB/km");
    env.end();
    reading.ocean().biology.push_back(layer);  // read_profile() takes them to its nodes
  }
}

}  // namespace

void read_head(CaseReading& reading) {
  ListReader& env = reading.env;
  PropagationCase& run_case = reading.run_case();

  env.begin("title");
  env.text(run_case.title, "");
  env.end();
  run_case.title = cut_to_bytes(run_case.title, 80);
  while (!run_case.title.empty() && run_case.title.back() == ' ') run_case.title.pop_back();

  env.begin("frequency");
  run_case.frequency = env.need_real("");
  if (!(run_case.frequency > 0.0 && run_case.frequency < 1e9))
    env.fail("", shown(run_case.frequency) + " Hz", "a frequency above 0 Hz");
  env.end();

  env.begin("number of media");
  if (const auto media = env.need_integer("", 0, 1000); media != 1)
    env.fail("", std::to_string(media), "1: rays know one medium");
  env.end();

  env.begin("top options");
  std::string letters;
  if (!env.text(letters, "")) env.fail("", "no value", "up to six letters in quotes");
  read_letters(reading, letters);
  env.end();

  if (reading.options.volume == 'T') reading.ocean().absorption = Thorp{};
  if (reading.options.volume == 'F') read_francois_garrison(reading);
  if (reading.options.volume == 'B') read_biology(reading);
  reading.volume_loss = absorption_db_per_km(reading.ocean().absorption, run_case.frequency) /
                        (1000.0 * db_per_neper);

  reading.ocean().surface.material = read_material(reading, reading.options.surface, true);
}

void read_bottom_options(CaseReading& reading) {
  ListReader& env = reading.env;
  CaseOptions& options = reading.options;
  env.begin("bottom options");
  std::string letters;
  if (!env.text(letters, "")) env.fail("", "no value", "up to two letters in quotes");
  letters.resize(std::max<std::size_t>(letters.size(), 2), ' ');
  options.bottom = boundary_letter(env, letters, 0);
  options.bathymetry = has_shape(env, letters, 1, "bathymetry");
  double roughness = 0.0;
  env.real(roughness, "roughness");
  if (roughness != 0.0)
    reading.note("the roughness of the bottom, " + shown(roughness) +
                 " m, changes nothing (BELLHOP reads and ignores it, too)");
  env.end();
  reading.ocean().bottom.material = read_material(reading, options.bottom, false);
}

}  // namespace asdic::detail::bellhop
