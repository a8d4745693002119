"""Shapes and a writer for scenes in the VRUT text format, in plain Python.

A mesh is a list of triangles, each three points, counter-clockwise seen from outside; every shape made
here is closed. `Scene` welds the points, finds the normals, and writes the text.
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


def mix(a, b, t):
    return add(scale(a, 1 - t), scale(b, t))


def steps(first, last, count):
    """`count` + 1 values from first to last."""
    return [first + (last - first) * i / count for i in range(count + 1)]


def curve(table):
    """A smooth function through the (x, y) pairs of a table; straight beyond its ends."""
    xs = [x for x, _ in table]
    ys = [y for _, y in table]
    slopes = [(y1 - y0) / (x1 - x0) for x0, x1, y0, y1 in zip(xs, xs[1:], ys, ys[1:])]
    tangents = [slopes[0]] + [(a + b) / 2 for a, b in zip(slopes, slopes[1:])] + [slopes[-1]]

    def at(x):
        if x <= xs[0]:
            return ys[0] + tangents[0] * (x - xs[0])
        if x >= xs[-1]:
            return ys[-1] + tangents[-1] * (x - xs[-1])
        i = max(k for k in range(len(xs) - 1) if xs[k] <= x)
        h = xs[i + 1] - xs[i]
        t = (x - xs[i]) / h
        return ((1 + 2 * t) * (1 - t) ** 2 * ys[i] + t * (1 - t) ** 2 * h * tangents[i]
                + t * t * (3 - 2 * t) * ys[i + 1] - t * t * (1 - t) * h * tangents[i + 1])

    return at


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


def tube(path, radius, sides=8):
    """A round bar along a path, its ends closed."""
    rings = []
    for k, p in enumerate(path):
        along = unit(sub(path[min(k + 1, len(path) - 1)], path[max(k - 1, 0)]))
        across = unit(cross(along, (0, 1, 0) if abs(along[1]) < 0.9 else (1, 0, 0)))
        third = cross(across, along)
        rings.append([add(p, add(scale(across, radius * math.cos(2 * math.pi * i / sides)),
                                 scale(third, radius * math.sin(2 * math.pi * i / sides))))
                      for i in range(sides)])
    mesh = []
    for a, b in zip(rings, rings[1:]):
        for i in range(sides):
            j = (i + 1) % sides
            mesh += quad(a[i], a[j], b[j], b[i])
    for end, flip in ((rings[0], True), (rings[-1], False)):
        fan = [(end[0], b, c) for b, c in zip(end[1:], end[2:])]
        mesh += [(a, c, b) for a, b, c in fan] if flip else fan
    return outward(mesh)


def shell(rows, thickness, bevel=0.004, lift=0.0, ring=False, centre=(0, 0.6, 0), back=(2, 2)):
    """A sheet of metal or glass over a grid of points, with a chamfered edge all around.

    The grid is the sheet's outer side, which faces away from `centre`; it is raised by `lift` first. With
    `ring` the last column joins the first. The inner side takes only every n-th row and column (`back`).
    """
    count, width = len(rows), len(rows[0])

    def at(i, j):
        return rows[i][j % width if ring else min(max(j, 0), width - 1)]

    normals = [[unit(cross(sub(at(i, j + 1), at(i, j - 1)),
                           sub(at(min(i + 1, count - 1), j), at(max(i - 1, 0), j))))
                for j in range(width)] for i in range(count)]
    facing = sum(dot(n, sub(p, centre)) for ps, ns in zip(rows, normals) for p, n in zip(ps, ns))
    if facing < 0:
        normals = [[scale(n, -1) for n in line] for line in normals]

    def layer(height):
        return [[add(p, scale(n, height)) for p, n in zip(ps, ns)] for ps, ns in zip(rows, normals)]

    def inset(i, j, step_i, step_j):
        start, end = top[i][j], top[i + step_i][(j + step_j) % width if ring else j + step_j]
        return scale(unit(sub(end, start)), bevel)

    top, edge, inner = layer(lift), layer(lift - bevel), layer(lift - thickness)
    face = [list(line) for line in top]
    for i in range(count):
        for j in range(width):
            if i in (0, count - 1):
                face[i][j] = add(face[i][j], inset(i, j, 1 if i == 0 else -1, 0))
            if not ring and j in (0, width - 1):
                face[i][j] = add(face[i][j], inset(i, j, 0, 1 if j == 0 else -1))

    back_rows = sorted({*range(0, count, back[0]), count - 1})
    back_columns = sorted({*range(0, width, back[1])} | (set() if ring else {width - 1}))

    def cells(line, closed):
        return list(zip(line, line[1:] + line[:1] if closed else line[1:]))

    mesh = []
    for i, k in cells(list(range(count)), False):
        for j, m in cells(list(range(width)), ring):
            mesh += quad(face[i][j], face[i][m], face[k][m], face[k][j])
    for i, k in cells(back_rows, False):
        for j, m in cells(back_columns, ring):
            mesh += quad(inner[i][j], inner[k][j], inner[k][m], inner[i][m])

    if ring:
        borders = [[(0, j) for j in range(width)], [(count - 1, -j % width) for j in range(width)]]
    else:
        m, n = count - 1, width - 1
        borders = [[(0, j) for j in range(n)] + [(i, n) for i in range(m)]
                   + [(m, n - j) for j in range(n)] + [(m - i, 0) for i in range(m)]]
    for border in borders:  # each begins at a corner, which the inner side has too
        behind = border[0]
        for (i, j), (k, m) in cells(border, True):
            mesh += quad(edge[i][j], edge[k][m], face[k][m], face[i][j])
            mesh.append((inner[behind[0]][behind[1]], edge[k][m], edge[i][j]))
            if k in back_rows and m in back_columns:
                mesh.append((inner[behind[0]][behind[1]], inner[k][m], edge[k][m]))
                behind = (k, m)
    return outward(mesh)


# ---- the scene text --------------------------------------------------------------------------------------

IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
SMOOTH_BELOW = math.cos(math.radians(50))  # edges bent less than this are shaded as one smooth surface


def placed(x, y, z, mirror=False):
    """The matrix that puts a part at a place; `mirror` makes its counterpart on the car's other side."""
    return (-1 if mirror else 1, 0, 0, -x if mirror else x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)


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


class Scene:
    """Collects materials, geometries and nodes, and writes them. Ids are given in the order of making."""

    def __init__(self, name, comment):
        self.blocks = []
        self.materials = {}
        self.geometries = {}
        self.nodes = 0
        self.triangles = 0  # as drawn: a geometry placed four times counts four times
        self.head = "vrut-text 1\n" + "".join(f"# {line}".rstrip() + "\n" for line in comment) + "unit 1\n"
        self.blocks.append(f'node 0 "{name}" root end')

    def material(self, name, ambient, diffuse, specular=(0, 0, 0), shininess=0):
        mid = self.materials[name] = len(self.materials) + 1
        colours = {"ambient": ambient, "diffuse": diffuse, "specular": specular}
        members = "".join(f"  {key} {numbers(value)} 1 " for key, value in colours.items())
        self.blocks.append(f'material {mid} "{name}"\n{members} shininess {number(shininess, 2)}\nend')

    def _node(self, name, kind, parent, members, matrix):
        self.nodes += 1
        rows = "  ".join(numbers(matrix[i:i + 4]) for i in (0, 4, 8, 12))
        place = "" if tuple(matrix) == IDENTITY else f"   matrix {rows}"
        self.blocks.append(f'node {self.nodes} "{name}" {kind}   parent {parent}{members}{place}   end')
        return self.nodes

    def group(self, name, parent=0, matrix=IDENTITY):
        return self._node(name, "assembly", parent, "", matrix)

    def part(self, name, parent, mesh, material, matrix=IDENTITY):
        """A node that shows a mesh. A mesh used again is written once."""
        if id(mesh) not in self.geometries:
            vertices, triangles = indexed(mesh)
            gid = len(self.geometries) + 1
            self.geometries[id(mesh)] = (gid, len(triangles), mesh)
            self.blocks.append(geometry_text(gid, vertices, triangles))
        gid, count, _ = self.geometries[id(mesh)]
        self.triangles += count
        members = f"   geometry {gid}   material {self.materials[material]}"
        return self._node(name, "geometry", parent, members, matrix)

    def text(self):
        return self.head + "\n" + "\n".join(self.blocks) + "\n"


def lines_of(items, width=110):
    """Items joined into lines."""
    lines, line = [], ""
    for item in items:
        if line and len(line) + len(item) + 1 > width:
            lines.append(line)
            line = ""
        line = f"{line} {item}" if line else item
    return lines + [line] if line else lines
