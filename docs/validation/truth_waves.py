"""Wave theory for the truths: wavenumber integrals over horizontally stratified water. numpy and
scipy only.

Time dependence exp(−iωt); the source is exp(ikR)/R, so that in cylindrical coordinates

    p(r, z) = ∫₀^∞ g(k; z) J₀(kr) k dk,     g'' + (ω²/c²(z) − k²) g = −2 δ(z − z_s)
    (1)

(Jensen, Kuperman, Porter, Schmidt, Computational Ocean Acoustics, 2nd ed. (2011), chapters 2 and
4). J₀ is entire, and all poles of g lie on
or above the real axis, so the path may run below it, where nothing is singular.
"""
import numpy as np
from scipy.special import airye, jv

NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
FAR = 25.0   # |z| from which the asymptotic series of J₀ is exact to 1e-12


def bessel_j0(z):
    """J₀ of complex z, Re z ≥ 0: scipy near the origin, Hankel's series beyond (Abramowitz & Stegun
    9.2.5)."""
    z = np.asarray(z, complex)
    far = np.abs(z) > FAR
    w = np.where(far, z, FAR)
    p, q, term = np.ones_like(w), np.zeros_like(w), np.ones_like(w)
    for m in range(1, 13):
        term = term * -((2 * m - 1) ** 2) / (m * 8.0 * w)       # a_m(0)/w^m
        if m % 2:
            q = q + (-1) ** (m // 2) * term
        else:
            p = p + (-1) ** (m // 2) * term
    value = np.sqrt(2.0 / (np.pi * w)) * (p * np.cos(w - np.pi / 4) - q * np.sin(w - np.pi / 4))
    if not far.all():
        value[~far] = jv(0, z[~far])
    return value


def contour(k_low, k_high, longest):
    """Nodes and weights of a path below the real axis for ranges up to `longest`: Gauss–Legendre
    panels of 2π/longest, 3/longest below. It starts
    on the axis where k_low is 0, and is level otherwise (the integrand has to be tapered at both
    ends then). → k, dk, complex [n]"""
    panels = max(8, int(np.ceil((k_high - k_low) * longest / (2.0 * np.pi))))
    edges = np.linspace(k_low, k_high, panels + 1)
    half = 0.5 * (edges[1] - edges[0])
    s = (edges[:-1, None] + half * (1.0 + NODES)).ravel()
    w = np.tile(half * WEIGHTS, panels)
    below = 3.0 / longest
    if k_low > 0.0:
        return s - 1j * below, w.astype(complex)
    scale = 4.0 * half
    return s - 1j * below * (1.0 - np.exp(-s / scale)), w * (1.0 - 1j * below / scale
        * np.exp(-s / scale))


def taper(k, rise, fall):
    """1 in the middle, 0 at the ends: cosine ramps over rise = (from, to) and fall = (from, to), by
    Re k."""
    x = np.real(k)

    def ramp(a, b):
        return 0.5 - 0.5 * np.cos(np.pi * np.clip((x - a) / (b - a), 0.0, 1.0))
    return ramp(*rise) * (1.0 - ramp(*fall))


def integrate(green, k, dk, ranges, block=40):
    """(1) at ranges [n_r]: green [n_z, n_k] → pressure [n_z, n_r]"""
    kernel = green * (k * dk)
    out = [kernel @ bessel_j0(np.outer(k, ranges[i:i + block]))
           for i in range(0, len(ranges), block)]
    return np.concatenate(out, axis=1)


def vertical(k_medium, k):
    """√(k_m² − k²) of the wave that decays or leaves, for k on or below the axis (cut along Im γ =
    0)."""
    gamma = np.sqrt(np.asarray(k_medium**2 - k**2, complex))
    return np.where(gamma.imag < 0.0, -gamma, gamma)


def pekeris_green(k, omega, depth, source, receivers, water, bottom):
    """g of (1) for isovelocity water of `water` = (c, ρ) between a free surface and a fluid of
    `bottom` = (c, ρ, dB per wavelength). [n_z, n_k]

    The wavenumber in the bottom is k_b(1 + iδ), δ = a/(40π lg e)."""
    c1, rho1 = water
    c2, rho2, attenuation = bottom
    g1 = vertical(omega / c1 + 0j, k)
    g2 = vertical(omega / c2 * (1.0 + 1j * attenuation / (40.0 * np.pi * np.log10(np.e))), k)
    r = (rho2 * g1 - rho1 * g2) / (rho2 * g1 + rho1 * g2)
    out = []
    for z in np.atleast_1d(receivers):
        low, high = min(z, source), max(z, source)
        # u(low) = sin; v(high) leaves downwards with the bottom's echo; W = u v' − u' v
        v = np.exp(1j * g1 * (high - low)) + r * np.exp(1j * g1 * (2 * depth - high - low))
        u = 1.0 - np.exp(2j * g1 * low)
        out.append(1j / g1 * u * v / (1.0 + r * np.exp(2j * g1 * depth)))
    return np.array(out)


def linear_n2_green(k, omega, c0, slope, source, receivers):
    """g of (1) for a half-space below a free surface with 1/c² = (1 + slope·z)/c₀², slope > 0.
    [n_z, n_k]

    With ζ = (ω²slope/c₀²)^⅓ (z + (1 − k²c₀²/ω²)/slope) solutions are Airy functions of −ζ; Ai(−ζ
    e^{iα}) with α = 2π/3 goes down as exp(−iωt) asks.
    Scaled Airy functions (airye) keep their exponents apart, so that deep shadows do not
    overflow."""
    scale = ((omega / c0) ** 2 * slope) ** (1.0 / 3.0)
    turn = np.exp(2j * np.pi / 3.0)

    def zeta(z):
        return scale * (z + (1.0 - (k * c0 / omega) ** 2) / slope)

    def ai(x):      # → Ai·exp(+exponent), exponent
        return airye(x)[0], 2.0 / 3.0 * x * np.sqrt(x)

    out = []
    for z in np.atleast_1d(receivers):
        low, high = min(z, source), max(z, source)
        # u(low) = A(low)B(0) − A(0)B(low), A = Ai(−ζ), B = Ai(−ζ·turn) outgoing; g = −2 u v/W, W by
        # Wronskian of A and B
        a_low, ea_low = ai(-zeta(low))
        a_0, ea_0 = ai(-zeta(0.0) + 0j)
        b_low, eb_low = ai(-zeta(low) * turn)
        b_0, eb_0 = ai(-zeta(0.0) * turn)
        b_high, eb_high = ai(-zeta(high) * turn)
        # W{Ai(x), Ai(x e^{+2πi/3})} = e^{−iπ/6}/(2π) (A&S 10.4.12),
        # chain rule dx/dz = −scale
        wronskian = -scale * np.exp(-1j * np.pi / 6.0) / (2.0 * np.pi)
        first = a_low * b_high * np.exp(-ea_low - eb_high)
        second = a_0 * b_low * b_high / b_0 * np.exp(-ea_0 - eb_low - eb_high + eb_0)
        out.append(-2.0 * (first - second) / wronskian)
    return np.array(out)


def numerov_green(k, omega, speed, step, depth, source, receivers, absorb):
    """g of (1) under a free surface for any c(z): Numerov's fourth-order steps of `step`, all k at
    once. [n_z, n_k]

    `speed(z)` [m/s], down to `depth`; below it a layer of thickness `absorb` with c(depth) whose
    loss grows slowly, so that nothing returns. Source and
    receivers are moved to the nearest step. Shooting down from the surface and up from below is
    stable: it follows what grows."""
    n = int(round((depth + absorb) / step))
    z = np.arange(n + 1) * step
    fade = np.clip((z - depth) / absorb, 0.0, 1.0)
    q = (omega / speed(np.minimum(z, depth))) ** 2 * (1.0 + 0.1j * fade**3)
    h2 = step**2 / 12.0
    places = sorted({int(round(x / step)) for x in (source, *receivers)})

    def shoot(order, start, keep):
        """y'' = −(q − k²) y from two values on; kept at the indices of `keep`, with the last
        neighbour → {index: (y, y before)}"""
        y0, y1 = start
        f0, f1 = q[order[0]] - k**2, q[order[1]] - k**2
        found = {}
        for here, nxt in zip(order[1:-1], order[2:]):
            f2 = q[nxt] - k**2
            y2 = ((2.0 - 10.0 * h2 * f1) * y1 - (1.0 + h2 * f0) * y0) / (1.0 + h2 * f2)
            if here in keep:
                found[here] = (y1, y0, y2)
            y0, y1, f0, f1 = y1, y2, f1, f2
        return found

    zero = np.zeros_like(k)
    top = shoot(range(0, places[-1] + 3), (zero, zero + 1e-30), set(places))
    low = shoot(range(n, places[0] - 3, -1), (zero, zero + 1e-30), set(places))
    # Wronskian at the middle of a step, from Numerov's conserved form: (1 + h²f/12)y takes the
    # place of y
    m = places[0]
    f = {i: 1.0 + h2 * (q[i] - k**2) for i in (m, m + 1)}
    u0, u1 = top[m][0] * f[m], top[m][2] * f[m + 1]
    v0, v1 = low[m][0] * f[m], low[m][1] * f[m + 1]
    wronskian = (u0 * v1 - u1 * v0) / step
    s = int(round(source / step))
    out = []
    for x in receivers:
        i = int(round(x / step))
        out.append(-2.0 * top[min(i, s)][0] * low[max(i, s)][0] / wronskian)
    return np.array(out)


def windows(p, ranges, centres, half):
    """TL of the mean intensity within half of each centre [dB]: p [..., ranges] → [..., centres]"""
    return np.stack([-10 * np.log10((np.abs(p[..., np.abs(ranges - c) <= half]) ** 2).mean(axis=-1))
                     for c in centres], axis=-1)
