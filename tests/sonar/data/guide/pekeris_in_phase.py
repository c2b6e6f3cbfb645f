"""Bottom reverberation of a Pekeris guide, every pair of images in phase: writes pekeris_in_phase.csv (ten minutes).

100 m of water at 1500 m/s over a fluid bottom (1700 m/s, density ratio 2, 0.5 dB a wavelength), Lambert -27 dB, source at 30 m and
receiver at 50 m on one vertical, 220 dB, 1 kHz, a Hann window of 0.2 s. Numpy alone; no code of asdic.
"""
import numpy as np

DEPTH, SPEED, FREQUENCY, DURATION, STRENGTH, IMAGES = 100.0, 1500.0, 1000.0, 0.2, 10**-2.7, 60
OMEGA = 2.0 * np.pi * FREQUENCY


def reflection(sine):
    """Of the bottom, time dependence exp(+iwt)."""
    slowness_below = 1.0 / 1700.0 * (1.0 - 0.5j / (40.0 * np.pi * np.log10(np.e)))
    below = OMEGA * np.sqrt(slowness_below**2 - (1.0 - sine**2) / SPEED**2 + 0j)
    below = np.where(below.imag > 0.0, -below, below)
    above = OMEGA / SPEED * sine
    return (2.0 * above - below) / (2.0 * above + below)


def leg(depth, reach):
    """Delays and amplitudes of all images of a point at a depth; Lambert's root of sine with them."""
    n = np.repeat(np.arange(IMAGES), 2)
    side = np.tile([1.0, -1.0], IMAGES)
    height = (2 * n + 1) * DEPTH - side * depth
    length = np.hypot(reach, height)
    sine = height / length
    return length / SPEED, side * (-1.0) ** n * reflection(sine) ** n / length * np.sqrt(sine)


def level(time, step=0.5):
    moments = time - 0.5 + (np.arange(20) + 0.5) / 20
    in_phase = energies = 0.0
    for reach in np.arange(max(1.0, 0.4 * SPEED * (time - 1.1 - DURATION)), 0.5 * SPEED * (time + 0.5), step):
        (out, a), (back, b) = leg(30.0, reach), leg(50.0, reach)
        delay, pressure = (out[:, None] + back).ravel(), (a[:, None] * b).ravel()
        strong = (abs(pressure) ** 2 > 1e-9 * max(abs(pressure)) ** 2) & (abs(delay - time + DURATION / 2) < 0.5 + DURATION)
        since = moments[:, None] - delay[strong]
        window = np.where((since > 0) & (since < DURATION), 0.5 - 0.5 * np.cos(2 * np.pi * since / DURATION), 0.0)
        received = window * pressure[strong]
        in_phase += reach * np.mean(abs((received * np.exp(-1j * OMEGA * delay[strong])).sum(1)) ** 2)
        energies += reach * np.mean((abs(received) ** 2).sum(1))
    return [220.0 + 10.0 * np.log10(2.0 * np.pi * step * STRENGTH * x) for x in (in_phase, energies)]


if __name__ == "__main__":
    print("t_s,in_phase_dB,energies_dB")
    for t in (3, 4, 6, 8, 10, 14, 18):
        print(t, *(f"{x:.2f}" for x in level(float(t))), sep=",", flush=True)
