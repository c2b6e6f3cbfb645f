#include "app/topics.h"

#include "app/console.h"
#include "app/shared_files.h"

namespace asdic::detail::app {
namespace {

std::string scenarios() { return told_place("scenarios"); }

/// \param pages  in docs/
std::string read_on(const std::vector<std::string>& pages) {
  std::string text = "Read on:";
  for (const std::string& page : pages)
    text += (&page == &pages.front() ? " " : ", ") + told_place("docs/" + page);
  return text;
}

std::vector<Topic> all_topics() {
  return {
      {"begin",
       "a first ping, its pictures and what is in its file",
       {"Take a scenario that comes with asdic. The first command checks it, the second makes the "
        "sound of every phone, the others show what came of it:",
        "  asdic validate " + scenarios() + "/deep_ocean.toml",
        "  asdic ping " + scenarios() + "/deep_ocean.toml -o ping.h5", "  asdic info ping.h5",
        "  asdic plot ping.h5 -o pictures",
        "Then copy the scenario and change it, or change one value for one run:",
        "  asdic ping " + scenarios() +
            "/deep_ocean.toml --set target.0.strength_db=20 -o louder.h5",
        read_on({"guide/first-ping.md"})}},
      {"scenario",
       "the file that says what the sea and the sonar are",
       {"A scenario is a TOML file: [environment] is the sea, [platform], [transmitter], [pulse] "
        "and [array] are the sonar, [[target]] what it may find, [noise] and [reverberation] what "
        "else is received, [pings] how often and how long. [run] asks for fields, arrivals or rays "
        "without a sonar.",
        "Scenarios to begin with are in " + scenarios() + ".",
        "asdic settings lists all keys with unit, range and default; asdic settings pulse one "
        "table; "
        "asdic settings --schema is for editors. asdic validate FILE says what was understood, and "
        "with --all every setting. --set KEY=VALUE replaces one value for one run:",
        "  asdic validate " + scenarios() + "/deep_ocean.toml --set environment.wind_speed=12",
        read_on({"guide/scenarios.md", "formats/scenario.md"})}},
      {"units",
       "metres, seconds, decibels and degrees",
       {"Files are in SI units: m, s, Hz, m/s. Names that end in _deg are degrees, those in _db "
        "decibels. --set takes other units as well: --set target.0.range=25km, --set "
        "pulse.frequency=3.5kHz. Lengths on the command line are 60km, 500m or plain metres.",
        "A position is [east, north, depth], with depth positive down. Bearings and headings are "
        "true: clockwise from north. What is relative says to what. An elevation is positive up.",
        "Pressure is in pascal. Levels are re 1 µPa, source levels re 1 µPa at 1 m. Transmission "
        "loss is re the pressure at 1 m.",
        read_on({"formats/conventions.md", "glossary.md"})}},
      {"study",
       "how often, how far, how well: Monte Carlo",
       {"A study file names a scenario, what varies and how it is drawn, and what is measured. "
        "asdic study makes its realisations, in an order that does not depend on threads or parts. "
        "It may be stopped at any time; the same command goes on.",
        "  asdic study " + scenarios() + "/studies/known_answer.toml -o detection.h5",
        "  asdic plot detection.h5 -o study-pictures",
        "On a cluster: --shard slurm and asdic merge, or mpirun asdic-mpi study.",
        read_on({"guide/studies.md", "guide/cluster.md"})}},
      {"files",
       "what is read and written, and what is never written over",
       {"Results are HDF5 files that describe themselves: xarray, h5py, MATLAB's h5read and ncdump "
        "read them. asdic info FILE says what is in one, asdic info FILE --check whether it is "
        "whole. asdic export makes WAV files, asdic convert BELLHOP's files.",
        "A result appears under its name when it is whole. An earlier result of asdic's is "
        "replaced; any other file needs --force. What a killed run left is in NAME.XXXX.part: see "
        "asdic recover --help.",
        read_on({"formats", "guide/commands.md"})}},
      {"python",
       "asdic in notebooks and programs of your own",
       {"import asdic does what the program does, with NumPy, pandas and xarray "
        "(Debian package: python3-asdic). Its scenario is an object:",
        "  python3 -c 'import asdic; print(asdic.Scenario(\"" + scenarios() +
            "/deep_ocean.toml\").arrivals())'",
        "Files are read without it, too: xarray.open_dataset(\"ping.h5\", engine=\"netcdf4\").",
        "In C++: find_package(asdic) and #include <asdic/asdic.h> (Debian package: libasdic-dev).",
        read_on({"guide/python.md", "guide/cpp.md"})}},
      {"pictures",
       "what asdic plot draws, and what it needs",
       {"asdic plot FILE draws what a file of asdic ping, process, study, field, arrivals or rays "
        "holds. It needs Python with three packages; Debian names them python3-numpy, python3-h5py "
        "and python3-matplotlib. They come with the package asdic, unless you have told apt to "
        "leave out what is recommended.",
        "ASDIC_PYTHON names another Python than /usr/bin/python3.",
        "  asdic plot ping.h5 -o pictures", read_on({"guide/pictures.md"})}},
      {"ocean",
       "the water and the sea floor of a real place",
       {"asdic ocean writes the [environment] of a place, a track or an area: out of files that "
        "you name (GEBCO, World Ocean Atlas, HYCOM, CMEMS, ERA5, Argo, CTD casts), or of Debian's "
        "package ferret-datasets. A scenario takes it by include = \"ocean.toml\".",
        "  asdic ocean --latitude 30.5 --longitude -60.5 --month 3 -o ocean.toml",
        read_on({"guide/real-ocean.md"})}},
      {"bellhop",
       "cases of BELLHOP, and what differs",
       {"asdic bellhop ROOT reads ROOT.env and its companions as they are, and writes ROOT.shd, "
        ".arr "
        "or .ray. By default it computes what is right; --like-bellhop gives BELLHOP's own "
        "numbers, "
        "and asdic explain says why the two differ. asdic convert makes a scenario of a case.",
        read_on({"guide/from-bellhop.md"})}},
      {"completion",
       "the Tab key, and manual pages",
       {"Packages install both. Without them, this shell completes asdic's words after one of:",
        "  source <(asdic help --completion bash)", "  source <(asdic help --completion zsh)",
        "  asdic help --completion fish | source",
        "asdic help --man ping is a manual page:", "  asdic help --man ping | man -l -"}},
  };
}

}  // namespace

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all = all_topics();
  return all;
}

std::string joined_topics() {
  std::string names;
  for (const Topic& topic : topics()) names += (names.empty() ? "" : ", ") + topic.name;
  return names;
}

std::string example_of_beginning() {
  return "Example:  asdic ping " + scenarios() +
         "/deep_ocean.toml -o ping.h5\n"
         "          asdic plot ping.h5 -o pictures";
}

std::string topic_text(const Topic& topic, std::size_t width) {
  std::string title = wrapped(topic.name + ": " + topic.brief, width, 2);
  title.pop_back();
  std::string text = emphasised(title) + '\n';
  bool typed = false;
  for (const std::string& paragraph : topic.paragraphs) {
    const bool to_type = paragraph.starts_with(' ');
    if (!(typed && to_type)) text += '\n';
    text += to_type ? wrapped(paragraph, width, 6, " \\") : wrapped(paragraph, width, 0);
    typed = to_type;
  }
  return text;
}

}  // namespace asdic::detail::app
