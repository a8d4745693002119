"""Pictures as arrays: shapes with smooth edges, letters of strokes, and PNG files. Needs numpy.

Places are in pixels from the top left. A shape is the array of its pixels' distances from its outline, negative
inside."""

import math
import struct
import zlib

import numpy as np

# ---- shapes ----------------------------------------------------------------------------------------------


class Canvas:
    """An RGB picture, 0 to 1, that shapes are painted on."""

    def __init__(self, width, height, colour=(0, 0, 0)):
        self.x, self.y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        self.rgb = np.ones((height, width, 3)) * np.array(colour)

    def paint(self, shape, colour, opacity=1.0, softness=1.0):
        """`softness` is the width of the edge in pixels; the colour may be an array of the picture's size."""
        cover = opacity * np.clip(0.5 - shape / softness, 0, 1)[..., None]
        self.rgb = self.rgb * (1 - cover) + cover * np.array(colour)

    def disc(self, x, y, radius):
        return np.hypot(self.x - x, self.y - y) - radius

    def ring(self, x, y, radius, width):
        return np.abs(self.disc(x, y, radius)) - width / 2

    def box(self, left, top, right, bottom, radius=0.0):
        dx = np.abs(self.x - (left + right) / 2) - (right - left) / 2 + radius
        dy = np.abs(self.y - (top + bottom) / 2) - (bottom - top) / 2 + radius
        return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0) - radius

    def line(self, points, width):
        """Straight pieces with round ends."""
        shape = np.full(self.x.shape, np.inf)
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            dx, dy = bx - ax, by - ay
            t = np.clip(((self.x - ax) * dx + (self.y - ay) * dy) / max(dx * dx + dy * dy, 1e-9), 0, 1)
            shape = np.minimum(shape, np.hypot(self.x - ax - t * dx, self.y - ay - t * dy))
        return shape - width / 2

    def arc(self, x, y, radius, start, end, width):
        """Degrees, clockwise from the top."""
        return self.line([polar(x, y, radius, start + (end - start) * i / 40) for i in range(41)], width)

    def polygon(self, points):
        """Convex, clockwise as seen."""
        shape = np.full(self.x.shape, -np.inf)
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1]):
            length = math.hypot(bx - ax, by - ay)
            shape = np.maximum(shape, ((self.x - ax) * (by - ay) - (self.y - ay) * (bx - ax)) / length)
        return shape

    def text(self, text, x, y, height, width, stretch=1.0, align=0.5):
        """Letters with their middle at y; align 0: from x on, 0.5: about x, 1: up to x."""
        unit = height / 6
        step = 5.6 * unit * stretch
        left = x - align * (step * len(text) - 1.6 * unit * stretch)
        shape = np.full(self.x.shape, np.inf)
        for i, letter in enumerate(text):
            for stroke in LETTERS[letter]:
                points = [(left + i * step + px * unit * stretch, y + (3 - py) * unit) for px, py in stroke]
                shape = np.minimum(shape, self.line(points, width))
        return shape


def polar(x, y, radius, degrees):
    """Clockwise from the top."""
    return x + radius * math.sin(math.radians(degrees)), y - radius * math.cos(math.radians(degrees))


def bow(x, y, rx, ry, start, end):
    """A part of an ellipse in a letter: degrees, anticlockwise from the right."""
    angles = [math.radians(start + (end - start) * i / 12) for i in range(13)]
    return [(x + rx * math.cos(a), y + ry * math.sin(a)) for a in angles]


# Strokes in a field 4 wide and 6 high, from its bottom left.
LETTERS = {
    "0": [bow(2, 4, 2, 2, 0, 180) + bow(2, 2, 2, 2, 180, 360) + [(4, 4)]],
    "1": [[(0.8, 4.7), (2.2, 6), (2.2, 0)]],
    "2": [bow(2, 4.1, 1.9, 1.9, 165, -35) + [(0, 0), (4, 0)]],
    "3": [bow(1.9, 4.5, 1.7, 1.5, 150, -90) + bow(1.9, 1.55, 2, 1.55, 90, -150)],
    "4": [[(3, 0), (3, 6), (0, 1.6), (4, 1.6)]],
    "5": [[(3.6, 6), (0.6, 6), (0.3, 3.2)] + bow(1.9, 1.95, 2, 1.95, 125, -150)],
    "6": [[(3.2, 6), (0.5, 3)] + bow(2, 1.95, 2, 1.95, 150, 510)],
    "7": [[(0, 6), (4, 6), (1.4, 0)]],
    "8": [bow(2, 4.55, 1.6, 1.45, -90, 270), bow(2, 1.55, 2, 1.55, 90, 450)],
    "9": [[(0.8, 0), (3.5, 3)] + bow(2, 4.05, 2, 1.95, -30, 330)],
    "A": [[(0, 0), (2, 6), (4, 0)], [(0.75, 2), (3.25, 2)]],
    "C": [bow(2.2, 3, 2.2, 3, 50, 310)],
    "D": [[(0, 0), (0, 6), (1.5, 6)] + bow(1.5, 3, 2.5, 3, 90, -90) + [(0, 0)]],
    "E": [[(4, 6), (0, 6), (0, 0), (4, 0)], [(0, 3.1), (3.2, 3.1)]],
    "F": [[(4, 6), (0, 6), (0, 0)], [(0, 3), (3.2, 3)]],
    "H": [[(0, 0), (0, 6)], [(4, 0), (4, 6)], [(0, 3), (4, 3)]],
    "R": [[(0, 0), (0, 6), (2.3, 6)] + bow(2.3, 4.4, 1.7, 1.6, 90, -90) + [(0, 2.8)], [(2.2, 2.8), (4, 0)]],
    "T": [[(0, 6), (4, 6)], [(2, 6), (2, 0)]],
    "U": [[(0, 6), (0, 2)] + bow(2, 2, 2, 2, 180, 360) + [(4, 6)]],
    "V": [[(0, 6), (2, 0), (4, 6)]],
    "h": [[(0.5, 0), (0.5, 6)], [(0.5, 2.4)] + bow(2, 2.4, 1.5, 1.5, 180, 0) + [(3.5, 0)]],
    "k": [[(0.5, 0), (0.5, 6)], [(3.3, 3.9), (0.5, 1.6)], [(1.6, 2.5), (3.6, 0)]],
    "m": [[(0, 0), (0, 3.9)], [(0, 2.9)] + bow(1, 2.9, 1, 1, 180, 0) + [(2, 0)], [(2, 2.9)] + bow(3, 2.9, 1, 1, 180, 0)
          + [(4, 0)]],
    "x": [[(0.5, 0), (3.5, 3.9)], [(0.5, 3.9), (3.5, 0)]],
    "/": [[(0.6, 0), (3.4, 6)]],
    ":": [[(2, 1.2), (2, 1.3)], [(2, 3.7), (2, 3.8)]],
    ".": [[(2, 0), (2, 0.1)]],
    "-": [[(0.6, 3), (3.4, 3)]],
    " ": [],
}

# ---- files -----------------------------------------------------------------------------------------------


def to_bytes(values):
    return np.floor(np.clip(values, 0, 1) * 255 + 0.5).astype(np.uint8)


def write(path, pixels, palette=None):
    """Bytes as rows of grey values, RGB or RGBA; or of numbers in a palette of RGB or RGBA."""
    pixels = pixels if pixels.ndim == 3 else pixels[..., None]
    height, width, channels = pixels.shape
    kind = 3 if palette is not None else {1: 0, 3: 2, 4: 6}[channels]
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0))]
    if palette is not None:
        chunks.append((b"PLTE", palette[:, :3].tobytes()))
        if palette.shape[1] == 4:
            chunks.append((b"tRNS", palette[:, 3].tobytes()))
    chunks += [(b"IDAT", packed(pixels)), (b"IEND", b"")]
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks:
            file.write(struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)))


def packed(pixels):
    """The shortest of what PNG's filters give, each used for the whole picture or the best for each row."""
    now = pixels.astype(np.int16)
    left, above, corner = (np.zeros_like(now) for _ in range(3))
    left[:, 1:], above[1:], corner[1:, 1:] = now[:, :-1], now[:-1], now[:-1, :-1]
    guess = left + above - corner
    far = [np.abs(guess - other) for other in (left, above, corner)]
    nearest = np.where((far[0] <= far[1]) & (far[0] <= far[2]), left, np.where(far[1] <= far[2], above, corner))
    filtered = [((now - other) & 255).astype(np.uint8)
                for other in (np.zeros_like(now), left, above, (left + above) // 2, nearest)]
    cost = [np.abs(f.astype(np.int8).astype(int)).sum(axis=(1, 2)) for f in filtered]
    choices = [[number] * len(now) for number in range(5)] + [list(np.argmin(cost, axis=0))]
    results = []
    for choice in choices:
        raw = b"".join(bytes([n]) + filtered[n][row].tobytes() for row, n in enumerate(choice))
        results.append(zlib.compress(raw, 9))
    return min(results, key=len)
