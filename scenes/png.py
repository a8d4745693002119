"""Reads and writes PNG pictures, in plain Python."""

import struct
import zlib

CHANNELS = {0: 1, 2: 3, 6: 4}  # by PNG's colour type
COLOUR_TYPE = {count: kind for kind, count in CHANNELS.items()}


def write(path, width, height, channels, rows):
    """`rows` from the top, each `width` · `channels` bytes; 1 channel is grey, 3 RGB, 4 RGBA."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, COLOUR_TYPE[channels], 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def paeth(a, b, c):
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


def read(path):
    """Width, height, channels and rows of a picture of 8 bits a channel that is not interlaced."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height, _, colour_type = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
    channels, raw = CHANNELS[colour_type], zlib.decompress(packed)
    size, above, rows = width * channels, bytearray(width * channels), []
    for y in range(height):
        start = y * (size + 1)
        row = bytearray(raw[start + 1:start + 1 + size])
        for x in range(size if raw[start] else 0):
            a, c = (row[x - channels], above[x - channels]) if x >= channels else (0, 0)
            b = above[x]
            row[x] = (row[x] + (0, a, b, (a + b) // 2, paeth(a, b, c))[raw[start]]) & 255
        rows.append(row)
        above = row
    return width, height, channels, rows
