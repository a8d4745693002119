#!/usr/bin/env python3
"""Writes a table of the gap between two parts as CSV: where it was measured, and how wide it is there.

The ends of their paths in the scene's tree name the parts. The script looks at the scene from one side,
goes along lines across the picture, and measures wherever the second part follows the first. A width is the
distance of the second part's edge from the line along the first one's, in the unit that the room shows.

It takes control, and gives it back at its end; the camera comes back, too. Needs python3-websockets (Debian)
or `pip install websockets`. The environment may give the server's address and token as VRUT_PREVIEW_URL and
VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import csv
import json
import os
import sys
import urllib.parse

import websockets

NAME = "Gap table"
WIDTH, HEIGHT = 1600, 900
STEP = 4  # pixels between picks
WIDEST = 60  # pixels between the parts, else they are no neighbours there
PER_METRE = {"mm": 1000, "cm": 100, "m": 1, "in": 1 / 0.0254}


class Server:
    """One connection: requests that are answered one after the other."""

    def __init__(self, socket):
        self.socket, self.requests, self.measured = socket, 0, {}

    async def receive(self):
        async for received in self.socket:
            if isinstance(received, bytes):
                continue
            message = json.loads(received)
            if message["type"] == "error":
                raise SystemExit(f"gaps.py: {message['message']}")
            if message["type"] == "patch":
                self.measured.update((message["patch"].get("measured") or {}).get(NAME) or {})
            return message

    async def send(self, **message):
        self.requests += 1
        await self.socket.send(json.dumps({"id": self.requests, **message}))
        while (answer := await self.receive()).get("id") != self.requests:
            pass
        return answer

    async def state(self):
        while (message := await self.receive())["type"] != "state":
            pass
        return message["state"]


class Scan:
    """Picks in the present view, along lines across it or, with `down`, down it."""

    def __init__(self, server, parts, down):
        self.server, self.parts, self.down = server, parts, down

    def place(self, line, along):
        return {"x": line, "y": along} if self.down else {"x": along, "y": line}

    async def part_at(self, line, along):
        """0 or 1 where that part is seen, else None."""
        picked = await self.server.send(type="pick", **self.place(line, along))
        path = "/".join([*picked.get("path", []), ""])
        return next((i for i, part in enumerate(self.parts) if f"/{part}/" in path), None)

    async def border(self, line, inside, outside, part):
        """Where the part ends between two places, to a hundredth of a pixel."""
        while abs(outside - inside) > 0.01:
            middle = (inside + outside) / 2
            if await self.part_at(line, middle) == part:
                inside = middle
            else:
                outside = middle
        return inside

    async def crossings(self, line):
        """Where the second part follows the first: the ends of the gap."""
        end, last = None, None
        for along in range(0, HEIGHT if self.down else WIDTH, STEP):
            part = await self.part_at(line, along)
            if part == 1 and last == 0 and along - end <= WIDEST:
                yield (await self.border(line, end, end + STEP, 0),
                       await self.border(line, along, along - STEP, 1))
            if part is not None:
                end, last = along, part

    async def edge(self, line, along):
        """The edge there as a feature, or else the point; and that point in the world."""
        picked = await self.server.send(type="pick", **self.place(line, along), snap={"within": 6, "to": ["edge"]})
        found = picked.get("snapped")
        if found and found["feature"]["node"] == picked["node"]:
            return found["feature"], found["point"]
        return {"node": picked["node"], "snap": "point", "points": [picked["local"]]}, picked["point"]


async def gaps(server, scan, lines):
    """Rows of the table, lengths in the scene's unit."""
    for number in range(lines):
        line = (number + 1) * (WIDTH if scan.down else HEIGHT) / (lines + 1)
        async for first_end, second_end in scan.crossings(line):
            first, start = await scan.edge(line, first_end)
            second, end = await scan.edge(line, second_end)
            second = {"node": second["node"], "snap": "point", "points": second["points"][:1]}
            kind = "parallel" if first["snap"] == "edge" else "distance"
            await server.send(type="patch", patch={"measures": {NAME: {"kind": kind, "picks": [first, second]}}})
            yield [number + 1, *start, *end, server.measured["value"]]


async def look_from(server, state, direction):
    low, high = state["scene"]["bounds"]["min"], state["scene"]["bounds"]["max"]
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    size = max(b - a for a, b in zip(low, high))
    eye = [m + size * d for m, d in zip(middle, direction)]
    await server.send(type="resize", width=WIDTH, height=HEIGHT, pixelRatio=1)
    await server.send(type="patch", patch={"camera": {"eye": eye, "focus": middle, "center": middle, "fov": 10}})
    await server.send(type="fit")


async def table(server, state, options):
    metres, shown = state["unit"]["metres"], state["unit"]["shown"]
    scale = metres * PER_METRE[shown]
    rows = csv.writer(options.out)
    rows.writerow(["line", *(f"{part} {axis}" for part in ("first", "second") for axis in "xyz"), f"width {shown}"])
    found = 0
    async for row in gaps(server, Scan(server, [options.first, options.second], options.down), options.lines):
        rows.writerow([row[0], *(f"{value:.6g}" for value in row[1:-1]), f"{row[-1] * scale:.4f}"])
        found += 1
    if not found:
        raise SystemExit(f"gaps.py: '{options.second}' does not follow '{options.first}' on any line of this view")


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--first", default="Doors/Front left", help="end of its path (default 'Doors/Front left')")
    arguments.add_argument("--second", default="Doors/Rear left", help="end of its path (default 'Doors/Rear left')")
    arguments.add_argument("--from", dest="direction", default="1,0,0", help="the side to look from (default 1,0,0)")
    arguments.add_argument("--down", action="store_true", help="lines go down the picture, not across it")
    arguments.add_argument("--lines", type=int, default=20, help="across the picture (default 20)")
    arguments.add_argument("--out", type=argparse.FileType("w"), default=sys.stdout, help="file (default: print)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    direction = [float(number) for number in options.direction.split(",")]
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as socket:
        server = Server(socket)
        await socket.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        state = await server.state()
        await server.send(type="control", action="take")
        camera = {member: state["camera"][member] for member in ("eye", "focus", "up", "center", "fov")}
        try:
            await look_from(server, state, direction)
            await table(server, state, options)
        finally:
            await server.send(type="patch", patch={"measures": {NAME: None}, "camera": camera})

asyncio.run(main())
