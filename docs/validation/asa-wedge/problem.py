"""The benchmark wedge: asdic's rays against a parabolic equation of all angles."""
from pathlib import Path

import numpy as np
import suite

NAME = "ASA wedge"
TRUTH = "parabolic equation"
QUICK = False
HIGHER = 100.0                          # a frequency where rays hold better [Hz]
CENTRES = np.arange(350.0, 3400.0, 500.0)
IN_WATER = 1000.0                       # of the receiver at 150 m [m]
STRIKES = "a ray reflects where it strikes, with the phase of a plane wave: near the critical " \
          "angle a beam is displaced; with `run.beams.displacement` it is"
MISSED = ["25 Hz, rays as they strike, median", "25 Hz, rays as they strike, mean",
          "100 Hz, rays as they strike, 95 %"]          # by STRIKES
FLOOR = "there is no field in the floor"


def windows(p, ranges, centres, half=250.0):
    return np.array([suite.db((np.abs(p[np.abs(ranges - c) <= half]) ** 2).mean())
                     for c in centres])


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    checks, rows, curves = [], [], []
    for frequency, most in ((25.0, 1.0), (HIGHER, 0.5)):
        exact = None
        for label, settings in (("rays as they strike", {}),
                                ("displaced", {"run__beams__displacement": "true"})):
            found = asdic.field(scenario, run__frequency=frequency, **settings)
            if exact is None:
                exact = truth.pressure(frequency, found.range, found.depth)
                curves.append((frequency, found.range, suite.loss(exact[0]), "truth"))
            curves.append((frequency, found.range, suite.loss(found.pressure[0]), label))
            shallow = suite.loss(found.pressure[0]) - suite.loss(exact[0])
            wet = CENTRES + 250.0 <= IN_WATER
            mean = [windows(found.pressure[0], found.range, CENTRES)
                    - windows(exact[0], found.range, CENTRES),
                    windows(found.pressure[1], found.range, CENTRES[wet])
                    - windows(exact[1], found.range, CENTRES[wet])]
            where = f"{frequency:g} Hz, {label}"
            errors = [("median at 30 m", float(np.median(np.abs(shallow))), 0.5),
                      (f"mean of 500 m, worst of {len(CENTRES) + wet.sum()} windows",
                       float(max(np.concatenate(mean), key=abs)), most)]
            if frequency == HIGHER:
                errors.append((f"95 % of {shallow.size} receivers at 30 m",
                               suite.percentile(shallow), 1.0))
            checks += [suite.Check(f"{where}, {what}", error, bound, gap=STRIKES if any(
                           f"{where}, {what}".startswith(m) for m in MISSED) else "")
                       for what, error, bound in errors]
            rows += [[f"{frequency:g}", label, "30" if k == 0 else "150", f"{c:.0f}", f"{e:+.2f}"]
                     for k in (0, 1) for c, e in zip(CENTRES if k == 0 else CENTRES[wet], mean[k])]
        if frequency == 25.0:
            below = [c for c in CENTRES if c - 250.0 >= IN_WATER]
            off = (windows(found.pressure[1], found.range, below)
                   - windows(exact[1], found.range, below))
            checks.append(suite.Check(f"25 Hz, 150 m, in the floor, of {len(below)} windows off by "
                                      "more than 3 dB", int((np.abs(off) > 3.0).sum()), 0,
                                      "windows", gap=FLOOR))

    def draw(axes, style):
        colours = {"truth": (style.INK, 2.2, "-"), "displaced": (style.BLUE, 1.0, "--"),
                   "rays as they strike": (style.VERMILION, 1.0, "--")}
        for frequency, at, tl, label in curves:
            if frequency == 25.0:
                colour, width, dashes = colours[label]
                axes.plot(at / 1e3, tl, dashes, color=colour, lw=width,
                          label="parabolic equation" if label == "truth" else f"asdic, {label}")
        axes.set(xlabel="range upslope / km", ylabel="transmission loss / dB", ylim=(75, 35))
        axes.legend(title="25 Hz, receiver at 30 m")

    return suite.Result(checks, ["frequency / Hz", "asdic", "depth / m", "about / m",
                                 "asdic − truth / dB"], rows, draw,
                        ["The truth over a flat floor agrees with the wavenumber integral to "
                         f"{truth.flat_check():.1g} dB in means over 500 m."])
