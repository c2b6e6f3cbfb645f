"""Reverberation over a slope: asdic's vertical planes against images in three dimensions."""
from pathlib import Path

import numpy as np
import suite

NAME = "Reverberation over a slope"
TRUTH = "energy of all 3-D images"
QUICK = False
TIMES, WIDTH, PINGS = np.array([0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0]), 0.2, 40
MANY = {"propagation__max_bottom_bounces": 12, "propagation__max_surface_bounces": 12}
LOSSY = {"environment__bottom__magnitude": [0.4, 0.4]}      # 8 dB a bounce: few are received
RETURNED = "what turns round up the slope and strikes the floor behind the sonar is left out, and so " \
           "is refraction out of planes that cut the slope obliquely"


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    sigma = suite.chance(truth.PULSE, PINGS, WIDTH)
    flat = truth.levels(TIMES, np.radians(0.001))
    checks, columns = [], []
    worst = round(0.5 + 3 * sigma, 2)
    average = round(0.3 + 3 * sigma / np.sqrt(len(TIMES)), 2)
    for label, bearing, gap in (("upslope", 0.0, RETURNED), ("downslope", 180.0, "")):
        def levels(bearing=bearing, **settings):
            return suite.window_levels(*suite.mean_square(asdic.ping(
                scenario, pings__count=PINGS, transmitter__bearing_deg=bearing, **settings)),
                TIMES, WIDTH)

        exact = truth.levels(TIMES, down=bearing > 0, width=WIDTH)
        received = levels(**MANY), levels()
        lossy = levels(**LOSSY) - truth.levels(TIMES, down=bearing > 0, width=WIDTH, kept=0.4**2)
        off, default = (h - exact for h in received)
        times = f"of {len(TIMES)} times"
        checks += [suite.Check(f"{label}, R = 0.4, worst {times}", float(max(lossy, key=abs)),
                               worst),
                   suite.Check(f"{label}, R = 0.4, mean {times}", float(lossy.mean()), average),
                   suite.Check(f"{label}, 12 bounces, worst {times}", float(max(off, key=abs)),
                               worst, gap=gap),
                   suite.Check(f"{label}, 12 bounces, mean {times}", float(off.mean()), average,
                               gap=gap),
                   suite.Check(f"{label}, default bounces, worst {times}",
                               float(max(default, key=abs)), worst, gap=gap)]
        columns.append((label, exact, received[0], received[1]))

    def draw(axes, style):
        axes.plot(TIMES, flat, ":", color=style.INK, lw=1.0, label="images, flat floor")
        for (label, exact, received, default), colour in zip(columns,
                                                             (style.VERMILION, style.BLUE)):
            axes.plot(TIMES, exact, color=colour, lw=2.0, alpha=0.6, label=f"images, {label}")
            axes.plot(TIMES, received, "o", color=colour, ms=4, label=f"asdic, {label}")
            axes.plot(TIMES, default, "x", color=colour, ms=4, label="default bounces")
        axes.set(xlabel="time after the start of transmission / s", ylabel="level / dB re 1 µPa²")
        axes.legend()

    rows = [[f"{t:g}", f"{flat[i]:.2f}", *(text for _, exact, received, default in columns for text in
             (f"{exact[i]:.2f}", f"{received[i] - exact[i]:+.2f}", f"{default[i] - exact[i]:+.2f}"))]
            for i, t in enumerate(TIMES)]
    return suite.Result(checks, ["t / s", "flat / dB", "upslope / dB", "12 bounces / dB",
                                 "default / dB", "downslope / dB", "12 bounces / dB",
                                 "default / dB"], rows, draw,
                        [f"Means over {WIDTH:g} s and {PINGS} pings, one standard error "
                         f"{sigma:.2f} dB; of asdic the differences are told. "
                         "The bounds are 0.5 dB, of the mean over times 0.3 dB, "
                         "and three of them."])
