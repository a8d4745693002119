"""The mechanical parts: floor and frame, suspension, brakes, exhaust, and the drive train with what stands around it.

Round parts have four or six sides in the cage, which the limit rounds."""

import math

from authoring import FINE, HARD, Cage, box, cap, grid, thickened, tube
from body import lower_surface, on_front, on_side, windscreen_place
from body_skin import lower_point
from mathutils import Matrix, Vector
from wheels import AXLE_Y, AXLES, TRACK_X, stud, turned

FRONT_AXLE, REAR_AXLE = AXLES[0][1], AXLES[1][1]
HIDDEN = 3  # tolerance of parts under the body
ROUND = 0.9  # of round ones that the open bonnet shows
MIRROR = Matrix.Diagonal((-1, 1, 1, 1))
SIDES = (("left", Matrix.Identity(4)), ("right", MIRROR))


# ---- shapes ----------------------------------------------------------------------------------------------


def solid(profile, segments=6, creases=(), ends=(0, 1)):
    """A lathe about x, closed at the profile's ends given: both, where no other part hides one."""
    cage = turned(profile, segments, {0: HARD, len(profile) - 1: HARD, **dict(creases)})
    points, count = list(cage.mesh.verts), len(profile)
    for end in ends:
        cap(cage, points[end * (count - 1)::count])
    return cage.outward()


def along(cage, start, end):
    """Lays a cage's x axis from one point towards another."""
    turn = Vector((1, 0, 0)).rotation_difference(Vector(end) - Vector(start)).to_matrix().to_4x4()
    return cage.transform(Matrix.Translation(start) @ turn)


def pipe(path, radius, sides=4, capped=False):
    """A round pipe whose limit has the given radius; its path is rounded at the points. Without caps its ends stand
    in other parts."""
    grow = 3 / (2 + math.cos(2 * math.pi / sides))
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    return tube(path, [r * grow for r in radii], sides, capped)


def bar(path, width, height, sharpness=HARD, up=(0, 1, 0)):
    """A bar of rectangular section; width and height are numbers, or one for each point of the path."""
    path, up = [Vector(p) for p in path], Vector(up)
    widths, heights = (s if isinstance(s, (list, tuple)) else [s] * len(path) for s in (width, height))
    rows = []
    for i, p in enumerate(path):
        ahead = (path[min(i + 1, len(path) - 1)] - path[max(i - 1, 0)]).normalized()
        across = ahead.cross(up).normalized()
        upward = across.cross(ahead)
        rows.append([p + across * sx * widths[i] / 2 + upward * sy * heights[i] / 2
                     for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1))])
    cage = grid(rows, closed_columns=True)
    points = list(cage.mesh.verts)
    edges = [(points[i], points[i + 4]) for i in range(len(points) - 4)]
    for end in (points[:4], points[-4:]):
        cage.mesh.faces.new(end)
        edges += zip(end, end[1:] + end[:1])
    return cage.crease(sharpness, [cage.mesh.edges.get(pair) for pair in edges]).outward()


def both(cage):
    return cage.join(cage.mirrored())


def joined(*cages):
    return Cage().join(*cages)


def on_both_sides(car, name, parent, cage, material, detail=None):
    mesh = cage if isinstance(cage, int) else car.mesh(cage, name)
    for side, place in SIDES:
        car.part(f"{name} {side}", parent, mesh, material, None if side == "left" else place, HIDDEN, detail)


def place(x, y, z, *more):
    matrix = Matrix.Translation((x, y, z))
    for other in more:
        matrix = matrix @ other
    return matrix


def scaled(x, y, z):
    return Matrix.Diagonal((x, y, z, 1))


# ---- drive train -----------------------------------------------------------------------------------------

ENGINE = (-0.13, 0.47, 1.45)  # the block's middle
CYLINDERS = [-0.13 + 0.09 * k for k in (-1.5, -0.5, 0.5, 1.5)]
PULLEYS = (("Crankshaft pulley", 0.40, 1.45, 0.068), ("Compressor pulley", 0.335, 1.60, 0.045),
           ("Alternator pulley", 0.50, 1.625, 0.030), ("Water pump pulley", 0.56, 1.43, 0.050))
BELT_X = -0.347


def sump():
    def narrower(p):
        return (p.x * (0.98 if p.y > 0 else 0.8), p.y, p.z * (1 if p.y > 0 else 0.72))
    return box(0.38, 0.14, 0.21, 2.5).bend(narrower).move(-0.13, 0.275, 1.45)


def exhaust_manifold():
    collector = Vector((-0.13, 0.50, 1.205))
    pipes = [pipe([(x, 0.66, 1.36), (x + (collector.x - x) * 0.2, 0.645, 1.25), collector + Vector((d, 0, 0))], 0.019)
             for x, d in zip(CYLINDERS, (-0.03, -0.01, 0.01, 0.03))]
    return joined(*pipes)


def belt():
    """Around the outside of the pulleys, three points to each."""
    circles = [[(y + r * math.cos(a), z + r * math.sin(a)) for a in (2 * math.pi * k / 72 for k in range(72))]
               for _, y, z, r in PULLEYS]
    hull = convex(sum(circles, []))
    outline = []
    for (_, y, z, r), circle in zip(PULLEYS, circles):
        starts = [k for k in range(72) if circle[k] in hull and circle[k - 1] not in hull]
        count = sum(p in hull for p in circle)
        wrapped = [circle[(starts[0] + k) % 72] for k in range(count)]
        out = (3 - math.cos(math.pi * (count - 1) / 72)) / 2  # so that the limit touches the pulley
        middle = Vector(wrapped[count // 2]) - Vector((y, z))
        outline += [wrapped[0], tuple(Vector((y, z)) + middle * out), wrapped[-1]]
    outline = convex(outline)
    rows = []
    for i, (y, z) in enumerate(outline):
        (y0, z0), (y1, z1) = outline[i - 1], outline[(i + 1) % len(outline)]
        normal = Vector((z1 - z0, y0 - y1)).normalized() * 0.006
        if normal.dot(Vector((y - 0.45, z - 1.53))) < 0:
            normal.negate()
        rows.append([(BELT_X + x, y + normal[0] * out, z + normal[1] * out)
                     for x, out in ((0, -0.5), (0.012, 1), (-0.012, 1))])
    cage = grid(rows, closed_rows=True, closed_columns=True).outward()
    points = list(cage.mesh.verts)
    return cage.crease(HARD, [cage.mesh.edges.get((points[i], points[(i + 3) % len(points)]))
                              for i in range(len(points))])


def convex(points):
    """The convex hull, counter-clockwise."""
    points, hull = sorted(set(points)), []
    for sweep in (points, points[::-1]):
        half = []
        for p in sweep:
            while len(half) > 1 and ((half[-1][0] - half[-2][0]) * (p[1] - half[-2][1])
                                     <= (half[-1][1] - half[-2][1]) * (p[0] - half[-2][0])):
                half.pop()
            half.append(p)
        hull += half[:-1]
    return hull


def gaiter():
    return turned([(0.046, 0), (0.050, 0.018), (0.026, 0.026), (0.042, 0.042), (0.014, 0.062)], 5).outward()


def drive_shaft():
    """From the gearbox's joint to the wheel's."""
    profile = [(0.044, 0), (0.044, 0.05), (0.014, 0.056), (0.014, 0.385), (0.044, 0.39), (0.044, 0.46)]
    return solid(profile, 4, {1: HARD, 2: HARD, 3: HARD, 4: HARD})


def engine(car, parent):
    group = car.group("Engine", parent)

    def part(name, cage, material, matrix=None, tolerance=HIDDEN, detail=None):
        return car.part(name, group, cage, material, matrix, tolerance, detail)

    part("Cylinder block", box(0.40, 0.27, 0.22, 2.5).move(*ENGINE), "Cast iron")
    part("Cylinder head", box(0.385, 0.12, 0.195).move(-0.13, 0.65, 1.45), "Aluminium")
    coils = [stud(0.020, 0.030).turn("Z", 90).move(x + 0.13, 0.020, 0) for x in CYLINDERS]
    cover = box(0.395, 0.085, 0.205, 2.2).join(*coils)
    part("Cam cover", cover.move(-0.13, 0.742, 1.45), "Plastic black", None, ROUND)
    part("Oil filler cap", stud(0.026, 0.03).turn("Z", 90).move(-0.27, 0.77, 1.50), "Plastic grey", None, ROUND)
    part("Oil sump", sump(), "Aluminium", None, 1.5)
    plenum = pipe([(-0.33, 0.66, 1.69), (-0.13, 0.66, 1.70), (0.05, 0.66, 1.69)], 0.046, capped=True)
    part("Intake plenum", plenum, "Plastic black")
    path = [(0, 0.655, 1.745), (0, 0.775, 1.725), (0, 0.785, 1.60), (0, 0.645, 1.48)]
    runner = car.mesh(pipe(path, 0.021), "Intake runner")
    for number, x in enumerate(CYLINDERS, 1):
        part(f"Intake runner {number}", runner, "Plastic grey", place(x, 0, 0), 1.5)
    part("Throttle body", solid([(0.036, 0), (0.036, 0.05)], 4).move(0.04, 0.66, 1.69), "Aluminium", None, ROUND)
    part("Exhaust manifold", exhaust_manifold(), "Cast iron", detail=FINE)
    alternator = solid([(0.035, 0), (0.058, 0.012), (0.058, 0.10), (0.03, 0.115)], 4, {1: HARD, 2: HARD})
    part("Alternator", alternator.move(-0.33, 0.50, 1.625), "Aluminium", None, ROUND)
    part("Air conditioning compressor", solid([(0.052, 0), (0.052, 0.13)], 4).move(-0.33, 0.335, 1.60), "Aluminium",
         None, ROUND)
    pulley = car.mesh(solid([(1, -0.013), (1, 0.013), (0.72, 0.005)], 6, {1: HARD}, ends=(1,)), "Pulley")
    for name, y, z, radius in PULLEYS:
        part(name, pulley, "Steel", place(BELT_X, y, z, scaled(-1, radius, radius)), 14)
    part("Auxiliary belt", belt(), "Belt rubber", detail=FINE)


def gearbox(car, parent):
    group = car.group("Gearbox", parent)
    profile = [(0.155, 0.07), (0.155, 0.09), (0.128, 0.095), (0.105, 0.19), (0.092, 0.345), (0.06, 0.365)]
    case = solid(profile, 8, {k: HARD for k in range(1, 5)})
    car.part("Gearbox case", group, case.move(0, 0.42, 1.43), "Aluminium", None, ROUND)
    bulge = solid([(0.050, 0.045), (0.104, 0.085), (0.108, 0.165), (0.052, 0.215)], 6, {1: 2, 2: 2})
    car.part("Differential", group, bulge.move(0, AXLE_Y, FRONT_AXLE), "Aluminium", None, ROUND)


def drive_shafts(car, parent):
    group = car.group("Drive shafts", parent)
    shaft, boot = car.mesh(drive_shaft(), "Drive shaft"), car.mesh(gaiter(), "Gaiter")
    turn = Matrix.Rotation(math.pi, 4, "Y")
    for side, where in (("left", place(0.215, AXLE_Y, FRONT_AXLE)), ("right", place(-0.215, AXLE_Y, FRONT_AXLE, turn))):
        car.part(f"Drive shaft {side}", group, shaft, "Steel", where, 1.2)
        car.part(f"Inner gaiter {side}", group, boot, "Rubber", where @ place(0.046, 0, 0), 1.2, FINE)
        car.part(f"Outer gaiter {side}", group, boot, "Rubber", where @ place(0.394, 0, 0, turn), 1.2, FINE)
    middle = pipe([(0.06, AXLE_Y, FRONT_AXLE), (-0.22, AXLE_Y, FRONT_AXLE)], 0.018)
    car.part("Intermediate shaft", group, middle, "Steel", None, HIDDEN)


# ---- engine bay ------------------------------------------------------------------------------------------


def fan():
    cage = stud(0.045, 0.03)
    for k in range(5):
        blade = bar([(0.012, 0.03, 0), (0.012, 0.125, 0)], [0.03, 0.075], 0.005, up=(1, 0, -0.6))
        cage.join(blade.turn("X", 72 * k))
    return cage.turn("Y", 90)


BONNET_SIDE = (0.880, 0.705), (1.150, 0.716), (1.440, 0.690), (1.680, 0.615), (1.812, 0.500)  # z and half width


def between(places, t):
    """The value at t, in a straight line between pairs of place and value."""
    for (a, u), (b, v) in zip(places, places[1:]):
        if t <= b or b == places[-1][0]:
            return u + (v - u) * (t - a) / (b - a)


def inner_wing():
    """From the side member up, and out to the wing's edge beside the bonnet."""
    crest = [lower_point(7, i) for i in (8, 7, 6, 5, 4)]
    rows = []
    for z in (0.972, 1.10, 1.25, 1.42, 1.58, 1.70):
        edge = between(BONNET_SIDE, z) + 0.012
        top = between([(p[2], p[1]) for p in crest], z) - 0.034
        rows.append([(x, y, z) for x, y in ((0.484, 0.49), (0.484, top - 0.105), (0.500, top - 0.085),
                                            (edge - 0.030, top - 0.060), (edge, top))])
    return thickened(facing(grid(rows), 0, -1), 0.005).crease_angle(60)


def scuttle_tray():
    """Closes the bay between firewall and windscreen; its lip stands below the bonnet's rear edge."""
    edge = (0, 1.046), (0.20, 1.044), (0.33, 1.030), (0.45, 1.002), (0.56, 0.968), (0.705, 0.885)
    columns = []
    for x in (0, 0.17, 0.33, 0.45, 0.56, 0.66, 0.73):
        z, y = between(edge, x) - 0.020, windscreen_place(x, 0).y
        columns.append([(x, 0.905, 0.968), (x, y - 0.052, z), (x, y - 0.050, z + 0.012), (x, y - 0.015, z + 0.012)])
    columns = [[(-x, y, z) for x, y, z in c] for c in columns[:0:-1]] + columns
    return thickened(facing(grid(columns), 1, 1), 0.004).crease_angle(60)


def slam_panel():
    path = [(-0.47, 0.776, 1.775), (-0.25, 0.783, 1.858), (0, 0.786, 1.875), (0.25, 0.783, 1.858), (0.47, 0.776, 1.775)]
    return bar(path, [0.07, 0.10, 0.10, 0.10, 0.07], 0.026)


def bonnet_lock():
    cheeks = [box(0.012, 0.030, 0.055).move(x, 0.812, 1.858) for x in (-0.016, 0.016)]
    return joined(box(0.075, 0.006, 0.075).move(0, 0.801, 1.858), *cheeks,
                  pipe([(-0.02, 0.816, 1.858), (0.02, 0.816, 1.858)], 0.004))


def bay_fittings(part):
    """What the open bonnet shows besides the engine."""
    part("Scuttle tray", scuttle_tray(), "Plastic black", detail=FINE)
    part("Slam panel", slam_panel(), "Steel")
    part("Bonnet lock", bonnet_lock(), "Cast iron")
    stay = pipe([(0.40, 0.798, 1.775), (0.36, 0.810, 1.775), (-0.34, 0.806, 1.775), (-0.37, 0.825, 1.775)], 0.005)
    part("Bonnet stay", stay, "Chrome", 1.5)
    part("Battery lid", box(0.169, 0.028, 0.239, 3.5).move(0.365, 0.718, 1.215), "Plastic grey")
    clips = [box(0.016, 0.035, 0.010).move(x, 0.665, 1.672) for x in (0.31, 0.42)]
    part("Air filter clips", joined(*clips), "Steel")
    bearing = [(0.046, 0), (0.042, 0.014), (0.013, 0.016), (0.013, 0.036)]
    for side, x in (("left", 1), ("right", -1)):
        where = solid(bearing, 6, {1: HARD, 2: HARD}, ends=(1,)).turn("Z", 90).move(0.552 * x, 0.808, 1.245)
        part(f"Strut bearing {side}", where, "Cast iron", ROUND)


def engine_bay(car, parent):
    group = car.group("Engine bay", parent)

    def part(name, cage, material, tolerance=HIDDEN, detail=None):
        car.part(name, group, cage, material, None, tolerance, detail)

    part("Battery", box(0.165, 0.165, 0.235).move(0.365, 0.635, 1.215), "Plastic black")
    posts = joined(*(stud(0.009, 0.02).turn("Z", 90).move(0.415, 0.730, z) for z in (1.13, 1.30)))
    part("Battery terminals", posts, "Copper")
    lid = box(0.18, 0.055, 0.25).bend(lambda p: (p.x * (0.85 if p.y > 0 else 1), p.y, p.z * (0.88 if p.y > 0 else 1)))
    filter_box = box(0.17, 0.09, 0.24).move(0.365, 0.615, 1.55).join(lid.move(0.365, 0.69, 1.55))
    part("Air filter box", filter_box, "Plastic black")
    part("Intake duct", pipe([(0.28, 0.69, 1.60), (0.22, 0.70, 1.69), (0.09, 0.66, 1.69)], 0.032), "Plastic black")
    part("Radiator", box(0.60, 0.37, 0.03).move(0, 0.465, 1.885), "Aluminium")
    part("Radiator tanks", both(box(0.045, 0.38, 0.045).move(0.322, 0.465, 1.885)), "Plastic black")
    part("Fan cowl", box(0.56, 0.34, 0.03).move(0, 0.465, 1.855), "Plastic black")
    part("Fan", fan().turn("Y", 180).move(0, 0.465, 1.862), "Plastic grey", detail=FINE)
    part("Coolant hose", pipe([(0.06, 0.67, 1.50), (0.17, 0.73, 1.66), (0.27, 0.66, 1.80), (0.315, 0.61, 1.88)], 0.018),
         "Rubber")
    part("Coolant tank", joined(box(0.13, 0.13, 0.19, 1.8).move(-0.39, 0.66, 1.20),
                                stud(0.022, 0.025).turn("Z", 90).move(-0.39, 0.715, 1.18)), "Plastic grey", 1.5)
    booster = solid([(0.112, 0), (0.115, 0.06), (0.03, 0.10)], 6, {1: HARD})
    part("Brake servo", booster.turn("Y", -90).move(0.36, 0.72, 0.968), "Plastic black", ROUND)
    bay_fittings(part)


# ---- floor and frame -------------------------------------------------------------------------------------

FLOOR = ((0.962, 0.286, 0.48), (0.85, 0.286, 0.655), (-0.50, 0.286, 0.655), (-0.58, 0.396, 0.655), (-0.89, 0.405, 0.59),
         (-1.13, 0.570, 0.49), (-2.03, 0.570, 0.49))  # z, height and half width


def floor_pan():
    """From the firewall to the tail; the tunnel ends at the kick-up under the rear bench."""
    rows = []
    for i, (z, y, half) in enumerate(FLOOR):
        tunnel = 0.375 if i < 3 else y
        section = (half, y), (0.11, y), (0.08, tunnel)
        rows.append([(x, h, z) for x, h in section] + [(-x, h, z) for x, h in reversed(section)])
    return thickened(grid(rows).crease_angle(15, 4), 0.010).crease_angle(40)


def firewall():
    """Narrow between the wheel arches, wide above them."""
    outline = (0.29, 0.48), (0.55, 0.49), (0.62, 0.66), (0.70, 0.735), (0.905, 0.735)
    cage = grid([[(-half, y, 0.966), (half, y, 0.966)] for y, half in outline]).flip()
    return thickened(cage, 0.012).crease_angle(40)


def side_member():
    """From the bumper along engine bay, floor and over the rear axle to the tail."""
    path = [(0.44, 0.50, 1.92), (0.44, 0.50, 1.16), (0.40, 0.25, 0.76), (0.40, 0.25, -0.46),
            (0.42, 0.32, -0.66), (0.45, 0.505, -1.08), (0.45, 0.505, -2.03)]
    return bar(path, 0.062, [0.11, 0.11, 0.055, 0.055, 0.06, 0.07, 0.07])


def sill_member():
    """Higher at the rear, where the floor is."""
    return bar([(0.713, 0.262, 0.83), (0.713, 0.262, -0.40), (0.713, 0.297, -0.85)], 0.135, [0.09, 0.09, 0.16])


LINER = 0.368  # radius: a little more than the arch's


def column_at(z, row=0):
    """Where along the lower body's left half its rows pass z."""
    low, high = 0.0, 19.0
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (middle, high) if lower_surface(row, middle).z > z else (low, middle)
    return low


def arch_liner(axle, inner):
    """Over the wheel, from the body's sheet inward, with a wall at its inner end; left side. A ledge within the wheel
    hides the strut above the tyre; in front of the wheel and behind it the liner goes down to the body's lower edge."""
    def straight(sign):
        edge = lower_surface(0, column_at(axle + sign * LINER)).y + 0.006
        return [(lambda r, y=y: (y, axle + sign * r)) for y in (edge, AXLE_Y - 0.06)]

    def bent(degrees):
        a = math.radians(degrees)
        grow = 1.01 if degrees in (0, 180) else 3 / (2 + math.cos(math.radians(45)))  # so that the limit is round
        return lambda r: (AXLE_Y + grow * r * math.sin(a), axle + grow * r * math.cos(a))

    rows = []
    for height_and_length in straight(-1) + [bent(a) for a in range(180, -1, -45)] + straight(1)[::-1]:
        y, z = height_and_length(LINER)
        section = [(LINER, on_side(z, y)[0].x - 0.010), (LINER, 0.620), (0.303, 0.612), (0.303, inner), (0.16, inner),
                   (LINER + 0.005, inner - 0.008)]
        rows.append([(x, *height_and_length(r)) for r, x in section])
    cage = grid(rows, closed_columns=True)
    vertices = list(cage.mesh.verts)
    cage.crease(HARD, [cage.mesh.edges.get((vertices[i], vertices[i + 6])) for i in range(len(vertices) - 6)])
    for ring in (vertices[:6], vertices[-6:]):
        cap(cage, ring)
        cage.crease(HARD, [cage.mesh.edges.get(pair) for pair in zip(ring, ring[1:] + ring[:1])])
    return cage.outward()


def facing(cage, axis, sign):
    """Turns a sheet so that it looks along the axis given."""
    cage.mesh.normal_update()
    if sum(f.normal[axis] * f.calc_area() for f in cage.mesh.faces) * sign < 0:
        cage.flip()
    return cage


def lower_edge(columns):
    """Points just within the body's lower edge, from the right half to the left."""
    half = [lower_surface(0, c) + Vector((0, 0.004, 0)) for c in columns]
    half = [p - Vector((0.008 * (p.x > 0.1), 0, math.copysign(0.010, p.z))) for p in half]
    return [Vector((-p.x, p.y, p.z)) for p in reversed(half)] + half[1:]


def engine_shield():
    """From the front skirt's lower edge to the wheels, and narrower between them to the firewall."""
    back = FRONT_AXLE + LINER
    edge = lower_edge([0, 0.75, 1.5, 2, 2.5, 3, 3.5] + [column_at(back + 0.003)])
    front = facing(grid([edge, [(p.x, 0.200, back) for p in edge]]), 1, -1)
    rear = facing(grid([[(x, 0.196, z) for x in (-0.50, 0.50)] for z in (back + 0.01, 1.06)]), 1, -1)
    return joined(*(thickened(sheet, 0.005).crease_angle(60) for sheet in (front, rear)))


def rear_tray():
    """Closes the underside behind the rear wheels, beside the spare wheel and behind it."""
    front = REAR_AXLE - LINER
    columns = [column_at(front - 0.003)] + [15 + k * 0.5 for k in range(9)]
    half = [p for p in lower_edge(columns[::-1]) if p.x >= 0]
    rise = [Vector((max(min(p.x * 0.9, 0.60), 0.0), 0.475, max(p.z + 0.08, -2.03))) for p in half]
    inside = [Vector((min(p.x, 0.44), 0.480, p.z if p.x > 0.44 else -2.0)) for p in rise]
    rows = [[Vector((-p.x, p.y, p.z)) for p in row[:0:-1]] + row for row in (half, rise, inside)]
    return thickened(facing(grid(rows), 1, -1), 0.005).crease_angle(60)


def duct(below, above, back):
    """A closed box behind a hole of the front, which looks out of it; of its lower and upper edge: x and height."""
    def edge(end, y):
        return [(end * k / 3, y) for k in range(-3, 4)]

    outline = edge(*below) + edge(*above)[::-1]
    rows = [[(x, y, z) for (x, y), z in zip(outline, depth)]
            for depth in ([on_front(x, y)[0].z - 0.010 for x, y in outline], [back] * len(outline))]
    cage = grid(rows, closed_columns=True)
    cap(cage, list(cage.mesh.verts)[-len(outline):])
    cage.outward()
    last = next(f for f in cage.mesh.faces if all(v.co.z == min(w.co.z for w in cage.mesh.verts) for v in f.verts))
    if last.normal.z < 0:
        cage.flip()
    return thickened(cage.crease_angle(40), 0.003)


def liners(car, parent):
    group = car.group("Wheel arch liners", parent)
    # The boot's lining is further out than the engine bay's side.
    for axle, z, inner in (("Front", FRONT_AXLE, 0.505), ("Rear", REAR_AXLE, 0.585)):
        mesh = car.mesh(arch_liner(z, inner), f"{axle} wheel arch liner")
        for side, mirror in SIDES:
            car.part(f"{axle} {side}", group, mesh, "Plastic black", None if side == "left" else mirror, 1.5)


def floor(car, parent):
    group = car.group("Floor and frame", parent)

    def part(name, cage, material="Underbody"):
        car.part(name, group, cage, material, None, HIDDEN)

    part("Floor pan", floor_pan())
    well = solid([(0.27, 0), (0.255, 0.15)], 6, {1: HARD}).turn("Z", -90)
    part("Spare wheel well", well.move(-0.12, 0.565, -1.66))
    rib = car.mesh(box(0.24, 0.014, 0.06), "Stiffening rib")
    for number, z in enumerate((0.42, -0.22), 1):
        for side, x in (("left", 0.245), ("right", -0.245)):
            car.part(f"Stiffening rib {number} {side}", group, rib, "Underbody", place(x, 0.273, z), HIDDEN)
    on_both_sides(car, "Side member", group, side_member(), "Underbody")
    on_both_sides(car, "Sill member", group, sill_member(), "Underbody")
    car.part("Engine shield", group, engine_shield(), "Plastic black")
    part("Front cross member", bar([(-0.50, 0.50, 1.91), (0, 0.50, 1.965), (0.50, 0.50, 1.91)], 0.05, 0.10), "Steel")
    part("Rear cross member", box(1.0, 0.10, 0.04).move(0, 0.50, -2.05), "Steel")
    car.part("Firewall", group, firewall(), "Plastic grey", None, HIDDEN)
    support = joined(*(box(0.88, 0.05, 0.05).move(0, y, 1.88) for y in (0.70, 0.240)))
    part("Radiator support", support, "Steel")
    on_both_sides(car, "Inner wing", group, inner_wing(), "Plastic grey", FINE)
    tower = solid([(0.112, 0), (0.108, 0.095), (0.094, 0.112), (0.050, 0.116)], 6, {1: 1}).turn("Z", 90)
    on_both_sides(car, "Strut tower", group, tower.move(0.552, 0.694, 1.245), "Plastic grey")


# ---- suspension, steering, brakes ------------------------------------------------------------------------


def spring():
    """Two turns, 0.2 high, about x."""
    turns = []
    for k in range(9):
        radius = 0.053 if k in (0, 8) else 0.053 * 1.5  # the limit of four points to a turn is within them
        turns.append((0.2 * k / 8, radius * math.cos(math.pi / 2 * k), radius * math.sin(math.pi / 2 * k)))
    return pipe(turns, 0.0068, 3)


STRUT = (0.605, 0.345, 1.28), (0.548, 0.79, 1.247)


def suspension(car, parent):
    coil, hub = car.mesh(spring(), "Spring"), car.mesh(solid([(0.055, 0), (0.045, 0.06)], 4), "Hub carrier")
    front = car.group("Front suspension", parent)
    damper = along(solid([(0.026, 0), (0.026, 0.185), (0.066, 0.19), (0.062, 0.20), (0.011, 0.205), (0.011, 0.45)], 4,
                         {k: HARD for k in range(1, 5)}), *STRUT)
    arm = joined(bar([(0.36, 0.235, 1.25), (0.645, 0.222, 1.28)], [0.07, 0.045], 0.03),
                 bar([(0.37, 0.24, 1.02), (0.57, 0.228, 1.27)], [0.06, 0.045], 0.028))
    path = [(0.655, 0.20, 1.28), (0.670, 0.312, 1.28), (0.610, 0.43, 1.275)]
    upright = bar(path, [0.06, 0.15, 0.06], 0.045, 2, (1, 0, 0))
    turn = Vector((1, 0, 0)).rotation_difference(Vector(STRUT[1]) - Vector(STRUT[0])).to_matrix().to_4x4()
    seat = place(*Vector(STRUT[0]).lerp(Vector(STRUT[1]), 0.43), turn)
    on_both_sides(car, "Strut", front, damper, "Steel")
    on_both_sides(car, "Lower arm", front, arm, "Cast iron")
    on_both_sides(car, "Upright", front, upright, "Cast iron")
    for side, mirror in SIDES:
        car.part(f"Spring {side}", front, coil, "Steel", mirror @ seat, HIDDEN, FINE)
    half = [(0.0, 0.315, 1.0), (0.37, 0.315, 1.0), (0.48, 0.315, 1.05), (0.592, 0.38, 1.262)]
    roll = [(-x, y, z) for x, y, z in half[:0:-1]] + half[1:]
    car.part("Anti-roll bar", front, pipe(roll, 0.011), "Steel", None, HIDDEN)
    frame = joined(box(0.78, 0.045, 0.13).move(0, 0.235, 1.14),
                   both(bar([(0.36, 0.238, 1.34), (0.38, 0.238, 0.98)], 0.085, 0.05)))
    car.part("Subframe", front, frame, "Underbody", None, HIDDEN)

    rear = car.group("Rear suspension", parent)
    beam = bar([(-0.54, 0.31, -1.08), (0.54, 0.31, -1.08)], 0.07, 0.085)
    car.part("Torsion beam", rear, beam, "Underbody", None, HIDDEN)
    trailing = joined(bar([(0.52, 0.33, -0.91), (0.545, 0.31, -1.10), (0.585, 0.305, -1.38)], [0.07, 0.06, 0.05],
                          [0.07, 0.06, 0.06], 2.5),
                      bar([(0.57, 0.285, -1.27), (0.39, 0.285, -1.27)], 0.11, 0.02, 2))
    on_both_sides(car, "Trailing arm", rear, trailing, "Underbody")
    shock = solid([(0.014, 0), (0.018, 0.17), (0.018, 0.31)], 4, {1: HARD})
    on_both_sides(car, "Damper", rear, along(shock, (0.594, 0.29, -1.385), (0.592, 0.60, -1.355)), "Underbody")
    turn = Matrix.Rotation(math.pi / 2, 4, "Z")
    for side, mirror in SIDES:
        where = mirror @ place(0.44, 0.29, -1.27, turn, scaled(0.9, 0.9, 0.9))
        car.part(f"Spring {side}", rear, coil, "Steel", where, HIDDEN, FINE)
        car.part(f"Hub carrier {side}", rear, hub, "Cast iron", mirror @ place(0.64, AXLE_Y, REAR_AXLE), HIDDEN)


def steering(car, parent):
    group = car.group("Steering", parent)
    rack = pipe([(-0.25, 0.375, 1.035), (0.25, 0.375, 1.035)], 0.024)
    car.part("Steering rack", group, rack, "Aluminium", None, HIDDEN)
    on_both_sides(car, "Tie rod", group, pipe([(0.24, 0.375, 1.035), (0.36, 0.36, 1.05), (0.625, 0.335, 1.16)],
                                              [0.030, 0.011, 0.010]), "Steel")
    car.part("Steering shaft", group, pipe([(0.20, 0.385, 1.03), (0.36, 0.60, 0.955)], 0.013), "Steel", None, HIDDEN)


def arc_block(section, angles):
    """A ring's piece about the wheel's axle: a section of (radius, x) at angles, 0 is up and 90 towards +z."""
    rows = [[(x, r * math.cos(a), r * math.sin(a)) for r, x in section] for a in map(math.radians, angles)]
    cage = grid(rows, closed_columns=True)
    points, count = list(cage.mesh.verts), len(section)
    for end in (points[:count], points[-count:]):
        cap(cage, end)
    return cage.outward()


def caliper():
    """Two halves beside the disc, which two bridges join over its edge; about the axle and towards +z."""
    outer = [(0.098, 0.006), (0.106, 0.013), (0.155, 0.013), (0.165, 0.004), (0.165, -0.007), (0.098, -0.007)]
    inner = [(0.092, -0.039), (0.165, -0.039), (0.165, -0.058), (0.092, -0.064)]
    bridge = [(0.153, 0.004), (0.167, 0.004), (0.167, -0.052), (0.153, -0.052)]
    halves = arc_block(outer, (56, 72, 108, 124)), arc_block(inner, (58, 90, 122))
    return joined(*halves, arc_block(bridge, (56, 72)), arc_block(bridge, (108, 124))).crease_angle(25)


def brake_pads():
    """Backing plates; their outer edges stand in the caliper's window."""
    plates = [[(0.104, x), (0.157, x), (0.157, x - 0.005), (0.104, x - 0.005)] for x in (-0.006, -0.035)]
    return joined(*(arc_block(plate, (64, 90, 116)) for plate in plates)).crease_angle(25)


def brakes(car, parent):
    group = car.group("Brake calipers", parent)
    mesh = car.mesh(caliper(), "Brake caliper")
    for axle, z in AXLES:
        for side, mirror in SIDES:
            car.part(f"{axle} {side}", group, mesh, "Brake caliper", caliper_place(z, mirror), 1)


def caliper_place(z, mirror):
    return mirror @ place(TRACK_X, AXLE_Y, z, scaled(1, 1, -1 if z > 0 else 1))


def pads(car, parent):
    group = car.group("Brake pads", parent)
    mesh = car.mesh(brake_pads(), "Brake pads")
    for axle, z in AXLES:
        for side, mirror in SIDES:
            car.part(f"{axle} {side}", group, mesh, "Copper", caliper_place(z, mirror), 1, FINE)


# ---- exhaust and tank ------------------------------------------------------------------------------------


def exhaust(car, parent):
    group = car.group("Exhaust system", parent)
    box_mesh = car.mesh(solid([(0.35, 0), (1, 0.12), (1, 0.88), (0.35, 1)], 4, {1: HARD, 2: HARD}), "Silencer")

    def part(name, cage, material="Steel", matrix=None, tolerance=HIDDEN):  # of a mesh of radius 1: in its own units
        car.part(name, group, cage, material, matrix, tolerance)

    def chamber(name, start, end, across, high):
        turn = Vector((1, 0, 0)).rotation_difference(Vector(end) - Vector(start)).to_matrix().to_4x4()
        length = (Vector(end) - Vector(start)).length
        part(name, box_mesh, "Steel", place(*start, turn, scaled(length, high, across)), 14)

    chamber("Catalyst", (-0.13, 0.515, 1.20), (-0.12, 0.325, 1.125), 0.058, 0.058)
    path = [(-0.122, 0.34, 1.13), (-0.11, 0.29, 1.09), (0, 0.285, 0.86), (0, 0.308, 0.28)]
    part("Front pipe", pipe(path, 0.025))
    chamber("Middle silencer", (0, 0.312, 0.32), (0, 0.312, -0.20), 0.066, 0.055)
    part("Rear pipe", pipe([(0, 0.312, -0.16), (0.02, 0.29, -0.46), (0.30, 0.235, -0.58), (0.35, 0.25, -0.86),
                            (0.35, 0.44, -1.08), (0.35, 0.40, -1.42), (0.22, 0.33, -1.74)], 0.024))
    chamber("Rear silencer", (-0.02, 0.335, -1.80), (0.44, 0.335, -1.80), 0.115, 0.075)
    part("Outlet pipe", pipe([(0.34, 0.32, -1.84), (0.45, 0.255, -1.95), (0.45, 0.235, -2.05)], 0.022, capped=True))
    tip = turned([(0.031, 0), (0.031, 0.11), (0.027, 0.11), (0.026, 0.02)], 6, {1: HARD, 2: HARD}, True).outward()
    car.part("Tail pipe", group, tip.turn("Y", 90).move(0.45, 0.235, -2.02), "Chrome", None, 0.3)


def fuel_tank(car, parent):
    def shape(p):
        return (p.x, p.y * (1 if p.x < 0.2 else 0.8), p.z)
    tank = box(0.74, 0.165, 0.33, 2.6).bend(shape).move(-0.12, 0.305, -0.765)
    group = car.group("Fuel system", parent)
    car.part("Fuel tank", group, tank, "Plastic black", None, HIDDEN)


def closures(car, parent):
    """What hides the inside of bumpers and skirts."""
    group = car.group("Closures", parent)
    car.part("Intake duct", group, duct((0.512, 0.254), (0.446, 0.397), 1.915), "Plastic black", None, HIDDEN)
    car.part("Grille duct", group, duct((0.334, 0.646), (0.366, 0.762), 1.935), "Plastic black", None, HIDDEN,
             FINE)
    car.part("Rear tray", group, rear_tray(), "Underbody", None, HIDDEN, FINE)


def add(car):
    car.numbered_from(700)
    train = car.group("Drive train")
    for build in (engine, gearbox, drive_shafts):
        build(car, train)
    chassis = car.group("Chassis")
    for build in (floor, liners, suspension, steering, brakes, exhaust, fuel_tank, engine_bay, closures, pads):
        build(car, chassis)
