#!/usr/bin/env python3
"""The folders include one another in one direction only, so do the rooms in them, and each borrowed library stays where it belongs.

core <- raytrace <- reverb <- sonar <- processing <- io <- study, serve <- app, library. library implements include/asdic, which includes
itself and the standard library alone. HDF5, netCDF, TOML and libsndfile in io/*.cpp; SQLite, muParser and MPI in
study/; Asio in serve/; FFTW in one file of sonar/; TBB in .cpp files; public headers show Eigen and the standard library only.
Parallel loops are raytrace/parallel/parallel.h's, which are left when the realisation they belong to is called off. What depends on the
instruction level (core/level_namespace.h) is included by sources that are compiled once a level (LEVELS in CMakeLists.txt) alone.
"""
import pathlib
import re
import sys

ORDER = ["core", "raytrace", "reverb", "sonar", "processing", "io", "study", "serve", "app", "library"]
PUBLIC = "asdic"  # include/asdic
ROOMS = {  # in the folders named here every file lies in a room, and a room includes itself and those before it
    "io": ["files", "isolated", "text", "hdf5", "wav", "mat", "settings", "climatology", "scenario", "bellhop", "compare", "ping", "result", "processing"],
    "study": ["expression", "sampling", "plan", "measures", "summary", "comparison", "reader", "placement", "pilot", "journal", "runs", "crew", "mpi"],
    "raytrace": ["math", "parallel", "ocean", "area", "cases", "layered", "tracing", "paths", "beams", "waves", "volume", "places", "bellhop_emulation", "runs", "warnings", ""],
    "reverb": ["scattering", "pairs", "fields", "power"],
    "sonar": ["signal", "noise_spectra", "scenario", "paths", "noise", "reverberation", "synthesis", "echoes", "warnings", "ping", "channel"],
}
ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)
HOMES = {  # header prefix -> (folders whose .cpp files may include it)
    "sqlite3": ["study"], "muParser": ["study"], "mpi.h": ["study"], "asio": ["serve"], "hdf5": ["io"], "netcdf": ["io"], "toml++": ["io"], "sndfile": ["io"], "openssl": ["io", "study"],
    "fftw3": ["sonar"], "tbb/": ["raytrace", "reverb", "sonar", "processing", "io", "study", "serve", "app"], "oneapi/tbb": ["raytrace", "reverb", "sonar", "processing", "io", "study", "serve", "app"],
    "Random123": ["core"], "nlohmann": ["io", "study", "serve", "app"], "CLI": ["app"], "fmt/": ["app"],
}


def faults():
    fftw_files = set()
    for folder in ORDER:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = path.relative_to(ROOT)
            for quote, header in INCLUDE.findall(path.read_text()):
                top = header.split("/")[0]
                if quote == '"' and top == PUBLIC and folder == "library":
                    continue
                if quote == '"':
                    if top not in ORDER:
                        yield f'{name}: "{header}" must be written from the top, as "folder/file.h"'
                    elif ORDER.index(top) > ORDER.index(folder):
                        yield f"{name}: includes {header}, but {folder} comes before {top}"
                    continue
                if header.endswith("tbb/parallel_for.h") and str(name) != "raytrace/parallel/parallel.cpp":
                    yield f"{name}: <{header}> belongs in raytrace/parallel/parallel.cpp; loops are in_parallel() of raytrace/parallel/parallel.h"
                if header.startswith("CLI/") and str(name) != "app/command.cpp":
                    yield f"{name}: <{header}> belongs in app/command.cpp, which alone takes seconds to compile"
                for prefix, homes in HOMES.items():
                    if header.startswith(prefix) and (folder not in homes or (path.suffix == ".h" and folder != "app")):
                        yield f"{name}: <{header}> belongs in .cpp files of {', '.join(homes)}"
                if header.startswith("fftw3"):
                    fftw_files.add(str(name))
    for path in sorted((ROOT / "include").rglob("*.h")):
        for quote, header in INCLUDE.findall(path.read_text()):
            inside = (ROOT / "include" / header).exists() and header.startswith(PUBLIC + "/")
            if (quote == '"') != inside or (quote == "<" and ("/" in header or "." in header)):
                yield f"{path.relative_to(ROOT)}: includes {header}; public headers include one another and the standard library alone"
    if len(fftw_files) > 1:
        yield f"FFTW belongs in one file, found in {', '.join(sorted(fftw_files))}"


def room_of(name):
    """(folder, number of the room) of a path in a folder with rooms; the number is None outside of all rooms. Room "": the folder's own files"""
    folder, *inner = name.split("/")
    if folder not in ROOMS:
        return None
    within = "/".join(inner[:-1])
    homes = [room for room in ROOMS[folder] if within == room or within.startswith(room + "/")]
    return folder, ROOMS[folder].index(max(homes, key=len)) if homes else None


def room_faults():
    """Rooms of one folder include one another in one direction only"""
    for folder, rooms in ROOMS.items():
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = str(path.relative_to(ROOT))
            here = room_of(name)
            if here[1] is None:
                yield f"{name}: lies in none of the rooms {', '.join(rooms)}"
                continue
            for quote, header in INCLUDE.findall(path.read_text()):
                there = room_of(header) if quote == '"' else None
                if there and there[0] == folder and there[1] is not None and there[1] > here[1]:
                    yield f"{name}: includes {header}, but {rooms[here[1]] or folder} comes before {rooms[there[1]] or folder}"


def level_faults():
    """Sources that include what depends on the instruction level, and are compiled for one level alone"""
    includes = {}
    for folder in ORDER:
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in (".h", ".cpp"):
                quoted = [header for quote, header in INCLUDE.findall(path.read_text()) if quote == '"']
                includes[str(path.relative_to(ROOT))] = quoted
    reached = {"core/level_namespace.h"}
    while grown := {name for name, headers in includes.items() if name not in reached and reached.intersection(headers)}:
        reached |= grown
    text = re.sub(r"#.*", "", (ROOT / "CMakeLists.txt").read_text())
    hot = [place for places in re.findall(r"\bLEVELS\b([^)]*)\)", text) for place in places.split()]
    for name in sorted(reached):
        if name.endswith(".cpp") and not any(name.startswith(place) for place in hot):
            yield f"{name}: depends on the instruction level, but is not among LEVELS in CMakeLists.txt"


if __name__ == "__main__":
    found = [*faults(), *room_faults(), *level_faults()]
    print("\n".join(found) or "include order: clean")
    sys.exit(bool(found))
