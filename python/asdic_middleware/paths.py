"""Sound paths on request, in iBellhop's place: `asdic arrivals` and `asdic rays` as child
processes.
"""
import json
import subprocess

TIME_LIMIT = 300          # [s]
LARGEST_ANSWER = 8 << 20  # bytes of JSON


class PathsError(Exception):
    """What the program said."""


def settings_in(arguments):
    """The `--set KEY=VALUE` among a server's arguments: its sea is the request's, too."""
    words = []
    for k, word in enumerate(arguments):
        if word == "--set" and k + 1 < len(arguments):
            words.append("--set=" + arguments[k + 1])
        elif word.startswith("--set="):
            words.append(word)
    return words


def words_of(asked, scenario, own_depth=None, arguments=()):
    """The command's words. Numbers were checked, so no word of a request can be an option."""
    words = [asked["output"], str(scenario), "--json", *settings_in(arguments)]
    options = {"arrivals": ("frequency", "receiver_depth", "range", "bearing_deg", "source_depth"),
               "rays": ("from_deg", "to_deg", "count", "range", "bearing_deg", "source_depth")}
    spelt = {"bearing_deg": "bearing", "from_deg": "from", "to_deg": "to"}
    values = dict(asked)
    if own_depth is not None:
        values.setdefault("source_depth", own_depth)
    for name in options[asked["output"]]:
        if name in values:
            value = int(values[name]) if name == "count" else values[name]
            words.append(f"--{spelt.get(name, name).replace('_', '-')}={value!r}")
    if "sound_speed" in asked:
        columns = ",".join(f"{k}={json.dumps(v)}" for k, v in asked["sound_speed"].items())
        words.append('--set=environment.sound_speed={kind="table",' + columns + "}")
    if "bottom_depth" in asked:
        words.append(f"--set=environment.bottom.depth={asked['bottom_depth']!r}")
    return words


def answer(program, asked, scenario, own_depth=None, arguments=()):
    """arguments: of the server. → dict: what the program prints as JSON (docs/formats/arrivals.md,
    rays.md), and `id`. \\throws PathsError
    """
    try:
        done = subprocess.run([program, *words_of(asked, scenario, own_depth, arguments)],
                              capture_output=True, text=True, timeout=TIME_LIMIT,
                              stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise PathsError(f"not done after {TIME_LIMIT} s") from None
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise PathsError(said[-1][:300])
    if len(done.stdout) > LARGEST_ANSWER:
        raise PathsError(f"found {len(done.stdout)} bytes of an answer, expected at most "
                         f"{LARGEST_ANSWER}: ask for fewer rays")
    found = json.loads(done.stdout)
    found.pop("scenario", None)  # a path of this machine
    told = [line.partition("warning: ")[2] for line in done.stderr.splitlines()
            if "warning: " in line]
    if told:
        found["warnings"] = found.get("warnings", []) + told
    return {"ok": True, **({"id": asked["id"]} if "id" in asked else {}), **found}
