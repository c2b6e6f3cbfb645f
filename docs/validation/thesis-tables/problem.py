"""The thesis's tables: angles and times against quadrature and print, levels against the sonar
equation."""
from pathlib import Path

import h5py
import numpy as np
import suite

NAME = "The thesis's tables"
TRUTH = "Snell's law by quadrature; sonar equation"
QUICK = True
# SL, TS, range, printed RL (Table 5.1)
LEVELS = ((230.0, 30.0, 30000.0, 80.0), (230.0, 40.0, 30000.0, 90.0), (240.0, 40.0, 30000.0, 100.0))


def compare(asdic, truth):
    folder = Path(__file__).parent
    with h5py.File(asdic.run("arrivals", folder / "scenario.toml")) as f:
        a = {key: f["arrivals"][key][:] for key in ("range", "launch_elevation_deg", "delay",
                                                    "surface_bounces", "bottom_bounces")}
    rows, angle, time, printed_off = [], [], [], []
    for distance, printed in truth.PRINTED.items():
        for by_surface, thesis in zip((False, True), printed):
            exact, exact_time = truth.eigenray(distance, by_surface)
            mine = (np.abs(a["range"] - distance)
                    < 1) & (a["surface_bounces"] == by_surface) & (a["bottom_bounces"] == 0)
            k = np.flatnonzero(mine)[np.abs(a["launch_elevation_deg"][mine] - exact).argmin()]
            angle.append(a["launch_elevation_deg"][k] - exact)
            time.append((a["delay"][k] - exact_time) * 1e6)
            printed_off.append(a["launch_elevation_deg"][k] - thesis)
            rows.append([f"{distance / 1e3:.0f}", "surface" if by_surface else "direct",
                         f"{thesis:.0f}", f"{exact:.4f}", f"{a['launch_elevation_deg'][k]:.4f}",
                         f"{exact_time:.6f}", f"{a['delay'][k]:.6f}"])
    off, notes = [], []
    for source, strength, distance, printed in LEVELS:
        file = asdic.ping(folder / "levels.toml", transmitter__source_level_db=source,
                          target__0__strength_db=strength, target__0__range=distance)
        with h5py.File(file) as f:
            level = float(f["echoes"]["level_db"][0])
        exact = truth.echo_level(source, strength, distance)
        off.append(level - exact)
        notes.append(f"Table 5.1, SL {source:g}, TS {strength:g}: printed {printed:g}, "
                     f"exact {exact:.3f}, asdic {level:.3f} dB.")

    def draw(axes, style):
        r = np.linspace(4500.0, 23000.0, 60)
        for by_surface, colour, label in ((False, style.BLUE, "direct"),
                                          (True, style.GREEN, "by the surface")):
            axes.plot(r / 1e3, [truth.eigenray(x, by_surface)[0] for x in r], color=colour,
                      label=f"{label}, Snell's law")
            axes.plot([x / 1e3 for x in truth.PRINTED], [p[by_surface]
                                                         for p in truth.PRINTED.values()], "s",
                                                         mfc="white", color=colour,
                                                         label=f"{label}, printed")
        seen = (a["surface_bounces"]
                <= 1) & (a["bottom_bounces"] == 0) & (a["launch_elevation_deg"] > 0)
        axes.plot(a["range"][seen] / 1e3, a["launch_elevation_deg"][seen], "+",
                  color=style.VERMILION, ms=10, label="asdic")
        axes.set(xlabel="range / km", ylabel="launch elevation / °")
        axes.legend(fontsize=8)

    return suite.Result([suite.Check("launch angles, worst of 10 paths", float(max(angle, key=abs)),
                                     1e-4, "°"),
                         suite.Check("travel times, worst of 10 paths", float(max(time, key=abs)),
                                     1.0, "µs"),
                         suite.Check("angles against Table 5.6, printed in whole degrees",
                                     float(max(printed_off, key=abs)), 1.5, "°"),
                         suite.Check("levels against the sonar equation", float(max(off, key=abs)),
                                     0.01)],
                        ["range / km", "path", "printed / °", "exact / °", "asdic / °", "exact / s",
                         "asdic / s"], rows, draw, notes)
