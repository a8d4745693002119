"""The body: panels cut out of the skin, and what is fixed to them."""

import math

from mathutils import Matrix, Vector

from authoring import FINE, HARD, Cage, box, cap, grid, thickened, tube
from body_skin import R0, UPPER as ROWS, body_skin, lower_point, upper_point

FAR = 3.0  # beyond the car, in an outline
AXLES = {"Front": 1.28, "Rear": -1.28}
AXLE_Y, ARCH = 0.312, 0.356
WAIST = 0.972  # the doors' panels end and their window frames begin
SIDES = (("left", 1), ("right", -1))

FRONT_DOOR = [(0.835, 0.252, 0.05), (0.850, 0.560, 0.60), (0.800, 0.925, 0.10), (0.712, 0.962, 0.06),
              (0.040, 1.384, 0.14), (-0.232, 1.392, 0.012), (-0.196, 0.252, 0.05)]
FRONT_WINDOW = [(0.612, 0.992, 0.02), (0.058, 1.343, 0.09), (-0.194, 1.350, 0.012), (-0.180, 0.992, 0.012)]
REAR_DOOR = [(-0.120, 0.252, 0.01), (-0.120, 1.392, 0.01), (-0.700, 1.392, 0.3), (-0.836, 1.372, 0.07),
             (-0.955, 0.985, 0.12), (-0.962, 0.760, 0.16), (-0.850, 0.520, 0.30), (-0.842, 0.252, 0.05)]
REAR_WINDOW = [(-0.234, 0.992, 0.012), (-0.258, 1.350, 0.012), (-0.700, 1.350, 0.3), (-0.800, 1.335, 0.06),
               (-0.906, 1.000, 0.05)]
QUARTER_TRIM = [(-0.800, 0.974, 0), (-0.800, 1.376, 0), (-1.200, 1.378, 0.4), (-1.700, 1.366, 0.06),
                (-1.815, 1.010, 0.06), (-1.760, 0.984, 0.05)]
QUARTER_WINDOW = [(-0.998, 1.004, 0.03), (-0.897, 1.346, 0.04), (-1.200, 1.348, 0.4), (-1.680, 1.338, 0.06),
                  (-1.780, 1.018, 0.05), (-1.740, 1.008, 0.04)]
HEADLAMP = [(0.395, 0.672, 0.025), (0.415, 0.756, 0.025), (0.600, 0.802, 0.15), (0.765, 0.840, 0.03),
            (0.812, 0.800, 0.04), (0.790, 0.700, 0.06), (0.590, 0.650, 0.15)]
TAIL_LAMP = [(0.560, 0.690, 0.03), (0.560, 1.030, 0.03), (0.900, 1.045, 0), (0.900, 0.680, 0)]  # from behind
TAIL_LAMP_SIDE = [(-FAR, 0.600, 0), (-1.835, 0.690, 0.05), (-1.790, 0.860, 0.25), (-1.900, 1.080, 0), (-FAR, 1.080, 0)]


def both(half):
    """An outline in a view from front, rear or top from its right half (first coordinate above 0), front to back."""
    return half + [(-a, b, r) for a, b, r in reversed(half)]


WINDSCREEN_BAND = both([(0.350, 0.990, 0.8), (0.686, 0.976, 0.05), (0.530, 1.404, 0.08), (0.250, 1.419, 1.0)])
WINDSCREEN = both([(0.350, 1.010, 0.8), (0.664, 0.996, 0.05), (0.512, 1.388, 0.07), (0.250, 1.402, 1.0)])
BONNET = both([(0.300, 1.048, 0.6), (0.560, 0.975, 0.3), (0.705, 0.880, 0.03), (0.716, 1.150, 1.0),
               (0.690, 1.440, 0.8), (0.615, 1.680, 0.30), (0.500, 1.812, 0.15), (0.250, 1.893, 0.6)])
COWL = both([(0.700, 0.780, 0.0), (0.700, 1.150, 0.0)])
GRILLE = both([(0.345, 0.636, 0.035), (0.374, 0.752, 0.028)])
INTAKE = both([(0.500, 0.265, 0.03), (0.430, 0.385, 0.05)])
FOG_LAMP = [(0.560, 0.290, 0.035), (0.575, 0.390, 0.045), (0.690, 0.390, 0.045), (0.690, 0.300, 0.035)]
ROOF = both([(0.488, 0.050, 0.05), (0.500, -0.800, 3.0), (0.488, -1.805, 0.05)])
TAILGATE = both([(0.545, 0.622, 0.05), (0.572, 0.860, 0.3), (0.572, 1.010, 0.3), (0.500, 1.406, 0.08)])
REAR_WINDOW_BAND = both([(0.512, 1.002, 0.06), (0.460, 1.370, 0.07), (0.250, 1.380, 1.0)])
REAR_WINDOW_PANE = both([(0.490, 1.022, 0.05), (0.440, 1.352, 0.06), (0.250, 1.362, 1.0)])
PLATE_RECESS = both([(0.275, 0.668, 0.02), (0.275, 0.790, 0.02)])


def arch(axle, radius=ARCH):
    z = AXLES[axle]
    return [(z - radius, -FAR, 0), (z - radius, AXLE_Y + radius, radius), (z + radius, AXLE_Y + radius, radius),
            (z + radius, -FAR, 0)]


def mirrored(outline):
    return [(-a, b, r) for a, b, r in outline]


def above(y):
    return [(-FAR, y, 0), (FAR, y, 0), (FAR, FAR, 0), (-FAR, FAR, 0)]


def band(low, high):
    return [(-FAR, low, 0), (FAR, low, 0), (FAR, high, 0), (-FAR, high, 0)]


def cut_skin(car):
    """The cuts, each taking what the ones before it left."""
    skin = car.skin(body_skin(), "Body skin")

    def cut(name, *within, gap=0.0045, detail=0):
        car.cut(skin, name, *within, gap=gap, detail=detail)

    for axle in AXLES:
        cut(f"{axle} wheel arches", ("sides", arch(axle)), gap=0)
    cut("Windscreen", ("front", WINDSCREEN), gap=0.003)
    cut("Windscreen band", ("front", WINDSCREEN_BAND), gap=0.002, detail=FINE)
    cut("Rear window", ("rear", REAR_WINDOW_PANE), gap=0.003)
    cut("Rear window band", ("rear", REAR_WINDOW_BAND), gap=0.002, detail=FINE)
    cut("Plate recess", ("rear", PLATE_RECESS), gap=0.002, detail=FINE)
    cut("Grille", ("front", GRILLE), gap=0)
    cut("Intake", ("front", INTAKE), gap=0)
    for side, sign in SIDES:
        turned = (lambda o: o) if sign > 0 else mirrored
        cut(f"Front window {side}", (side, FRONT_WINDOW), gap=0.003)
        cut(f"Rear window {side}", (side, REAR_WINDOW), gap=0.003)
        cut(f"Quarter window {side}", (side, QUARTER_WINDOW), gap=0.003)
        for name, outline in (("Front", FRONT_DOOR), ("Rear", REAR_DOOR)):
            cut(f"{name} door frame {side}", (side, outline), (side, above(WAIST)), gap=0.004, detail=FINE)
            cut(f"{name} door {side}", (side, outline))
        cut(f"Quarter trim {side}", (side, QUARTER_TRIM), gap=0.002, detail=FINE)
        cut(f"Fog lamp {side}", ("front", turned(FOG_LAMP)), gap=0)
    cut("Fuel flap", ("right", [(-1.64, 0.735, 0.04), (-1.64, 0.875, 0.04), (-1.49, 0.875, 0.04), (-1.49, 0.735, 0.04)]),
        gap=0.003, detail=FINE)
    cut("Bonnet", ("top", BONNET), ("front", above(0.70)))
    for side, sign in SIDES:
        turned = (lambda o: o) if sign > 0 else mirrored
        cut(f"Headlamp {side}", ("front", turned(HEADLAMP)), gap=0.003)
    cut("Boot lid", ("rear", TAILGATE), ("sides", [(-FAR, 0, 0), (-FAR, FAR, 0), (-1.80, FAR, 0), (-1.80, 0, 0)]))
    for side, sign in SIDES:
        turned = (lambda o: o) if sign > 0 else mirrored
        lamp = ("rear", turned(TAIL_LAMP)), (side, TAIL_LAMP_SIDE)
        cut(f"Rear indicator {side}", *lamp, ("sides", band(0.840, 0.905)), gap=0.002, detail=FINE)
        cut(f"Reversing lamp {side}", *lamp, ("sides", band(0.778, 0.840)), gap=0.002, detail=FINE)
        cut(f"Tail lamp {side}", *lamp, gap=0.003)
    cut("Cowl", ("top", COWL), ("front", above(0.90)), gap=0.003)
    cut("Roof", ("top", ROOF), ("sides", above(1.30)), gap=0.006)
    for side, sign in SIDES:
        turned = (lambda o: o) if sign > 0 else mirrored
        cut(f"Rear reflector {side}", ("rear", turned([(0.500, 0.440, 0.01), (0.500, 0.472, 0.01), (0.690, 0.478, 0.01),
                                                       (0.690, 0.446, 0.01)])), gap=0.002, detail=FINE)
    cut("Front skirt", ("sides", [(FAR, -FAR, 0), (1.30, -FAR, 0), (1.30, 0.238, 0), (FAR, 0.262, 0)]), gap=0.003)
    cut("Rear skirt", ("sides", [(-FAR, -FAR, 0), (-1.30, -FAR, 0), (-1.30, 0.300, 0), (-1.900, 0.330, 0.3), (-FAR, 0.390, 0)]), gap=0.003)
    cut("Front bumper", ("sides", [(FAR, -FAR, 0), (1.40, -FAR, 0), (1.40, 0.515, 0), (1.640, 0.545, 0.10),
                                   (1.700, 0.740, 0.03), (1.780, 0.800, 0.0), (1.780, FAR, 0), (FAR, FAR, 0)]), gap=0.0035)
    cut("Rear bumper", ("sides", [(-FAR, -FAR, 0), (-1.40, -FAR, 0), (-1.40, 0.560, 0), (-1.700, 0.600, 0.2),
                                  (-FAR, 0.612, 0)]), gap=0.0035)
    for side, _ in SIDES:
        cut(f"Sill {side}", (side, [(1.20, -FAR, 0), (1.20, 0.247, 0), (-1.20, 0.247, 0), (-1.20, -FAR, 0)]), gap=0.003)
        cut(f"Front wing {side}", (side, [(0.700, 0, 0), (0.700, 0.958, 0), (0.815, 0.958, 0), (0.815, FAR, 0), (FAR, FAR, 0),
                                          (FAR, 0, 0)]), gap=0.004)
    return skin


# Where things sit on the skin

def lower_surface(row, column):
    """The lower body's surface at fractional row and column: a bicubic B-spline through the skin's own points."""
    def weights(t):
        k = math.floor(t)
        f = t - k
        return [(k - 1, (1 - f) ** 3 / 6), (k, (3 * f ** 3 - 6 * f ** 2 + 4) / 6),
                (k + 1, (-3 * f ** 3 + 3 * f ** 2 + 3 * f + 1) / 6), (k + 2, f ** 3 / 6)]

    place = Vector()
    for r, a in weights(row):
        for c, b in weights(column):
            x, y, z = lower_point(min(max(r, 0), 7), R0 - abs(R0 - abs(c)))
            place += a * b * Vector((-x if c < 0 or c > R0 else x, y, z))
    return place


def on_skin(fits, columns, rows=(0, 7)):
    """The place of the lower body's left half, and its normal, where fits(place) is least."""
    (c0, c1), (r0, r1) = columns, rows
    best = None
    for step in range(5):
        tries = [(fits(lower_surface(r0 + (r1 - r0) * j / 12, c0 + (c1 - c0) * i / 12)), r0 + (r1 - r0) * j / 12,
                  c0 + (c1 - c0) * i / 12) for i in range(13) for j in range(13)]
        _, row, column = best = min(tries)
        dc, dr = (c1 - c0) / 8, (r1 - r0) / 8
        c0, c1, r0, r1 = column - dc, column + dc, max(0, row - dr), min(7, row + dr)
    _, row, column = best
    place = lower_surface(row, column)
    along = lower_surface(row, column + 0.01) - lower_surface(row, column - 0.01)
    up = lower_surface(row + 0.01, column) - lower_surface(row - 0.01, column)
    return place, up.cross(along).normalized() * -1


def on_front(x, y):
    place, normal = on_skin(lambda p: (p.x - abs(x)) ** 2 + (p.y - y) ** 2, (0, 5.5))
    side = Vector((math.copysign(1, x), 1, 1))
    return place * side, normal * side


def on_side(z, y):
    return on_skin(lambda p: (p.z - z) ** 2 + (p.y - y) ** 2, (4, 16))


def on_rear(x, y):
    place, normal = on_skin(lambda p: (p.x - abs(x)) ** 2 + (p.y - y) ** 2, (14, R0))
    side = Vector((math.copysign(1, x), 1, 1))
    return place * side, normal * side


# Parts that are fixed to the panels

def ring(path, profile):
    """A closed moulding: `profile` is a ring of (outward, forward) about every point of a closed path in the x-y plane."""
    n = len(path)
    rows = []
    for i, p in enumerate(path):
        along = (Vector(path[(i + 1) % n]) - Vector(path[i - 1])).normalized()
        outward = Vector((along.y, -along.x, 0)).normalized()
        rows.append([Vector(p) + a * outward + b * Vector((0, 0, 1)) for a, b in profile])
    return grid(rows, closed_rows=True, closed_columns=True).outward()


def oval(n, width, height, power=3.0):
    """n points of a superellipse in the x-y plane, counter-clockwise."""
    points = []
    for i in range(n):
        a = 2 * math.pi * (i + 0.5) / n
        c, s = math.cos(a), math.sin(a)
        points.append((width / 2 * math.copysign(abs(c) ** (2 / power), c), height / 2 * math.copysign(abs(s) ** (2 / power), s)))
    return points


def rounded(outline, step=math.radians(24)):
    """An outline's corners with their radii as a ring of points, counter-clockwise."""
    points = []
    corners = [Vector(c[:2]) for c in outline]
    for i, (corner, (_, _, radius)) in enumerate(zip(corners, outline)):
        back, on = (corners[i - 1] - corner).normalized(), (corners[(i + 1) % len(corners)] - corner).normalized()
        half = back.angle(on) / 2
        centre = corner + (back + on).normalized() * radius / math.sin(half)
        start = corner + back * radius / math.tan(half) - centre
        bend = math.copysign(math.pi - 2 * half, back.x * on.y - back.y * on.x) * -1
        steps = max(2, round(abs(bend) / step))
        points += [centre + Matrix.Rotation(bend * k / steps, 2) @ start for k in range(steps + 1)]
    area = sum(p.x * q.y - p.y * q.x for p, q in zip(points, points[1:] + points[:1]))
    return [tuple(p) for p in (points if area > 0 else reversed(points))]


def loft(rings, close_front=False, close_back=False):
    """A sheet through rings of equally many points; the first ring is the front."""
    n = len(rings[0])
    cage = grid(rings, closed_columns=True)
    vertices = list(cage.mesh.verts)
    if close_front:
        cap(cage, vertices[:n])
    if close_back:
        cap(cage, vertices[-n:])
    return cage.outward()


def bowl(radius, depth):
    """A lamp's reflector that looks along +z: a thin paraboloid with a hole for the bulb."""
    front = [(radius, 0), (0.72 * radius, -0.5 * depth), (0.15 * radius, -0.98 * depth)]
    back = [(r + 0.002, z - 0.004) for r, z in reversed(front)]
    n = 8
    rings = [[(r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n), z) for k in range(n)]
             for r, z in front + back]
    cage = grid(rings, closed_rows=True, closed_columns=True).outward()
    sharp = [e for e in cage.mesh.edges if all(round(v.co.z, 6) in [round(z, 6) for _, z in (front[0], front[2], back[0], back[2])]
                                               for v in e.verts) and abs(e.verts[0].co.z - e.verts[1].co.z) < 1e-6]
    return cage.crease(HARD, sharp)


def ball(radius):
    """A sphere of six quads, as near as their limit comes."""
    return box(2, 2, 2, 0).scale(1.18 * radius, 1.18 * radius, 1.18 * radius)


def handle():
    """A pull handle along z, its foot points at x = 0."""
    path = [(0, 0, -0.096), (0.022, 0, -0.088), (0.037, 0, -0.060), (0.040, 0, 0), (0.037, 0, 0.060), (0.022, 0, 0.088),
            (0, 0, 0.096)]
    return tube(path, 0.011, 6, up=(0, 1, 0)).scale(1, 1.35, 1)


def mirror_housing():
    """The left outside mirror's housing about its own middle; it opens to the rear (-z)."""
    def at_depth(z, k, dx=0.0):
        return [(0.105 * 2 * x * k + dx, 0.068 * 2 * y * k + (0.010 * x if k > 0.5 else 0), z) for x, y in oval(12, 1, 1, 2.6)]

    cage = loft([at_depth(-0.020, 0.92), at_depth(-0.052, 0.955), at_depth(-0.056, 0.985), at_depth(-0.044, 1.01),
                 at_depth(0.000, 0.985), at_depth(0.034, 0.86), at_depth(0.056, 0.58), at_depth(0.064, 0.26)], close_front=True, close_back=True)
    for depth in (-0.052, -0.056):  # the rim
        cage.crease(HARD, where=lambda p: abs(p.z - depth) < 1e-5)
    return cage


def mirror_glass():
    """A flat pane that looks along -z."""
    outer = [(0.172 * x, 0.112 * y, 0) for x, y in oval(12, 1, 1, 3.2)]
    cage = Cage(outer, [])
    vertices = list(cage.mesh.verts)
    cap(cage, list(reversed(vertices)))
    return cage


def lamp_bucket(outline, depth):
    """The housing behind a lamp's lens: a thin shell that follows the outline, open to the front."""
    points = [Vector(p) for p in rounded(outline, math.radians(40))]
    if len(points) % 2:
        points.pop()
    middle = sum(points, Vector((0, 0))) / len(points)
    rings = []
    for size, back in ((1.005, 0.014), (0.99, 0.5 * depth), (0.96, depth), (0.5, 1.1 * depth)):
        places = [middle + (p - middle) * size for p in points]
        rings.append([Vector((p.x, p.y, on_front(p.x, p.y)[0].z - back)) for p in places])
    cage = grid(rings, closed_columns=True)
    cap(cage, list(cage.mesh.verts)[-len(points):])
    cage.outward()
    cage.mesh.normal_update()
    if sum(f.normal.z * f.calc_area() for f in cage.mesh.faces) < 0:
        cage.flip()
    return thickened(cage, 0.003)


class Sides:
    """Builds left parts and their mirror images: `part` for the left, with x mirrored for the right."""

    def __init__(self, car):
        self.car = car
        self.meshes = {}

    def part(self, name, parent, sign, cage, material, place=(0, 0, 0), turn=None, tolerance=0.2, key=None, detail=None):
        """`cage` makes the left part's cage about its origin; the right one uses it through a mirrored matrix."""
        key = key or cage
        if key not in self.meshes:
            self.meshes[key] = self.car.mesh(cage(), name)
        matrix = Matrix.Translation(place) @ (turn or Matrix())
        if sign < 0:
            matrix = Matrix.Diagonal((-1, 1, 1, 1)) @ matrix
        return self.car.part(name, parent, self.meshes[key], material, None if matrix == Matrix() else matrix,
                             tolerance=tolerance, detail=detail)


# The tree

FRONT_HINGE, REAR_HINGE = Vector((0.828, 0.600, 0.828)), Vector((0.832, 0.600, -0.210))
DRIVERS_EYE = Vector((0.36, 1.17, -0.20))
BONNET_HINGE, TAILGATE_HINGE = Vector((0, 0.968, 0.935)), Vector((0, 1.425, -1.880))


def at(place, sign=1):
    return Matrix.Translation((place[0] * sign, place[1], place[2]))


def add_doors(car, skin, body, sides):
    """The four doors; each hangs in its hinge, the node's own y axis."""
    doors = car.group("Doors", body)
    nodes = {}
    for row, hinge in (("Front", FRONT_HINGE), ("Rear", REAR_HINGE)):
        for side, sign in SIDES:
            door = car.group(f"{row} {side}", doors, at(hinge, sign), hinge=[0, 1, 0, -65 * sign])
            nodes[f"{row} {side}"] = (door, Vector((hinge.x * sign, hinge.y, hinge.z)))
            glass = "Glass clear" if row == "Front" else "Glass tinted"
            car.painted_panel("Panel", door, skin, f"{row} door {side}", 0.022)
            car.panel("Window frame", door, skin, f"{row} door frame {side}", "Piano black", lift=-0.001, thickness=0.022)
            car.pane("Window", door, skin, f"{row} window {side}", glass)
            z = -0.070 if row == "Front" else -0.735
            place, _ = on_side(z, 0.792 if row == "Front" else 0.812)
            local = place - hinge
            sides.part("Handle", door, sign, handle, "Chrome", local)
            if row == "Front":
                add_mirror(car, door, sign, hinge, sides)
    return nodes


def add_mirror(car, door, sign, hinge, sides):
    centre = Vector((0.905, 1.020, 0.590))
    mirror = car.group("Mirror", door, at(centre - hinge, sign))
    tilt = Matrix.Rotation(math.radians(15), 4, "Y")
    car.painted("Housing", mirror, lambda name, parent, paint: sides.part(
        name, parent, sign, mirror_housing, paint, turn=tilt))
    place = Vector((-0.010 * sign, 0, -0.044))
    to_mirror = (Vector((centre.x * sign, centre.y, centre.z)) + place - DRIVERS_EYE).normalized()
    normal = (Vector((0.045 * sign, -0.03, -1)).normalized() - to_mirror).normalized()  # the driver sees along the car
    glass = (at(place) @ Matrix.Rotation(math.atan2(-normal.x, -normal.z), 4, "Y")
             @ Matrix.Rotation(math.asin(normal.y), 4, "X"))
    if "mirror glass" not in sides.meshes:
        sides.meshes["mirror glass"] = car.mesh(mirror_glass(), "Mirror glass")
    car.part("Glass", mirror, sides.meshes["mirror glass"], "Mirror", glass, tolerance=0.15)
    sides.part("Foot", mirror, sign, lambda: tube([(-0.200, -0.048, 0.030), (-0.130, -0.052, 0.022), (-0.075, -0.048, 0.012), (-0.02, -0.03, 0.0)],
                                                  [0.044, 0.034, 0.026, 0.022], 6).bend(lambda p: (p.x, p.y * 0.7 - 0.014, p.z * 1.3)),
               "Black trim", key="mirror foot")


def add_lids(car, skin, body):
    bonnet = car.group("Bonnet", body, at(BONNET_HINGE), hinge=[1, 0, 0, -50])
    car.painted_panel("Panel", bonnet, skin, "Bonnet", 0.018)

    lid = car.group("Boot lid", body, at(TAILGATE_HINGE), hinge=[1, 0, 0, 70])
    car.painted_panel("Panel", lid, skin, "Boot lid", 0.022)
    car.pane("Window", lid, skin, "Rear window", "Glass tinted")
    car.panel("Window band", lid, skin, "Rear window band", "Piano black", lift=-0.002, thickness=0.012)
    car.panel("Plate recess", lid, skin, "Plate recess", "Black trim", lift=-0.018, thickness=0.010)

    def hung(x, y, z):
        return at(Vector((x, y, z)) - TAILGATE_HINGE)

    car.part("Number plate", lid, number_plate(), "Plate rear", hung(0, 0.729, on_rear(0, 0.729)[0].z - 0.001)
             @ Matrix.Rotation(math.pi, 4, "Y"))
    grip = [(x, 0.822 - 0.010 * (x / 0.3) ** 2, on_rear(x, 0.822)[0].z - 0.006) for x in (-0.30, -0.15, 0, 0.15, 0.30)]
    car.part("Handle", lid, tube([Vector(p) - TAILGATE_HINGE for p in grip], 0.015, 6).scale(1, 1, 1), "Chrome")
    car.part("Badge", lid, badge(), "Badge", hung(0, 0.905, on_rear(0, 0.905)[0].z + 0.004) @ Matrix.Rotation(math.pi, 4, "Y")
             @ Matrix.Rotation(math.radians(-6), 4, "X"), tolerance=0.15, detail=0)
    car.painted("Spoiler", lid, lambda name, parent, paint: car.part(
        name, parent, spoiler().move(*(-TAILGATE_HINGE)), paint))
    car.part("High brake lamp", lid, box(0.30, 0.012, 0.010, 3), "Lamp red", hung(0, 1.431, -2.001))
    pivot = rear_window_place(0, 1.010)
    wiper = car.group("Wiper", lid, hung(*pivot))
    car.part("Arm", wiper, tube([Vector((0, 0, 0.010)), Vector((0, 0.001, -0.014)), *(
        rear_window_place(x, y) + Vector((0, 0, -0.014)) - pivot for x, y in ((-0.06, 1.024), (-0.20, 1.055), (-0.30, 1.078)))],
        [0.016, 0.015, 0.010, 0.007, 0.005], 6), "Plastic black", tolerance=0.4)
    car.part("Blade", wiper, tube([rear_window_place(x, y) + Vector((0, 0, -0.007)) - pivot for x, y in (
        (-0.12, 1.036), (-0.20, 1.052), (-0.28, 1.070), (-0.36, 1.090), (-0.42, 1.105))], 0.006, 4), "Rubber")
    return lid


def number_plate():
    """0.52 x 0.11 m, upright, its face along +z."""
    return box(0.52, 0.11, 0.006).texture(lambda p: (p.x / 0.52 + 0.5, p.y / 0.11 + 0.5))


def badge():
    """A round shield of 0.09 m, domed, its face along +z."""
    cage = loft([[(r * math.cos(2 * math.pi * k / 12), r * math.sin(2 * math.pi * k / 12), z) for k in range(12)]
                 for r, z in ((0.022, 0.010), (0.040, 0.007), (0.046, 0.003), (0.046, -0.010))], True, True)
    return cage.crease(3, where=lambda p: abs(p.z - 0.003) < 1e-6).texture(lambda p: (p.x / 0.092 + 0.5, p.y / 0.092 + 0.5))


def spoiler():
    """Goes on from the roof over the rear window."""
    def section(x):
        k = (x / 0.5) ** 2
        top, back = 1.472 - 0.035 * k, -2.030 + 0.050 * k ** 2
        return [(x, top + 0.003, -1.840), (x, top, -1.930), (x, top - 0.016, back), (x, top - 0.030, back + 0.004),
                (x, top - 0.045, -1.960), (x, top - 0.020, -1.850)]

    xs = (-0.475, -0.44, -0.25, 0, 0.25, 0.44, 0.475)
    cage = grid([section(x) for x in xs], closed_columns=True)
    vertices = list(cage.mesh.verts)
    cap(cage, vertices[:6])
    cap(cage, vertices[-6:])
    cage.outward()
    return cage.crease(2.5, where=lambda p: p.z < -1.965)


def add_front(car, body, skin, sides):
    """Grille, intake, fog lamps, plate and badge."""
    front = car.group("Grille", body)
    loop = rounded(GRILLE)
    profile = [(0.008, -0.020), (0.008, 0.002), (0.000, 0.006), (-0.008, 0.000), (-0.008, -0.030)]
    car.part("Frame", front, ring([(x, y, on_front(x, y)[0].z) for x, y in loop], profile), "Chrome", tolerance=0.2)
    columns = (-0.365, -0.24, -0.12, 0, 0.12, 0.24, 0.365)
    mesh = [[(x, y, on_front(x, y)[0].z - 0.050) for x in columns] for y in (0.620, 0.695, 0.765)]
    car.part("Mesh", front, thickened(grid(mesh).flip() if grid_looks_back(mesh) else grid(mesh), 0.004), "Black trim")
    slats = car.group("Slats", front)
    for k, y in enumerate((0.660, 0.682, 0.704, 0.726)):
        rows = []
        for x in columns:
            z = on_front(x, y)[0].z
            rows.append([(x, y + 0.004, z - 0.006), (x, y + 0.005, z - 0.030), (x, y - 0.004, z - 0.032), (x, y - 0.003, z - 0.005)])
        slat = grid(rows, closed_columns=True)
        vertices = list(slat.mesh.verts)
        cap(slat, vertices[:4])
        cap(slat, vertices[-4:])
        car.part(f"Slat {k + 1}", slats, slat.outward().crease(2.5), "Dash silver", tolerance=0.3)
    place, normal = on_front(0, 0.786)
    car.part("Badge", front, badge(), "Badge", at(place + 0.004 * normal) @ Matrix.Rotation(-math.atan2(normal.y, normal.z), 4, "X"), tolerance=0.15, detail=0)

    bumpers = car.group("Bumpers", body)
    for row in ("Front", "Rear"):
        bumper = car.group(row, bumpers)
        car.painted_panel("Cover", bumper, skin, f"{row} bumper")
        car.panel("Skirt", bumper, skin, f"{row} skirt", "Black trim")
        if row == "Rear":
            for side, _ in SIDES:
                car.panel(f"Reflector {side}", bumper, skin, f"Rear reflector {side}", "Lamp red", lift=-0.001, thickness=0.004,
                          edge=0.001)
        if row == "Front":
            columns = (-0.52, -0.36, -0.18, 0, 0.18, 0.36, 0.52)
            mesh = [[(x, y, on_front(x, max(y, 0.25))[0].z - 0.070) for x in columns] for y in (0.250, 0.325, 0.400)]
            car.part("Intake mesh", bumper, thickened(grid(mesh).flip() if grid_looks_back(mesh) else grid(mesh), 0.004), "Black trim")
            for k, y in enumerate((0.300, 0.345)):
                bar = [(x, y, on_front(x, y)[0].z - 0.030) for x in columns]
                car.part(f"Intake bar {k + 1}", bumper, tube(bar, 0.008, 4, up=(0, 1, 0)), "Piano black")
            place, normal = on_front(0, 0.488)
            car.part("Number plate", bumper, number_plate(), "Plate front", at(place + Vector((0, 0, 0.010))))
            car.part("Plate carrier", bumper, box(0.54, 0.13, 0.05), "Plastic black", at(place + Vector((0, 0, -0.018))))
            for side, sign in SIDES:
                place, normal = on_front(0.632, 0.342)
                lamp = car.group(f"Fog lamp {side}", bumper)
                sides.part("Housing", lamp, sign, lambda: lamp_bucket(FOG_LAMP, 0.10), "Black trim", key="fog bucket", tolerance=2)
                turn = Matrix.Rotation(math.radians(12), 4, "Y")
                middle = place + Vector((-0.008, 0.0, -0.042))
                sides.part("Reflector", lamp, sign, lambda: bowl(0.043, 0.04), "Reflector", middle, turn, tolerance=0.08, key="fog bowl")
                sides.part("Lens", lamp, sign, lambda: loft([[(r * math.cos(2 * math.pi * k / 12), r * math.sin(2 * math.pi * k / 12), z) for k in range(12)]
                           for r, z in ((0.020, 0.012), (0.040, 0.006), (0.044, 0.0), (0.044, -0.003), (0.02, -0.003))], True, True), "Lamp glass", middle, turn, key="fog lens")


def grid_looks_back(rows):
    a, b, c = Vector(rows[0][0]), Vector(rows[1][0]), Vector(rows[0][1])
    return (b - a).cross(c - a).z < 0


def add_lamps(car, body, skin, sides):
    lamps = car.group("Lamps", body)
    for side, sign in SIDES:
        lamp = car.group(f"Headlamp {side}", lamps)
        car.panel("Lens", lamp, skin, f"Headlamp {side}", "Lamp glass", lift=-0.001, thickness=0.003, edge=0, layer="outside")
        sides.part("Housing", lamp, sign, lambda: lamp_bucket(HEADLAMP, 0.115), "Piano black", key="headlamp bucket")
        for name, x, y, radius in (("Dipped beam", 0.612, 0.727, 0.056), ("Main beam", 0.490, 0.717, 0.043),
                                   ("Indicator", 0.728, 0.768, 0.031)):
            place, normal = on_front(x, y)
            turn = Matrix.Rotation(math.atan2(normal.x, normal.z) * 0.45, 4, "Y")
            axis = turn @ Vector((0, 0, 1))
            place = place - axis * (0.016 + 0.5 * radius)  # the rim's outer edge is nearest to the slanted lens
            group = car.group(name, lamp)
            sides.part("Reflector", group, sign, lambda radius=radius: bowl(radius, 0.75 * radius), "Reflector", place, turn,
                       tolerance=0.08, key=f"bowl {radius}")
            bulb = "Bulb amber" if name == "Indicator" else "Bulb"
            sides.part("Bulb", group, sign, lambda: ball(0.009).scale(1, 1, 2), bulb, place - axis * 0.4 * radius, turn, key="bulb")
            sides.part("Ring", group, sign, lambda radius=radius: torus(radius * 1.03, 0.004), "Chrome", place, turn,
                       tolerance=0.1, key=f"ring {radius}", detail=FINE)
    for side, sign in SIDES:
        lamp = car.group(f"Tail lamp {side}", lamps)
        car.panel("Lens", lamp, skin, f"Tail lamp {side}", "Lamp red", lift=0.001, thickness=0.003, edge=0, layer="outside")
        car.panel("Indicator lens", lamp, skin, f"Rear indicator {side}", "Lamp amber", lift=0.001, thickness=0.003, edge=0, layer="outside")
        car.panel("Reversing lens", lamp, skin, f"Reversing lamp {side}", "Lamp clear", lift=0.001, thickness=0.003, edge=0, layer="outside")
        for name, cut in (("Housing", "Tail lamp"), ("Indicator housing", "Rear indicator"), ("Reversing housing", "Reversing lamp")):
            car.panel(name, lamp, skin, f"{cut} {side}", "Dash silver", lift=-0.034, thickness=0.004, edge=0)
        for name, y, bulb in (("Brake bulb", 0.965, "Bulb"), ("Indicator bulb", 0.872, "Bulb amber"), ("Reversing bulb", 0.809, "Bulb"), ("Tail bulb", 0.735, "Bulb")):
            place, normal = on_rear(0.655, y)
            turn = Matrix.Rotation(math.pi, 4, "Y") @ Matrix.Rotation(math.radians(-15), 4, "Y")
            place = place + Vector((-0.006, 0, 0.022))
            sides.part(name.replace("bulb", "reflector"), lamp, sign, lambda: bowl(0.030, 0.016), "Reflector", place, turn, key="tail bowl")
            sides.part(name, lamp, sign, lambda: ball(0.009).scale(1, 1, 2), bulb, place + Vector((0, 0, 0.004)), key="bulb")


def torus(radius, thickness, n=10):
    rows = []
    for i in range(n):
        a = 2 * math.pi * i / n
        rows.append([((radius + thickness * math.cos(b)) * math.cos(a), (radius + thickness * math.cos(b)) * math.sin(a),
                      thickness * math.sin(b)) for b in (0, 2 * math.pi / 3, 4 * math.pi / 3)])
    return grid(rows, closed_rows=True, closed_columns=True).outward()


def windscreen_place(x, up):
    """A place on the windscreen, x across and `up` from 0 (base) to 1 (about the mirror's height)."""
    row = up * 2.0
    low = int(row)

    def middle_and_pillar(r):
        if r == 0:
            end = lower_point(7, 8)
            return (1.020, 0.985), (end[0], end[2], end[1])
        _, _, middle, pillar, _ = ROWS[r - 1]
        return middle, pillar

    (z0, y0), p0 = middle_and_pillar(low)
    (z1, y1), p1 = middle_and_pillar(low + 1)
    f = row - low
    z, y = z0 + (z1 - z0) * f, y0 + (y1 - y0) * f
    px, pz, py = (a + (b - a) * f for a, b in zip(p0, p1))
    u = abs(x) / px
    return Vector((x, y + (py - y) * u ** 2, z + (pz - z) * u ** 2.2))


def rear_window_place(x, y):
    """A place on the tailgate's window."""
    def surface(row, u):
        column = R0 - 3 * u
        k = min(int(column), R0 - 1)
        low, high = (Vector(upper_point(int(r), k)).lerp(Vector(upper_point(int(r), k + 1)), column - k)
                     for r in (row, min(row + 1, 4)))
        return low.lerp(high, row - int(row))

    tries = ((surface(r / 20, u / 40) for r in range(0, 61) for u in range(41)))
    place = min(tries, key=lambda p: (p.x - abs(x)) ** 2 + (p.y - y) ** 2)
    return Vector((x, y, place.z))


def add_wipers(car, body):
    wipers = car.group("Wipers", body)
    lift = Vector((0, 0.011, 0.008))
    for name, pivot, near, far in (("Left", 0.555, 0.50, -0.13), ("Right", -0.02, -0.08, -0.58)):
        start = windscreen_place(pivot, 0.03) + Vector((0, -0.006, 0.012))
        wiper = car.group(name, wipers, at(start))
        def along(t):
            return windscreen_place(near + (far - near) * t, 0.13 + 0.06 * math.sin(math.pi * t)) + lift - start
        car.part("Blade", wiper, tube([along(t) for t in (0, 0.25, 0.5, 0.75, 1)], [0.006, 0.009, 0.010, 0.009, 0.006], 4), "Rubber")
        car.part("Arm", wiper, tube([(0, 0, 0), Vector((-0.05, 0.012, 0.002)), along(0.25) + Vector((0, 0.010, 0.006)), along(0.5) + Vector((0, 0.006, 0.004))],
                                    [0.012, 0.009, 0.007, 0.005], 6), "Plastic black", tolerance=0.4)


def add_roof(car, body, skin):
    roof = car.group("Roof", body)
    car.painted_panel("Panel", roof, skin, "Roof")
    rail_cage = None
    for side, sign in SIDES:
        path = []
        for column, lift in ((9, -0.012), (9.12, 0.022), (9.5, 0.036), (11, 0.040), (13, 0.038), (14.4, 0.032), (14.9, 0.018), (15.05, -0.012)):
            k = int(column)
            p, q = Vector(upper_point(4, k)), Vector(upper_point(4, min(k + 1, R0)))
            place = p + (q - p) * (column - k)
            path.append(Vector((place.x - 0.008, place.y + lift - 0.008, place.z)))
        if rail_cage is None:
            rail_cage = car.mesh(tube(path, [0.016, 0.014] + [0.013] * 4 + [0.014, 0.016], 6, up=(0, 1, 0)), "Roof rail")
        car.part(f"Rail {side}", roof, rail_cage, "Alloy", None if sign > 0 else Matrix.Diagonal((-1, 1, 1, 1)))
    fin = loft([[(0.028 * c, 0, 0.085 * s) for c, s in ring16()], [(0.022 * c, 0.018, 0.070 * s - 0.012) for c, s in ring16()],
                [(0.009 * c, 0.045, 0.040 * s - 0.040) for c, s in ring16()], [(0.004 * c, 0.058, 0.020 * s - 0.054) for c, s in ring16()]], True, True)
    car.part("Aerial", roof, fin.crease(HARD, where=lambda p: p.y == 0), "Black trim", at((0, 1.470, -1.560)))


def ring16(n=8):
    return [(math.cos(2 * math.pi * (k + 0.5) / n), math.sin(2 * math.pi * (k + 0.5) / n)) for k in range(n)]


def add(car):
    """The whole body; returns the nodes and hinges of the doors and the boot lid, for what hangs in them from inside."""
    car.numbered_from(100)
    skin = cut_skin(car)
    body = car.group("Body")
    sides = Sides(car)
    doors = add_doors(car, skin, body, sides)
    lid = add_lids(car, skin, body)
    panels = car.group("Panels", body)
    for name in ("Front wing left", "Front wing right", "Sill left", "Sill right"):
        car.painted_panel(name, panels, skin, name)
    car.painted_panel("Side frame", panels, skin, None, 0.025)
    car.painted_panel("Fuel flap", panels, skin, "Fuel flap", 0.008)
    car.panel("Scuttle", panels, skin, "Cowl", "Black trim", lift=-0.004)
    glass = car.group("Windows", body)
    car.pane("Windscreen", glass, skin, "Windscreen", "Glass clear")
    car.panel("Windscreen band", glass, skin, "Windscreen band", "Piano black", lift=-0.002, thickness=0.012)
    for side, _ in SIDES:
        car.pane(f"Quarter window {side}", glass, skin, f"Quarter window {side}", "Glass tinted")
        car.panel(f"Quarter trim {side}", glass, skin, f"Quarter trim {side}", "Piano black", lift=-0.001)
    add_roof(car, body, skin)
    add_front(car, body, skin, sides)
    add_lamps(car, body, skin, sides)
    add_wipers(car, body)
    return doors, (lid, TAILGATE_HINGE)
