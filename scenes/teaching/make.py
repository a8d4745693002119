"""Writes what is too long to write by hand: the shapes at the end of the teaching scenes, and their pictures.

A scene that needs shapes has a line `# ---- shapes, made by make.py ---- 1 ball, 2 cone 24`, which names a
geometry's id and its shape; all below that line is made anew. What stands above it is written by hand.
"""

import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import png  # noqa: E402
from modelling import box, geometry_text, indexed, lathe, moved, quad, scale, turned, unit  # noqa: E402

# ---- shapes ----------------------------------------------------------------------------------------------
# Each gives (point, normal) pairs, the triangles that name them by number, and whether the normals are written.


def shaded(mesh):
    vertices, triangles = indexed(mesh)
    return vertices, triangles, True


def ball(segments=20, rings=12):
    """Of radius 1, about the origin."""
    profile = [(math.sin(math.pi * i / rings), -math.cos(math.pi * i / rings)) for i in range(rings + 1)]
    profile[0], profile[-1] = (0, -1), (0, 1)
    vertices, triangles, _ = shaded(turned(lathe(profile, segments, closed=False), 2, 90))
    return [(p, tuple(round(c, 3) for c in unit(p))) for p, _ in vertices], triangles, True


def flat_ball():
    vertices, triangles, _ = ball(12, 8)
    return vertices, triangles, False


def unusual_ball():
    """Normals of every length; those of the upper third are 0."""
    vertices, triangles, _ = ball(12, 8)
    lengths = (0.01, 1, 100, 7)
    return [(p, scale(n, 0 if p[1] > 0.6 else lengths[i % 4])) for i, (p, n) in enumerate(vertices)], triangles, True


def fine_ball():
    return ball(36, 20)


def cube():
    """Of side 1, about the origin, its edges bevelled."""
    return shaded(box((1, 1, 1), 0.05))


def cone(segments):
    """Stands on y = 0, 2 high."""
    return shaded(turned(lathe([(0, 0), (0.8, 0), (0, 2)], segments, closed=False), 2, 90))


def ring():
    """In the plane z = 0, of outer radius 1.4."""
    profile = [(1.2 + 0.2 * math.cos(a), 0.3 * math.sin(a)) for a in (math.pi * k / 5 for k in range(10))]
    return shaded(turned(lathe(profile, 28), 1, 90))


def pipe():
    """An upright pipe with no thickness, open at both ends, whose front faces inwards."""
    corners = [(math.sin(a), math.cos(a)) for a in (math.pi * k / 12 for k in range(24))]
    mesh = []
    for (x, z), (u, w) in zip(corners, corners[1:] + corners[:1]):
        mesh += quad((x, -0.8, z), (x, 0.8, z), (u, 0.8, w), (u, -0.8, w))
    return shaded(mesh)


def bent_sheet():
    """2 by 2, curved about the vertical, facing +z."""
    turns = [math.radians(6 * k - 48) for k in range(17)]
    columns = [(1.35 * math.sin(a), 1.35 * math.cos(a) - 1.1) for a in turns]
    mesh = []
    for (x, z), (u, w) in zip(columns, columns[1:]):
        mesh += quad((x, -1, z), (u, -1, w), (u, 1, w), (x, 1, z))
    return shaded(mesh)


def letter():
    """An F, 1.5 high and 0.3 thick: no mirror image looks like it."""
    rectangles = [(0, 0, 0.3, 0.5), (0, 0.5, 0.3, 0.8), (0.3, 0.5, 0.75, 0.8), (0, 0.8, 0.3, 1.2), (0, 1.2, 0.3, 1.5),
                  (0.3, 1.2, 0.95, 1.5)]
    outline = [(0, 0), (0.3, 0), (0.3, 0.5), (0.75, 0.5), (0.75, 0.8), (0.3, 0.8), (0.3, 1.2), (0.95, 1.2),
               (0.95, 1.5), (0, 1.5), (0, 1.2), (0, 0.8), (0, 0.5)]
    mesh = []
    for x, y, u, v in rectangles:
        mesh += quad((x, y, 0.3), (u, y, 0.3), (u, v, 0.3), (x, v, 0.3))
        mesh += quad((x, y, 0), (x, v, 0), (u, v, 0), (u, y, 0))
    for (x, y), (u, v) in zip(outline, outline[1:] + outline[:1]):
        mesh += quad((x, y, 0), (u, v, 0), (u, v, 0.3), (x, y, 0.3))
    return shaded(moved(mesh, (-0.475, -0.75, -0.15)))


SHAPES = {"ball": ball, "flat ball": flat_ball, "unusual ball": unusual_ball, "fine ball": fine_ball, "cube": cube,
          "cone": cone, "ring": ring, "pipe": pipe, "bent sheet": bent_sheet, "letter": letter}
MARK = "# ---- shapes, made by make.py ----"


def with_shapes(text):
    above, mark, below = text.partition(MARK)
    if not mark:
        return text
    wanted = below.splitlines()[0]
    blocks = []
    for item in wanted.split(","):
        gid, *words = item.split()
        counts = [int(word) for word in words if word.isdigit()]
        shape = SHAPES[" ".join(word for word in words if not word.isdigit())]
        blocks.append(geometry_text(gid, *shape(*counts)))
    return above + mark + wanted + "\n" + "\n".join(blocks) + "\n"


# ---- pictures --------------------------------------------------------------------------------------------


def draw(name, width, height, pixel, channels=3):
    """`pixel` gives the colour, 0 to 1, at the middle of a pixel; x and y from the bottom left, 0 to 1."""
    rows = []
    for row in range(height):
        colours = (pixel((column + 0.5) / width, 1 - (row + 0.5) / height) for column in range(width))
        rows.append(bytes(int(255 * min(max(c, 0), 1) + 0.5) for colour in colours for c in colour))
    png.write(os.path.join(HERE, "textures", name), width, height, channels, rows)


CREAM, INK = (0.95, 0.91, 0.82), (0.16, 0.22, 0.34)
RED, GREEN, BLUE, YELLOW = (0.80, 0.24, 0.18), (0.30, 0.62, 0.36), (0.20, 0.42, 0.75), (0.95, 0.78, 0.25)


def mixed(a, b, t):
    t = min(max(t, 0), 1)
    return tuple((1 - t) * p + t * q for p, q in zip(a, b))


def letter_card(x, y):
    """An R in a frame; its corners are red, green, blue and yellow, counter-clockwise from the bottom left."""
    if (x < 0.19 or x > 0.81) and (y < 0.19 or y > 0.81):
        return (YELLOW if x < 0.5 else BLUE) if y > 0.5 else (RED if x < 0.5 else GREEN)
    if min(x, y, 1 - x, 1 - y) < 0.05:
        return INK
    bowl = math.hypot(max(x - 0.5, 0), y - 0.63)
    stem = 0.28 < x < 0.4 and 0.2 < y < 0.8
    leg = 0.2 < y < 0.48 and abs(x - (0.72 - 0.9 * (y - 0.2))) < 0.075
    arc = x > 0.28 and 0.06 < bowl < 0.17 and (x > 0.5 or abs(y - 0.63) > 0.06)
    return INK if stem or leg or arc else CREAM


def pixels(x, y):
    """6 by 5, no two neighbours alike."""
    column, row = int(6 * x), int(5 * y)
    return (RED, CREAM, BLUE, YELLOW, GREEN, INK)[(column * (row + 1) + 3 * row) % 6]


def checker(x, y):
    return (0.88, 0.85, 0.78) if (int(8 * x) + int(8 * y)) % 2 else (0.28, 0.38, 0.42)


def leaf(x, y):
    """An upright leaf with a bite out of its right side; soft edges."""
    width = 0.36 * math.sin(math.pi * min(max((y - 0.06) / 0.88, 0), 1)) ** 0.8
    inside = min(width - abs(x - 0.5), math.hypot(x - 0.82, y - 0.6) - 0.17)
    vein = min(abs(x - 0.5), abs((y - 0.12) % 0.16 - 0.6 * abs(x - 0.5) % 0.16))
    return (*mixed((0.70, 0.80, 0.40), (0.22, 0.52, 0.25), vein / 0.03), min(max(0.5 + inside * 24, 0), 1))


def hills(x, y):
    """An evening sky, the sun on the left, three ranges of hills."""
    colour = mixed((0.98, 0.80, 0.55), (0.36, 0.52, 0.76), (y - 0.25) / 0.6)
    colour = mixed((1, 0.95, 0.80), colour, (math.hypot(1.5 * (x - 0.25), y - 0.62) - 0.08) / 0.02)
    for k, shade in enumerate(((0.52, 0.50, 0.58), (0.34, 0.42, 0.42), (0.20, 0.30, 0.26))):
        edge = 0.42 - 0.11 * k + 0.05 * math.sin(5 * x + 2.1 * k) + 0.025 * math.sin(13 * x + k)
        colour = mixed(shade, colour, (y - edge) / 0.012)
    return colour


def studs(x, y):
    """The normals of four by four rounded studs on a plane, from 0 to 1."""
    u, v = (4 * x) % 1 * 2 - 1, (4 * y) % 1 * 2 - 1
    radius = math.hypot(u, v)
    slope = 0.9 * math.sin(math.pi * min(radius / 0.8, 1)) / max(radius, 1e-6)
    return tuple(0.5 + 0.5 * c for c in unit((slope * u, slope * v, 1)))


def worn(x, y):
    """Paint with scratches down to the metal: darker in the joints, rough paint, smooth metal."""
    joint = min((4 * x) % 1, 1 - (4 * x) % 1, (4 * y) % 1, 1 - (4 * y) % 1)
    scratch = max(math.sin(31 * x + 9 * y) * math.sin(5 * x - 23 * y + 1), 0) ** 2
    metal = min(max((scratch - 0.3) * 6, 0), 1)
    return (mixed((0.35,), (1,), joint / 0.12)[0], 0.9 - 0.6 * metal, metal)


FACES = ("px", "nx", "py", "ny", "pz", "nz")
DOTS = {1: [(1, 1)], 2: [(0, 0), (2, 2)], 3: [(0, 0), (1, 1), (2, 2)], 4: [(0, 0), (0, 2), (2, 0), (2, 2)],
        5: [(0, 0), (0, 2), (1, 1), (2, 0), (2, 2)], 6: [(0, 0), (0, 1), (0, 2), (2, 0), (2, 1), (2, 2)]}
TINTS = ((0.80, 0.30, 0.24), (0.24, 0.56, 0.60), (0.50, 0.52, 0.56), (0.86, 0.84, 0.80), (0.24, 0.40, 0.70),
         (0.90, 0.58, 0.20))


def studio(face):
    """A side of the studio: walls that darken downwards, a bright ceiling, a dark floor, and dots to count."""
    def pixel(x, y):
        if face == 2:
            colour = (0.94, 0.95, 0.97)
        elif face == 3:
            colour = (0.34, 0.33, 0.32)
        else:
            colour = mixed((0.34, 0.33, 0.32), (0.94, 0.95, 0.97), y)
        nearest = min(math.hypot(x - 0.5 - 0.2 * (i - 1), y - 0.5 - 0.2 * (j - 1)) for i, j in DOTS[face + 1])
        colour = mixed(TINTS[face], colour, (nearest - 0.075) * 64)
        along = abs(x - 0.5) if face > 1 else 1  # a stroke towards the top, to see which way up ceiling and floor are
        return TINTS[face] if face in (2, 3) and along < 0.03 and 0.86 < y < 0.97 else colour
    return pixel


def main():
    os.makedirs(os.path.join(HERE, "textures"), exist_ok=True)
    draw("letter.png", 64, 64, letter_card)
    draw("pixels.png", 6, 5, pixels)
    draw("checker.png", 64, 64, checker)
    draw("leaf.png", 64, 64, leaf, channels=4)
    draw("hills.png", 96, 64, hills)
    draw("studs.png", 64, 64, studs)
    draw("worn.png", 64, 64, worn)
    for i, name in enumerate(FACES):
        draw(f"studio-{name}.png", 64, 64, studio(i))
    for name in sorted(os.listdir(HERE)):
        if name.endswith(".vrut"):
            path = os.path.join(HERE, name)
            with open(path, encoding="utf-8") as file:
                text = with_shapes(file.read())
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)


if __name__ == "__main__":
    main()
