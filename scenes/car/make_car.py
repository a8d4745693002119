#!/usr/bin/env python3
"""Makes car.vrut, a small estate of named parts, beside this file. The same text every time."""

import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, os.pardir))

from modelling import (Scene, add, bent, box, cross, lathe, mix, moved, placed, scale, shell, steps, sub,
                       tube, turned, unit)
from skin import (AXLE_Y, BELT, EAVES, FRONT_AXLE, FRONT_Z, REAR_AXLE, REAR_Z, ROOF_FRONT, SKIRT, arch_height,
                  arch_places, arch_reach, bonnet, bonnet_edge, bonnet_height, front, pane, patch, rear, roof,
                  shoulder, side, skin, surround, windscreen)
from wheel import brake_disc, rim, tyre

LAMP_LOW = 0.613  # lower edge of lamps, grille and boot lid: above the bumpers
LAMP_REAR, LAMP_FRONT = 2.09, front(0.43)  # the headlamp's ends on the skin
DOOR_LOW, B_PILLAR, C_PILLAR = 0.315, -0.18, -0.905  # the doors' lower edge, and where they meet and end
BOOT, TAIL_LAMP = 0.39, 0.74  # p of the boot lid's left edge and of the tail lamp's
COMMENT = """Small estate, made by make_car.py: change that, not this.
Metres; y is up. The front looks along +z, so the car's left is +x. The wheels stand on y = 0.
Doors, bonnet and boot lid have their hinge at their own origin: a rotation about y opens a door (the same
negative angle on both sides, as the right side is the left one's mirror image), one about x the other two.
Wheels have the axle at their own origin and turn about x.""".splitlines()


def materials(scene):
    scene.material("Paint red", (0.12, 0.006, 0.006), (0.62, 0.03, 0.03), (0.42, 0.4, 0.4), 64)
    scene.material("Glass dark", (0.015, 0.018, 0.02), (0.09, 0.11, 0.125), (0.7, 0.7, 0.7), 120)
    scene.material("Plastic black", (0.012, 0.012, 0.012), (0.07, 0.07, 0.072), (0.12, 0.12, 0.12), 16)
    scene.material("Rubber", (0.01, 0.01, 0.01), (0.045, 0.045, 0.045), (0.06, 0.06, 0.06), 8)
    scene.material("Alloy", (0.05, 0.05, 0.052), (0.5, 0.51, 0.53), (0.5, 0.5, 0.5), 40)
    scene.material("Chrome", (0.05, 0.05, 0.055), (0.42, 0.43, 0.45), (0.9, 0.9, 0.9), 90)
    scene.material("Steel", (0.02, 0.02, 0.02), (0.25, 0.24, 0.23), (0.3, 0.3, 0.3), 24)
    scene.material("Lamp clear", (0.05, 0.05, 0.055), (0.3, 0.32, 0.35), (0.9, 0.9, 0.9), 100)
    scene.material("Lamp white", (0.1, 0.1, 0.1), (0.72, 0.74, 0.77), (0.8, 0.8, 0.8), 100)
    scene.material("Lamp red", (0.08, 0.003, 0.005), (0.42, 0.01, 0.02), (0.7, 0.6, 0.6), 100)
    scene.material("Lamp amber", (0.08, 0.03, 0), (0.75, 0.32, 0.02), (0.7, 0.7, 0.6), 100)
    scene.material("Plate", (0.05, 0.05, 0.05), (0.82, 0.82, 0.78), (0.1, 0.1, 0.1), 20)


NUMBER_PLATE = box((0.52, 0.11, 0.012), 0.002)


def on_both_sides(scene, parent, name, mesh, material):
    scene.part(f"{name} left", parent, mesh, material)
    scene.part(f"{name} right", parent, mesh, material, placed(0, 0, 0, mirror=True))


def disc(radius, depth, segments=16, dome=0.004):
    """A round cap, slightly domed, that looks along +z."""
    profile = [(0, depth + dome), (radius, depth), (radius, 0), (0, 0)]
    return turned(lathe(profile, segments, closed=False), 1, -90)


def on_skin(mesh, p, y, lift):
    """A mesh that looks along +z, set onto the skin at a place of the front's left half."""
    along, up = sub(skin(p - 0.01, y), skin(p + 0.01, y)), sub(skin(p, y + 0.01), skin(p, y - 0.01))
    normal = unit(cross(up, along))
    if normal[2] < 0:
        normal = scale(normal, -1)
    across = unit(cross((0, 1, 0), normal))
    upright = cross(normal, across)
    origin = add(skin(p, y), scale(normal, lift))

    def to_skin(q):
        return add(add(origin, scale(across, q[0])), add(scale(upright, q[1]), scale(normal, q[2])))

    return bent(mesh, to_skin)


def window_frame(outline, opening):
    return shell(surround(outline, opening, 2), 0.025, 0.003, lift=-0.003, ring=True)


def glass(opening):
    """A pane a little larger than its opening and behind it."""
    return shell(pane(opening, 0.02, 3), 0.006, 0.001, lift=-0.012)


# ---- doors -----------------------------------------------------------------------------------------------


def door_handle():
    grip = bent(box((0.016, 0.026, 0.17), 0.005), lambda p: (p[0] - 2.4 * p[2] ** 2, p[1], p[2]))
    return (grip + box((0.034, 0.018, 0.02), 0.003, (-0.024, 0, 0.06))
            + box((0.034, 0.018, 0.02), 0.003, (-0.024, 0, -0.06)))


def mirror_housing():
    """Rounded in front, flat towards the rear, on a foot."""
    arc = [math.radians(d) for d in (24, 50, 75, 90, 105, 130, 156)]
    profile = [(0, -0.1)] + [(math.sin(a) ** 0.6, -math.cos(a) * 0.1) for a in arc] + [(0, 0.1)]
    body = lathe(profile, 12, closed=False)
    body = bent(body, lambda p: (p[0], p[1] * 0.062, p[2] * (0.06 if p[2] > 0 else 0.018)))
    foot = bent(box((0.14, 0.022, 0.05), 0.005), lambda p: (p[0] - 0.1, p[1] - 0.03 + 0.15 * p[0], p[2]))
    return body + foot


def mirror_glass():
    oval = lathe([(0, 0.002), (0.95, 0.002), (1, 0), (0.95, -0.002), (0, -0.002)], 14, closed=False)
    return turned(bent(oval, lambda p: (p[0], p[1] * 0.05, p[2] * 0.084)), 1, 90)


def doors(scene, body):
    group = scene.group("Doors", body)
    handle, housing, looking_glass = door_handle(), mirror_housing(), mirror_glass()
    top = EAVES - 0.006
    for row, hinge, back, front_top, pane_front in (
            ("Front", 0.84, B_PILLAR + 0.003, ROOF_FRONT, 0.73),
            ("Rear", B_PILLAR - 0.003, C_PILLAR, B_PILLAR - 0.003, B_PILLAR - 0.04)):
        outline = [(side(back + 0.002), BELT - 0.012), (side(hinge - 0.002), BELT - 0.012),
                   (side(front_top), top), (side(back + 0.002), top)]
        opening = [(side(back + 0.04), BELT + 0.022), (side(pane_front), BELT + 0.022),
                   (side(front_top - 0.04), top - 0.035), (side(back + 0.04), top - 0.035)]
        pivot = (0.80, 0.0, hinge)
        to_hinge = scale(pivot, -1)
        places = [side(z) for z in steps(back, hinge, 2)]
        panel = moved(shell(patch(places, DOOR_LOW, BELT, 8), 0.03), to_hinge)
        frame, window = moved(window_frame(outline, opening), to_hinge), moved(glass(opening), to_hinge)
        grip = add(add(skin(side(back + 0.16), 0.845), (0.032, 0, 0)), to_hinge)
        foot = add(add(skin(side(0.74), 1.0), (0.15, 0.03, 0)), to_hinge)
        for name, mirrored in (("left", False), ("right", True)):
            door = scene.group(f"{row} {name}", group, placed(*pivot, mirrored))
            scene.part("Panel", door, panel, "Paint red")
            scene.part("Window frame", door, frame, "Plastic black")
            scene.part("Window", door, window, "Glass dark")
            scene.part("Handle", door, handle, "Chrome", placed(*grip))
            if row == "Front":
                mirror = scene.group("Mirror", door, placed(*foot))
                scene.part("Housing", mirror, housing, "Paint red")
                scene.part("Glass", mirror, looking_glass, "Chrome", placed(0, 0, -0.019))


# ---- the rest of the body --------------------------------------------------------------------------------


def arch_panel(axle, towards, ends, top):
    """Places and lower edge of the panel over a wheel arch: it ends above the sill and above the bumper."""
    over_sill, over_bumper = axle - towards * arch_reach(DOOR_LOW), axle + towards * arch_reach(LAMP_LOW)
    low_z, high_z = sorted((over_sill, over_bumper))
    within = [z for z in arch_places(axle) if low_z + 0.008 < z < high_z - 0.02]
    places = sorted([side(z) for z in within + [low_z, high_z]] + ends)

    def low(p):
        z = REAR_Z + (p - 1) * (FRONT_Z - REAR_Z)
        return max(arch_height(z, axle), LAMP_LOW if (z - over_bumper) * towards >= 0 else DOOR_LOW)

    return places, patch(places, low, top, 3)


def front_wing():
    ends = [side(0.845), 2.0, LAMP_REAR - 0.005]
    places, rows = arch_panel(FRONT_AXLE, 1, ends, lambda p: shoulder(p, 0)[1])
    return shell(rows + [[shoulder(p, v) for p in places] for v in (0.33, 0.66, 1)], 0.02, back=(3, 1))


def rear_quarter():
    _, rows = arch_panel(REAR_AXLE, -1, [TAIL_LAMP + 0.005, 0.82, 0.91, 1.0], BELT)
    return shell(rows, 0.02, back=(2, 1))


def panels(scene, body):
    group = scene.group("Panels", body)
    on_both_sides(scene, group, "Front wing", front_wing(), "Paint red")
    on_both_sides(scene, group, "Rear quarter", rear_quarter(), "Paint red")
    nose = [LAMP_FRONT + 0.003 + (3 - LAMP_FRONT - 0.003) * u for u in steps(0, 2, 6)]
    rows = [[skin(p, 0.722) for p in nose]] + [[shoulder(p, v) for p in nose] for v in steps(0, 1, 3)]
    scene.part("Nose", group, shell(rows, 0.02), "Paint red")
    sill = shell(patch([side(z) for z in steps(-0.906, 0.944, 2)], SKIRT, 0.345, 3), 0.05, 0.01, lift=-0.014)
    on_both_sides(scene, group, "Sill", sill, "Plastic black")

    hinge = (0, bonnet_height(0, 1.05), 1.05)
    rows = [[bonnet(u, v) for u in steps(-1, 1, 8)] for v in steps(0, 1, 6)]
    bonnet_mesh = moved(shell(rows, 0.02, 0.006), scale(hinge, -1))
    scene.part("Bonnet", body, bonnet_mesh, "Paint red", placed(*hinge))


def roof_parts(scene, body):
    group = scene.group("Roof", body)
    angles = [-90, -70, -52, -38, -22, 0, 22, 38, 52, 70, 90]
    rows = [[roof(a, t) for a in angles] for t in (0, 0.25, 0.5, 0.75, 0.92, 0.97, 0.992, 1)]
    scene.part("Panel", group, shell(rows, 0.025, 0.005, centre=(0, 0.6, -0.6)), "Paint red")

    ends = [add(roof(50, t), (0, h, 0)) for t, h in ((0.10, -0.005), (0.115, 0.02), (0.14, 0.036))]
    middle = [add(roof(50, t), (0, 0.04, 0)) for t in (0.3, 0.5, 0.7)]
    rest = [add(roof(50, t), (0, h, 0)) for t, h in ((0.86, 0.036), (0.885, 0.02), (0.90, -0.005))]
    on_both_sides(scene, group, "Rail", tube(ends + middle + rest, 0.014), "Alloy")
    aerial = tube([(0, 0, 0), (0, 0.02, -0.01), (0, 0.055, -0.09)], 0.006, 6)
    scene.part("Aerial", group, aerial, "Plastic black", placed(*roof(0, 0.06)))

    pillars = scene.group("Pillars", body)
    rows = []
    for v in steps(0, 1, 4):
        z = 0.845 + (ROOF_FRONT + 0.005 - 0.845) * v
        outer, inner = skin(side(z), BELT - 0.015 + (EAVES - 0.004 - BELT + 0.015) * v), windscreen(0.93, v)
        middle = add(mix(outer, inner, 0.5), (0.02, 0.014, 0.014))
        bulge = mix(mix(outer, middle, 0.55), (outer[0], middle[1], middle[2]), 0.2)
        rows.append([outer, bulge, middle, inner])
    on_both_sides(scene, pillars, "Front", shell(rows, 0.03, 0.005), "Paint red")
    corner = [BOOT + 0.005, 0.5, 0.62, 0.75, 0.88, side(REAR_Z - 0.004)]
    rear_pillar = shell(patch(corner, BELT + 0.005, EAVES - 0.005, 4), 0.02)
    on_both_sides(scene, pillars, "Rear", rear_pillar, "Paint red")


def windows(scene, body):
    group = scene.group("Windows", body)
    rows = [[windscreen(u, v) for u in steps(-1, 1, 6)] for v in steps(0, 1, 3)]
    scene.part("Windscreen", group, shell(rows, 0.006, 0.001, lift=-0.008), "Glass dark")
    outline = [(side(REAR_Z), BELT + 0.005), (side(C_PILLAR - 0.005), BELT + 0.005),
               (side(C_PILLAR - 0.005), EAVES - 0.006), (side(REAR_Z), EAVES - 0.006)]
    opening = [(side(REAR_Z + 0.05), BELT + 0.03), (side(-0.975), BELT + 0.03),
               (side(-0.975), EAVES - 0.041), (side(REAR_Z + 0.08), EAVES - 0.041)]
    on_both_sides(scene, group, "Rear side frame", window_frame(outline, opening), "Plastic black")
    on_both_sides(scene, group, "Rear side", glass(opening), "Glass dark")

    wipers = scene.group("Wipers", body)
    for name, u0, u1, v1 in (("Left", 0.62, 0.05, 0.14), ("Right", -0.02, -0.6, 0.12)):
        blade = [add(windscreen(u0 + (u1 - u0) * t, v1 * t), (0, 0.012, 0.008)) for t in steps(0, 1, 2)]
        scene.part(name, wipers, tube(blade, 0.008, 5), "Plastic black")


def boot_lid(scene, body):
    hinge = add(skin(0, EAVES), (0, 0, 0.03))
    to_hinge = scale(hinge, -1)
    group = scene.group("Boot lid", body, placed(*hinge))
    low, top = LAMP_LOW + 0.01, EAVES - 0.006
    outline = [(-BOOT, low), (BOOT, low), (BOOT, top), (-BOOT, top)]
    opening = [(-0.33, 1.02), (0.33, 1.02), (0.33, EAVES - 0.07), (-0.33, EAVES - 0.07)]
    panel = shell(surround(outline, opening, 4, 3), 0.025, ring=True)
    scene.part("Panel", group, moved(panel, to_hinge), "Paint red")
    window = shell(pane(opening, 0.03, 4), 0.006, 0.001, lift=-0.008)
    scene.part("Window", group, moved(window, to_hinge), "Glass dark")
    across = [(x, EAVES + 0.082 - 0.09 * x * x - 0.15 * x ** 4) for x in steps(-0.53, 0.53, 4)]
    rows = [[(x, y + lift, z + 0.18 * x * x) for x, y in across]
            for lift, z in ((0.006, -1.79), (0, -1.88), (-0.012, -1.96))]
    spoiler = shell(rows, 0.02, 0.006, centre=(0, 0, -1.88))
    scene.part("Spoiler", group, moved(spoiler, to_hinge), "Paint red")
    handle = box((0.5, 0.022, 0.02), 0.005)
    scene.part("Handle", group, handle, "Chrome", placed(*add(add(skin(0, 0.875), (0, 0, -0.008)), to_hinge)))
    place = add(add(skin(0, 0.785), (0, 0, -0.012)), to_hinge)
    scene.part("Number plate", group, NUMBER_PLATE, "Plate", placed(*place))
    wiper = [add(add(skin(p, y), (0, 0, -0.012)), to_hinge)
             for p, y in ((0, 1.0), (-0.02, 1.03), (-0.1, 1.06), (-0.2, 1.075))]
    scene.part("Wiper", group, tube(wiper, 0.008, 5), "Plastic black")


def bumper(start, count, low, high, lift, axle, towards):
    """A band around the car's front or rear, from wheel arch to wheel arch."""
    rows = []
    for y in steps(low, high, count):
        first = side(axle + towards * arch_reach(y))
        corner = [0.03, 0.17, 0.34, 0.52, 0.75, 1]
        left = [first] + [start + towards * t for t in corner]
        middle = start + towards
        rows.append([skin(p, y) for p in left + [2 * middle - p for p in reversed(left[:-1])]])
    return shell(rows, 0.03, 0.01, lift=lift)


def ends(scene, body):
    group = scene.group("Bumpers", body)
    for name, start, axle, towards in (("Front", 2.0, FRONT_AXLE, 1), ("Rear", 1.0, REAR_AXLE, -1)):
        one = scene.group(name, group)
        cover = bumper(start, 2, 0.345, 0.605, 0.014, axle, towards)
        scene.part("Cover", one, cover, "Paint red")
        skirt = bumper(start, 1, SKIRT + 0.001, 0.342, 0.010, axle, towards)
        scene.part("Skirt", one, skirt, "Plastic black")
        if name == "Front":
            rows = patch([front(x) for x in steps(0.46, -0.46, 6)], 0.365, 0.435, 1)
            scene.part("Intake", one, shell(rows, 0.03, 0.008, lift=0.02), "Plastic black")
            place = add(skin(3, 0.515), (0, 0, 0.022))
            scene.part("Number plate", one, NUMBER_PLATE, "Plate", placed(*place))

    grille = scene.group("Grille", body)
    across = [front(x) for x in steps(0.415, -0.415, 4)]
    scene.part("Mesh", grille, shell(patch(across, LAMP_LOW, 0.716, 1), 0.02, lift=-0.012), "Plastic black")
    bars = []
    for y in (0.638, 0.665, 0.692):
        bars += tube([skin(p, y) for p in across], 0.006, 4)
    scene.part("Bars", grille, bars, "Chrome")
    scene.part("Badge", grille, disc(0.042, 0.014), "Chrome", placed(*skin(3, 0.672)))


def lamps(scene, body):
    group = scene.group("Lamps", body)
    amber = 2.2

    def lamp(first, last):
        places = steps(first, last, 5 if last - first > 0.2 else 2)
        rows = patch(places, LAMP_LOW, lambda p: shoulder(p, 0)[1], 3)
        return shell(rows + [[shoulder(p, v) for p in places] for v in (0.33, 0.66, 1)], 0.02, 0.006)

    on_both_sides(scene, group, "Headlamp", lamp(amber + 0.002, LAMP_FRONT), "Lamp clear")
    on_both_sides(scene, group, "Front indicator", lamp(LAMP_REAR, amber - 0.002), "Lamp amber")
    for name, radius, x, y, lift in (("Dipped beam", 0.054, 0.655, 0.685, -0.02),
                                     ("Main beam", 0.048, 0.525, 0.68, -0.02),
                                     ("Fog lamp", 0.042, 0.6, 0.28, -0.012)):
        on_both_sides(scene, group, name, on_skin(disc(radius, 0.03), front(x), y, lift), "Lamp white")
    tail = steps(BOOT + 0.006, TAIL_LAMP, 5)
    for name, low, high, count, material in (("Tail lamp", 0.745, BELT, 3, "Lamp red"),
                                             ("Reversing lamp", 0.685, 0.741, 1, "Lamp white"),
                                             ("Rear indicator", LAMP_LOW, 0.681, 1, "Lamp amber")):
        lens = shell(patch(tail, low, high, count), 0.02, 0.006, lift=0.004)
        on_both_sides(scene, group, name, lens, material)


def structure(scene, body):
    """What stands behind the seams and under the car: black, seen in the gaps and through an open door."""
    group = scene.group("Structure", body)

    def lining(rows, lift=-0.034):
        return shell(rows, 0.012, 0, lift=lift)

    def strip(z, low, high, half=0.04):
        return lining(patch([side(z - half), side(z + half)], low, high, 3))

    frame = strip(0.842, 0.25, 0.93) + strip(B_PILLAR, 0.25, EAVES)
    frame += strip(C_PILLAR + 0.01, 0.46, EAVES, 0.03)
    cant = [side(z) for z in steps(REAR_Z + 0.02, ROOF_FRONT - 0.02, 3)]
    frame += lining(patch(cant, EAVES - 0.035, EAVES + 0.004, 1), -0.04)
    frame += lining([[skin(side(z + d), y) for d in (-0.07, 0.0)]
                     for z, y in ((0.87, 0.93), (0.545, 1.18), (ROOF_FRONT + 0.03, EAVES - 0.02))], -0.037)
    on_both_sides(scene, group, "Side frame", frame, "Plastic black")

    tail = lining(patch([0.34, 0.48, 0.65, 0.82, 1.02], 0.58, EAVES - 0.01, 4))
    tail += lining(patch([side(z) for z in (-1.60, -1.25, -0.93)], BELT - 0.04, BELT + 0.04, 1))
    on_both_sides(scene, group, "Tail frame", tail, "Plastic black")
    sill = lining(patch([rear(x) for x in steps(-0.6, 0.6, 6)], 0.57, 0.67, 1))
    scene.part("Boot sill", group, sill, "Plastic black")

    places = [side(0.86), side(1.25), 2.0, 2.3, 2.6, 3.0]
    places += [6 - p for p in reversed(places[:-1])]
    gutter = lining([[bonnet_edge(p, out) for p in places] for out in (0.02, -0.03)])
    carrier = lining(patch(places[2:-2], 0.56, 0.74, 1))
    scene.part("Front carrier", group, gutter + carrier, "Plastic black")
    cowl = lining([[add(windscreen(u, 0), (0, y, z)) for u in steps(-1, 1, 6)]
                   for y, z in ((0.028, -0.05), (0.01, 0.03), (0, 0.09))])
    scene.part("Cowl", group, cowl, "Plastic black")

    floor = box((1.16, 0.04, 3.9), 0.01, (0, 0.24, 0)) + box((1.56, 0.05, 1.8), 0.01, (0, 0.242, 0.02))
    scene.part("Floor", group, floor, "Plastic black")
    scene.part("Engine", group, box((0.9, 0.44, 0.85), 0.03, (0, 0.46, 1.42)), "Plastic black")
    exhaust = tube([(0.42, 0.2, -1.2), (0.42, 0.2, -1.8), (0.42, 0.19, -2.07)], 0.028, 10)
    scene.part("Exhaust", group, exhaust, "Steel")
    liner = lathe([(0.392, -0.15), (0.392, 0.075), (0.382, 0.075), (0.382, -0.15)], 14, arc=180)
    liner += lathe([(0, -0.149), (0.381, -0.149), (0.381, -0.138), (0, -0.138)], 12, arc=180)
    liner += lathe([(0, -0.09), (0.2, -0.09), (0.2, -0.08), (0, -0.08)], 12, closed=False)
    housings = scene.group("Wheel housings", group)
    for name, z, mirrored in CORNERS:
        scene.part(name, housings, liner, "Plastic black", placed(WHEEL_X, AXLE_Y, z, mirrored))


# ---- wheels ----------------------------------------------------------------------------------------------

WHEEL_X = 0.712
CORNERS = [(f"{row} {name}", z, mirrored) for row, z in (("Front", FRONT_AXLE), ("Rear", REAR_AXLE))
           for name, mirrored in (("left", False), ("right", True))]


def wheels(scene):
    group = scene.group("Wheels")
    parts = (("Tyre", tyre(), "Rubber"), ("Rim", rim(), "Alloy"), ("Disc", brake_disc(), "Steel"))
    for name, z, mirrored in CORNERS:
        wheel = scene.group(name, group, placed(WHEEL_X, AXLE_Y, z, mirrored))
        for part, mesh, material in parts:
            scene.part(part, wheel, mesh, material)


def main():
    scene = Scene("Small estate", COMMENT)
    materials(scene)
    body = scene.group("Body")
    for build in (doors, panels, boot_lid, roof_parts, windows, ends, lamps, structure):
        build(scene, body)
    wheels(scene)
    path = os.path.join(HERE, "car.vrut")
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(scene.text())
    print(f"car.vrut: {scene.nodes} nodes, {scene.triangles} triangles, {os.path.getsize(path)} bytes")


if __name__ == "__main__":
    main()
