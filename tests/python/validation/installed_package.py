#!/usr/bin/env python3
"""The Python package as pip installs it: it works away from its sources, and its types hold.

The full form runs pip itself, which builds the library anew, and mypy.
"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from deep import in_depth  # noqa: E402

BUILD = Path(os.environ["ASDIC_BUILD"])
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)

FIRST = """
import asdic
from pathlib import Path
assert Path(asdic.__file__).is_relative_to({place!r}), asdic.__file__
s = asdic.Scenario(sound_speed=1500.0, bathymetry=200.0)
path = s.arrivals(range=2000.0, depth=60.0, source_depth=30.0, frequency=1000.0).iloc[0]
assert abs(path.delay - (2000.0 ** 2 + 30.0 ** 2) ** 0.5 / 1500.0) < 1e-9, path.delay
print("heard")
"""
CONFIG = "[mypy]\nignore_missing_imports = True\n"
USER = """
import asdic

s = asdic.Scenario("x.toml")
reveal_type(s.arrivals(range=1.0, depth=1.0, arrays=True).delay)
s.ping(number="one")
s.arrivals(range="far")
"""


class Installed(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.at = Path(self.folder.name)

    def run_it(self, *words, **more):
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True,
                              cwd=self.at, env={**environment, **more.pop("env", {})}, **more)
        return done.returncode, done.stdout + done.stderr

    def test_it_works_away_from_the_build(self):
        code, said = self.run_it("cmake", "--install", BUILD, "--component", "wheel", "--prefix",
                                 self.at)
        self.assertEqual(code, 0, said)
        package = self.at / "python/asdic"
        for file in (ROOT / "python/asdic").glob("*.py"):
            shutil.copy(file, package)
        code, said = self.run_it(sys.executable, "-c", FIRST.format(place=str(self.at)),
                                 env={"PYTHONPATH": str(self.at / "python")})
        self.assertEqual((code, said.strip()), (0, "heard"), said)

    @in_depth("the component that pip installs is installed and used")
    def test_pip(self):
        python = self.at / "venv/bin/python"
        self.assertEqual(self.run_it("/usr/bin/python3", "-m", "venv", "--system-site-packages",
                                     self.at / "venv")[0], 0)
        sources = self.at / "sources"
        subprocess.run(["git", "clone", "--quiet", "--shared", ROOT, sources], check=True)
        code, said = self.run_it(python, "-m", "pip", "install", "--no-build-isolation",
                                 "--no-index", sources, timeout=3600)
        self.assertEqual(code, 0, said[-2000:])
        code, said = self.run_it(python, "-c", FIRST.format(place=str(self.at)))
        self.assertEqual((code, said.strip()), (0, "heard"), said)

    @in_depth("the names of the stub are held against the extension (python_package.py)")
    def test_types(self):
        if not shutil.which("mypy"):
            self.skipTest("no mypy (Debian: mypy)")
        (self.at / "mypy.ini").write_text(CONFIG)
        # classes of pybind11's: of their own metaclass, and without a constructor that Python sees
        made = [f"asdic._core.{name}" for name in ("Arrivals", "Channel", "Ping", "Pinger", "Scenario")]
        (self.at / "allowed").write_text("".join(f"{name}\n{name}.__init__\n" for name in made))
        here = {"PYTHONPATH": str(BUILD / "python"), "MYPYPATH": str(BUILD / "python")}
        for words in (["mypy.stubtest", "asdic._core", "--mypy-config-file", "mypy.ini",
                       "--ignore-positional-only", "--allowlist", "allowed",
                       "--ignore-unused-allowlist"],
                      ["mypy", "--config-file", "mypy.ini", "-p", "asdic"]):
            code, said = self.run_it("/usr/bin/python3", "-m", *words, env=here)
            self.assertEqual(code, 0, said)
        (self.at / "user.py").write_text(USER)
        code, said = self.run_it("/usr/bin/python3", "-m", "mypy", "--config-file", "mypy.ini",
                                 "user.py", env=here)
        self.assertIn("floating", said)
        self.assertIn('"ping" of "Scenario" has incompatible type "str"', said)
        self.assertEqual(said.count("user.py:7: error"), 1, said)


if __name__ == "__main__":
    unittest.main(verbosity=1)
