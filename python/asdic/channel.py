"""The time-varying impulse response from a transmitter to the phones of an array."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _core, datasets, described
from .told import tell

if TYPE_CHECKING:
    import xarray as xr


def _real(signal) -> np.ndarray:
    """[n] pressure. Raises InputError for what is none."""
    values = np.asarray(signal)
    if np.iscomplexobj(values):
        raise described.made("signal", "complex numbers", "real pressure: of complex baseband b about "
                             "a carrier f that is (b * np.exp(2j*np.pi*f*t)).real")
    if values.ndim != 1:
        raise described.made("signal", f"an array of shape {values.shape}", "one of shape (n,)")
    values = described.numbers("signal", signal, "Pa")
    if not np.isfinite(values).all():
        raise described.made("signal", f"{values[~np.isfinite(values)][0]} at sample "
                             f"{int(np.argmin(np.isfinite(values)))}", "finite numbers [Pa]")
    return values


class Channel:
    """What sound goes through on its way to each phone; :meth:`Scenario.channel` makes one.

    Attributes
    ----------
    paths : xarray.Dataset
        ``delay`` [s], complex ``amplitude`` re 1 m, ``doppler_factor``, angles and ``path_length``,
        each (phone, path, time), NaN where there is no such path; bounces and turns (phone, path).
        ``time``: when sound leaves, from 0 [s].
    warnings : list of str
        What to know before trusting it.

    Called with a signal it says what the phones receive: :meth:`__call__`.
    """

    def __init__(self, scenario, asked: tuple):
        self._scenario, self._asked = scenario.copy(), asked
        self._core = _core.channel(self._scenario._core, *asked)
        shown = self._core.shown
        self.warnings = shown["warnings"]
        self.frequency = shown["frequency"]  #: of the amplitudes [Hz]
        xr = datasets.xarray()
        units = {"delay": "s", "path_length": "m"}
        variables = {}
        for name, values in shown.items():
            if isinstance(values, np.ndarray):
                dims = ("phone", "path", "time")[:values.ndim]
                if name.endswith("bearing_deg"):
                    values = values % 360.0  # true bearings as files tell them
                unit = units.get(name, "degrees" if name.endswith("_deg") else "1")
                variables[name] = (dims, values, {"units": unit})
        variables["delay"][2]["long_name"] = "from leaving to being received"
        self.paths = xr.Dataset(variables, coords={"time": ("time", shown["time"], {"units": "s"})},
                                attrs={"frequency_hz": self.frequency, "sent": shown["sent"],
                                       "warnings": self.warnings})

    def __call__(self, signal, sample_rate: float, start: float | None = None,
                 samples: int | None = None) -> xr.DataArray:
        """What the phones receive of a signal.

        Parameters
        ----------
        signal : array, [n]
            Pressure at 1 m from the channel's time 0 on [Pa].
        sample_rate : float
            [Hz]
        start, samples : optional
            Of the answer: its first sample's time after time 0 [s], rounded to a whole sample, and
            how many; without them all that is received.

        Returns
        -------
        xarray.DataArray
            Pressure [Pa], float32, (phone, time), time after the channel's time 0 [s].

        Raises InputError for a signal that is longer than the channel. Warns where absorption within
        the signal's band differs by more than 1 dB from that of the channel's frequency.
        """
        sample_rate = described.number("sample_rate", sample_rate, "Hz")
        pressure, first, told = _core.through(self._scenario._core, self._core, _real(signal),
                                              sample_rate)
        tell(told)
        begin = int(round(first * sample_rate))
        if start is not None or samples is not None:
            wanted = begin if start is None else int(round(start * sample_rate))
            count = begin + pressure.shape[1] - wanted if samples is None else int(samples)
            cut = np.zeros((pressure.shape[0], max(0, count)), np.float32)
            low, high = max(wanted, begin), min(wanted + count, begin + pressure.shape[1])
            if high > low:
                cut[:, low - wanted:high - wanted] = pressure[:, low - begin:high - begin]
            begin, pressure = wanted, cut
        time = (begin + np.arange(pressure.shape[1])) / sample_rate
        return datasets.xarray().DataArray(
            pressure, dims=("phone", "time"), name="pressure",
            coords={"time": ("time", time, {"units": "s"})},
            attrs={"units": "Pa", "sample_rate_hz": float(sample_rate)})

    def __reduce__(self):
        return Channel, (self._scenario, self._asked)

    def __repr__(self) -> str:
        sizes = self.paths.sizes
        return (f"<asdic.Channel: {sizes['phone']} phones, {sizes['path']} paths, "
                f"{float(self.paths.time[-1]):g} s at {self.frequency:g} Hz>")
