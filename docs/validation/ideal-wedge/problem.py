"""The ideal wedge: asdic's field and eigenrays against the images on their ring."""
from pathlib import Path

import h5py
import numpy as np
import suite

NAME = "Ideal wedge"
TRUTH = "120 images on a ring"
QUICK = False
PLACES, SPEED = [500.0, 1000.0, 1500.0, 2400.0], 1500.0      # of eigenrays [m], m/s


def eigenrays(file, truth):
    """Of a file of arrivals: how many images are missing, the worst delay [µs], and bounces, way
    [m] and excess of amplitude over 1/R [dB] of the paths at each place of the first depth"""
    with h5py.File(file) as f:
        rays, depths = f["arrivals"], f["depth"][:]
        at = [(i, j) for i in range(len(depths)) for j in range(len(PLACES))]
        missing, worst, found = 0, 0.0, []
        for i, j in at:
            here = (rays["depth_index"][:] == i) & (rays["range_index"][:] == j)
            way = np.sort(truth.ring([PLACES[j]], [depths[i]])[0].ravel())
            delay = rays["delay"][:][here]
            nearest = np.abs(delay[:, None] * SPEED - way).argmin(axis=1)
            missing += len(way) - len(np.unique(nearest))
            worst = max(worst, 1e6 * np.abs(delay - way[nearest] / SPEED).max())
            if i == 0:
                bounces = (rays["surface_bounces"][:] + rays["bottom_bounces"][:])[here]
                found.append((bounces, way[nearest],
                              2 * suite.db(rays["amplitude"][:][here] * way[nearest])))
    return missing, worst, found


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    line = asdic.field(scenario)
    exact = truth.line(line.range, line.depth)
    off = suite.loss(line.pressure) - suite.loss(exact)

    energies = asdic.field(scenario, run__source__kind='"point"', run__field='"incoherent"')
    wanted = suite.db(truth.intensity(energies.range, energies.depth))
    loud = -suite.loss(energies.pressure) - wanted
    missing, late, rays = eigenrays(asdic.run(
        "arrivals", scenario, "--set", 'run.source.kind="point"', "--set",
        f"run.receivers.range={PLACES}"), truth)
    excess = np.concatenate([x for _, _, x in rays])

    def draw(axes, style):
        axes.plot(line.range / 1e3, wanted[0], color=style.INK, lw=2.2,
                  label="images, point source")
        axes.plot(line.range / 1e3, -suite.loss(energies.pressure[0]), "--", color=style.VERMILION,
                  lw=1.0, label="asdic, point source")
        axes.plot(line.range / 1e3, suite.db((np.abs(exact[0]) ** 2)) - 90, color=style.INK, lw=1.2,
                  label="images, line source − 90 dB")
        axes.plot(line.range / 1e3, -suite.loss(line.pressure[0]) - 90, "--", color=style.BLUE,
                  lw=0.8, label="asdic, line source − 90 dB")
        axes.set(xlabel="range upslope / km", ylabel="level / dB", ylim=(-125, -25))
        axes.legend(ncols=2, fontsize=8, loc="center", bbox_to_anchor=(0.5, 0.62))

    rows = []
    for place, (bounces, way, over) in zip(PLACES, rays):
        for n in (0, 1, 4, 8, 16, 30, 53):
            k = np.flatnonzero(bounces == n)
            if len(k):
                rows.append([f"{place:.0f}", str(n), f"{way[k[0]]:.1f}", f"{over[k[0]]:+.3f}"])
    return suite.Result(
        [suite.Check(f"line source, 95 % of {off.size} receivers", suite.percentile(off), 0.05),
         suite.Check(f"eigenrays missing of {120 * 2 * len(PLACES)}", missing, 0, "rays"),
         suite.Check("eigenrays, worst delay", late, 1.0, "µs"),
         suite.Check("point source, worst amplitude of a path", float(max(excess, key=abs)), 0.05),
         suite.Check(f"point source, energy, worst of {loud.size} receivers",
                     float(max(loud.ravel(), key=abs)), 0.5)],
        ["range / m", "bounces", "way / m", "amplitude − 1/R / dB"], rows, draw)
