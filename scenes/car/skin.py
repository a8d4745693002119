"""The surfaces of the small estate: what every part of its body is cut from.

Metres; y is up; the front looks along +z, so the car's left is +x. The wheels stand on y = 0.
"""

import math

from modelling import add, curve, mix, steps

# ---- the body's outer skin -------------------------------------------------------------------------------
# The skin runs around the car at every height y. Its place p is 0 in the middle of the rear, 1 where the left
# side begins, 2 where it ends, 3 in the middle of the front; p < 0 and p > 3 are the right side's.

REAR_Z, FRONT_Z = -1.66, 1.70  # where the sides end
REAR_AXLE, FRONT_AXLE, AXLE_Y = -1.28, 1.32, 0.31
REAR_ROUND, FRONT_ROUND = 3.6, 2.7  # exponents of the corners, which are superellipses
BELT = 0.955  # height at which doors end and windows begin
ROOF_FRONT = 0.20  # where the roof meets door and windscreen pillar
EAVES = 1.42  # height at which the roof begins

half_width = curve([(0.18, 0.79), (0.32, 0.826), (0.48, 0.846), (0.62, 0.85), (0.76, 0.846), (0.87, 0.832),
                    (0.955, 0.806), (1.02, 0.782), (1.20, 0.722), (1.43, 0.638)])
rear_end = curve([(0.20, -2.04), (0.34, -2.09), (0.52, -2.10), (0.60, -2.075), (0.90, -2.05), (1.0, -2.03),
                  (1.20, -1.965), (1.45, -1.865)])
front_end = curve([(0.20, 2.03), (0.32, 2.085), (0.48, 2.10), (0.60, 2.085), (0.72, 2.045), (0.85, 1.96)])
bonnet_middle = curve([(0.85, 1.012), (1.2, 0.975), (1.5, 0.93), (1.75, 0.872), (1.9, 0.82), (2.05, 0.74)])


def corner(p, side_z, end_z, width, power):
    """A quarter of a superellipse; p is 0 at the car's end and 1 at its side."""
    angle = p * math.pi / 2
    return (width * math.sin(angle) ** (2 / power),
            side_z + (end_z - side_z) * max(math.cos(angle), 0.0) ** (2 / power))


def taper(z):
    """The car is a little narrower towards its ends."""
    return 1 - 0.03 * min(1, abs(z) / 1.7) ** 3


def plan(p, width, rear_z, front_z):
    """The outline seen from above, for the sizes that it has at some height."""
    if p < 0 or p > 3:
        x, z = plan(-p if p < 0 else 6 - p, width, rear_z, front_z)
        return -x, z
    if p < 1:
        x, z = corner(p, REAR_Z, rear_z, width, REAR_ROUND)
    elif p <= 2:
        x, z = width, REAR_Z + (FRONT_Z - REAR_Z) * (p - 1)
    else:
        x, z = corner(3 - p, FRONT_Z, front_z, width, FRONT_ROUND)
    return x * taper(z), z


def skin(p, y):
    x, z = plan(p, half_width(y), rear_end(y), front_end(y))
    return x, y, z


def side(z):
    """p of a place on the left side."""
    return 1 + (z - REAR_Z) / (FRONT_Z - REAR_Z)


def rear(x):
    """p of a place at the rear."""
    return math.copysign(math.asin(min(1, abs(x) / 0.85) ** (REAR_ROUND / 2)) / (math.pi / 2), x)


def front(x):
    return 3 - math.copysign(math.asin(min(1, abs(x) / 0.83) ** (FRONT_ROUND / 2)) / (math.pi / 2), x)


BONNET_REAR, BONNET_CORNER = 0.92, 0.52  # z where the bonnet's sides begin, x where its front begins


def bonnet_height(x, z):
    return bonnet_middle(z) - 0.055 * (x / 0.7) ** 2


def bonnet_edge(p, outside=0.0):
    """The line along which bonnet and wings meet."""
    x, z = plan(p, 0.70 + outside, REAR_Z, 1.955 + outside)
    return x, bonnet_height(x, z), z


def shoulder(p, v):
    """From the skin (v = 0) over the wing's rounded shoulder to the bonnet (v = 1)."""
    inner = bonnet_edge(p)
    outer = skin(p, inner[1] - 0.06)
    inward, upward = 1 - math.cos(v * math.pi / 2), math.sin(v * math.pi / 2)
    return tuple(a + (b - a) * t for a, b, t in zip(outer, inner, (inward, upward, inward)))


ARCH_REACH, ARCH_TOP, ARCH_POWER, SKIRT = 0.372, 0.675, 2.4, 0.215


def arch_height(z, axle):
    """Lower edge of the skin at a place on the side: the wheel arch, or the skirt beside it."""
    u = min(1, abs(z - axle) / ARCH_REACH)
    return SKIRT + (ARCH_TOP - SKIRT) * (1 - u ** ARCH_POWER) ** (1 / ARCH_POWER)


def arch_reach(y):
    """Half the width of a wheel arch at a height."""
    return ARCH_REACH * (1 - ((y - SKIRT) / (ARCH_TOP - SKIRT)) ** ARCH_POWER) ** (1 / ARCH_POWER)


def arch_places(axle):
    """Places along the side, from rear to front, that follow a wheel arch evenly."""
    return [axle - math.copysign(abs(math.cos(a)) ** (2 / ARCH_POWER), math.cos(a)) * ARCH_REACH
            for a in map(math.radians, (0, 16, 29, 43, 58, 74, 90, 106, 122, 137, 151, 164, 180))]


def patch(ps, low, high, count):
    """Rows of the skin between two heights, numbers or functions of p."""
    def height(y, p):
        return y(p) if callable(y) else y
    return [[skin(p, height(low, p) + (height(high, p) - height(low, p)) * t) for p in ps]
            for t in steps(0, 1, count)]


def between(corners, u, v):
    """A place on the skin within four corners (p, y): lower rear, lower front, upper front, upper rear."""
    low = [a + (b - a) * u for a, b in zip(corners[0], corners[1])]
    high = [a + (b - a) * u for a, b in zip(corners[3], corners[2])]
    return skin(*(a + (b - a) * v for a, b in zip(low, high)))


def pane(corners, grow, count):
    """Rows of a window within four corners, or a little beyond them."""
    return [[between(corners, u, v) for u in steps(-grow, 1 + grow, count)]
            for v in steps(-grow, 1 + grow, count)]


def surround(outer, inner, per_side, rings=1):
    """Rows of a frame: rings from four outer corners to four inner ones."""
    rows = []
    for t in steps(0, 1, rings):
        corners = [tuple(a + (b - a) * t for a, b in zip(*pair)) for pair in zip(outer, inner)]
        rows.append([skin(*(a + (b - a) * s for a, b in zip(start, end)))
                     for start, end in zip(corners, corners[1:] + corners[:1])
                     for s in steps(0, 1, per_side)[:-1]])
    return rows


# ---- roof and windscreen ---------------------------------------------------------------------------------

roof_crown = curve([(-1.87, 0.08), (-1.3, 0.108), (-0.6, 0.118), (0.0, 0.105), (0.35, 0.075)])


def roof(angle, t):
    """angle -90 to 90 from right to left, t 0 at the windscreen to 1 at the boot lid."""
    a = math.radians(angle)
    x = math.copysign(abs(math.sin(a)) ** (2 / 2.8), a) * half_width(EAVES)
    across = min(1, abs(x) / half_width(EAVES))
    rear_z = REAR_Z + (rear_end(EAVES) - REAR_Z) * (1 - across ** REAR_ROUND) ** (1 / REAR_ROUND)
    z = (ROOF_FRONT + 0.12 - 0.11 * across ** 4) * (1 - t) + rear_z * t
    crown = roof_crown(z) * max(0, 1 - max(0, (t - 0.92) / 0.08) ** 3) ** 0.5
    return x * taper(z), EAVES + crown * max(math.cos(a), 0) ** (2 / 2.8), z


def windscreen(u, v):
    """u -1 to 1 from right to left, v 0 at the bonnet to 1 at the roof."""
    angle = math.degrees(math.asin(abs(u * 0.58 / half_width(EAVES)) ** 1.4))
    top = roof(math.copysign(angle, u), 0)
    bottom = (u * 0.72, 0.985 - 0.03 * u * u, 1.07 - 0.15 * u * u)
    return add(mix(bottom, top, v), (0, 0.03 * v * (1 - v), 0.05 * v * (1 - v)))


def bonnet(u, v):
    """u -1 to 1 from right to left, v 0 at the windscreen to 1 at the front: a patch between four curves."""
    inset = -0.004

    def at_side(v):
        first, last = side(BONNET_REAR), front(BONNET_CORNER)
        x, _, z = bonnet_edge(first + (last - first) * v, inset)
        return x, z

    def at_end(u, rear_end_of_it):
        if rear_end_of_it:
            return at_side(0)[0] * u, 1.09 - (1.09 - at_side(0)[1]) * u * u
        x, _, z = bonnet_edge(3 - (3 - front(BONNET_CORNER)) * u, inset)
        return x, z

    (sx, sz), (x0, z0), (x1, z1) = at_side(v), at_end(u, True), at_end(u, False)
    (cx0, cz0), (cx1, cz1) = at_side(0), at_side(1)
    x = sx * u + (x0 * (1 - v) + x1 * v) - u * (cx0 * (1 - v) + cx1 * v)
    z = sz + (z0 * (1 - v) + z1 * v) - (cz0 * (1 - v) + cz1 * v)
    return x, bonnet_height(x, z), z
