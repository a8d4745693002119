#!/usr/bin/env python3
"""Makes the pictures in textures/: the photo studio around the car, its shadow on the floor, and what is printed on its
parts. The same bytes every time. Needs numpy (on Debian: /usr/bin/python3 and python3-numpy)."""

import math
import os

import numpy as np

from pixels import Canvas, polar, to_bytes, write

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "textures")
WHITE, BLACK = (0.96, 0.97, 0.98), (0.02, 0.02, 0.02)


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def blurred(values, radius):
    """Each row and column, by a bell curve; edges go on."""
    bell = np.exp(-0.5 * (np.arange(-3 * radius, 3 * radius + 1) / radius) ** 2)
    bell /= bell.sum()
    for axis in range(values.ndim):
        pad = [(3 * radius, 3 * radius) if a == axis else (0, 0) for a in range(values.ndim)]
        values = np.apply_along_axis(np.convolve, axis, np.pad(values, pad, mode="edge"), bell, "valid")
    return values


# ---- the studio ------------------------------------------------------------------------------------------

FACE = 512
# What a camera sees whose view and whose up are these.
FACES = {"px": ((1, 0, 0), (0, 1, 0)), "nx": ((-1, 0, 0), (0, 1, 0)), "py": ((0, 1, 0), (0, 0, 1)),
         "ny": ((0, -1, 0), (0, 0, -1)), "pz": ((0, 0, 1), (0, 1, 0)), "nz": ((0, 0, -1), (0, 1, 0))}
# Floor and wall run into each other: brightness by degrees above the horizon. The floor is lit around the car (as seen
# from a few metres away); the wall is darkest where paint and chrome show it between floor and lamps.
COVE = ((-90, 0.20), (-45, 0.24), (-24, 0.295), (-15, 0.345), (-9, 0.395), (-4, 0.44), (0, 0.52), (3, 0.58), (6, 0.59),
        (9, 0.50), (12, 0.30), (15, 0.17), (20, 0.12), (60, 0.07), (90, 0.06))


def cove(elevation):
    degrees = np.arange(-90, 90.25, 0.25)
    curve = blurred(np.interp(degrees, *zip(*COVE)), 6)
    return np.interp(elevation, degrees, curve)


def soft_box(x, y, z, azimuth, elevation, half_width, half_height, edges, fade=0.0):
    """How bright it is, seen from the origin: on a plane at distance 1 towards `azimuth` (degrees from +z towards +x)
    and `elevation`. `edges`: the widths over which it ends at the sides, below and above; `fade`: what its upper edge
    lacks of the lower one's brightness."""
    a, e = math.radians(azimuth), math.radians(elevation)
    ahead = x * math.sin(a) * math.cos(e) + y * math.sin(e) + z * math.cos(a) * math.cos(e)
    right = x * math.cos(a) - z * math.sin(a)
    up = -x * math.sin(a) * math.sin(e) + y * math.cos(e) - z * math.cos(a) * math.sin(e)
    near = np.maximum(ahead, 1e-6)
    u, v = np.abs(right / near), up / near
    side, below, above = edges
    shape = smoothstep(half_width + side / 2, half_width - side / 2, u)
    shape = shape * smoothstep(-half_height - below / 2, -half_height + below / 2, v)
    shape = shape * smoothstep(half_height + above / 2, half_height - above / 2, v)
    shape = shape * (1 - 0.12 * (u / half_width) ** 2) * (1 - fade * smoothstep(-half_height, half_height, v))
    return np.where(ahead > 0, shape, 0)


def studio(direction):
    """Brightness towards unit directions."""
    x, y, z = direction
    elevation = np.degrees(np.arcsin(np.clip(y, -1, 1)))
    light = cove(elevation)
    for azimuth, most in ((-145, 0.10), (-35, 0.05), (35, 0.05), (145, 0.07)):  # washes of light on the wall
        a = math.radians(azimuth)
        towards = (x * math.sin(a) + z * math.cos(a)) / np.maximum(np.hypot(x, z), 1e-6)
        light = light + most * np.exp(-((elevation - 7) / 9) ** 2) * np.exp((towards - 1) * 2.2)
    lamps = [1.00 * soft_box(x, y, z, 0, 90, 0.30, 1.05, (0.20, 0.30, 0.30)),  # over the car, along it
             1.00 * soft_box(x, y, z, 90, 42, 2.0, 0.28, (0.7, 0.18, 0.24), 0.5),  # along both sides
             0.94 * soft_box(x, y, z, -90, 42, 2.0, 0.28, (0.7, 0.18, 0.24), 0.5),
             0.92 * soft_box(x, y, z, 3, 29, 0.28, 0.13, (0.18, 0.12, 0.14), 0.3),  # before and behind the car
             0.92 * soft_box(x, y, z, 184, 29, 0.34, 0.13, (0.18, 0.12, 0.14), 0.3)]
    for lamp in lamps:
        light = light + np.maximum(lamp - light, 0) * smoothstep(0, 0.3, lamp)
    return light


def toned(brightness):
    """RGB bytes: shadows a little cool, lamps white. The channels are rounded at different places, so that a smooth
    gradient has steps a third as high."""
    v = brightness[..., None]
    return to_bytes(v + v * (1 - v) * np.array((-0.055, -0.01, 0.065)) + np.array((0, 1 / 3, -1 / 3)) / 255)


def write_studio():
    at = (np.arange(FACE) + 0.5) / FACE * 2 - 1
    u, v = np.meshgrid(at, -at)
    for name, (view, up) in FACES.items():
        view, up = np.array(view), np.array(up)
        right = np.cross(view, up)
        direction = [view[i] + u * right[i] + v * up[i] for i in range(3)]
        length = np.sqrt(sum(c * c for c in direction))
        write(path(f"{name}.png"), toned(studio([c / length for c in direction])))


def write_floor_shadow():
    """Under the car, on 2.4 x 5 m: its alpha. The car's front is at the picture's top."""
    width, length = 144, 300
    x, z = np.meshgrid(((np.arange(width) + 0.5) / width - 0.5) * 2.4, (0.5 - (np.arange(length) + 0.5) / length) * 5)

    def box(cx, cz, half_x, half_z, radius):
        dx, dz = np.abs(x - cx) - half_x + radius, np.abs(z - cz) - half_z + radius
        return np.hypot(np.maximum(dx, 0), np.maximum(dz, 0)) + np.minimum(np.maximum(dx, dz), 0) - radius

    car = box(0, -0.04, 0.82, 2.06, 0.35)
    through = 1 - 0.80 * smoothstep(0.16, -0.34, car)  # what light is left: under the car, ...
    through *= 1 - 0.42 * np.exp(-np.maximum(car + 0.1, 0) / 0.20)  # ... around it ...
    for cz in (1.28, -1.28):  # ... and at the tyres
        for cx in (-0.735, 0.735):
            tyre = box(cx, cz, 0.10, 0.10, 0.05)
            through *= 1 - 0.75 * np.exp(-np.maximum(tyre, 0) / 0.075)
    fade = smoothstep(-0.02, -0.42, box(0, 0, 1.2, 2.5, 0.75))  # as the sheet is rounded
    palette = np.zeros((256, 4), np.uint8)
    palette[:, 3] = np.arange(256)
    write(path("floor_shadow.png"), to_bytes((1 - through) * fade), palette)


# ---- what is printed -------------------------------------------------------------------------------------


def write_plate():
    """520 x 110 mm, of a land that does not exist."""
    c = Canvas(416, 88, (0.06, 0.06, 0.06))
    c.paint(c.box(2, 2, 414, 86, 9), WHITE)
    c.paint(np.abs(c.box(6, 6, 410, 82, 7)) - 1, BLACK)
    c.paint(c.box(10, 10, 46, 78, 4), (0.08, 0.20, 0.50))
    c.paint(np.abs(c.disc(28, 32, 9)) - 1.5, (0.95, 0.8, 0.2))
    c.paint(c.text("VR", 28, 62, 14, 2.4, 0.85), WHITE)
    c.paint(c.text("VRT", 132, 44, 50, 7.6, 0.75), BLACK)
    c.paint(c.text("2010", 312, 44, 50, 7.6, 0.75), BLACK)
    c.paint(c.disc(214, 31, 8), (0.75, 0.12, 0.1))
    c.paint(c.disc(214, 57, 8), (0.1, 0.42, 0.2))
    c.paint(c.text("10", 214, 57, 7, 1.2, 0.9), WHITE)
    write_few_colours("plate.png", c.rgb)


def write_badge():
    """VRUT's own: a V of two wings over a ring."""
    c = Canvas(128, 128, (0.62, 0.64, 0.67))
    shade = np.clip(0.72 + 0.26 * (64 - c.y) / 64, 0, 1)[..., None] * np.array((0.96, 0.98, 1))
    c.paint(c.disc(64, 64, 62), shade)
    c.paint(c.disc(64, 64, 53), (0.05, 0.10, 0.20))
    c.paint(c.ring(64, 64, 49, 1.6), (0.45, 0.55, 0.7))
    for side in (-1, 1):
        wing = [(64 + side * 35, 38), (64 + side * 17, 38), (64, 80), (64, 102)]
        c.paint(c.polygon(wing if side < 0 else wing[::-1]), shade)
    c.paint(c.disc(64, 44, 8), shade)
    write_few_colours("badge.png", c.rgb)


def write_dials():
    """Speed at the right, engine speed at the left, temperature, fuel and a display between them."""
    c = Canvas(512, 192, (0.025, 0.027, 0.032))
    red, dim = (0.92, 0.15, 0.08), (0.45, 0.48, 0.52)

    def dial(x, y, radius, marks, numbers, size, low=-130, high=130):
        c.paint(c.disc(x, y, radius + 7), (0.30, 0.31, 0.33))
        c.paint(c.disc(x, y, radius + 4), (0.03, 0.032, 0.038))
        c.paint(c.disc(x, y, radius - 24), (0.055, 0.058, 0.066), softness=12)
        for i in range(marks + 1):
            long = i % 2 == 0
            a = low + (high - low) * i / marks
            ends = [polar(x, y, radius - r, a) for r in (2, 11 if long else 7)]
            c.paint(c.line(ends, 2.2 if long else 1.2), WHITE if long else dim)
        for i, text in enumerate(numbers):
            tx, ty = polar(x, y, radius - 21, low + (high - low) * i / (len(numbers) - 1))
            c.paint(c.text(text, tx, ty, size, 1.5, 0.8), WHITE)

    def needle(x, y, radius, angle, hub):
        c.paint(c.line([polar(x, y, hub, angle), polar(x, y, radius, angle)], 3), red)
        c.paint(c.disc(x, y, hub), (0.10, 0.10, 0.11))
        c.paint(c.ring(x, y, hub, 1.2), (0.3, 0.3, 0.32))

    dial(108, 98, 78, 28, ["0", "1", "2", "3", "4", "5", "6", "7"], 11)
    c.paint(c.arc(108, 98, 73, 100, 130, 5), red, 0.85)
    c.paint(c.text("x1000", 108, 140, 8, 1.1, 0.8), dim)
    needle(108, 98, 66, -130 + 260 * 0.8 / 7, 11)
    dial(404, 98, 78, 24, [str(n) for n in range(0, 260, 40)], 9.5)
    c.paint(c.text("km/h", 404, 140, 8, 1.2, 0.85), dim)
    needle(404, 98, 66, -130, 11)

    c.paint(c.box(206, 78, 306, 176, 5), (0.20, 0.21, 0.22))
    c.paint(c.box(208, 80, 304, 174, 4), (0.03, 0.05, 0.08))
    c.paint(c.text("14:20", 256, 98, 15, 1.8, 0.85), (0.75, 0.88, 1))
    c.paint(c.text("21.5 C", 256, 122, 11, 1.4, 0.85), (0.6, 0.74, 0.9))
    c.paint(c.line([(218, 136), (294, 136)], 1), (0.3, 0.4, 0.5))
    c.paint(c.text("2010.4 km", 256, 154, 10, 1.3, 0.8), (0.6, 0.74, 0.9))
    for x, low, high, at in ((222, "C", "H", 0.5), (290, "E", "F", 0.8)):
        c.paint(c.arc(x, 50, 24, -70, 70, 2), dim)
        c.paint(c.arc(x, 50, 24, *((45, 70) if low == "C" else (-70, -45)), 3), red)
        c.paint(c.line([(x, 50), polar(x, 50, 22, -70 + 140 * at)], 2.2), red)
        c.paint(c.disc(x, 50, 4), (0.2, 0.2, 0.21))
        c.paint(c.text(low, x - 20, 56, 7, 1.1, 0.8), dim)
        c.paint(c.text(high, x + 20, 56, 7, 1.1, 0.8), dim)
    for x, colour in ((238, (0.1, 0.7, 0.25)), (274, (0.1, 0.7, 0.25))):
        side = 1 if x > 256 else -1
        arrow = [(x - side * 4, 14), (x + side * 5, 20), (x - side * 4, 26)]
        c.paint(c.polygon(arrow if side > 0 else arrow[::-1]), colour, 0.5)
    write_glowing("dials.png", c.rgb)


def write_screen():
    """A map in perspective with a route, and the next turn."""
    c = Canvas(320, 192, (0.16, 0.20, 0.22))
    depth = np.clip((c.y - 34) / 158, 0, 1)
    c.rgb = np.array((0.20, 0.25, 0.26)) * (0.75 + 0.35 * depth[..., None])

    def ground(x, y):
        """From the map, x to the right and y ahead, to the picture."""
        s = 1 / (0.55 + 0.45 * y)
        return 175 + x * 105 * s, 22 + 165 * s * 0.62

    def road(points, width, colour):
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            steps = [ground(ax + (bx - ax) * t / 8, ay + (by - ay) * t / 8) for t in range(9)]
            for k, (p, q) in enumerate(zip(steps, steps[1:])):
                y = ay + (by - ay) * (k + 0.5) / 8
                c.paint(c.line([p, q], max(width / (0.55 + 0.45 * y), 1)), colour)

    green, blue = (0.18, 0.33, 0.24), (0.14, 0.27, 0.42)
    patches = ((-1.9, 0.6, -0.75, 1.8, green), (0.6, 2.3, 2.2, 3.6, green), (-3, 2.6, -0.8, 3.4, blue))
    for x0, y0, x1, y1, colour in patches:
        c.paint(c.polygon([ground(x0, y1), ground(x1, y1), ground(x1, y0), ground(x0, y0)]), colour)
    grey = (0.52, 0.55, 0.58)
    for points in ([(-4, 0.3), (4, 0.5)], [(-4, 2.1), (4, 2.2)], [(-5, 4), (5, 3.9)], [(-1.3, -0.3), (-0.9, 6)],
                   [(1.3, -0.3), (1.5, 6)], [(3, 0), (3.2, 6)], [(-3, 0), (-3, 6)], [(0.1, 2.1), (-0.2, 6)]):
        road(points, 4, grey)
    route = [(0, -0.4), (0.05, 1), (0.1, 2.12), (1.38, 2.14), (1.45, 5)]
    road(route, 10, (0.06, 0.20, 0.42))
    road(route, 7, (0.20, 0.62, 1.0))
    x, y = ground(0.02, 0.6)
    c.paint(c.disc(x, y, 15), WHITE, 0.25, 3)
    for side in (-1, 1):
        arrow = [(x, y - 13), (x + side * 9, y + 9), (x, y + 4)]
        c.paint(c.polygon(arrow if side > 0 else arrow[::-1]), (0.95, 0.4, 0.1) if side > 0 else (1, 0.55, 0.2))
    sky = smoothstep(44, 26, c.y)[..., None]
    c.rgb = c.rgb * (1 - sky) + sky * np.array((0.30, 0.42, 0.55))
    c.paint(c.box(0, 0, 320, 24), (0.05, 0.06, 0.08), 0.92)
    c.paint(c.text("14:20", 30, 12, 11, 1.4, 0.8), WHITE)
    c.paint(c.text("12.4 km", 270, 12, 10, 1.3, 0.8), (0.8, 0.85, 0.9))
    c.paint(c.box(8, 34, 82, 106, 7), (0.05, 0.07, 0.10), 0.9)
    c.paint(c.line([(34, 80), (34, 60), (52, 60)], 6), WHITE)
    c.paint(c.polygon([(50, 49), (64, 60), (50, 71)]), WHITE)
    c.paint(c.text("200 m", 45, 94, 10, 1.4, 0.75), WHITE)
    c.paint(c.box(0, 168, 320, 192), (0.05, 0.06, 0.08), 0.92)
    for k in range(5):
        c.paint(c.box(40 + k * 56, 176, 64 + k * 56, 184, 3), (0.20, 0.62, 1) if k == 1 else (0.35, 0.38, 0.42))
    write_glowing("screen.png", c.rgb)


def write_cloth():
    """Seat fabric that tiles: fine ribs along v, with thin lines of dashes."""
    n = 128
    v, u = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    noise = np.random.default_rng(7).random((n, n))
    noise = (noise + np.roll(noise, 1, 0) + np.roll(noise, 2, 0)) / 3  # threads run along v
    weave = 0.5 + 0.5 * np.cos(2 * np.pi * u / 8) * (0.75 + 0.25 * np.cos(2 * np.pi * (v / 4 + (u // 8) % 2 / 2)))
    grey = 0.15 + 0.10 * weave + 0.07 * (noise - 0.5)
    dash = ((u % 32) // 4 == 3) & (((v + (u // 32) * 8) % 16) < 10)
    grey = np.where(dash, grey + 0.16, grey)
    tones = to_bytes(np.arange(256)[:, None] / 255 * np.array((0.97, 0.99, 1.06)))
    write(path("cloth.png"), to_bytes(np.round(grey * 32) / 32), tones)


def write_hall():
    """An exhibition hall at dusk, out of focus: rows of lamps towards a glass front, and their shine on the floor."""
    c = Canvas(960, 540)
    middle, horizon = 480, 190
    above = np.clip((horizon - c.y) / horizon, 0, 1)
    below = np.clip((c.y - horizon) / (540 - horizon), 0, 1)
    wall = np.interp(above, (0, 0.16, 0.5, 1), (0.50, 0.44, 0.24, 0.12))
    floor = np.interp(below, (0, 0.08, 0.4, 1), (0.46, 0.38, 0.28, 0.20))
    light = np.where(c.y < horizon, wall, floor)
    light = light * (1 - 0.30 * (np.abs(c.x - middle) / middle) ** 2)
    light = light + 0.22 * np.exp(-((c.x - middle) / 300) ** 2 - ((c.y - horizon + 8) / 60) ** 2)
    tone = np.clip((light - 0.1) / 0.5, 0, 1)[..., None]
    c.rgb = light[..., None] * (np.array((0.86, 0.96, 1.14)) * (1 - tone) + np.array((1.04, 1.0, 0.94)) * tone)
    for row in (-2.1, -0.7, 0.7, 2.1):
        for k in range(7):
            near, far = 1.25 + 0.9 * k, 1.70 + 0.9 * k
            ends = [(middle + 330 * x / d, horizon - 184 / d) for x, d in
                    ((row - 0.14, near), (row + 0.14, near), (row + 0.14, far), (row - 0.14, far))]
            c.paint(c.polygon(ends), (0.98, 0.96, 0.90), 0.92, softness=14 / near)
            shine = [(x, 2 * horizon - y) for x, y in reversed(ends)]
            c.paint(c.polygon(shine), (0.62, 0.62, 0.62), 0.30, softness=60 / near)
    write(path("hall.png"), to_bytes(c.rgb))


def write_few_colours(name, colours):
    """RGB or RGBA, with a palette: colours rounded until they are at most 256."""
    channels = colours.shape[-1]
    for levels in (32, 24, 18, 14, 11, 9, 7):
        rounded = to_bytes(np.round(colours * levels) / levels)
        palette, numbers = np.unique(rounded.reshape(-1, channels), axis=0, return_inverse=True)
        if len(palette) <= 256:
            break
    write(path(name), numbers.reshape(colours.shape[:2]).astype(np.uint8), palette)


def write_glowing(name, rgb):
    """For a layer before something black: alpha is brightness, so that a material's emission or ambient shows the
    picture. The colours are what light has to add to 0.28 of it."""
    most = rgb.max(axis=2, keepdims=True)
    colour = np.clip((rgb / np.maximum(most, 0.04) - 0.28) / 0.72, 0, 1)
    write_few_colours(name, np.concatenate([colour, most], axis=2))


def path(name):
    return os.path.join(FOLDER, name)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    write_studio()
    write_floor_shadow()
    for make in (write_plate, write_badge, write_dials, write_screen, write_cloth, write_hall):
        make()


if __name__ == "__main__":
    main()
