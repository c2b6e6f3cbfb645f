#!/usr/bin/env python3
"""The numbers behind the pictures: envelopes, spectra, and beams that point where sound comes from.

Plane waves with known directions (tests/support/plausible_ping.py) are injected.
"""
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

import make_ping_file as synthetic  # noqa: E402
from asdic_pictures import bearing_time, signal  # noqa: E402
from asdic_pictures.data import PingFile  # noqa: E402


class Signals(unittest.TestCase):
    def test_envelope_of_a_tone(self):
        """A tone of amplitude 3 in the flat part of the band has the envelope
        3·exp(i2π(f − carrier)t + iφ), but for what the record's cut ends leave half a second away:
        less than −60 dB in 25/width.
        """
        rate, n, start = 8000.0, 16000, 0.25
        t = start + np.arange(n) / rate
        b = signal.baseband([3.0 * np.cos(2 * np.pi * 1010.0 * t + 0.7)], rate, 1000.0, 50.0, start)
        expected = 3.0 * np.exp(1j * (2 * np.pi * (1010.0 - b.carrier) * b.times + 0.7))
        inside = np.abs(b.times - start - 1.0) < 0.5
        np.testing.assert_allclose(b.values[0][inside], expected[inside], atol=3e-3)

    def test_a_loud_start_does_not_wrap_round_into_the_end(self):
        """Half a second at 180 dB, begun and ended abruptly, then silence: eight seconds later the
        band holds nothing above 80 dB, neither by wrapping round nor by the filter's tails.
        """
        rate, n = 4000.0, 40001
        t = np.arange(n) / rate
        p = np.where(t < 0.5, np.sqrt(2.0) * 1e-6 * 10**9.0 * np.cos(2 * np.pi * 1000.0 * t), 0.0)
        for width in (12.0, 54.0, 400.0):
            with self.subTest(width=width):
                b = signal.baseband([p], rate, 1000.0, width)
                level = signal.decibels(0.5 * np.abs(b.values[0]) ** 2)
                self.assertAlmostEqual(level[b.times < 0.4].max(), 180.0, delta=1.5)
                self.assertLess(np.nanmax(level[b.times > 8.5]), 80.0)

    def test_a_loud_start_does_not_wrap_round_in_the_beams(self):
        """The same for a wide band and a long line."""
        rate, n = 4000.0, 20001
        t = np.arange(n) / rate
        loud = np.where(t < 0.25, 1e3 * np.cos(2 * np.pi * (800.0 * t + 800.0 * t * t)), 0.0)
        phones = np.arange(24)[:, None] * [0.0, 0.75, 0.0]
        b = signal.baseband([loud] * 24, rate, 1000.0, 480.0)
        looks = signal.scan(phones, beams=9).looks
        level = signal.decibels(signal.beam_power(b, phones, looks, 1500.0, b.edges(100)))
        self.assertLess(np.nanmax(level[:, 90:]), np.nanmax(level) - 90.0)

    def test_a_faint_sound_after_a_loud_one_has_its_level_and_bearing(self):
        """Plane waves from two sides: 200 dB for half a second, 20 s later 30 dB for a second.

        A beam is the mean of its phones' envelopes, each late by up to the line's length: it is
        never louder than the phones are about that time. On the faint one's bearing its level is
        that of the wave, but for half a beam's step: 0.5 % of the sine, 12 phones half a wavelength
        apart: below 0.01 dB.
        """
        rate, seconds, c, f0 = 4000.0, 30.0, 1500.0, 1000.0
        t = np.arange(int(rate * seconds)) / rate
        phones = np.arange(12)[:, None] * [0.0, 0.75, 0.0]

        def wave(level_db, sine, start, duration):
            late = t - start - phones[:, 1:2] * sine / c
            tone = np.sqrt(2.0) * 1e-6 * 10 ** (level_db / 20) * np.cos(2 * np.pi * f0 * late)
            return np.where((late > 0) & (late < duration), tone, 0.0)

        b = signal.baseband(wave(200.0, 0.5, 0.1, 0.5) + wave(30.0, -0.3, 20.0, 1.0), rate, f0, 60.0)
        where = signal.scan(phones)
        edges = b.edges(300)
        level = signal.decibels(signal.beam_power(b, phones, where.looks, c, edges))
        phone = signal.decibels(b.average(0.5 * np.abs(b.values) ** 2, edges)).max(axis=0)
        about = np.maximum.reduce([np.roll(phone, k) for k in (-1, 0, 1)])
        self.assertLess((level.max(axis=0) - about).max(), 0.5)
        within = (edges[:-1] > 20.2) & (edges[1:] < 20.8)
        received = level[:, within]
        np.testing.assert_allclose(received.max(axis=0), 30.0, atol=0.05)
        travel = np.array([[np.sqrt(1 - 0.09), -0.3, 0.0]])
        loudest = where.coordinate[received.argmax(axis=0)]
        np.testing.assert_allclose(loudest, signal.apparent(where, travel)[0], atol=0.006)

    def test_spectral_level_of_white_noise(self):
        """White noise of variance σ² has the one-sided density 2σ²/rate.

        8 phones × 60 s × 90 Hz hold 43 000 independent exponential values, so their mean is good
        to 5/√43 000 = 2.4 % at five sigma.
        """
        rng = np.random.default_rng(3)
        rate, sigma = 2000.0, 0.02
        b = signal.baseband(sigma * rng.standard_normal((8, int(60 * rate))), rate, 500.0, 100.0)
        _, f, density = signal.spectrogram(b, int(b.rate), 900)
        inside = np.abs(f - b.carrier) < 45.0
        self.assertAlmostEqual(density[inside].mean() / (2 * sigma**2 / rate), 1.0, delta=0.024)

    def test_averages_keep_the_mean(self):
        x = np.random.default_rng(1).random((3, 1000))
        np.testing.assert_allclose(signal.average(x, 50).mean(axis=1), x.mean(axis=1))
        np.testing.assert_allclose(signal.average(x, 5000), x)   # never more columns than samples

    def test_columns_have_exact_edges(self):
        """Sample k stands for [k, k + 1): a column that cuts it counts the part inside. Means over
        uneven columns, weighted by their widths, are the mean over all.
        """
        x = np.random.default_rng(2).random(733)
        edges = np.linspace(0.0, 733.0, 1001)
        means = signal.average_between(x, edges)
        self.assertAlmostEqual(float(means @ np.diff(edges)), float(x.sum()), places=9)
        np.testing.assert_allclose(signal.average_between(np.array([1.0, 3.0]), [0.5, 1.5, 2.0]),
                                   [2.0, 3.0])
        past = signal.average_between(x, [700.0, 733.0, 760.0, 800.0])
        self.assertTrue(np.isfinite(past[0]) and np.isnan(past[1:]).all())

    def test_level_of_a_tone(self):
        """A tone of amplitude √2·1 µPa·10^(80/20) has the level 80 dB re 1 µPa."""
        self.assertAlmostEqual(float(signal.decibels((1e-6 * 10**4.0) ** 2)), 80.0, places=9)


class Beamformer(unittest.TestCase):
    """A plane wave is injected; the beams must peak where it appears, within half a beamwidth, at
    its level.
    """

    SPEED, RATE, CARRIER = 1530.0, 10000.0, 4000.0

    def received(self, phones, elevation_deg, bearing_deg, bandwidth=0.0):
        """→ envelopes of a Hann pulse of rms 1 Pa at its peak that travels along the direction
        given
        """
        s = synthetic.Settings(sample_rate=self.RATE, frequency=self.CARRIER, pulse=0.2,
                               bandwidth=bandwidth)
        pressure = np.zeros((len(phones), int(0.6 * self.RATE)))
        travel = synthetic.travel_direction(elevation_deg, bearing_deg)
        synthetic.add_echo(pressure, phones - phones.mean(axis=0), s, 0.2, travel, 1.0, 120.0,
                           self.SPEED)
        return signal.baseband(pressure, self.RATE, self.CARRIER, 1.2 * bandwidth + 40.0), travel

    def check_peak(self, phones, elevation_deg, bearing_deg, half_width, bandwidth=0.0,
                   expected=None):
        b, travel = self.received(phones, elevation_deg, bearing_deg, bandwidth)
        where = signal.scan(phones, beams=361)
        power = signal.beam_power(b, phones, where.looks, self.SPEED,
                                  b.edges(b.values.shape[1]))
        beam, column = np.unravel_index(np.argmax(power), power.shape)
        truth = signal.apparent(where, travel)[0]
        if expected is not None:
            self.assertAlmostEqual(truth, expected, places=9)
        miss = where.coordinate[beam] - truth
        if where.kind == "azimuth":
            miss = (miss + 180.0) % 360.0 - 180.0
        self.assertLess(abs(miss), half_width)
        # Hann's peak is at the middle of the pulse, with the mean square 1 Pa²; beams stand 1/180
        # apart in sine,
        # at most 1/360 off the peak, a loss below 0.1 dB for 3 m at 4 kHz; 0.3 dB leaves room for
        # the band's edge.
        self.assertAlmostEqual(b.times[column], 0.3, delta=0.02)
        if where.kind != "azimuth":
            self.assertAlmostEqual(10 * np.log10(power[beam, column]), 0.0, delta=0.3)

    def line(self, heading_deg=None, count=16, spacing=0.1875):
        n = ((np.arange(count) - (count - 1) / 2) * spacing)[:, None]
        if heading_deg is None:
            # vertical, the first phone the deepest
            return n * [0.0, 0.0, -1.0] + [10.0, 20.0, 4500.0]
        h = np.radians(heading_deg)
        return n * [np.sin(h), np.cos(h), 0.0] + [10.0, 20.0, 4500.0]

    # Half of the −3 dB width of N phones in sine: 0.443·λ/(N·d).
    HALF = 0.443 * (SPEED / CARRIER) / (16 * 0.1875)

    def test_horizontal_line(self):
        """cos(app) = cos(β − s)·cos(el) of a source at bearing β, where s is the heading of the
        line towards its southern end: bearings of the eastern side rise with the axis.
        """
        for heading in (0.0, 37.0, 250.0):
            for az in (-60.0, -20.0, 0.0, 35.0, 75.0):
                for elevation in (0.0, -30.0):
                    with self.subTest(heading=heading, az=az, elevation=elevation):
                        look = heading + 90.0 + az
                        south = {0.0: 180.0, 37.0: 217.0, 250.0: 250.0}[heading]
                        expected = np.cos(np.radians(look - south)) * np.cos(np.radians(elevation))
                        self.check_peak(self.line(heading), elevation, look + 180.0, self.HALF,
                                        expected=expected)

    def test_vertical_line(self):
        """Sound that travels upwards comes from below: look elevation = −elevation of travel,
        whatever its bearing.
        """
        for elevation in (-50.0, -8.0, 0.0, 25.0):
            with self.subTest(elevation=elevation):
                self.check_peak(self.line(), elevation, 123.0, self.HALF,
                                expected=-np.sin(np.radians(elevation)))

    def test_order_of_the_phones_does_not_matter_to_a_vertical_line(self):
        self.check_peak(self.line()[::-1], -20.0, 10.0, self.HALF,
                        expected=np.sin(np.radians(20.0)))

    def test_array_in_space(self):
        rng = np.random.default_rng(5)
        phones = rng.uniform(-1, 1, (40, 3)) * [1.0, 1.0, 0.2] + [0.0, 0.0, 100.0]
        for look in (5.0, 130.0, 300.0):
            # aperture 2 m: half a beamwidth is about 0.443·λ/2 m = 4.9°
            with self.subTest(look=look):
                self.check_peak(phones, 0.0, look + 180.0, 4.9, expected=look)

    def test_wide_sweep_across_a_long_line(self):
        """100 phones, 600 Hz: the delay across the array is 12 ms, seven cells of resolution;
        steering the phase at the centre frequency alone would smear the end-fire beams. Sub-bands
        keep the level within 0.3 dB."""
        self.check_peak(self.line(0.0, 100), 0.0, 350.0 + 180.0, self.HALF * 0.16, bandwidth=600.0)

    def test_a_wrong_sign_would_be_found(self):
        """The mirror image of the true direction is far more than a beamwidth off and far below the
        peak.
        """
        phones = self.line(0.0)
        b, travel = self.received(phones, 0.0, 90.0 + 40.0 + 180.0)
        where = signal.scan(phones, beams=361)
        power = signal.beam_power(b, phones, where.looks, self.SPEED, b.edges(100)).max(axis=1)
        truth = signal.apparent(where, travel)[0]
        there = power[np.argmin(np.abs(where.coordinate - truth))]
        mirror = power[np.argmin(np.abs(where.coordinate + truth))]
        self.assertGreater(10 * np.log10(there / mirror), 10.0)

    def test_record_of_a_whole_file(self):
        """From the file to the picture's numbers: the loudest cell lies at the true echo, within
        half a beamwidth of its direction.
        """
        settings = synthetic.Settings(
            duration=6.0, sample_rate=2500.0, frequency=1000.0, pulse=0.25, phones=16, spacing=0.75,
            heading=20.0, depth=500.0, water=1200.0, targets=[(3000.0, 65.0, 60.0)], strength=30.0,
            reverberation=False, noise_level=20.0)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "ping.h5"
            synthetic.write(path, settings)
            with PingFile(path) as data:
                where, edges, db = bearing_time.record(data, 0)
                echo = data.echoes(0)[0]
        beam, column = np.unravel_index(np.nanargmax(db), db.shape)
        time = 0.5 * (edges[column] + edges[column + 1])
        strong = echo.level_db > echo.level_db.max() - 6.0
        truth = signal.apparent(where, echo.direction[strong])
        self.assertLess(np.min(np.abs(where.coordinate[beam] - truth)), 0.443 * 1.5 / (16 * 0.75))
        self.assertTrue(np.any((time >= echo.delay[strong]) & (time <= echo.delay[strong] + 0.25)))


if __name__ == "__main__":
    unittest.main(verbosity=1)
