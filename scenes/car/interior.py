"""The car's interior: dashboard, seats, linings and whatever else is seen from within. Car coordinates, but for parts
that turn: those are made about the origin of their node."""

import math
from functools import lru_cache

import bpy
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

from authoring import HARD, Cage, box, cap, close_ends, cylinder, grid, lathe, thickened, tube
import authoring
from body import FRONT_WINDOW, QUARTER_WINDOW, REAR_WINDOW, REAR_WINDOW_PANE
from body_skin import body_skin

FIRST_ID, FIRST_DOOR_ID, LAST_ID = 400, 560, 599  # of the nodes
MIRRORED = Matrix.Diagonal((-1, 1, 1, 1))
DRIVER_X = 0.36  # the seats' middle
EYE = Vector((DRIVER_X, 1.17, -0.20))
RECLINE = 22
B_PILLAR = -0.215  # z
FINE = {"Rim", "Spokes", "Lower spoke", "Hub", "Badge", "Ring", "Knob", "Gaiter", "Surround", "Hood", "Housing",
        "Cup wells", "Handle", "Screen frame", "Fascia", "Stalk left", "Stalk right",
        "Cup holder front", "Cup holder rear", "Climate knob left", "Climate knob middle",
        "Climate knob right"}


# What is seen from afar, or as an edge only.
COARSE = {"Seal", "Quarter window seals", "Door jambs", "Side lining left", "Side lining right", "Return"}


def add(car):
    car.numbered_from(FIRST_ID)
    interior = car.group("Interior")
    for build in (dashboard, steering, pedals, console, front_seats, rear_bench, seat_belts, linings, roof_lining,
                  mirror, boot, jambs):
        build(car, interior)
    refine(car, FIRST_ID)


def refine(car, first):
    """Nothing of the car is seen from so near as what is around the driver: less error than elsewhere."""
    for node in car.nodes:
        if first <= node["id"] <= LAST_ID and "mesh" in node:
            name = node["name"]
            node["tolerance"] = 0.3 if name in FINE else 2.0 if name in COARSE else 0.9
            if name in COARSE and not name.startswith("Side"):
                node["detail"] = authoring.FINE


# ---- shapes ----------------------------------------------------------------------------------------------


def place(x, y, z, axis=None, degrees=0.0):
    turn = Matrix.Rotation(math.radians(degrees), 4, axis) if axis else Matrix.Identity(4)
    return Matrix.Translation((x, y, z)) @ turn


def sheet(rows, towards):
    """A sheet through rows of points whose front looks about in the direction given."""
    cage = grid(rows)
    cage.mesh.normal_update()
    if sum((f.normal * f.calc_area() for f in cage.mesh.faces), Vector()).dot(Vector(towards)) < 0:
        cage.flip()
    return cage


def symmetric(half):
    """A ring of points from those of its half with x > 0, in order."""
    return list(half) + [(-x, y, z) for x, y, z in reversed(half)]


def loft(rings, end=1.0, ends=(True, True)):
    """A solid through rings of an even number of points; `end` is the sharpness of its ends' rims, and `ends` tells
    which of them are closed."""
    cage = grid(rings, closed_columns=True)
    points, n = list(cage.mesh.verts), len(rings[0])
    for ring, closed in zip((points[:n], points[-n:]), ends):
        if not closed:
            continue
        cap(cage, ring)
        cage.crease(end, [cage.mesh.edges.get(pair) for pair in zip(ring, ring[1:] + ring[:1])])
    return cage.outward()


def crease_rows(cage, columns, rows, sharpness):
    """Makes rows of a grid's edges sharp, those along the columns' direction; the grid has `columns` points a row."""
    points = list(cage.mesh.verts)
    for i in rows:
        row = points[i * columns:(i + 1) * columns]
        cage.crease(sharpness, [cage.mesh.edges.get(p) for p in zip(row, row[1:])])
    return cage


def crease_columns(cage, columns, which, sharpness):
    """Makes columns of a grid's edges sharp; the grid comes first among the cage's points."""
    points = list(cage.mesh.verts)
    for j in which:
        edges = [cage.mesh.edges.get(p) for p in zip(points[j::columns], points[j + columns::columns])]
        cage.crease(sharpness, [e for e in edges if e])
    return cage


def crease_around(cage, columns, which, sharpness):
    """The same for a lathe's rings, which are closed."""
    points = list(cage.mesh.verts)
    n = len(points) // columns
    for j in which:
        ring = points[j:n * columns:columns]
        cage.crease(sharpness, [cage.mesh.edges.get(p) for p in zip(ring, ring[1:] + ring[:1])])
    return cage


def rounded_box(x, y, z, sharpness=3.0, at=(0, 0, 0)):
    return box(x, y, z, sharpness).move(*at)


def rim(segments):
    """By how much a ring of points must be larger than the circle it is to become."""
    return 6 / (4 + 2 * math.cos(2 * math.pi / segments))


def rectangle(width, height):
    """A plane about the origin that looks along +z, with the whole of a picture on it."""
    w, h = width / 2, height / 2
    cage = Cage([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)], [(0, 1, 2, 3)])
    return cage.texture(lambda p: (p.x / width + 0.5, p.y / height + 0.5))


def facing(at, towards):
    """The matrix of a plane at a place that looks in a direction, upright."""
    normal = Vector(towards).normalized()
    across = Vector((0, 1, 0)).cross(normal).normalized()
    turn = Matrix((across, normal.cross(across), normal)).transposed().to_4x4()
    return Matrix.Translation(at) @ turn


def both_sides(car, name, parent, cage, material, **more):
    first = car.part(f"{name} left", parent, cage, material, **more)
    return first, car.part(f"{name} right", parent, car.nodes[-1]["mesh"], material, MIRRORED, **more)


def at_four_a_metre(cage, u, v):
    """Cloth: four repeats of the picture a metre, along two directions."""
    return cage.texture(lambda p: (4 * p.dot(Vector(u)), 4 * p.dot(Vector(v))))


@lru_cache(maxsize=None)
def skin():
    """The body's skin, finely divided, to find places on."""
    mesh = bpy.data.meshes.new("Skin")
    body_skin().mesh.to_mesh(mesh)
    thing = bpy.data.objects.new("Skin", mesh)
    bpy.context.scene.collection.objects.link(thing)
    thing.modifiers.new("Limit", "SUBSURF").levels = 3
    return BVHTree.FromObject(thing, bpy.context.evaluated_depsgraph_get())


def within(origin, towards, depth):
    place, normal, _, _ = skin().ray_cast(Vector(origin), Vector(towards))
    return place - normal * depth


def on_left(z, y, depth):
    """The place this far within the skin's left side."""
    return within((2, y, z), (-1, 0, 0), depth)


def on_tail(x, y, depth):
    """The same at the rear."""
    return within((x, y, -3), (0, 0, 1), depth)


def rounded(outline):
    """The points of an outline with rounded corners, none too far from the next, and the outward normals there."""
    n, points = len(outline), []
    for i, (a, b, radius) in enumerate(outline):
        corner, before, after = (Vector(outline[k % n][:2]) for k in (i, i - 1, i + 1))
        turn = (before - corner).angle(after - corner)
        cut = min(max(radius / math.tan(turn / 2), 0.02), 0.45 * (before - corner).length,
                  0.45 * (after - corner).length)
        first, last = corner + (before - corner).normalized() * cut, corner + (after - corner).normalized() * cut
        points += [first, (first + 2 * corner + last) / 4, last]
        following = Vector(outline[(i + 1) % n][:2])
        if (following - corner).length > 0.3:
            points.append((corner + following) / 2)
    area = sum(p.x * q.y - p.y * q.x for p, q in zip(points, points[1:] + points[:1]))
    normals = []
    for i in range(len(points)):
        along = (points[(i + 1) % len(points)] - points[i - 1]).normalized()
        normals.append(Vector((along.y, -along.x)) * math.copysign(1, area))
    return list(zip(points, normals))


def seal(outline, place, profile=((-0.010, 0.0085), (-0.003, 0.028), (0.013, 0.0245))):
    """The rubber between a pane's edge and its frame: `profile` is a ring of (outward, depth), `place` a function of
    a point of the outline and the depth."""
    rows = [[place(*(point + out * normal), depth) for out, depth in profile] for point, normal in rounded(outline)]
    return grid(rows, closed_rows=True, closed_columns=True).outward()


def interpolate(x, points):
    """A height at x on the polyline through points (x, height)."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * max(0.0, (x - x0) / (x1 - x0))
    return points[-1][1]


# ---- dashboard -------------------------------------------------------------------------------------------

DASH_HALF = 0.672  # half its width, clear of the door trims
CLUSTER = Vector((DRIVER_X, 0.893, 0.510))


def screen_base(x):
    """z at which the dashboard meets the windscreen."""
    return 1.0 - 0.215 * (x / 0.68) ** 2


def dash_pad():
    """The soft upper part: from the windscreen over the edge to below the vents."""
    rows = []
    places = (-DASH_HALF, -0.62, -0.36, -0.14, 0.14, 0.205, 0.515, 0.62, DASH_HALF)
    for x in places:
        back, bulge = screen_base(x), 0.02 * math.cos(x / DASH_HALF * math.pi / 2)
        rows.append([(x, 0.970 - 0.03 * x * x, back), (x, 0.972, 0.5 * (back + 0.53)), (x, 0.972, 0.545 - bulge),
                     (x, 0.945, 0.485 - bulge), (x, 0.845, 0.475 - bulge), (x, 0.822, 0.52)])
    cage = crease_rows(sheet(rows, (0, 0.5, -1)), 6, (0, len(places) - 1), 1)
    behind = [f for f in cage.mesh.faces if all(0.2 < v.co.x < 0.52 and v.co.z < 0.56 for v in f.verts)]
    for face in behind:  # the instruments' hood stands before the opening
        cage.mesh.faces.remove(face)
    return cage


def dash_end():
    """Covers the pad's and the lower part's ends, a little proud of both; its edge is turned in over them."""
    profile = ((0.957, 0.820), (0.980, 0.680), (0.979, 0.545), (0.950, 0.478), (0.850, 0.468), (0.760, 0.467),
               (0.660, 0.468), (0.556, 0.515), (0.508, 0.615), (0.535, 0.870))
    rows = []
    for y, z in profile:
        spine = 0.945 - 0.40 * min(max((0.957 - y) / 0.42, 0), 1)
        rows.append([(0.664, 0.74 + 0.9 * (y - 0.74), 0.68 + 0.9 * (z - 0.68)), (0.668, y, z), (0.6785, y, z),
                     (0.6785, spine, max(z, 0.88))])
    return crease_columns(sheet(rows, (1, 0, 0)), 4, (1, 2), HARD)


def dash_lower():
    rows = []
    for x in (-DASH_HALF, -0.61, -0.14, 0.14, 0.61, DASH_HALF):
        knee = 0.02 if abs(x) < 0.65 else 0.0
        rows.append([(x, 0.812, 0.515), (x, 0.79, 0.485 - knee), (x, 0.66, 0.478 - knee), (x, 0.56, 0.53),
                     (x, 0.52, 0.62), (x, 0.56, 0.92 - 0.12 * abs(x))])
    return crease_rows(sheet(rows, (0, 0, -1)), 6, (0, 5), 2)


def dash_strip():
    """The satin band between the upper and the lower part, from the centre stack outward."""
    rows = [[(x, 0.832, z + 0.03), (x, 0.829, z), (x, 0.803, z - 0.002), (x, 0.800, z + 0.03)]
            for x, z in ((0.125, 0.462), (0.36, 0.466), (0.664, 0.482))]
    return crease_columns(sheet(rows, (0, 0, -1)), 4, (1, 2), 3)


def hood():
    """The instruments' binnacle: an arch that stands on the pad, with a lip and a dark inside."""
    def arch(width, height, z):
        half = [(0.45 * width, height, z), (0.86 * width, height - 0.014, z), (width, height - 0.075, z + 0.01),
                (width, 0.825, max(z, 0.49))]
        return [(DRIVER_X + x, y, d) for x, y, d in [(-x, y, d) for x, y, d in reversed(half)] + half]

    rows = [arch(0.205, 0.945, 0.73), arch(0.198, 1.000, 0.58), arch(0.190, 1.008, 0.425), arch(0.180, 0.998, 0.412),
            arch(0.170, 0.984, 0.435), arch(0.166, 0.966, 0.525)]
    outer = crease_rows(sheet(rows[:4], (0, 1, -0.2)), 8, (3,), HARD)
    inner = sheet(rows[3:], (0, -1, 0))
    inner.crease(3, where=lambda p: p.z > 0.52)
    cap(inner, list(inner.mesh.verts)[-8:])
    return outer, sheet_of(inner, (0, -0.3, -1))


def vent_ring():
    profile = [(0.050, -0.010), (0.050, 0.012), (0.046, 0.018), (0.039, 0.004)]
    cage = lathe([(r * rim(8), x) for r, x in reversed(profile)], 8)
    return crease_around(cage.flip(), 4, (1, 2), 1)


def vent_well():
    """The darkness behind the vanes."""
    cage = lathe([(0.043 * rim(8), 0.004), (0.02, 0.004)], 8)
    cap(cage, list(cage.mesh.verts)[1::2])
    return sheet_of(cage, (1, 0, 0))


def vent_inside():
    """Four vanes, each a slanted shell, and a bar to aim them."""
    cage = upright(0.014, 0.02, 0.004)
    for y in (-0.0255, -0.0085, 0.0085, 0.0255):
        half = math.sqrt(0.0395 ** 2 - (abs(y) + 0.003) ** 2)
        edges = ((0.006, y - 0.003), (0.013, y + 0.002))
        blade = sheet([[(x, height, -half), (x, height, half)] for x, height in edges], (1, 0, 0))
        cage.join(thickened(blade, 0.0025))
    return cage


def upright(x, y, z):
    """A flat quad that looks along +x, with half its height and width."""
    return sheet([[(x, -y, -z), (x, -y, z)], [(x, y, -z), (x, y, z)]], (1, 0, 0))


def sheet_of(cage, towards):
    """Turns each face to the side given."""
    cage.mesh.normal_update()
    for face in cage.mesh.faces:
        if face.normal.dot(Vector(towards)) < 0:
            face.normal_flip()
    return cage


def centre_stack():
    """A tall panel with turned edges between dashboard and console."""
    rows = []
    for y, z in ((0.945, 0.53), (0.957, 0.448), (0.93, 0.436), (0.72, 0.412), (0.56, 0.392), (0.46, 0.385)):
        rows.append([(x, y, z + d) for x, d in ((-0.134, 0.09), (-0.13, 0.0), (0.13, 0.0), (0.134, 0.09))])
    cage = sheet(rows, (0, 0, -1))
    return crease_columns(cage, 4, (1, 2), 3)


def on_stack(x, y, out=0.0):
    """A place in front of the centre stack's face."""
    return x, y, interpolate(-y, ((-0.93, 0.436), (-0.72, 0.412), (-0.56, 0.392))) - out


STACK_NORMAL = (0, 0.115, -1)


def knob():
    cage = lathe([(0.0165 * rim(8), 0.02), (0.021 * rim(8), 0.0)], 8)
    cap(cage, list(cage.mesh.verts)[0::2])
    return crease_around(cage.outward(), 2, (0,), 2.5)


VENTS = (("outer left", 0.602), ("inner left", 0.066), ("inner right", -0.066), ("outer right", -0.602))


def vent_place(x):
    at = (x, 0.897, 0.473) if abs(x) > 0.3 else on_stack(x, 0.897)
    return aimed(at, (-0.12 * x, 0.1, -1))


def dashboard(car, interior):
    group = car.group("Dashboard", interior)
    car.part("Upper pad", group, dash_pad(), "Plastic grain")
    car.part("Lower part", group, dash_lower(), "Plastic grey")
    both_sides(car, "End cover", group, dash_end(), "Plastic black")
    both_sides(car, "Trim strip", group, dash_strip(), "Dash silver")
    lid = rounded_box(0.46, 0.165, 0.035, 3, (-0.39, 0.685, 0.478))
    car.part("Glove box", group, lid, "Plastic grey")
    car.part("Glove box handle", group, rounded_box(0.09, 0.018, 0.02, 3, (-0.375, 0.745, 0.462)), "Plastic black")

    ring, inside = car.mesh(vent_ring(), "Vent ring"), car.mesh(vent_inside(), "Vent vanes")
    for name, x in VENTS:
        vent = car.group(f"Vent {name}", group, vent_place(x))
        car.part("Ring", vent, ring, "Dash silver")
        car.part("Vanes", vent, inside, "Plastic grey")

    outer, inner = hood()
    instruments = car.group("Instrument cluster", group)
    car.part("Hood", instruments, outer, "Plastic grain")
    car.part("Hood inside", instruments, inner, "Plastic black")
    car.part("Dials", instruments, rectangle(0.288, 0.108), "Dials", facing(CLUSTER, (0, 0.355, -1)))

    stack = car.group("Centre stack", group)
    car.part("Fascia", stack, centre_stack(), "Dash silver")
    bezel = aimed(on_stack(0, 0.782), STACK_NORMAL)
    car.part("Screen frame", stack, rounded_box(0.014, 0.128, 0.21, 4), "Piano black", bezel)
    car.part("Screen", stack, rectangle(0.175, 0.105), "Screen", facing(on_stack(0, 0.782, 0.0076), STACK_NORMAL))
    controls = aimed(on_stack(0, 0.685), STACK_NORMAL)
    car.part("Buttons", stack, rounded_box(0.016, 0.022, 0.20, HARD), "Piano black", controls)
    car.part("Climate panel", stack, rounded_box(0.012, 0.07, 0.22, HARD), "Plastic black",
             aimed(on_stack(0, 0.622), STACK_NORMAL))
    dial = car.mesh(knob(), "Climate knob")
    for name, x in (("left", 0.07), ("middle", 0.0), ("right", -0.07)):
        car.part(f"Climate knob {name}", stack, dial, "Dash silver", aimed(on_stack(x, 0.622, 0.005), STACK_NORMAL))


def aimed(at, towards):
    """The matrix that turns +x to a direction, y kept upright, at a place."""
    x = Vector(towards).normalized()
    z = x.cross(Vector((0, 1, 0))).normalized()
    return Matrix.Translation(at) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()


# ---- steering wheel, pedals ------------------------------------------------------------------------------


def steering_rim():
    """About z, which looks at the driver; thicker where the thumbs lie."""
    rings, n, m = [], 14, 5
    for i in range(n):
        a = 2 * math.pi * i / n
        thick = 1.25 if i in (1, 6) else 1.0
        centre = 0.170 * rim(n) - 0.004 * (thick - 1) * 4
        ring = []
        for k in range(m):
            b = 2 * math.pi * k / m
            r = centre + 0.0155 * thick * rim(m) * math.cos(b)
            ring.append((r * math.cos(a), r * math.sin(a), 0.0145 * rim(m) * math.sin(b)))
        rings.append(ring)
    return grid(rings, closed_rows=True, closed_columns=True).outward()


SPOKE, PRONG = (0.030, 0.021, 0.020), (0.017, 0.011, 0.014)


def spoke(degrees, widths):
    """A rounded bar from the hub to the rim, half as wide as given at its root, waist and end."""
    rings = []
    for r, w, z in zip((0.040, 0.075, 0.120, 0.172), (widths[0], *widths), (-0.006, -0.010, -0.010, 0.0)):
        rings.append([(r, w * a, z + 0.010 * b) for a, b in ((1, 0), (0.55, 0.9), (-0.55, 0.9), (-1, 0), (-0.55, -0.9),
                                                             (0.55, -0.9))])
    return loft(rings, ends=(False, False)).turn("Z", degrees)


def airbag_cover():
    def ring(w, h, z):
        return [(w * math.copysign(abs(math.cos(a)) ** 0.8, math.cos(a)), h * math.sin(a), z)
                for a in (math.pi * (k + 0.5) / 4 for k in range(8))]
    return loft([ring(0.070, 0.062, -0.030), ring(0.080, 0.071, 0.000), ring(0.069, 0.061, 0.018),
                 ring(0.038, 0.034, 0.024)], 0, (False, True))


def emblem():
    """A flat disc that looks along +z."""
    radius = 0.022
    cage = loft([[(radius * rim(12) * math.cos(k * math.pi / 6), radius * rim(12) * math.sin(k * math.pi / 6), z)
                  for k in range(12)] for z in (0.010, 0.0250)], HARD, (False, True))
    return cage.texture(lambda p: (0.5 + 0.5 * p.x / radius, 0.5 + 0.5 * p.y / radius))


def steering(car, interior):
    tilt = math.radians(25)
    axes = Matrix(((-1, 0, 0), (0, math.cos(tilt), math.sin(tilt)), (0, math.sin(tilt), -math.cos(tilt)))).to_4x4()
    group = car.group("Steering", interior, Matrix.Translation((DRIVER_X, 0.86, 0.33)) @ axes)
    wheel = car.group("Steering wheel", group)
    car.part("Rim", wheel, steering_rim(), "Leather")
    car.part("Spokes", wheel, close_ends(spoke(0, SPOKE).join(spoke(180, SPOKE))), "Plastic black")
    car.part("Lower spoke", wheel, close_ends(spoke(257, PRONG).join(spoke(283, PRONG))), "Dash silver")
    car.part("Hub", wheel, airbag_cover(), "Plastic grain")
    car.part("Badge", wheel, emblem(), "Badge")

    shroud = loft([symmetric(half) for half in (
        [(0.032, 0.044, -0.035), (0.056, 0.0, -0.035), (0.032, -0.052, -0.035)],
        [(0.04, 0.05, -0.22), (0.07, 0.0, -0.22), (0.04, -0.09, -0.22)])], 2)
    car.part("Column shroud", group, shroud, "Plastic grain")
    stalk = tube([(0.04, 0, -0.052), (0.10, 0.012, -0.052), (0.165, 0.03, -0.044)], [0.008, 0.008, 0.012], 4)
    both_sides(car, "Stalk", group, stalk, "Plastic black")


def pedals(car, interior):
    group = car.group("Pedals", interior)
    for name, x, y, z, width, height in (("Accelerator", 0.235, 0.44, 0.74, 0.05, 0.13),
                                         ("Brake", 0.335, 0.50, 0.70, 0.075, 0.06),
                                         ("Clutch", 0.445, 0.50, 0.70, 0.065, 0.06)):
        one = car.group(name, group)
        car.part("Arm", one, tube([(x, y + 0.01, z + 0.012), (x, 0.66, z + 0.11)], 0.011, 4, capped=False), "Steel")
        pad = rounded_box(width, height, 0.016, 3).turn("X", 30).move(x, y, z)
        car.part("Pad", one, pad, "Plastic black")


# ---- centre console --------------------------------------------------------------------------------------

CONSOLE = ((-0.34, 0.455), (-0.1, 0.475), (0.10, 0.480), (0.25, 0.500), (0.34, 0.525), (0.44, 0.575))  # z, height


def console_height(z):
    return interpolate(z, CONSOLE)


CUPS = (0.150, 0.068)  # z of their middles
CUP_CELL, CUP_HALF = 0.041, 0.043  # half of the plate around one, along and across


def console_body():
    """A long cover over the tunnel, open where the cups stand."""
    rows = []
    for z in (-0.345, -0.33, CUPS[1] - CUP_CELL, CUPS[0] + CUP_CELL, 0.35, 0.47):
        y, w = console_height(z), 0.086 if z < 0.3 else 0.094
        drop = 0.12 if z < -0.34 else 0.0
        half = [(0.042, y - drop), (w - 0.006, y - drop), (w + 0.004, y - 0.025 - drop), (0.105, 0.345)]
        rows.append([(x, h, z) for x, h in [(-x, h) for x, h in reversed(half)] + half])
    cage = sheet(rows, (0, 1, 0))
    crease_columns(cage, 8, (2, 5), 1.5)
    crease_rows(cage, 8, (1,), 2)
    points = list(cage.mesh.verts)
    top = {points[i] for i in (2 * 8 + 3, 2 * 8 + 4, 3 * 8 + 4, 3 * 8 + 3)}
    cage.mesh.faces.remove(next(f for f in cage.mesh.faces if set(f.verts) == top))
    return cage


def console_slope(z):
    """The degrees by which the console rises there."""
    low, high = (CUPS[1] - CUP_CELL, CUPS[0] + CUP_CELL) if z < CUPS[0] + CUP_CELL else (CUPS[0] + CUP_CELL, 0.35)
    return math.degrees(math.atan2(console_height(high) - console_height(low), high - low))


def on_console(z):
    """The height of the console's top between its cage's rows."""
    low, high = (CUPS[1] - CUP_CELL, CUPS[0] + CUP_CELL) if z < CUPS[0] + CUP_CELL else (CUPS[0] + CUP_CELL, 0.35)
    return console_height(low) + (console_height(high) - console_height(low)) * (z - low) / (high - low)


def cup_well():
    """A plate that fills half the console's opening, and the well in it."""
    w, d = CUP_HALF + 0.002, CUP_CELL
    around = [(w, 0), (w, d), (0, d), (-w, d), (-w, 0), (-w, -d), (0, -d), (w, -d)]
    rows = [[(x, 0.0015, z) for x, z in around]]
    for radius, y in ((0.034, 0.0015), (0.032, -0.052)):
        rows.append([(rim(8) * radius * math.cos(a), y, rim(8) * radius * math.sin(a))
                     for a in (2 * math.pi * k / 8 for k in range(8))])
    cage = grid(rows, closed_columns=True)
    points = list(cage.mesh.verts)
    cap(cage, points[-8:])
    for ring in (points[:8], points[8:16], points[16:]):
        cage.crease(HARD, [cage.mesh.edges.get(pair) for pair in zip(ring, ring[1:] + ring[:1])])
    return sheet_of_well(cage)


def sheet_of_well(cage):
    """Turns each face upward, or towards the well's axis."""
    cage.mesh.normal_update()
    for face in cage.mesh.faces:
        middle = face.calc_center_median()
        if face.normal.y - 20 * (face.normal.x * middle.x + face.normal.z * middle.z) < 0:
            face.normal_flip()
    return cage


def cup_rim():
    profile = [(0.0325, -0.004), (0.034, 0.005), (0.037, 0.004), (0.038, 0.0)]
    cage = lathe([(r * rim(8), x) for r, x in profile], 8).transform(Matrix.Rotation(math.radians(90), 4, "Z"))
    cage.mesh.normal_update()
    return cage if sum(f.normal.y for f in cage.mesh.faces) > 0 else cage.flip()


def gaiter():
    """Leather in pleats that grow smaller upward."""
    square = ((1, 0), (0.82, 0.82), (0, 1), (-0.82, 0.82), (-1, 0), (-0.82, -0.82), (0, -1), (0.82, -0.82))
    rings = []
    for w, y in ((0.060, 0.000), (0.060, 0.008), (0.050, 0.013), (0.053, 0.021), (0.041, 0.027), (0.043, 0.036),
                 (0.030, 0.042), (0.031, 0.052), (0.019, 0.060), (0.013, 0.080)):
        rings.append([(w * x, y, w * z) for x, z in square])
    return loft(rings, ends=(False, False))


def gear_knob():
    def ring(w, d, y):
        return symmetric([(w * 0.6, y, d), (w, y, 0), (w * 0.6, y, -d)])
    return loft([ring(0.013, 0.013, 0.0), ring(0.022, 0.021, 0.025), ring(0.028, 0.027, 0.05),
                 ring(0.022, 0.021, 0.068)], 0.5, (False, True))


def console(car, interior):
    group = car.group("Centre console", interior)
    car.part("Body", group, console_body(), "Plastic grey")
    z = 0.272
    lever = car.group("Gear lever", group, place(0, on_console(z), z, "X", -console_slope(z)))
    car.part("Surround", lever, rounded_box(0.150, 0.014, 0.146, HARD, (0, 0.001, 0)), "Dash silver")
    car.part("Gaiter", lever, gaiter().move(0, 0.006, 0), "Leather")
    car.part("Rod", lever, tube([(0, 0.05, 0), (0, 0.10, 0)], 0.008, 4, capped=False), "Chrome")
    car.part("Knob", lever, gear_knob().move(0, 0.085, 0), "Leather")
    cup = car.mesh(cup_rim(), "Cup holder")
    for name, z in zip(("front", "rear"), CUPS):
        car.part(f"Cup holder {name}", group, cup, "Dash silver", place(0, on_console(z), z, "X", -console_slope(z)))
    brake = car.group("Handbrake", group, place(0.0, 0.463, -0.285, "X", -13))
    grip = tube([(0, 0, 0), (0, 0.0, 0.10), (0, 0.006, 0.14), (0, 0.002, 0.215)], [0.011, 0.012, 0.019, 0.014], 6)
    car.part("Lever", brake, grip, "Leather")
    car.part("Button", brake, rounded_box(0.011, 0.011, 0.03, 2, (0, 0.0, 0.222)), "Chrome")
    slot = sheet([[(x, 0.002 - 0.17 * z, z) for x in (-0.024, 0.024)] for z in (-0.03, 0.13)], (0, 1, 0))
    car.part("Slot", brake, slot, "Plastic black")


# ---- seats -----------------------------------------------------------------------------------------------

SEAT_PIVOT = (0.44, -0.15)  # y, z of the hinge between cushion and back
# Sections of the cushion: z, the top's height, how far the bolsters rise above it, the lower edge, how much narrower.
CUSHION = ((-0.20, 0.44, 0.02, 0.335, 0.0), (0.0, 0.455, 0.052, 0.335, 0.0), (0.20, 0.485, 0.045, 0.345, 0.0),
           (0.33, 0.50, 0.018, 0.37, 0.012), (0.365, 0.46, 0.0, 0.40, 0.03))


def seat_cushion():
    rings = []
    for z, top, bolster, low, narrow in CUSHION:
        rings.append(symmetric([(0.145, top, z), (0.20, top + bolster, z), (0.262 - narrow, top - 0.015, z),
                                (0.24 - narrow, low, z)]))
    return crease_columns(loft(rings, 0.5), 8, (0, 7), 1.2)


def cushion_insert():
    profile = []
    tops = [(z, top + bolster / 6) for z, top, bolster, *_ in CUSHION]
    for z, more in ((-0.14, -0.002), (0.125, 0.004), (0.14, -0.003), (0.155, 0.004), (0.30, 0.002)):
        profile.append((z, interpolate(z, tops), more))
    profile += [(0.368, 0.487, 0.002), (0.373, 0.43, -0.01)]
    rows = []
    for z, y, more in profile:
        up = y + 0.015 + more
        rows.append([(-0.146, y - 0.022, z), (-0.128, up, z), (0.128, up, z), (0.146, y - 0.022, z)])
    return at_four_a_metre(sheet(rows, (0, 1, 0)), (1, 0, 0), (0, -0.7, 1))


# Sections of the back: height above the hinge, half the width, the front, how far the bolsters stand out, the rear.
BACK = ((-0.03, 0.215, -0.01, 0.0, -0.075), (0.02, 0.245, 0.0, 0.03, -0.10), (0.20, 0.252, 0.012, 0.065, -0.115),
        (0.40, 0.245, 0.0, 0.055, -0.10), (0.56, 0.215, 0.004, 0.02, -0.085),
        (0.635, 0.175, -0.015, -0.012, -0.07))


def seat_back():
    """About the hinge, upright."""
    rings = []
    for y, width, front, bolster, back in BACK:
        rings.append(symmetric([(min(0.14, width * 0.62), y, front), (width * 0.80, y, front + bolster),
                                (width * 1.04, y, -0.03), (width * 0.78, y, back)]))
    return crease_columns(loft(rings, 0.7, (False, True)), 8, (0, 7), 1.2)


def back_insert():
    fronts = [(y, front + bolster / 6) for y, _, front, bolster, _ in BACK]
    rows = []
    for y, w, more in ((0.04, 0.144, -0.008), (0.20, 0.144, 0.0), (0.325, 0.144, -0.002), (0.335, 0.144, -0.002),
                       (0.46, 0.142, 0.0), (0.575, 0.128, 0.0), (0.605, 0.120, -0.018)):
        z = interpolate(y, fronts)
        out, inner = z + 0.013 + more, 0.88 * w
        rows.append([(-w, y, z - 0.020), (-inner, y, out), (inner, y, out), (w, y, z - 0.020)])
    return at_four_a_metre(sheet(rows, (0, 0, 1)), (1, 0, 0), (0, 1, 0))


# Sections of a headrest: the share of its height, half the width, front and rear.
HEADREST = ((0.0, 0.105, 0.0, -0.05), (0.12, 0.128, 0.018, -0.062), (0.75, 0.128, 0.026, -0.055),
            (1.0, 0.085, 0.005, -0.038))
LOW_HEADREST = ((0.0, 0.125, 0.0, -0.05), (0.6, 0.128, 0.02, -0.05), (1.0, 0.095, 0.005, -0.035))


def headrest(sections, height):
    rings = []
    for t, width, front, back in sections:
        rings.append(symmetric([(width * 0.62, height * t, front), (width, height * t, (front + back) / 2),
                                (width * 0.62, height * t, back)]))
    return loft(rings, 0.7)


def headrest_rods(length=0.10):
    cage = Cage()
    for x in (-0.065, 0.065):
        cage.join(tube([(x, -length, -0.024), (x, 0.08, -0.024)], 0.0085, 4, capped=False, up=(1, 0, 0)))
    return cage


def seat_base():
    """Rails on the floor and the outer cover of the left seat's hinge."""
    rails = Cage()
    for x in (-0.19, 0.19):
        section = ((-0.018, 0.30), (-0.018, 0.335), (0.018, 0.335), (0.018, 0.30))
        rails.join(sheet([[(x + dx, y, z) for dx, y in section] for z in (-0.22, 0.33)], (0, 1, 0)).crease(HARD))
    cover = rounded_box(0.03, 0.10, 0.36, 2.5)
    cover.bend(lambda p: (p.x, p.y + (0.0 if p.y < 0 else 0.03 if p.z < 0 else -0.02), p.z))
    return rails, cover.move(0.255, 0.385, -0.03)


def front_seats(car, interior):
    rails, cover = seat_base()
    parts = {name: car.mesh(cage, name) for name, cage in (
        ("Seat cushion", seat_cushion()), ("Seat cushion insert", cushion_insert()),
        ("Seat back", seat_back()), ("Seat back insert", back_insert()),
        ("Headrest", headrest(HEADREST, 0.175)), ("Headrest rods", headrest_rods()),
        ("Seat rails", rails), ("Seat cover", cover))}
    for side, x in (("left", DRIVER_X), ("right", -DRIVER_X)):
        seat = car.group(f"Front seat {side}", interior, place(x, 0, 0))
        car.part("Rails", seat, parts["Seat rails"], "Steel")
        car.part("Cover", seat, parts["Seat cover"], "Plastic black", None if x > 0 else MIRRORED)
        car.part("Cushion", seat, parts["Seat cushion"], "Seat bolster")
        car.part("Cushion insert", seat, parts["Seat cushion insert"], "Seat cloth")
        back = car.group("Back", seat, place(0, *SEAT_PIVOT, "X", -RECLINE))
        car.part("Shell", back, parts["Seat back"], "Seat bolster")
        car.part("Insert", back, parts["Seat back insert"], "Seat cloth")
        rest = car.group("Headrest", back, place(0, 0.652, -0.03, "X", 8))
        car.part("Pad", rest, parts["Headrest"], "Seat bolster")
        car.part("Rods", rest, parts["Headrest rods"], "Chrome")


# The rear bench is divided 60:40 at SPLIT; its outer places are at +-REAR_X.
SPLIT, REAR_X, BENCH_HALF, REAR_BACK_HALF = 0.17, 0.37, 0.672, 0.57
REAR_PIVOT = (0.49, -0.975)


def bench_dish(x, side):
    """How far the bench lies lower at x: hollows for the outer places, rounded ends."""
    across = (abs(x) - REAR_X) / 0.22
    hollow = math.cos(across * math.pi / 2) if abs(across) < 1 else 0.0
    return 0.018 * (hollow + (1 if side else 0))


# Sections of the bench, along x: the cushion's (z, y), and the back's (y, z) above its hinge.
BENCH_CUSHION = ((-1.13, 0.485), (-0.80, 0.485), (-0.56, 0.520), (-0.475, 0.475), (-0.505, 0.345), (-1.0, 0.345))
BENCH_BACK = ((-0.07, -0.005), (0.22, 0.012), (0.52, -0.005), (0.575, -0.04), (0.565, -0.085), (-0.04, -0.10))


def bench_part(xs, section, hinged):
    rings = []
    for i, x in enumerate(xs):
        end = i in (0, len(xs) - 1)
        low, inset = bench_dish(x, end), 0.012 if end else 0.0
        ring = []
        for k, (a, b) in enumerate(section):
            if k < 3:
                b -= low
            elif hinged or k < 5:
                a -= inset
            ring.append((x, a, b) if hinged else (x, b, a))
        rings.append(ring)
    return loft(rings, 1.5)


def bench_insert(x, half, section, hinged):
    """The cloth of an outer place: a pad let into the bench."""
    first, last = (0.05, 0.49) if hinged else (-0.90, -0.55)
    rows = []
    for t, sunk in ((0.0, 0.012), (0.06, 0.0), (0.5, 0.0), (0.94, 0.0), (1.0, 0.012)):
        a = first + (last - first) * t
        b = interpolate(a, section[:4]) - 0.013
        edge, low, up = half + 0.02, b - 0.016 - sunk, b + 0.012 - sunk
        ring = [(x - edge, low), (x - half, up), (x + half, up), (x + edge, low)]
        rows.append([(px, a, pb) if hinged else (px, pb, a) for px, pb in ring])
    cage = sheet(rows, (0, 0, 1) if hinged else (0, 1, 0))
    return at_four_a_metre(cage, (1, 0, 0), (0, 1, 0) if hinged else (0, 0, 1))


def rear_bench(car, interior):
    group = car.group("Rear bench", interior)
    rest = car.mesh(headrest(LOW_HEADREST, 0.14), "Rear headrest")
    for name, low, high, places in (("40", SPLIT + 0.002, None, (REAR_X,)),
                                    ("60", None, SPLIT - 0.002, (-REAR_X, -0.02))):
        def across(half):
            inner, sign, end = (low, 1, half) if low else (high, -1, -half)
            middle = [-0.02] if sign < 0 else []
            return sorted([inner, inner + sign * 0.04, *middle, sign * REAR_X, end - sign * 0.05, end])
        car.part(f"Cushion {name}", group, bench_part(across(BENCH_HALF), BENCH_CUSHION, False), "Seat bolster")
        back = car.group(f"Back {name}", group, place(0, *REAR_PIVOT, "X", -RECLINE))
        car.part("Shell", back, bench_part(across(REAR_BACK_HALF), BENCH_BACK, True), "Seat bolster")
        outer = places[0]
        car.part(f"Cushion insert {name}", group, bench_insert(outer, 0.14, BENCH_CUSHION, False), "Seat cloth")
        car.part("Insert", back, bench_insert(outer, 0.125, BENCH_BACK, True), "Seat cloth")
        for x in places:
            at = "middle" if abs(x) < 0.1 else "outer"
            car.part(f"Headrest {at}", back, rest, "Seat bolster", place(x, 0.565, -0.035, "X", 8))


BELT_TOP = Vector((0.612, 1.235, -0.221))  # where the webbing leaves the B pillar


def strap(path, half=0.023):
    """Webbing along points (x, y, z), its width along z, towards the cabin."""
    return sheet([[(x, y, z + half), (x, y, z - half)] for x, y, z in path], (-1, 0, 0))


def belt_ring():
    """A flat ring, longer along z, that the webbing runs through, and the bolt above it."""
    loop = [(0, 0.013, 0.036), (0, -0.015, 0.030), (0, -0.015, -0.030), (0, 0.013, -0.036), (0, 0.030, -0.014),
            (0, 0.030, 0.014)]
    rows = []
    for y, z in ((y, z) for _, y, z in loop):
        rows.append([(x, y * k, z * k) for x, k in ((-0.005, 1.0), (-0.005, 0.72), (0.005, 0.72), (0.005, 1.0))])
    cage = grid(rows, closed_rows=True, closed_columns=True).outward()
    return cage.join(cylinder(0.013, 0.022, 6, 2).move(0.004, 0.028, 0)).move(*BELT_TOP)


def seat_belts(car, interior):
    group = car.group("Seat belts", interior)
    x, y, z = BELT_TOP
    webbing = strap([(x + 0.002, y, z), (0.690, 0.96, B_PILLAR), (0.694, 0.90, B_PILLAR), (0.694, 0.46, B_PILLAR)])
    webbing.join(strap([(x - 0.004, y - 0.006, z), (0.640, 0.95, -0.235), (0.652, 0.60, -0.245),
                        (0.655, 0.345, -0.255)]))
    both_sides(car, "Strap", group, webbing, "Belt strap")
    tongue = rounded_box(0.014, 0.075, 0.056, 3, (0.650, 0.62, -0.2445))
    both_sides(car, "Deflector", group, belt_ring().join(tongue), "Plastic black")
    buckle = rounded_box(0.026, 0.10, 0.055, 2.5).turn("X", -15).move(0.108, 0.46, -0.17)
    both_sides(car, "Buckle", group, buckle, "Plastic black")


def rear_belts():
    """From the C pillar over the bench's back, down to its cushion."""
    path = ((0.652, 1.150, -0.925), (0.600, 1.055, -1.075), (0.548, 0.985, -1.162), (0.543, 0.75, -1.055),
            (0.543, 0.535, -0.962))
    return sheet([[(x - 0.022, y, z + dz), (x + 0.022, y, z - dz)] for (x, y, z), dz in
                  zip(path, (0.012, 0.012, 0, 0, 0))], (-0.3, 0.3, 1))


# ---- linings ---------------------------------------------------------------------------------------------


def belt_height(z):
    """The upper edge of the doors' trims and the boot's ledge, just below the windows."""
    return interpolate(-z, ((-0.77, 0.957), (-0.6, 0.980), (0.0, 0.984), (0.9, 0.988), (1.8, 0.998)))


def glass_at_belt(z):
    """x of the side windows' inner side there."""
    return interpolate(-z, ((-0.77, 0.690), (-0.6, 0.722), (-0.45, 0.738), (0.0, 0.750), (1.3, 0.750), (1.6, 0.736),
                            (1.8, 0.680), (1.93, 0.590), (2.01, 0.548), (2.025, 0.552)))


def floor():
    rows = []
    for z, y, tunnel in ((0.93, 0.80, 0.80), (0.915, 0.50, 0.56), (0.74, 0.335, 0.47), (0.38, 0.303, 0.42),
                         (-0.47, 0.30, 0.40), (-0.53, 0.44, 0.44)):
        side = y + 0.07 if z > 0 else 0.37
        rows.append([(-0.69, side, z), (-0.665, y, z), (-0.135, y, z), (-0.09, tunnel, z), (0.09, tunnel, z),
                     (0.135, y, z), (0.665, y, z), (0.69, side, z)])
    return crease_columns(sheet(rows, (0, 1, -0.3)), 8, (2, 3, 4, 5), HARD)


def sill():
    rows = []
    for z in (0.93, 0.03, -0.89):
        rows.append([(0.667, 0.30, z), (0.684, 0.384, z), (0.735, 0.386, z)])
    return crease_columns(sheet(rows, (-1, 1, 0)), 3, (1,), HARD)


def kick_panel():
    rows = [[(x, y, z) for x, z in ((0.690, 0.93), (0.690, 0.83), (0.738, 0.795))] for y in (0.36, 0.95)]
    return sheet(rows, (-1, 0, 0))


def shut_line(y):
    """z of the gap between the doors on the B pillar."""
    return -0.207 - 0.055 * (y - 0.99)


def b_pillar():
    rows = []
    for y, lean in ((0.955, 0), (1.19, 0), (1.35, 0), (1.405, 0.05)):
        z, face = shut_line(y), on_left(shut_line(y), min(y, 1.35), 0.026).x - lean
        rows.append([(face - 0.010, y, z + 0.034), (face - 0.050, y, z + 0.034), (face - 0.050, y, z - 0.034),
                     (face - 0.010, y, z - 0.034)])
    return rows


# The upper pillar trims, across from front to rear, from the belt up: 3 cm inside the body's skin.
PILLARS = {
    "A": ([(0.615, 0.962, 0.842), (0.664, 0.955, 0.715), (0.715, 0.960, 0.650), (0.738, 0.965, 0.635)],
          [(0.563, 1.172, 0.450), (0.586, 1.160, 0.385), (0.622, 1.172, 0.325), (0.642, 1.182, 0.322)],
          [(0.492, 1.358, 0.128), (0.515, 1.345, 0.070), (0.556, 1.345, 0.045), (0.575, 1.345, 0.050)]),
    "B": b_pillar(),
    "C": ([(0.748, 0.965, -0.890), (0.726, 0.965, -0.915), (0.726, 0.965, -0.995), (0.748, 0.965, -1.020)],
          [(0.690, 1.190, -0.845), (0.668, 1.190, -0.865), (0.668, 1.190, -0.935), (0.690, 1.190, -0.955)],
          [(0.590, 1.400, -0.765), (0.566, 1.400, -0.790), (0.566, 1.400, -0.875), (0.590, 1.400, -0.900)]),
    "D": ([(0.705, 0.975, -1.745), (0.678, 0.975, -1.800), (0.600, 0.975, -1.895), (0.536, 0.975, -1.985)],
          [(0.652, 1.190, -1.715), (0.625, 1.190, -1.790), (0.570, 1.190, -1.880), (0.530, 1.190, -1.930)],
          [(0.572, 1.375, -1.640), (0.547, 1.382, -1.730), (0.503, 1.390, -1.810), (0.484, 1.390, -1.848)])}
SHELL = 0.003  # the trims' thickness


def pillar(name):
    cage = sheet(PILLARS[name], (-1, 0, 0))
    return thickened(crease_columns(cage, 4, (1, 2), 3 if name == "B" else 1), SHELL)


def b_pillar_lower():
    rows = []
    for y, x in ((0.965, 0.728), (0.92, 0.704), (0.375, 0.700)):
        rows.append([(x + 0.03, y, B_PILLAR + 0.048), (x, y, B_PILLAR + 0.044), (x, y, B_PILLAR - 0.044),
                     (x + 0.03, y, B_PILLAR - 0.048)])
    return thickened(crease_columns(sheet(rows, (-1, 0, 0)), 4, (1, 2), 1.5), SHELL)


def linings(car, interior):
    group = car.group("Linings", interior)
    car.part("Carpet", group, floor(), "Carpet")
    both_sides(car, "Sill trim", group, thickened(sill(), SHELL), "Plastic grain")
    both_sides(car, "Kick panel", group, thickened(kick_panel(), SHELL), "Plastic grey")
    for name in PILLARS:
        both_sides(car, f"{name} pillar trim", group, pillar(name), "Headliner")
    both_sides(car, "B pillar lower trim", group, b_pillar_lower(), "Plastic grey")


# ---- jambs: what the doors and the tailgate close on --------------------------------------------------------

# Round the opening of a side's two doors, down from the A pillar's foot: the opening's edge (z, y), the trims' edge.
JAMB = (((0.805, 0.922), (0.735, 0.930, 0.790)), ((0.845, 0.800), (0.735, 0.800, 0.795)),
        ((0.850, 0.560), (0.735, 0.560, 0.795)), ((0.838, 0.300), (0.735, 0.400, 0.795)),
        ((0.800, 0.252), (0.735, 0.386, 0.760)), ((-0.200, 0.252), (0.735, 0.386, -0.200)),
        ((-0.800, 0.252), (0.735, 0.386, -0.820)), ((-0.842, 0.300), (0.745, 0.400, -0.880)),
        ((-0.850, 0.500), (0.745, 0.520, -0.880)), ((-0.900, 0.630), (0.745, 0.630, -0.880)),
        ((-0.953, 0.760), (0.745, 0.760, -0.880)), ((-0.957, 0.900), (0.745, 0.900, -0.885)),
        ((-0.938, 1.030), (0.733, 1.030, -0.878)), ((-0.885, 1.210), (0.685, 1.210, -0.842)),
        ((-0.838, 1.350), (0.612, 1.345, -0.790)), ((-0.720, 1.386), (0.612, 1.350, -0.700)),
        ((-0.450, 1.392), (0.604, 1.350, -0.450)), ((-0.200, 1.392), (0.590, 1.350, -0.200)),
        ((0.020, 1.382), (0.574, 1.346, 0.040)), ((0.100, 1.346), (0.586, 1.320, 0.092)),
        ((0.350, 1.190), (0.649, 1.165, 0.347)), ((0.600, 1.033), (0.714, 1.020, 0.556)),
        ((0.712, 0.965), (0.738, 0.955, 0.660)), ((0.770, 0.945), (0.735, 0.945, 0.750)))


def door_jamb():
    rows = []
    for i, (edge, inner) in enumerate(JAMB):
        edge = Vector(edge)
        along = (Vector(JAMB[(i + 1) % len(JAMB)][0]) - Vector(JAMB[i - 1][0])).normalized()
        out = edge + 0.008 * Vector((-along.y, along.x))
        rows.append([on_left(*out, 0.014), on_left(*edge, 0.034), inner])
    return crease_around(grid(rows, closed_rows=True), 3, (1,), 2)


def b_post(lower):
    """The closed post behind the gap between the doors, from the sill to the belt or from there to the roof."""
    rings = []
    heights = (0.30, 0.60, 0.80, 0.85, 0.90, 0.965) if lower else (0.955, 0.985, 1.10, 1.20, 1.30, 1.385)
    for y in heights:
        z = B_PILLAR if lower else shut_line(y)
        half = 0.049 if lower or y < 0.96 else 0.029
        face = on_left(z, y, 0.026).x
        inner = 0.706 if lower else face - 0.032
        rings.append([(face, y, z + half), (face, y, z - half), (inner, y, z - half), (inner, y, z + half)])
    return crease_columns(loft(rings, HARD), 4, (0, 1, 2, 3), HARD)


def tail_jamb():
    """Round the tailgate's opening, from the skin past the lamps to the boot's lining and the headlining."""
    half = []
    for x, y, deep in ((0.532, 0.604, 0.035), (0.545, 0.630, 0.045), (0.550, 0.67, 0.045), (0.565, 0.80, 0.045),
                       (0.572, 0.90, 0.045), (0.572, 1.00, 0.045), (0.563, 1.06, 0.040), (0.538, 1.20, 0.026),
                       (0.517, 1.31, 0.026), (0.509, 1.345, 0.026)):
        z = on_tail(x, y, 0).z
        half.append([on_tail(x + 0.010, y, 0.006), on_tail(x - 0.014, y, 0.0275), (x - deep, y, z + 0.046),
                     (x - deep + (0.0 if y < 1.03 else 0.010), y, z + 0.064)])
    # Its lip lies behind the lid's edge, along the skin: the gap is not to be seen through.
    for x, y, inward in ((0.487, 1.384, 0.009), (0.458, 1.401, 0.005), (0.43, 1.406, 0), (0.30, 1.406, 0),
                         (0, 1.406, 0)):
        z = on_tail(x, y, 0).z
        half.append([on_tail(x + inward, y + 0.006, 0.006), on_tail(x - inward, y - 0.013, 0.0275),
                     (x - 2.6 * inward, y - 0.030, z + 0.048), (x - 2.4 * inward, y - 0.033, z + 0.067)])
    rows = half + [[(-x, y, z) for x, y, z in row] for row in reversed(half[:-1])]
    cage = crease_columns(grid(rows), 4, (2,), HARD)
    cage.mesh.faces.ensure_lookup_table()
    cage.mesh.normal_update()
    return cage if cage.mesh.faces[0].normal.x < 0 else cage.flip()


def two_sided(cage):
    """With its mirror image."""
    return cage.join(cage.mirrored())


def jambs(car, interior):
    group = car.group("Jambs", interior)
    car.part("Door jambs", group, two_sided(thickened(door_jamb(), 0.002)), "Plastic black")
    car.part("B posts, upper", group, two_sided(b_post(False)), "Piano black")
    car.part("B posts, lower", group, two_sided(b_post(True)), "Plastic black")
    car.part("Tailgate jamb", group, thickened(tail_jamb(), 0.002), "Plastic black")
    car.part("Quarter window seals", group, two_sided(seal(QUARTER_WINDOW, on_left)), "Rubber")
    wells, cups = Cage(), Cage()
    for _, x in VENTS:
        wells.join(vent_well().transform(vent_place(x)))
    for z in CUPS:
        cups.join(cup_well().transform(place(0, on_console(z), z, "X", -console_slope(z))))
    car.part("Vent wells", named(car, "Dashboard"), wells, "Piano black")
    car.part("Cup wells", named(car, "Centre console"), cups, "Plastic black")
    car.part("Rear belts", named(car, "Seat belts"), two_sided(rear_belts()), "Belt strap")


def named(car, name):
    return next(node["id"] for node in car.nodes if node["name"] == name)


# The headlining's left half from the side inward, from the windscreen to the tailgate.
HEADLINING = ([(0.512, 1.336, 0.118), (0.41, 1.345, 0.188), (0.20, 1.352, 0.272)],
              [(0.570, 1.350, 0.030), (0.46, 1.398, 0.040), (0.20, 1.432, 0.050)],
              [(0.612, 1.352, -0.80), (0.50, 1.427, -0.80), (0.22, 1.462, -0.80)],
              [(0.596, 1.340, -1.69), (0.49, 1.396, -1.74), (0.22, 1.428, -1.77)],
              [(0.488, 1.370, -1.853), (0.40, 1.381, -1.878), (0.20, 1.387, -1.913)])


def headlining():
    return sheet([symmetric(half) for half in HEADLINING], (0, -1, 0))


def grab_handle():
    """It hangs from the headlining, leaning inward."""
    path = [(0.006, 0.012, 0.098), (-0.016, -0.024, 0.094), (-0.022, -0.034, 0.070), (-0.022, -0.034, -0.070),
            (-0.016, -0.024, -0.094), (0.006, 0.012, -0.098)]
    return tube(path, 0.010, 4, capped=False, up=(1, 0, 0))


def roof_lining(car, interior):
    group = car.group("Roof lining", interior)
    car.part("Headlining", group, headlining(), "Headliner")
    visor = car.mesh(rounded_box(0.33, 0.018, 0.15), "Sun visor")
    for name, x in (("left", 0.277), ("right", -0.277)):
        car.part(f"Sun visor {name}", group, visor, "Headliner", place(x, 1.374, 0.095, "X", 17))
    lamp = rounded_box(0.15, 0.036, 0.12, 3).turn("X", 20).move(0, 1.402, 0.11)
    car.part("Reading lamp", group, lamp, "Plastic grey")
    handle = car.mesh(grab_handle(), "Grab handle")
    for name, x, z in (("front right", -0.540, -0.09), ("rear left", 0.556, -0.56), ("rear right", -0.556, -0.56)):
        car.part(f"Grab handle {name}", group, handle, "Plastic grey",
                 place(x, 1.386, z) @ (Matrix.Identity(4) if x > 0 else MIRRORED))


MIRROR_AT = Vector((0, 1.312, 0.245))  # 5 cm clear of the windscreen
TAILGATE_GLASS = Vector((0, 1.19, -2.08))


def mirror(car, interior):
    """The inner mirror halves the angle between the driver's eye and the tailgate's window."""
    aim = (EYE - MIRROR_AT).normalized() + (TAILGATE_GLASS - MIRROR_AT).normalized()
    group = car.group("Interior mirror", interior, facing(MIRROR_AT, aim))
    housing = rounded_box(0.274, 0.088, 0.034, 2.5, (0, 0, -0.0185))
    car.part("Housing", group, housing, "Plastic black")
    car.part("Interior mirror glass", group, rectangle(0.24, 0.06), "Mirror")
    stem = tube([(0.004, 0.01, -0.025), (-0.005, 0.06, -0.048)], 0.009, 4, capped=False)
    car.part("Stem", group, stem, "Plastic black")


# ---- boot ------------------------------------------------------------------------------------------------


def boot_side():
    """Carpet from the rear door to the tail, over the wheel house, up to the ledge below the window."""
    rows = []
    for z, wheel, out in ((-0.880, 0.0, 0.745), (-0.910, 0.0, 0.700), (-0.925, 0.115, 0.700), (-1.00, 0.129, 0.700),
                          (-1.675, 0.131, 0.693), (-1.755, 0.01, 0.683), (-1.83, 0.0, 0.628), (-1.93, 0.0, 0.540),
                          (-2.00, 0.0, 0.531), (-2.03, 0.0, 0.531)):
        top = max(z, -2.002)  # the lamp leans forward there
        rows.append([(out - wheel, 0.36 if z > -1 else 0.595, z), (out - wheel, 0.745, z), (out, 0.81, (z + top) / 2),
                     (out + 0.008, 0.92, top + (0.004 if z < -2.02 else 0.012 if z < -1.99 else 0))])
    return thickened(crease_columns(sheet(rows, (-1, 0.3, 0)), 4, (1,), 1), SHELL)


def boot_ledge():
    rows = []
    for z, inner in ((-0.885, 0.690), (-1.58, 0.683), (-1.83, 0.616), (-1.93, 0.550), (-1.955, 0.542), (-1.968, 0.541)):
        y, out = belt_height(z), glass_at_belt(z)
        if not rows:
            rows.append([(out, y - dy, z + 0.004) for dy in (0.004, 0.0, 0.02, 0.11)])
        rows.append([(out, y - 0.004, z), (inner + 0.012, y, z), (inner, y - 0.02, z), (inner + 0.003, y - 0.11, z)])
    return thickened(crease_columns(sheet(rows, (-1, 0.5, 0)), 4, (1,), 1.5), SHELL)


def boot_sill():
    rows = []
    for x in (-0.545, -0.50, -0.25, 0.0, 0.25, 0.50, 0.545):
        z = on_tail(x, 0.612, 0).z
        rows.append([(x, 0.598, z + 0.006), (x, 0.616, z + 0.010), (x, 0.618, z + 0.10), (x, 0.598, z + 0.115)])
    return crease_columns(sheet(rows, (0, 1, 0)), 4, (1, 2), 3)


def boot(car, interior):
    group = car.group("Boot", interior)
    floor_rows = [[(-x, 0.60, z), (x, 0.60, z)] for x, z in ((0.70, -1.06), (0.70, -1.95), (0.56, -2.06))]
    car.part("Floor", group, sheet(floor_rows, (0, 1, 0)), "Boot carpet")
    both_sides(car, "Side lining", group, boot_side(), "Boot carpet")
    both_sides(car, "Side ledge", group, boot_ledge(), "Plastic grey")
    car.part("Sill cover", group, boot_sill(), "Plastic grain")
    cover = cylinder(0.034 * rim(6), 1.36, 6).move(0, 0.925, -1.245)
    cover.join(*(box(0.05, 0.090, 0.10).move(x, 0.925, -1.245) for x in (-0.678, 0.678)))
    car.part("Luggage cover", group, cover, "Plastic grain")


# ---- door trims ------------------------------------------------------------------------------------------


def trim_sheet(places, profile):
    """A sheet along a door, its profile a function of z; its ends are turned out towards the door."""
    rows = []
    for i, z in enumerate(places):
        out = 0.04 if i in (0, len(places) - 1) else 0.0
        points = profile(z)
        edge = max(x for x, _ in points)
        rows.append([(min(edge, x + out), y, z) for x, y in points])
    return crease_rows(sheet(rows, (-1, 0, 0)), len(points), (1, len(places) - 2), HARD)


def trim_rail(places):
    """The upper part, up to the window."""
    def profile(z):
        y, x = belt_height(z), glass_at_belt(z)
        return (x, y), (0.5 * (x + 0.69), y), (0.682, y - 0.022), (0.681, y - 0.10), (0.698, y - 0.107)
    return crease_columns(trim_sheet(places, profile), 5, (3,), HARD)


def trim_panel(places):
    cage = trim_sheet(places, lambda z: ((0.690, 0.885), (0.693, 0.55), (0.698, 0.392), (0.735, 0.390)))
    return crease_columns(cage, 4, (2,), HARD)


def trim_insert(front, back):
    rows = []
    for z in (front, back):
        rows.append([(0.702, 0.868, z), (0.684, 0.858, z), (0.686, 0.762, z), (0.702, 0.75, z)])
    cage = crease_columns(sheet(rows, (-1, 0, 0)), 4, (1, 2), 2)
    return at_four_a_metre(cage, (0, 0, 1), (0, 1, 0))


def armrest(front, back):
    rings = []
    for t, inner, top in ((0.0, 0.670, 0.732), (0.2, 0.636, 0.722), (1.0, 0.660, 0.712)):
        z = front + (back - front) * t
        rings.append([(0.705, top, z), (inner, top, z), (inner + 0.006, top - 0.045, z), (0.705, top - 0.075, z)])
    return crease_columns(loft(rings, 1.5), 4, (1,), 1)


def speaker():
    cage = lathe([(0.06, 0.01), (0.075, 0.0)], 8)
    cap(cage, list(cage.mesh.verts)[0::2])
    return cage.crease(2).outward().turn("Y", 180)


# Round a door's card and its sheet, down from its front: (y, z) of the card's edge, (z, y) of where the liner is met.
CARD_EDGES = {
    "Front": (((0.935, 0.768), (0.772, 0.922)), ((0.90, 0.768), (0.800, 0.895)), ((0.85, 0.768), (0.816, 0.85)),
              ((0.80, 0.768), (0.822, 0.80)), ((0.56, 0.768), (0.826, 0.56)), ((0.40, 0.768), (0.820, 0.31)),
              ((0.39, 0.760), (0.800, 0.277)), ((0.39, 0.30), (0.300, 0.277)), ((0.39, -0.150), (-0.150, 0.277)),
              ((0.40, -0.160), (-0.161, 0.30)), ((0.56, -0.160), (-0.161, 0.56)), ((0.80, -0.160), (-0.161, 0.80)),
              ((0.85, -0.160), (-0.161, 0.85)), ((0.90, -0.160), (-0.161, 0.90)), ((0.98, -0.160), (-0.161, 0.975))),
    "Rear": (((0.98, -0.270), (-0.269, 0.975)), ((0.90, -0.270), (-0.269, 0.90)), ((0.85, -0.270), (-0.269, 0.85)),
             ((0.80, -0.270), (-0.269, 0.80)), ((0.56, -0.270), (-0.269, 0.56)), ((0.40, -0.270), (-0.269, 0.30)),
             ((0.39, -0.280), (-0.280, 0.277)), ((0.39, -0.55), (-0.550, 0.277)), ((0.39, -0.800), (-0.800, 0.277)),
             ((0.40, -0.839), (-0.818, 0.31)), ((0.52, -0.839), (-0.830, 0.52)), ((0.63, -0.839), (-0.880, 0.65)),
             ((0.76, -0.839), (-0.930, 0.78)), ((0.85, -0.839), (-0.930, 0.85)), ((0.90, -0.839), (-0.930, 0.90)),
             ((0.98, -0.839), (-0.925, 0.975)))}


def door_return(row):
    """Closes the door between its card and its sheet, all round but for the window's slot."""
    rows = []
    for (y, z), (far_z, far_y) in CARD_EDGES[row]:
        edge = 0.728 if y < 0.93 else min(0.745, glass_at_belt(z) - 0.002)
        rows.append([(edge, y, z), on_left(far_z, far_y, 0.0205)])
    return grid(rows).crease(2)


def door_trims(car, doors):
    """`doors`: the door's node and its hinge, by "Front left" and so on."""
    car.numbered_from(FIRST_DOOR_ID)
    meshes = {}
    for row, places in (("Front", (0.768, 0.756, 0.56, B_PILLAR + 0.068, B_PILLAR + 0.056)),
                        ("Rear", (B_PILLAR - 0.056, B_PILLAR - 0.068, -0.828, -0.840))):
        front, back = places[0], places[-1]
        ends = places[:2] + places[-2:]
        inside = 0.32 if row == "Front" else 0.10  # clear of the dashboard
        cages = {"Rail": trim_rail(places), "Panel": trim_panel(ends),
                 "Insert": trim_insert(front - inside, back + 0.05), "Armrest": armrest(front - inside, back + 0.08),
                 "Handle": rounded_box(0.016, 0.026, 0.10, 2.5, (0.680, 0.81, front - inside - 0.08))}
        meshes[row] = {name: car.mesh(cage, f"{row} door {name.lower()}") for name, cage in cages.items()}
    meshes["Front"]["Speaker"] = car.mesh(speaker().move(0.697, 0.475, 0.60), "Door speaker")
    materials = {"Rail": "Plastic grain", "Panel": "Plastic grey", "Insert": "Seat cloth", "Armrest": "Seat bolster",
                 "Handle": "Chrome", "Speaker": "Plastic black"}
    groups = {}
    for name, (door, hinge) in doors.items():
        row, side = name.split()
        to_hinge = Matrix.Translation(-Vector(hinge)) @ (MIRRORED if side == "right" else Matrix.Identity(4))
        groups[name] = car.group("Trim", door, to_hinge)
        for part, mesh in meshes[row].items():
            car.part(part, groups[name], mesh, materials[part])
    returns = {row: car.mesh(door_return(row), f"{row} door return") for row in CARD_EDGES}
    seals = {row: car.mesh(seal(window, on_left), f"{row} door seal")
             for row, window in (("Front", FRONT_WINDOW), ("Rear", REAR_WINDOW))}
    for name, group in groups.items():
        car.part("Return", group, returns[name.split()[0]], "Plastic black")
        car.part("Seal", group, seals[name.split()[0]], "Rubber")
    refine(car, FIRST_DOOR_ID)


# ---- tailgate --------------------------------------------------------------------------------------------


def tail(x, y, inside):
    """z of a place this far within the tailgate's skin, which bends forward towards its sides."""
    middle = interpolate(y, ((0.65, -2.148), (0.98, -2.106), (1.10, -2.083), (1.20, -2.058), (1.30, -2.020),
                             (1.40, -1.970)))
    bend = interpolate(y, ((0.8, 0.035), (0.98, 0.041), (1.1, 0.063), (1.2, 0.075), (1.3, 0.095)))
    return middle + bend * (abs(x) / 0.5) ** 4 + inside


def tailgate_lining():
    """The panel below the window, and the frame around it."""
    rows = []
    for y, half, inside in ((1.030, 0.52, 0.026), (1.000, 0.53, 0.048), (0.66, 0.515, 0.050), (0.634, 0.510, 0.034)):
        places = ((-half, inside - 0.02), (-0.8 * half, inside), (0.8 * half, inside), (half, inside - 0.02))
        rows.append([(x, y, tail(x, y, depth)) for x, depth in places])
    lower = crease_columns(crease_rows(sheet(rows, (0, 0, 1)), 4, (1, 2), 2), 4, (1, 2), 2)
    rows = []
    for point, normal in rounded(REAR_WINDOW_PANE):
        wide = interpolate(point.y, ((1.05, 0.030), (1.20, 0.052), (1.33, 0.032)))
        rows.append([on_tail(*(point + out * normal), depth)
                     for out, depth in ((-0.013, 0.010), (-0.010, 0.030), (0.4 * wide, 0.044), (wide, 0.024))])
    frame = grid(rows, closed_rows=True)
    frame.mesh.normal_update()
    if sum(f.normal.z for f in frame.mesh.faces) < 0:
        frame.flip()
    return lower, frame


def tailgate_trim(car, lid, hinge):
    """The lining of the tailgate, under its node, whose origin is at `hinge`."""
    car.numbered_from(LAST_ID - 4)
    lower, frame = tailgate_lining()
    group = car.group("Trim", lid, Matrix.Translation(-Vector(hinge)))
    car.part("Panel", group, lower, "Plastic grey")
    car.part("Window frame", group, frame, "Plastic grey")
    refine(car, LAST_ID - 4)
