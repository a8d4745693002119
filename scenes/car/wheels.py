"""The wheels: each turns about its own x axis, its outer side looks along +x."""

import math

from authoring import Cage, cap, FINE, HARD, lathe
from mathutils import Matrix, Vector

AXLES = (("Front", 1.28), ("Rear", -1.28))
AXLE_Y, TRACK_X = 0.312, 0.735
SEGMENTS = 15  # of the tyre


def sides(x, y, z):
    """Where a part stands on the left, and turned by 180 degrees about y on the right."""
    return (("left", Matrix.Translation((x, y, z))),
            ("right", Matrix.Translation((-x, y, z)) @ Matrix.Rotation(math.pi, 4, "Y")))


def turned(profile, segments, creases=(), closed=False):
    """A lathe whose limit has the profile's radii: the limit of a polygon lies within it.
    `creases`: sharpness of the ring at a number in the profile."""
    cage = lathe(profile, segments, closed)
    grow = 3 / (2 + math.cos(2 * math.pi / segments))
    cage.scale(1, grow, grow)
    points, count = list(cage.mesh.verts), len(profile)
    for j, sharpness in dict(creases).items():
        ring = points[j::count]
        cage.crease(sharpness, [cage.mesh.edges.get(pair) for pair in zip(ring, ring[1:] + ring[:1])])
    return cage


def mirror_profile(half, creases, closing=0):
    """A profile from x > 0 to x < 0 of its one half; a point at x = 0 is in it once."""
    centre = half[-1][1] == 0
    other = [(r, -x) for r, x in reversed(half[:-1] if centre else half)]
    last = len(half) + len(other) - 1
    return half + other, {**creases, **{last - j: s for j, s in creases.items()}}


# ---- tyre ------------------------------------------------------------------------------------------------

SIDE_WALL = [(0.206, 0.074), (0.2195, 0.085), (0.2290, 0.1000), (0.246, 0.1040), (0.2485, 0.1064), (0.2555, 0.1074),
             (0.258, 0.1062), (0.286, 0.1030)]
SIDE_CREASES = {1: HARD, 2: 2, 3: HARD, 6: HARD}


def far_tyre():
    half = [SIDE_WALL[k] for k in (0, 1, 2, 5, 7)] + [(0.3115, 0.0900), (0.312, 0.036), (0.304, 0.031), (0.312, 0.026)]
    profile, creases = mirror_profile(half, {1: HARD, 2: 2, 6: HARD, 7: 1, 8: HARD})
    return turned(profile, 12, creases).outward()


def tread_block(start, end, side, slant=0.045):
    """A shoulder block, rounded over the tyre's edge; its foot stands in the tyre."""
    section = [(0.298, 0.061), (0.3125, 0.060), (0.3140, 0.0900), (0.287, 0.1015)]
    points = [(side * x, r * math.cos(a), r * math.sin(a))
              for along in (start, end) for r, x in section for a in [along + slant * (x - 0.06) / 0.04]]
    cage = Cage(points, [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 2, 1, 0), (4, 5, 6, 7)])
    edges = [(0, 1), (1, 2), (2, 3), (4, 5), (5, 6), (6, 7), (1, 5)]
    vertices = list(cage.mesh.verts)
    cage.crease(HARD, [cage.mesh.edges.get((vertices[a], vertices[b])) for a, b in edges])
    return cage.flip() if side > 0 else cage


def near_tyre():
    half = SIDE_WALL + [(0.3100, 0.0900), (0.3080, 0.0545), (0.312, 0.0495), (0.3125, 0.0065), (0.304, 0)]
    profile, creases = mirror_profile(half, {**SIDE_CREASES, 9: HARD, 10: HARD, 11: HARD, 12: 2})
    last = len(profile) - 1
    kept = [i for i in range(last + 1) if last - i not in (3, 4, 6)]  # the inner side wall has no raised ring
    creases = {kept.index(i): s for i, s in creases.items() if i in kept}
    return turned([profile[i] for i in kept], SEGMENTS, creases).outward()


def tread(blocks=40):
    cage = Cage()
    pitch = 2 * math.pi / blocks
    for k in range(blocks):
        for side in (1, -1):
            start = (k + (0.5 if side < 0 else 0)) * pitch
            cage.join(tread_block(start, start + 0.86 * pitch, side, 0.06 * side))
    return cage


# ---- rims ------------------------------------------------------------------------------------------------


LIP = [(0.2060, 0.0735), (0.2195, 0.0780)]  # of the rim, beneath the flange


def flange():
    """The bright edge around the rim; the tyre comes out behind it."""
    profile = [(0.2222, 0.080), (0.2215, 0.0915), (0.2140, 0.0915), (0.2070, 0.0795), (0.2005, 0.0780),
               (0.2000, 0.0700)]
    return turned(profile, 44, {1: 2, 2: 2, 3: HARD, 4: HARD}).outward()


def bored(cage, loop, radius, x, depth):
    """Fills a loop of six points with a sheet that has a round hole, closed at its ground."""
    middle = sum((v.co for v in loop), Vector()) / len(loop)
    out = (middle - Vector((middle.x, 0, 0))).normalized()
    across = out.cross(Vector((1, 0, 0)))
    if (loop[2].co - loop[0].co).dot(across) < 0:
        across.negate()
    rings = []
    for r, height in ((radius, x), (radius * 0.94, x - depth)):
        size = r * 3 / (2 + math.cos(math.pi / 3))
        ring = []
        for k in range(6):
            a = math.radians(210 + 60 * k)
            place = out * middle.dot(out) + across * size * math.cos(a) + out * size * math.sin(a)
            ring.append(cage.mesh.verts.new((height, place.y, place.z)))
        rings.append(ring)
    for a, b in ((loop, rings[0]), rings):
        for i in range(6):
            j = (i + 1) % 6
            cage.mesh.faces.new([a[i], a[j], b[j], b[i]])
    cap(cage, rings[1])
    for ring, sharpness in zip(rings, (4, HARD)):
        cage.crease(sharpness, [cage.mesh.edges.get(pair) for pair in zip(ring, ring[1:] + ring[:1])])


def hub_plate():
    """A plate on the rim's hub, five-fold, with the holes of the bolts. Four points to a bolt in each ring: three about
    the bolt, one between."""
    cage, rings = Cage(), []
    for radius, x in ((0.027, 0.0330), (0.0600, 0.0350), (0.0625, 0.0325), (0.0625, 0.018)):
        radius *= 3 / (2 + math.cos(math.radians(18)))
        angles = [[math.radians(72 * k + a) for a in (-18, 0, 18, 36)] for k in range(5)]
        rings.append([[cage.mesh.verts.new((x, radius * math.cos(a), radius * math.sin(a))) for a in row]
                      for row in angles])
    inner, outer = rings[:2]
    for k in range(5):
        a, b, after = inner[k], outer[k], (k + 1) % 5
        bored(cage, [a[0], a[1], a[2], b[2], b[1], b[0]], 0.0108, (a[1].co.x + b[1].co.x) / 2, 0.012)
        a, b = a[2:] + inner[after][:1], b[2:] + outer[after][:1]
        for i in range(2):
            cage.mesh.faces.new([a[i], a[i + 1], b[i + 1], b[i]])
    for a, b in zip(rings[1:], rings[2:]):
        a, b = sum(a, []), sum(b, [])
        for i in range(20):
            cage.mesh.faces.new([a[i], a[(i + 1) % 20], b[(i + 1) % 20], b[i]])
    return cage.outward()


DRAFT = 0.005


def spoked(count, rings, rear, lean=0.0, crown=0.0):
    """A rim of `count` spokes. Of the rings from hub to lip: radius, x of the spoke's face and of its back, half its
    width. `rear`: the barrel behind the lip, radius and x. The windows' outlines are creases, so that their corners
    come out rounded; behind they are narrower by DRAFT, so that their walls are seen. `lean` turns every second spoke
    one way at the hub and the others the other way, degrees. `crown`: how far the middle of a spoke's face stands
    out."""
    cage, whole = Cage(), 2 * math.pi / count
    columns = 4 if crown else 2  # of a spoke and the window after it, where both are there

    def ring(radius, x, half=None, shift=0.0, window=True, out=0.0):
        points = []
        for k in range(count):
            middle = k * whole + math.radians(shift) * (-1) ** k
            half_angle = math.asin(half / radius) if half else whole / 4
            places = [(middle - half_angle, x), (middle + half_angle, x)]
            if crown:
                places.insert(1, (middle, x + out))
                if window:
                    places.append(((k + 0.5) * whole, x))
            points.append([cage.mesh.verts.new((x, radius * math.cos(a), radius * math.sin(a))) for a, x in places])
        return points

    def band(a, b):
        a, b = sum(a, []), sum(b, [])
        for i in range(len(a)):
            j = (i + 1) % len(a)
            cage.mesh.faces.new([a[i], a[j], b[j], b[i]])

    last, right = len(rings) - 1, 2 if crown else 1
    front, back = [], []
    for i, (radius, face, rear_x, half) in enumerate(rings):
        ends = i in (0, last)
        shift = lean * (1 - 2 * i / last)
        front.append(ring(radius, face, half, shift, ends, crown * (0.5 if ends else 1)))
        drafted = radius + (DRAFT if i == 0 else -DRAFT if i == last else 0)
        back.append(ring(drafted, rear_x, half + DRAFT, shift, ends))
    hub = ring(0.028, rings[0][1] - 0.015)  # beneath the plate
    outer = [ring(r * 3 / (2 + math.cos(whole / columns)), x) for r, x in LIP + rear]
    band(hub, front[0])
    band(front[-1], outer[0])
    for a, b in zip(outer, outer[1:] + [back[-1]]):
        band(a, b)
    for k in range(count):
        for rows, i in ((rows, i) for rows in (front, back) for i in range(last)):
            for j in range(right):
                cage.mesh.faces.new([rows[i][k][j], rows[i][k][j + 1], rows[i + 1][k][j + 1], rows[i + 1][k][j]])
        for side in (0, right):
            for i in range(last):
                cage.mesh.faces.new([front[i][k][side], front[i + 1][k][side], back[i + 1][k][side], back[i][k][side]])
        for i in (0, last):
            f, b = (rows[i][k][right:] + [rows[i][(k + 1) % count][0]] for rows in (front, back))
            for j in range(len(f) - 1):
                cage.mesh.faces.new([f[j], f[j + 1], b[j + 1], b[j]])
    cage.outward()
    for rows in (front, back):
        for k in range(count):
            after = (k + 1) % count
            outline = [row[k][right] for row in rows] + rows[-1][k][right + 1:]
            outline += [row[after][0] for row in reversed(rows)]
            outline += list(reversed(rows[0][k][right + 1:]))
            cage.crease(HARD, [cage.mesh.edges.get(pair) for pair in zip(outline, outline[1:] + outline[:1])])
    for i, sharpness in enumerate((0, HARD)):
        points = sum(outer[i], [])
        cage.crease(sharpness, [cage.mesh.edges.get(pair) for pair in zip(points, points[1:] + points[:1])])
    return cage


def five_spokes():
    rings = [(0.070, 0.033, 0.016, 0.0270), (0.108, 0.0365, 0.020, 0.0165), (0.158, 0.050, 0.034, 0.0170),
             (0.200, 0.0720, 0.050, 0.0240)]
    return spoked(5, rings, [(0.216, -0.088), (0.194, -0.076)], crown=0.006)


def ten_spokes():
    rings = [(0.062, 0.030, 0.016, 0.0080), (0.130, 0.042, 0.024, 0.0090), (0.200, 0.0720, 0.052, 0.0105)]
    return spoked(10, rings, [(0.214, -0.088)], lean=3.5)


def stud(radius, height):
    """A round head that looks along +x: four sides, which the limit rounds."""
    cage = Cage([(x, radius * 1.5 * math.cos(a), radius * 1.5 * math.sin(a)) for x in (0, height)
                 for a in (math.radians(45 + 90 * k) for k in range(4))],
                [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)])
    return cage.crease(HARD, where=lambda p: p.x > height / 2).outward()


def bolts():
    cage = Cage()
    for k in range(5):
        cage.join(stud(0.0066, 0.009).move(0.0225, 0.0446, 0).turn("X", 72 * k))
    return cage


def centre_cap():
    cage = turned([(0.0305, 0.024), (0.0305, 0.036), (0.016, 0.040)], 6, {1: HARD})
    cap(cage, list(cage.mesh.verts)[2::3])
    return cage.outward()


# ---- brake disc ------------------------------------------------------------------------------------------


def brake_disc():
    """The hat that carries the rim, and the ring with the slit of its ventilation."""
    profile = [(0.030, 0.015), (0.072, 0.015), (0.076, -0.012), (0.148, -0.012), (0.148, -0.019), (0.138, -0.0205),
               (0.148, -0.022), (0.148, -0.030), (0.016, -0.030)]
    creases = {i: HARD for i in range(1, 8)}
    return turned(profile, 7, creases).outward()


def disc_slots():
    """Six slanting slots in the disc's outer face, as strips just in front of it."""
    cage = Cage()
    for k in range(6):
        strip = [(-0.0112, 0.090, 0.002), (-0.0112, 0.090, -0.002), (-0.0112, 0.138, 0.018), (-0.0112, 0.138, 0.022)]
        cage.join(Cage(strip, [(0, 1, 2, 3)]).turn("X", 60 * k))
    return cage


def add(car):
    car.numbered_from(600)
    group = car.group("Wheels")
    meshes = {name: car.mesh(make(), name) for name, make in
              (("Tyre", near_tyre), ("Tread", tread), ("Plain tyre", far_tyre), ("Rim, five spokes", five_spokes),
               ("Rim, ten spokes", ten_spokes), ("Wheel bolts", bolts), ("Centre cap", centre_cap),
               ("Brake disc", brake_disc), ("Slots", disc_slots))}
    turnings = []
    for axle, z in AXLES:
        for side, place in sides(TRACK_X, AXLE_Y, z):
            wheel = car.group(f"{axle} {side}", group, place)
            turning = car.group("Turning", wheel)
            tyre = car.node("lod", "Tyre", turning, ranges=[5])
            near = car.group("Near", tyre)
            car.part("Carcass", near, meshes["Tyre"], "Rubber", tolerance=0.55)
            car.part("Tread", near, meshes["Tread"], "Rubber", detail=FINE)
            car.part("Far", tyre, meshes["Plain tyre"], "Rubber", tolerance=0.75)
            rim = car.node("switch", "Rim", turning, activeChild=0)
            rims = []
            for spokes, material, tolerance in (("Five spokes", "Alloy", 0.38), ("Ten spokes", "Alloy dark", 0.6)):
                one = car.group(spokes, rim)
                rims.append((one, material))
                car.part("Rim", one, meshes[f"Rim, {spokes.lower()}"], material, tolerance=tolerance)
                car.part("Wheel bolts", one, meshes["Wheel bolts"], "Chrome", tolerance=0.45, detail=FINE)
                car.part("Centre cap", one, meshes["Centre cap"], "Plastic grey", tolerance=0.5)
            turnings.append((turning, rims))
            car.part("Brake disc", turning, meshes["Brake disc"], "Brake disc", tolerance=0.5)
            car.part("Slots", turning, meshes["Slots"], "Cast iron", detail=FINE)
    rim_flange, plate = car.mesh(flange(), "Flange"), car.mesh(hub_plate(), "Hub plate")
    for turning, rims in turnings:
        car.part("Flange", turning, rim_flange, "Alloy", tolerance=3, detail=FINE)
        for rim, material in rims:
            car.part("Hub plate", rim, plate, material, tolerance=0.5, detail=FINE)
