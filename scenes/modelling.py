"""Shapes and a writer for scenes in the VRUT text format, in plain Python.

A mesh is a list of triangles, each three points, counter-clockwise seen from outside; every shape made
here is closed. `indexed` welds its points and finds the normals.
"""

import math

# ---- vectors ---------------------------------------------------------------------------------------------


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return scale(a, 1 / length) if length > 0 else (0.0, 0.0, 0.0)


# ---- meshes ----------------------------------------------------------------------------------------------


def outward(mesh):
    """Turns a closed mesh so that its triangles face outward."""
    volume = sum(dot(a, cross(b, c)) for a, b, c in mesh)
    return mesh if volume > 0 else [(a, c, b) for a, b, c in mesh]


def moved(mesh, offset):
    return [tuple(add(p, offset) for p in triangle) for triangle in mesh]


def bent(mesh, function):
    """Every point through a function that keeps the mesh's handedness."""
    return [tuple(function(p) for p in triangle) for triangle in mesh]


def turned(mesh, axis, degrees):
    """Turned about a coordinate axis (0, 1, 2) through the origin."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3

    def turn(p):
        q = list(p)
        q[i], q[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
        return tuple(q)

    return bent(mesh, turn)


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def box(size, bevel, centre=(0, 0, 0)):
    """A box with chamfered edges."""
    half = [s / 2 for s in size]
    signs = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]

    def corner(sign, axis):  # the point of a corner that lies on the face across `axis`
        return tuple(sign[k] * (half[k] - (0 if k == axis else bevel)) for k in range(3))

    def put(sign, axis, value):
        return tuple(value if k == axis else sign[k] for k in range(3))

    polygons = [[corner(sign, axis) for axis in range(3)] for sign in signs]
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):
            ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            polygons.append([corner(put(put(put((0, 0, 0), axis, side), i, u), j, v), axis) for u, v in ring])
            for other in (-1, 1):  # the edge along `axis` where the faces across i and j meet
                low, high = (put(put(put((0, 0, 0), i, side), j, other), axis, end) for end in (-1, 1))
                polygons.append([corner(low, i), corner(high, i), corner(high, j), corner(low, j)])
    mesh = []
    for polygon in polygons:  # the box is convex about its centre: outward is away from it
        if dot(cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0])), polygon[0]) < 0:
            polygon = polygon[::-1]
        mesh += [(polygon[0], b, c) for b, c in zip(polygon[1:], polygon[2:])]
    return moved(mesh, centre)


def lathe(profile, segments, closed=True, arc=360):
    """A profile of (radius, x) turned about the x axis.

    `closed`: the profile is a loop; otherwise it must begin and end at radius 0. An `arc` below 360 degrees
    starts at +z, goes over +y, and its two ends are closed; that needs a convex profile.
    """
    full = arc == 360
    ring = []
    for k in range(segments if full else segments + 1):
        angle = math.radians(arc * k / segments)
        ring.append([(x, r * math.sin(angle), r * math.cos(angle)) for r, x in profile])
    mesh = []
    for k in range(segments):
        here, there = ring[k], ring[(k + 1) % len(ring)]
        for i in range(len(profile) if closed else len(profile) - 1):
            j = (i + 1) % len(profile)
            mesh += quad(here[i], here[j], there[j], there[i])
    if not full:
        for end, flip in ((ring[0], False), (ring[-1], True)):
            fan = [(end[0], c, b) for b, c in zip(end[1:], end[2:])]
            mesh += [(a, c, b) for a, b, c in fan] if flip else fan
    return outward(mesh)


# ---- the scene text --------------------------------------------------------------------------------------

SMOOTH_BELOW = math.cos(math.radians(50))  # edges bent less than this are shaded as one smooth surface


def number(value, digits):
    text = f"{value:.{digits}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values, digits=4):
    return " ".join(number(v, digits) for v in values)


def smooth_groups(indices, corners, normals):
    """The triangles around a point, parted where two neighbours meet at a sharp edge."""
    groups, left = [], list(indices)
    while left:
        left.sort(key=lambda k: (dot(normals[k], normals[k]), k))
        group = [left.pop()]  # begins with the largest
        for i in group:  # grows while it is walked
            for k in [k for k in left if len(set(corners[i]) & set(corners[k])) > 1
                      and dot(unit(normals[i]), unit(normals[k])) > SMOOTH_BELOW
                      and dot(unit(normals[group[0]]), unit(normals[k])) > 0.2]:
                left.remove(k)
                group.append(k)
        groups.append(group)
    return groups


def indexed(mesh):
    """Points rounded to a tenth of a millimetre and welded, triangles that this leaves without area dropped,
    and a normal for every corner: the mean over its smooth neighbours, weighted by area."""
    corners = [tuple(tuple(round(c, 4) + 0.0 for c in p) for p in triangle) for triangle in mesh]
    corners = [triangle for triangle in corners if len(set(triangle)) == 3]
    normals = [cross(sub(b, a), sub(c, a)) for a, b, c in corners]
    around = {}
    for i, triangle in enumerate(corners):
        for p in triangle:
            around.setdefault(p, []).append(i)
    normal_at = {}
    for p, indices in around.items():
        for group in smooth_groups(indices, corners, normals):
            total = (0, 0, 0)
            for i in group:
                total = add(total, normals[i])
            for i in group:
                normal_at[i, p] = tuple(round(c, 3) + 0.0 for c in unit(total))
    vertices, triangles = {}, []
    for i, triangle in enumerate(corners):
        triangles.append(tuple(vertices.setdefault((p, normal_at[i, p]), len(vertices)) for p in triangle))
    return list(vertices), triangles


def geometry_text(gid, vertices, triangles, normals=True):
    """A geometry of (point, normal) pairs and of triangles that name them by number."""
    lines = [f"geometry {gid}", f"  vertices {len(vertices)}"]
    lines += lines_of([numbers(p) for p, _ in vertices])
    if normals:
        lines += [f"  normals {len(vertices)}"] + lines_of([numbers(n, 3) for _, n in vertices])
    lines += [f"  triangles {len(triangles)}"] + lines_of([" ".join(map(str, t)) for t in triangles])
    return "\n".join(lines + ["end"])


def lines_of(items, width=110):
    """Items joined into lines."""
    lines, line = [], ""
    for item in items:
        if line and len(line) + len(item) + 1 > width:
            lines.append(line)
            line = ""
        line = f"{line} {item}" if line else item
    return lines + [line] if line else lines
