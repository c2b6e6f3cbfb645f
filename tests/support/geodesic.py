"""Distances and bearings on the ellipsoid of WGS 84, without a projection: what latitudes and longitudes are held
against. Vincenty's inverse formula (Survey Review 23, 88, 1975)."""
import numpy as np

EQUATOR, FLATTENING = 6378137.0, 1 / 298.257223563
SQUARE = FLATTENING * (2 - FLATTENING)  # of the eccentricity


def radii(lat):
    """How far a radian of latitude, and one of longitude, go at a latitude [°]: [m]."""
    w = 1 - SQUARE * np.sin(np.radians(lat)) ** 2
    return EQUATOR * (1 - SQUARE) / w ** 1.5, EQUATOR / np.sqrt(w) * np.cos(np.radians(lat))


def inverse(lat1, lon1, lat2, lon2):
    """Distance [m] and bearing at the first place [rad] from one place [°] to others."""
    f, a = FLATTENING, EQUATOR
    b = a * (1 - f)
    u1 = np.arctan((1 - f) * np.tan(np.radians(lat1)))
    u2 = np.arctan((1 - f) * np.tan(np.radians(lat2)))
    s1, c1, s2, c2 = np.sin(u1), np.cos(u1), np.sin(u2), np.cos(u2)
    apart = turn = np.radians(np.subtract(lon2, lon1))
    for _ in range(20):
        sine = np.maximum(np.hypot(c2 * np.sin(turn), c1 * s2 - s1 * c2 * np.cos(turn)), 1e-300)
        cosine = s1 * s2 + c1 * c2 * np.cos(turn)
        sigma = np.arctan2(sine, cosine)
        across = c1 * c2 * np.sin(turn) / sine
        cos2 = 1 - across ** 2
        middle = cosine - 2 * s1 * s2 / np.maximum(cos2, 1e-300)
        c = f / 16 * cos2 * (4 + f * (4 - 3 * cos2))
        turn = apart + (1 - c) * f * across * (sigma + c * sine * (middle + c * cosine * (2 * middle ** 2 - 1)))
    k = cos2 * (a ** 2 - b ** 2) / b ** 2
    p = 1 + k / 16384 * (4096 + k * (-768 + k * (320 - 175 * k)))
    q = k / 1024 * (256 + k * (-128 + k * (74 - 47 * k)))
    more = q * sine * (middle + q / 4 * cosine * (2 * middle ** 2 - 1))
    return b * p * (sigma - more), np.arctan2(c2 * np.sin(turn), c1 * s2 - s1 * c2 * np.cos(turn))
