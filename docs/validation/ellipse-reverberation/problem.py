"""Bistatic reverberation, asdic against an integral over the floor, by two scattering laws."""
from pathlib import Path

import numpy as np
import suite

NAME = "Bistatic ellipses"
TRUTH = "integral over the floor"
QUICK = True
TIMES, PINGS, WIDTH = np.array([0.65, 0.8, 1.0, 1.5, 2.0, 3.0, 4.0]), 60, 0.2


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    sigma = suite.chance(truth.PULSE, PINGS, WIDTH)
    bottom = '{kind="ellis-crowe", mu_db=-27.0, nu_db=-15.0, slope_deg=20.0, frozen=false}'
    checks, columns = [], []
    for label, law, settings in (("Lambert", truth.lambert, {}),
                                 ("Ellis–Crowe", truth.ellis_crowe,
                                  {"reverberation__bottom": bottom})):
        exact = truth.levels(TIMES, law, WIDTH)
        found = suite.window_levels(*suite.mean_square(asdic.ping(scenario, pings__count=PINGS,
            **settings)), TIMES, WIDTH)
        checks.append(suite.Check(f"{label}, worst of {len(TIMES)} times",
                                  float(max(found - exact, key=abs)), round(0.5 + 3 * sigma, 2)))
        checks.append(suite.Check(f"{label}, mean of {len(TIMES)} times",
                                  float(np.mean(found - exact)),
                                  round(0.2 + 3 * sigma / np.sqrt(len(TIMES)), 2)))
        columns.append((label, exact, found))

    def draw(axes, style):
        for (label, exact, found), colour in zip(columns, (style.BLUE, style.VERMILION)):
            axes.plot(TIMES, exact, color=colour, lw=1.6, label=f"{label}, integral")
            axes.plot(TIMES, found, "o", color=colour, mfc="white", label=f"{label}, asdic")
        axes.set(xlabel="time after the start of transmission / s", ylabel="level / dB re 1 µPa²")
        axes.legend()

    rows = [[label, f"{t:g}", f"{e:.2f}", f"{f:.2f}", f"{f - e:+.2f}"] for label, exact,
            found in columns for t, e, f in zip(TIMES, exact, found)]
    return suite.Result(checks, ["law", "t / s", "truth / dB", "asdic / dB", "difference / dB"],
                        rows, draw,
                        [f"Means over {WIDTH:g} s and {PINGS} pings: one standard error of a time is "
                         f"{sigma:.2f} dB; three of them are in the bounds, beside 0.5 and 0.2 dB."])
