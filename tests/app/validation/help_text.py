#!/usr/bin/env python3
"""Help: bare asdic, asdic help and its subjects, wrapped at the terminal; exit statuses; manual pages without warnings,
with every option; completions that bash, zsh and fish read, and what bash offers."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import terminal  # noqa: E402

ASDIC = os.environ["ASDIC"]
BUILD = Path(os.environ["ASDIC_BUILD"])


def fail(text):
    raise SystemExit("FAILED: " + text)


def run(*words, program=ASDIC, status=0, **variables):
    environment = {k: v for k, v in os.environ.items() if k != "COLUMNS"} | variables
    done = subprocess.run([program, *words], capture_output=True, text=True, env=environment, stdin=subprocess.DEVNULL)
    if done.returncode != status:
        fail(f"asdic {' '.join(words)}: status {done.returncode}: {done.stderr}")
    return done.stdout if status == 0 else done.stderr


# What there is, said by bare asdic: each command in one line, and how to begin.
bare = run()
groups = re.findall(r"^(\S.*):\n((?:  \S.*\n)+)", bare, re.M)
commands = [line.split()[0] for heading, lines in groups for line in lines.splitlines()]
if len(commands) < 20 or len(set(commands)) != len(commands) or len(groups) < 5:
    fail(f"bare asdic names {commands}")
for command in commands:
    for scenario in re.findall(r"\S+/scenarios/\S+\.toml", run(command, "--help", COLUMNS="300")):
        if not Path(scenario).exists():
            fail(f"asdic {command} --help: no {scenario}")
complaint = run("nonsense", status=2)
known = complaint.split("expected one of ")[1].split(";")[0].split(", ")
if sorted(known) != sorted(commands):
    fail(f"bare asdic leaves out {set(known) ^ set(commands)}")
if run("--help") != bare or not run("help").startswith(bare):
    fail("asdic --help and asdic help begin as bare asdic")
beginning = re.search(r"asdic ping (\S+/deep_ocean.toml) -o ping.h5", bare)
if not beginning or not Path(beginning[1]).exists():
    fail("bare asdic says how to begin, with a scenario that is there")

# Subjects, each with a pointer to what is there.
subjects = re.findall(r"^  (\S+)  +\S", run("help").split("Subjects")[1], re.M)
for subject in ["scenario", "units", "study", "files", "python", "pictures"]:
    if subject not in subjects:
        fail(f"no subject {subject}")
for subject in subjects:
    text = run("help", subject, COLUMNS="1000")
    for pages in re.findall(r"^Read on: (.*)", text, re.M):
        for page in pages.split(", "):
            if not Path(page).exists():
                fail(f"asdic help {subject}: no {page}")
if not re.search("study: .*Usage: asdic study", run("help", "study"), re.S):
    fail("a subject that is a command tells of both")

# Exit statuses; a near word is proposed; a table of settings is known.
if 'did you mean "ping"?' not in run("help", "pong", status=2):
    fail("asdic help pong")
if "asdic settings pulse" not in run("help", "pulse", status=2):
    fail("asdic help pulse")
run("help", "ping", "field", status=2)
run("help", "--completion", "tcsh", status=2)
run("help", "--man", "nonsense", status=2)


# Wrapped: by COLUMNS, by the terminal, at 80 without one. A word alone may be longer (a path).
def too_wide(text, width):
    return [line for line in text.splitlines() if len(line) > width and len(line.split()) > 2]


texts = [[command, "--help"] for command in commands] + [["help", subject] for subject in subjects] + [[]]
for words in texts:
    for width in (80, 50):
        if wide := too_wide(run(*words, **({"COLUMNS": str(width)} if width != 80 else {})), width):
            fail(f"asdic {' '.join(words)}: wider than {width}: {wide[0]}")
for columns in (60, 100):
    status, seen = terminal.run([ASDIC, "ping", "--help"], columns)
    lines = seen[-1][1]
    if status != 0 or max(map(len, lines)) > columns or max(map(len, lines)) < columns - 15:
        fail(f"asdic ping --help on {columns} columns: {max(map(len, lines))} wide")

# Manual pages: man finds nothing to warn of, every option is there.
man = shutil.which("man")
if not man:
    print("no man here (Debian: man-db): manual pages not rendered")


def check_manual(name, text, options):
    if not man:
        return
    with tempfile.NamedTemporaryFile("w", suffix=".1") as page:
        page.write(text)
        page.flush()
        shown = subprocess.run([man, "--warnings", "-l", page.name], capture_output=True, text=True,
                               env=os.environ | {"MANWIDTH": "100", "MAN_KEEP_FORMATTING": "", "LC_ALL": "C.UTF-8"})
    if shown.returncode or shown.stderr:
        fail(f"man {name}: {shown.stderr}")
    for option in options:
        if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", shown.stdout):
            fail(f"man {name}: no {option} in\n{shown.stdout}")


def options_of(help_text):
    return re.findall(r"(?<![\w-])--?[a-zA-Z][a-z0-9-]*", "\n".join(
        line.split("  ")[1] for line in help_text.splitlines() if line.startswith("  -")))


check_manual("asdic", run("help", "--man"), [f"asdic-{command}" for command in commands])
for command in commands:
    options = options_of(run(command, "--help"))
    if len(options) < 2:
        fail(f"{command}: options {options}")
    check_manual(command, run("help", "--man", command), options)

# Completions: their shells read them. What bash offers is what is there.
for shell, check in [("bash", ["bash", "-n"]), ("zsh", ["zsh", "-n"]), ("fish", ["fish", "--no-execute"])]:
    with tempfile.NamedTemporaryFile("w", suffix="." + shell) as file:
        file.write(run("help", "--completion", shell))
        file.flush()
        if shutil.which(shell):
            done = subprocess.run([*check, file.name], capture_output=True, text=True)
            if done.returncode or done.stderr:
                fail(f"{shell}: {done.stderr}")
        else:
            print(f"no {shell} here: its completions not read")
if shutil.which("fish"):
    script = f"'{ASDIC}' help --completion fish | source; complete -C 'asdic pi'; complete -C 'asdic ping --outp'"
    done = subprocess.run(["fish", "--no-config", "-c", script], capture_output=True, text=True)
    if [line.split()[0] for line in done.stdout.splitlines()] != ["ping", "--output"]:
        fail(f"fish offers {done.stdout}")


def offered(folder, *words):
    """What bash offers when Tab is typed after these words."""
    script = ('source <("$1" help --completion bash); shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1));'
              'compopt() { :; }; _asdic; printf "%s\\n" "${COMPREPLY[@]}"')
    done = subprocess.run(["bash", "-c", script, "bash", ASDIC, "asdic", *words], capture_output=True, text=True, cwd=folder)
    if done.stderr:
        fail(f"completion of {words}: {done.stderr}")
    return done.stdout.split()


with tempfile.TemporaryDirectory() as folder:
    for name in ("sea.toml", "sea.h5"):
        (Path(folder) / name).touch()
    (Path(folder) / "more").mkdir()
    for words, expected in [(["pi"], ["ping"]), (["ping", "--ou"], ["--output"]), (["ping", "s"], ["sea.toml"]),
                            (["ping", "sea.toml", "-o", "se"], ["sea.toml", "sea.h5"]),
                            (["plot", "sea.h5", "-o", ""], ["more"]), (["ping", "--pings", ""], []),
                            (["arrivals", "sea.toml", "--leg", ""], ["target", "array"]),
                            (["settings", "pul"], ["pulse"]), (["help", "uni"], ["units"]),
                            (["help", "--completion", "z"], ["zsh"])]:
        if sorted(offered(folder, *words)) != sorted(expected):
            fail(f"bash offers {offered(folder, *words)} after {words}, expected {expected}")
    if sorted(word for word in offered(folder, "") if not word.startswith("-")) != sorted(commands):
        fail("bash offers all commands")
    for command in commands:
        if sorted(offered(folder, command, "-")) != sorted(options_of(run(command, "--help"))):
            fail(f"bash offers other options of {command} than there are")

# asdic-mpi: the same of its one command.
mpi = BUILD / "bin" / "asdic-mpi"
if mpi.exists():
    help_of_study = run("study", "--help", program=mpi)
    check_manual("asdic-mpi study", run("help", "--man", "study", program=mpi), options_of(help_of_study))
    if "complete -F _asdic_mpi asdic-mpi" not in run("help", "--completion", "bash", program=mpi):
        fail("completion of asdic-mpi")
    run(program=mpi, status=2)
print(f"{len(commands)} commands, {len(subjects)} subjects: help, manual pages, completions")
