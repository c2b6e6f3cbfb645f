#!/usr/bin/env python3
"""The page of `asdic plot --html` in headless Chromium: it loads without a complaint and without a
network, draws, tells the file's values, zooms, links, is dark where that is wished.

    ASDIC=build/ci/bin/asdic page_in_browser.py [FOLDER for screenshots]

Needs Debian's chromium, chromium-driver and python3-selenium. ASDIC_DEEP=1 runs all cases.
"""
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

if not shutil.which("chromium") or not shutil.which("chromedriver"):
    print("no chromium or chromedriver here (Debian: chromium chromium-driver python3-selenium)")
    sys.exit(77)

import numpy as np  # noqa: E402
from selenium import webdriver  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]

from asdic_pictures import bearing_time, levels, processed  # noqa: E402
from asdic_pictures.data import PingFile  # noqa: E402
from deep import in_depth  # noqa: E402

ASDIC = os.environ["ASDIC"]
FLAGS = ("--headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
         "--disable-background-networking --disable-component-update --disable-sync").split()
SHOTS = Path(sys.argv.pop()) if len(sys.argv) > 1 and os.path.isdir(sys.argv[-1]) else None
SCENARIOS = ROOT / "scenarios"
PANEL = "const p = panels.find((q) => q.shown && q.name === arguments[0]);"


def asdic(*words, cwd):
    subprocess.run([ASDIC, *map(str, words)], cwd=cwd, check=True, capture_output=True)


class Browser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="asdic_browser_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium") or "/usr/bin/chromium"
        for flag in [*FLAGS, f"--user-data-dir={cls.folder / 'browser'}",
                     "--window-size=1500,1200"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        driver = shutil.which("chromedriver") or "/usr/bin/chromedriver"
        cls.browser = webdriver.Chrome(options=options, service=Service(driver))
        cls.addClassCleanup(cls.browser.quit)
        cls.make("deep", SCENARIOS / "deep_ocean.toml")

    @classmethod
    def make(cls, name, scenario, *settings, process=True):
        if (cls.folder / f"{name}.html").exists():
            return
        asdic("ping", scenario, "-o", f"{name}.h5", "-q", *settings, cwd=cls.folder)
        if process:
            asdic("process", f"{name}.h5", "-q", cwd=cls.folder)
        asdic("plot", f"{name}.h5", "--html", cwd=cls.folder)

    # ------------------------------------------------------------ helpers

    def open(self, name, wide=1500, high=1200, dark=False):
        cdp = self.browser.execute_cdp_cmd
        cdp("Emulation.setDeviceMetricsOverride",
            {"width": wide, "height": high, "deviceScaleFactor": 1, "mobile": False})
        cdp("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)                      # what other pages left
        self.browser.get(f"file://{self.folder / name}.html")
        self.drawn_by_now()

    def drawn_by_now(self):
        self.browser.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done))")

    def js(self, code, *arguments):
        return self.browser.execute_script(code, *arguments)

    def shot(self, name):
        if SHOTS:
            whole = self.browser.execute_cdp_cmd("Page.captureScreenshot",
                                                 {"captureBeyondViewport": True, "format": "png"})
            (SHOTS / f"{name}.png").write_bytes(base64.b64decode(whole["data"]))

    def complaints(self):
        return [entry["message"] for entry in self.browser.get_log("browser")]

    def requests(self):
        """Addresses that were asked for."""
        asked = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                asked.append(message["params"]["request"]["url"])
        return asked

    def panel(self, name):
        """Its stage, in view."""
        stage = self.js(PANEL + " p.stage.scrollIntoView({block: 'center'}); return p.stage", name)
        self.drawn_by_now()
        return stage

    def of(self, name, what):
        """A JavaScript expression of the panel p."""
        return self.js(f"{PANEL} return {what}", name)

    def move(self, name, x, y):
        """The pointer to data coordinates of a panel. → what is told there"""
        stage = self.panel(name)
        px, py = self.of(name, f"[p.px({x}), p.py({y})]")
        size = stage.size
        ActionChains(self.browser, duration=10).move_to_element_with_offset(
            stage, round(px - size["width"] / 2), round(py - size["height"] / 2)).perform()
        return self.told()

    def told(self):
        tip = self.browser.find_element(By.ID, "tip")
        return [] if not tip.is_displayed() else tip.text.splitlines()

    def pixels(self, name):
        """[row, column, 4] of a panel's drawing"""
        wide, high, text = self.js(PANEL + """
            const {width, height} = p.base;
            const d = p.base.getContext("2d").getImageData(0, 0, width, height).data;
            let s = "";
            for (let i = 0; i < d.length; i += 32768)
              s += String.fromCharCode(...d.subarray(i, i + 32768));
            return [width, height, btoa(s)];""", name)
        return np.frombuffer(base64.b64decode(text), np.uint8).reshape(high, wide, 4)

    def key(self, *keys):
        ActionChains(self.browser, duration=10).send_keys(*keys).perform()

    # ------------------------------------------------------------ tests

    def test_loads_quietly_and_alone(self):
        self.open("deep")
        self.assertEqual(self.complaints(), [])
        asked = [url for url in self.requests() if not url.startswith("data:")]
        self.assertEqual(asked, [f"file://{self.folder}/deep.html"])
        self.assertLess((self.folder / "deep.html").stat().st_size, 5e6)
        self.shot("deep_light")

    def test_draws_every_panel(self):
        self.open("deep")
        names = self.js("return panels.filter((p) => p.shown).map((p) => p.name)")
        self.assertEqual(names, ["Rays", "Range and bearing", "Bearing–time", "Detections",
                                 "Doppler–time", "Spectrogram", "Levels"])
        for name in names:
            image = self.pixels(name)
            colours = np.unique(image.reshape(-1, 4) // 8, axis=0)
            self.assertGreater(len(colours), 20, name)
            left, top, wide, high = self.of(name, "[p.box.x, p.box.y, p.box.w, p.box.h]")
            inside = image[int(top): int(top + high), int(left): int(left + wide), :3]
            self.assertGreater(inside.std(), 4.0, name)

    @in_depth("a page is loaded, drawn and linked")
    def test_no_peak_falls_between_pixels(self):
        """Drawn small, a panel still shows the colour of its largest value."""
        self.open("deep", wide=500)
        for name, cells in (("Doppler–time", "cellsOf(p.spec)"), ("Detections", "cellsOf(p.spec)"),
                            ("Range and bearing", "cellsOf(p.spec.sides[0])")):
            colour = self.js(PANEL + f"""
                const c = {cells};
                let most = 0;
                for (const n of c.values) if (n !== 65535 && n > most) most = n;
                const v = colourOf(c.low + most * c.step, p.spec.limits);
                return [v & 255, (v >> 8) & 255, (v >> 16) & 255];""", name)
            left, top, wide, high = self.of(name, "[p.box.x, p.box.y, p.box.w, p.box.h]")
            image = self.pixels(name)[int(top): int(top + high), int(left): int(left + wide), :3]
            self.assertTrue((image == np.array(colour, np.uint8)).all(axis=-1).any(), (name, colour))

    @in_depth("a page is loaded, drawn and linked")
    def test_tells_the_values_of_the_file(self):
        self.open("deep")
        with PingFile(self.folder / "deep.h5") as file:
            row = file.choose_ping(None)
            file.select_array(0)
            where, edges, db = bearing_time.record(file, row)
            m = processed.maps(file, row)
            curves = levels.curves(file, row)
        times = self.of("Bearing–time", "p.spec.x")
        for beam, column in ((120, 505), (30, 400), (90, 100)):
            said = self.move("Bearing–time", 0.5 * (edges[column] + edges[column + 1]),
                             where.coordinate[beam])
            found = self.js("return S.time")
            k = int((found - times["first"]) / times["step"])
            self.assertLess(abs(found - edges[column]), 0.2)
            near = db[max(beam - 1, 0): beam + 2, k]            # the pointer stands on whole pixels
            level = float(re.search(r"([−\d.]+) dB", said[2])[1].replace("−", "-"))
            self.assertLess(np.abs(near - level).min(), 0.06)
            self.assertEqual(said[0], f"{found:.3f} s")
            self.assertIn("true", said[1])
        strongest = np.unravel_index(np.nanargmax(m.doppler_db), m.doppler_db.shape)
        said = self.move("Doppler–time", m.time[strongest[1]],
                         4000.0 * (m.doppler[strongest[0]] - 1.0))
        peak = float(re.search(r"background: ([\d.]+) dB", said[2])[1])
        self.assertIn(round(peak, 1), np.round(m.doppler_db[strongest[0] - 2: strongest[0] + 3,
                                                           strongest[1] - 1: strongest[1] + 2], 1))
        self.assertIn("found: echo of target, 33.498 s, SNR 48.0 dB", "\n".join(said))
        said = self.move("Levels", 28.0, 65.0)
        at = self.js("return S.time")
        time, total = curves["measured"]
        expected = total[int(round((at - time[0]) / np.median(np.diff(time))))]
        self.assertIn(f"measured, all frequencies: {expected:.1f} dB re 1 µPa", said)

    @in_depth("a page is loaded, drawn and linked")
    def test_range_and_bearing_of_the_target(self):
        self.open("deep")
        said = "\n".join(self.move("Range and bearing", 25000 * np.sin(np.radians(70)),
                                   25000 * np.cos(np.radians(70))))
        for words in ("truth: target at 25.000 km, 70.0° true",
                      "range 24.948 km, bearing 70.0° true", "or 24.948 km, 290.0° true"):
            self.assertIn(words, said)
        with PingFile(self.folder / "deep.h5") as file:
            m = processed.maps(file, file.choose_ping(None))
        off, at = (float(re.search(words, said)[1])
                   for words in (r"range ([\d.]+) km", r"received at ([\d.]+) s"))
        self.assertAlmostEqual(np.interp(at, m.time, m.range) / 1e3, off, delta=0.15)
        self.assertAlmostEqual(self.js("return S.time"), at, 2)

    @in_depth("a page is loaded, drawn and linked")
    def test_wheel_drag_and_double_click(self):
        self.open("deep")
        stage = self.panel("Bearing–time")
        middle = self.of("Bearing–time", "[p.px(33.5), p.py(0.3)]")
        size = stage.size
        origin = [round(middle[0] - size["width"] / 2), round(middle[1] - size["height"] / 2)]
        ActionChains(self.browser).scroll_from_origin(
            ScrollOrigin.from_element(stage, *origin), 0, -300).perform()
        lo, hi = self.js("return [T.lo, T.hi]")
        self.assertLess(hi - lo, 45.0)
        self.assertTrue(lo < 33.5 < hi)
        # the point under the pointer stays, and every panel of time follows
        self.assertAlmostEqual(self.of("Bearing–time", "p.px(33.5)"), middle[0], delta=1.5)
        self.assertEqual(self.js("return panels.filter((p) => p.shown && p.x === T).length"), 5)
        shared = self.pixels("Levels")
        before = self.js("return [T.lo, T.hi]")
        a, b = self.of("Bearing–time", "[[p.px(30), p.py(0)], [p.px(36), p.py(0.6)]]")
        ActionChains(self.browser, duration=20).move_to_element_with_offset(
            stage, round(a[0] - size["width"] / 2), round(a[1] - size["height"] / 2)) \
            .click_and_hold().move_by_offset(round(b[0] - a[0]), round(b[1] - a[1])) \
            .release().perform()
        lo, hi = self.js("return [T.lo, T.hi]")
        self.assertNotEqual([lo, hi], before)
        self.assertAlmostEqual(lo, 30.0, delta=0.1)
        self.assertAlmostEqual(hi, 36.0, delta=0.1)
        self.assertAlmostEqual(self.of("Bearing–time", "Math.abs(p.y.hi - 0.6)"), 0.0, delta=0.02)
        self.assertFalse(np.array_equal(shared, self.pixels("Levels")))
        self.shot("deep_zoomed")
        ActionChains(self.browser).move_to_element_with_offset(stage, 0, 0).double_click().perform()
        self.assertEqual(self.js("return [T.lo, T.hi]"), self.js("return T.full"))

    def test_links_a_target(self):
        self.open("deep")
        before = {name: self.overlay(name)
                  for name in ("Rays", "Bearing–time", "Levels", "Range and bearing")}
        self.browser.find_element(By.CSS_SELECTOR, "#targets button").click()
        self.assertEqual(self.js("return S.target"), 0)
        chosen = [line.get_attribute("textContent") for line in
                  self.browser.find_elements(By.CSS_SELECTOR, "#scenario .chosen")]
        self.assertEqual(chosen[0], "[[target]]\n")
        self.assertIn("strength_db = 30.0\n", chosen)
        for name, was in before.items():
            self.assertNotEqual(was, self.overlay(name), name)
        # a click on its echo lets go of it
        x, y = self.of("Detections", "[p.spec.marks[0].x[0], p.spec.marks[0].y[0]]")
        self.move("Detections", x, y)
        ActionChains(self.browser).click().perform()
        self.assertIsNone(self.js("return S.target"))

    def overlay(self, name):
        return self.of(name, "p.over.toDataURL()")

    @in_depth("a page is loaded, drawn and linked")
    def test_links_a_time(self):
        self.open("deep")
        names = ("Rays", "Range and bearing", "Doppler–time", "Levels", "Spectrogram")
        before = {name: self.overlay(name) for name in names}
        self.move("Bearing–time", 28.0, 0.5)
        for name in names:
            self.assertNotEqual(before[name], self.overlay(name), name)
        ActionChains(self.browser).click().perform()
        held = self.js("return S.time")
        self.move("Levels", 10.0, 60.0)
        self.assertEqual(self.js("return S.time"), held)
        self.key(Keys.ESCAPE)
        self.assertIsNone(self.js("return S.time"))

    @in_depth("a page is loaded, drawn and linked")
    def test_keys_alone(self):
        self.open("deep")
        self.js("panels.find((p) => p.shown && p.name === 'Levels').stage.focus()")
        self.key(*[Keys.ARROW_RIGHT] * 5)
        self.assertAlmostEqual(self.js("return S.time"), 33.0, delta=0.5)
        self.assertTrue(self.told()[0].endswith(" s"))
        self.key("+", "+")
        lo, hi = self.js("return [T.lo, T.hi]")
        self.assertAlmostEqual(hi - lo, 60 * 0.49, delta=0.1)
        self.key("0")
        self.assertEqual(self.js("return [T.lo, T.hi]"), self.js("return T.full"))
        self.key("t")
        self.assertEqual(self.js("return S.target"), 0)
        self.key(Keys.ENTER)
        self.assertTrue(self.js("return S.pinned"))
        self.key(Keys.ESCAPE)
        self.assertEqual(self.js("return [S.target, S.pinned]"), [None, False])
        self.assertIn("Arrows", self.js("return document.activeElement.getAttribute('aria-label')"))

    @in_depth("a page is loaded, drawn and linked")
    def test_light_and_dark(self):
        def background():
            told = self.js("return getComputedStyle(document.body).backgroundColor")
            return [int(v) for v in re.findall(r"\d+", told)]
        self.open("deep")
        self.assertGreater(min(background()[:3]), 200)
        light = self.pixels("Levels")
        self.open("deep", dark=True)
        self.assertLess(max(background()[:3]), 60)
        self.assertGreater(np.abs(light.astype(int) - self.pixels("Levels")).mean(), 20)
        self.shot("deep_dark")
        self.browser.find_element(By.ID, "theme").click()
        self.assertGreater(min(background()[:3]), 200)
        self.browser.find_element(By.ID, "theme").click()
        self.assertLess(max(background()[:3]), 60)

    @in_depth("a page is loaded, drawn and linked")
    def test_narrow_and_wide(self):
        for wide in (380, 1000, 1500, 2200):
            self.open("deep", wide=wide, dark=wide == 380)
            beyond = self.js("return document.documentElement.scrollWidth - innerWidth")
            self.assertLessEqual(beyond, 0, wide)
            self.assertGreater(self.of("Bearing–time", "p.box.w"), 150)
            self.shot(f"deep_{wide}")

    @in_depth("a page is loaded, drawn and linked")
    def test_other_pings(self):
        """Each kind loads without a complaint, and shows what it has."""
        baseband = re.sub(r"(?m)^sample_rate.*$", 'samples = "baseband"',
                          (SCENARIOS / "deep_ocean.toml").read_text())
        (self.folder / "baseband.toml").write_text(baseband)
        cases = {"bistatic": (SCENARIOS / "bistatic.toml",),
                 "one": (SCENARIOS / "isovelocity.toml", "--set", "array.phones=1"),
                 "several": (SCENARIOS / "sweep.toml", "--pings", "6"),
                 "two_targets": (SCENARIOS / "two_targets.toml",),
                 "seamount": (SCENARIOS / "seamount_ping.toml",),
                 "baseband": (self.folder / "baseband.toml",)}
        for name, words in cases.items():
            with self.subTest(name):
                self.make(name, *words, process=name != "seamount")
                self.open(name, dark=name in ("bistatic", "several"))
                self.assertEqual(self.complaints(), [])
                self.assertEqual([u for u in self.requests() if not u.startswith("data:")],
                                 [f"file://{self.folder}/{name}.html"])
                self.assertLess((self.folder / f"{name}.html").stat().st_size, 6e6)
                self.assertGreaterEqual(self.js("return panels.filter((p) => p.shown).length"), 4)
                self.shot(name)
        self.open("several")
        self.assertEqual(self.js("return view().ping"), 1)
        self.move("Pings", 15.0, 4)
        ActionChains(self.browser).click().perform()
        self.assertEqual(self.js("return view().ping"), 4)
        self.key("[")
        self.assertEqual(self.js("return view().ping"), 3)
        self.assertEqual(self.browser.find_element(By.ID, "ping").get_attribute("value"), "3")
        self.assertEqual(self.complaints(), [])


if __name__ == "__main__":
    unittest.main()
