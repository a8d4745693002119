"""The body's master surface: one smooth skin of the whole outside, which cuts turn into panels.

Points are those of the control cage; the surface passes inside them. The half with x > 0 is built and
mirrored. Columns go round the car from the front's middle (F0) over the side (S) to the rear's middle (R0); rows go up
from the underside (L0) over the sill, the shoulder (L6) and the belt (L7) to the cant rail (G5). The bonnet and the
roof are patches of their own between these."""

import math
from functools import lru_cache

from mathutils import Vector

from authoring import Cage

# plan view of the widest row, (x, z)
PLAN = [(0.000, 2.080), (0.240, 2.070), (0.468, 2.030), (0.672, 1.920),                       # F0 F1 F2 F3
        (0.788, 1.735), (0.830, 1.530), (0.845, 1.280), (0.849, 1.020), (0.850, 0.780),       # S1 .. S5 (A pillar)
        (0.850, 0.420), (0.850, 0.020), (0.850, -0.440), (0.849, -0.900), (0.845, -1.280),    # S6 .. S10
        (0.834, -1.600), (0.800, -1.880),                                                     # S11 S12
        (0.685, -2.065), (0.480, -2.130), (0.250, -2.153), (0.000, -2.160)]                   # R3 R2 R1 R0
F3, S1, A, R3, R0 = 3, 4, 8, 16, 19

# rows of the lower body: heights at columns, half width, and the noses of front and rear in the middle
HEIGHT_COLUMNS = [0, 3, 4, 5, 6, 7, 8, 10, 12, 13, 15, 16, 19]
LOWER = [
    # heights at the columns above                                                       width  front  rear
    ([.205, .205, .200, .180, .165, .165, .165, .165, .165, .175, .200, .215, .220], 0.735, 1.990, -2.075),  # L0
    ([.240, .240, .230, .210, .195, .195, .195, .195, .195, .205, .235, .255, .260], 0.806, 2.052, -2.130),  # L1
    ([.330, .325, .315, .300, .285, .280, .280, .285, .290, .300, .330, .350, .360], 0.842, 2.084, -2.162),  # L2
    ([.445, .440, .435, .425, .415, .410, .410, .415, .420, .430, .450, .470, .480], 0.850, 2.090, -2.168),  # L3
    ([.570, .570, .565, .560, .560, .560, .565, .575, .590, .600, .615, .625, .630], 0.846, 2.070, -2.150),  # L4
    ([.680, .680, .685, .693, .703, .712, .718, .732, .748, .756, .768, .778, .782], 0.837, 2.058, -2.138),  # L5
    ([.765, .765, .775, .793, .814, .832, .844, .858, .870, .876, .885, .892, .897], 0.852, 2.032, -2.130),  # L6
    ([.815, .815, .828, .864, .902, .928, .945, .955, .964, .970, .979, .985, .987], 0.790, 1.965, -2.105),  # L7
]
FLARE = (0, 0.004, 0.010, 0.014, 0.014, 0.008, 0, 0)  # by row: how far the arches stand out
# rows of the greenhouse: side height and half width at the B pillar, the windscreen's middle (z, y), the A pillar
# (x, z, y), the rear's middle (z, y)
UPPER = [
    (1.080, 0.757, (0.852, 1.090), (0.712, 0.622, 1.062), (-2.082, 1.105)),  # G1
    (1.210, 0.716, (0.640, 1.213), (0.668, 0.432, 1.188), (-2.048, 1.238)),  # G2
    (1.330, 0.662, (0.425, 1.326), (0.617, 0.238, 1.308), (-2.004, 1.358)),  # G3
    (1.412, 0.607, (0.250, 1.408), (0.572, 0.080, 1.395), (-1.958, 1.432)),  # G4
    (1.458, 0.535, (0.110, 1.458), (0.510, -0.045, 1.442), (-1.885, 1.470)),  # G5
]
SCUTTLE = (1.020, 0.985)  # the windscreen's base in the middle, (z, y)
BONNET = [(1.965, 0.815), (1.810, 0.876), (1.610, 0.918), (1.400, 0.950), (1.200, 0.972), SCUTTLE]  # middle, (z, y)
ROOF = [(0.110, 1.458), (-0.080, 1.484), (-0.360, 1.500), (-0.680, 1.505), (-1.000, 1.500), (-1.310, 1.493),
        (-1.590, 1.484), (-1.770, 1.477), (-1.885, 1.470)]  # middle, (z, y)


def at(values, places, i):
    """A natural cubic spline through the values given at places."""
    n = len(places)
    h = [b - a for a, b in zip(places, places[1:])]
    low, middle, right = [0.0] * n, [1.0] * n, [0.0] * n
    for k in range(1, n - 1):  # the tridiagonal system for the second derivatives
        factor = h[k - 1] / middle[k - 1]
        middle[k] = 2 * (h[k - 1] + h[k]) - factor * low[k - 1]
        low[k] = h[k]
        step = 6 * ((values[k + 1] - values[k]) / h[k] - (values[k] - values[k - 1]) / h[k - 1])
        right[k] = step - factor * right[k - 1]
        if k == 1:
            middle[k], right[k] = 2 * (h[0] + h[1]), step
    second = [0.0] * n
    for k in range(n - 2, 0, -1):
        second[k] = (right[k] - low[k] * second[k + 1]) / middle[k]
    k = next(k for k in range(n - 1) if i <= places[k + 1] or k == n - 2)
    a, b = (places[k + 1] - i) / h[k], (i - places[k]) / h[k]
    return (a * values[k] + b * values[k + 1]
            + ((a ** 3 - a) * second[k] + (b ** 3 - b) * second[k + 1]) * h[k] ** 2 / 6)


def ease(t):
    """From 0 to 1 over t in 0..1, slow at its end."""
    return 1 - (1 - min(max(t, 0.0), 1.0)) ** 3


@lru_cache(maxsize=None)
def lower_point(row, i):
    heights, width, front, rear = LOWER[row]
    x, z = PLAN[i]
    x *= width / 0.850
    if row == 7 and i <= A:  # the wing's crest runs inside the side
        x *= (0.93, 0.93, 0.93, 0.93, 0.935, 0.943, 0.955, 0.972, 0.99)[i]
    z += (front - 2.080) * max(0.0, (z - 1.0) / 1.08) ** 2 + (rear + 2.160) * max(0.0, (-z - 1.3) / 0.86) ** 2
    if x > 0.7:
        x += FLARE[row] * sum(math.exp(-((z - axle) / 0.38) ** 2) for axle in (1.28, -1.28))
    return (x, at(heights, HEIGHT_COLUMNS, i), z)


def shoulder_point(i, side):
    """The shoulder has two rows, below (side -1) and above it (+1), so near each other that its radius is small; round
    the nose and the tail it fades."""
    here, there = Vector(lower_point(6, i)), Vector(lower_point(6 + side, i))
    distance = 0.008 + 0.028 * max(0.0, (F3 + 1.5 - i) / 4, (i - R3) / 3) ** 0.8
    return here + (there - here).normalized() * distance


def upper_point(row, i):
    """A point of the greenhouse: columns 0 to 3 are the windscreen's, A to R0 the side's and the rear's."""
    height, width, (zc, yc), (xa, za, ya), (zr, yr) = UPPER[row]
    if i < F3:
        u = (0, 0.36, 0.70)[i]
        return (xa * u, yc + (ya - yc) * u ** 2, zc + (za - zc) * u ** 2.2)
    x, z = PLAN[i]
    rear = -1.880 + 0.85 * (zr + 2.160)  # column S12, which comes forward with the raked rear
    t = (z - PLAN[A][1]) / (-1.880 - PLAN[A][1])
    if t > 1:  # round the rear corner
        t = (z + 1.880) / -0.280
        return (width * x / 0.850, height + (yr - height) * (0.6 + 0.4 * t), rear + (zr - rear) * t)
    front = ease(t / 0.55)
    back = max(0.0, (t - 0.45) / 0.55) ** 2
    return (xa + (width * x / 0.850 - xa) * front, ya + (height - ya) * front + (yr - height) * 0.6 * back,
            za + (rear - za) * t)


def body_skin():
    """The whole skin as a cage; its middle is at x = 0."""
    cage = Cage()
    points = {}

    def point(key, place):
        if key not in points:
            points[key] = cage.add([place], [])[0]
        return points[key]

    def lower(row, i):
        return point(("L", row, i), lower_point(row, i))

    def upper(row, i):
        return point(("U", row, i), upper_point(row, i))

    def base(i):
        """The windscreen's base; it ends at the belt's A column."""
        if i == F3:
            return lower(7, A)
        end = lower_point(7, A)
        u = (0, 0.36, 0.70)[i]
        return point(("W", i), (end[0] * u, SCUTTLE[1] + (end[1] - SCUTTLE[1]) * u ** 2,
                                SCUTTLE[0] + (end[2] - SCUTTLE[0]) * u ** 2.2))

    def bonnet(b, i):
        """From the nose (b = 0) to the windscreen (5), from the middle (i = 0) to the wing's crest (3)."""
        if b == 0:
            return lower(7, i)
        if b == 5:
            return base(i)
        if i == F3:
            return lower(7, F3 + b)
        u = (0, 0.38, 0.74)[i]
        side, (z, y) = lower_point(7, F3 + b), BONNET[b]
        rise = 0.010 * (0.4, 1, 1, 0.8)[b - 1] if i == 2 else 0  # the lines that run from the grille to the pillars
        return point(("B", b, i), (side[0] * u, y + (side[1] - y) * u ** 2.6 + rise, z + (side[2] - z) * u ** 2.2))

    def roof(r, i):
        """From the windscreen's head (r = 0) to the tail (8), from the middle (i = 0) to the cant rail (3)."""
        if r == 0:
            return upper(4, i if i < F3 else A)
        if r == 8:
            return upper(4, R0 - i)
        if i == F3:
            return upper(4, A + r)
        u = (0, 0.37, 0.72)[i]
        side, (z, y) = upper_point(4, A + r), ROOF[r]
        return point(("R", r, i), (side[0] * u, y + (side[1] - y) * u ** 2.4, z + (side[2] - z) * u ** 2))

    def quad(*corners):
        cage.mesh.faces.new(corners)

    def shoulder(side, i):
        return point(("S", side, i), shoulder_point(i, side))

    for i in range(R0):
        column, following = ([*(lower(row, k) for row in range(6)), shoulder(-1, k), shoulder(1, k), lower(7, k)]
                             for k in (i, i + 1))
        for a, b, c, d in zip(column, following, following[1:], column[1:]):
            quad(a, b, c, d)
    for i in range(A, R0):
        quad(lower(7, i), lower(7, i + 1), upper(0, i + 1), upper(0, i))
        for row in range(4):
            quad(upper(row, i), upper(row, i + 1), upper(row + 1, i + 1), upper(row + 1, i))
    for i in range(F3):
        j = i + 1 if i + 1 < F3 else A
        quad(base(i), base(i + 1), upper(0, j), upper(0, i))
        for row in range(4):
            quad(upper(row, i), upper(row, j), upper(row + 1, j), upper(row + 1, i))
        for b in range(5):
            quad(bonnet(b, i), bonnet(b, i + 1), bonnet(b + 1, i + 1), bonnet(b + 1, i))
        for r in range(8):
            quad(roof(r, i), roof(r, i + 1), roof(r + 1, i + 1), roof(r + 1, i))

    def line(sharpness, *vertices):
        cage.crease(sharpness, [cage.mesh.edges.get(pair) for pair in zip(vertices, vertices[1:])])

    line(1.5, *(lower(7, i) for i in range(A, R3 + 1)))           # the belt
    line(3.0, *(base(i) for i in range(F3 + 1)))                  # the windscreen's base
    line(1.6, *(bonnet(b, 2) for b in range(1, 6)))
    line(1.8, *(lower(2, i) for i in range(S1, R3 + 1)))          # above the sill
    line(1.5, *(lower(1, i) for i in range(R0 + 1)))              # the sill's lower edge
    other = cage.mirrored()
    cage.join(other)
    return cage.weld()
