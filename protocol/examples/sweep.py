#!/usr/bin/env python3
"""Sweeps a section through the scene and saves a JPEG file at each step: cut-000.jpg, cut-001.jpg, ...

It takes control, and gives it back at its end; what is cut away comes back, too. Needs python3-websockets
(Debian) or `pip install websockets`. The environment may give the server's address and token as
VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import json
import os
import pathlib
import urllib.parse

import websockets

NAME = "Sweep"


class Server:
    """One connection: requests that are answered one after the other."""

    def __init__(self, socket):
        self.socket, self.requests = socket, 0

    async def send(self, **message):
        """Returns the message of JSON that answers, and the bytes of a picture that came before it, if any."""
        self.requests += 1
        picture = None
        await self.socket.send(json.dumps({"id": self.requests, **message}))
        async for received in self.socket:
            if isinstance(received, bytes):
                picture = received
                if message["type"] == "snapshot":
                    return None, picture
                continue
            answer = json.loads(received)
            if answer.get("id") != self.requests:
                continue
            if answer["type"] == "error":
                raise SystemExit(f"sweep.py: {answer['message']}")
            return answer, picture

    async def state(self):
        async for received in self.socket:
            message = {"type": "frame"} if isinstance(received, bytes) else json.loads(received)
            if message["type"] == "error":
                raise SystemExit(f"sweep.py: {message['message']}")
            if message["type"] == "state":
                return message["state"]


def reach(bounds, normal):
    """How far the scene goes along the normal: the least and the greatest distance."""
    low = sum(n * (bounds["min"][i] if n > 0 else bounds["max"][i]) for i, n in enumerate(normal))
    high = sum(n * (bounds["max"][i] if n > 0 else bounds["min"][i]) for i, n in enumerate(normal))
    return low, high


async def sweep(server, state, options):
    normal = [float(number) for number in options.normal.split(",")]
    length = sum(n * n for n in normal) ** 0.5 or 1
    low, high = reach(state["scene"]["bounds"], [n / length for n in normal])
    width, height = map(int, options.size.split("x"))
    for step in range(options.steps):
        distance = high - (high - low) * (step + 1) / (options.steps + 1)
        section = {"normal": normal, "distance": distance, "hatched": options.hatched}
        await server.send(type="patch", patch={"sections": {NAME: section}})
        _, picture = await server.send(type="snapshot", width=width, height=height, format="jpeg")
        (options.out / f"cut-{step:03}.jpg").write_bytes(picture)


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--normal", default="1,0,0", help="where to cut from (default 1,0,0: from the car's left)")
    arguments.add_argument("--steps", type=int, default=20, help="pictures (default 20)")
    arguments.add_argument("--size", default="1280x720", help="of the pictures, in pixels (default 1280x720)")
    arguments.add_argument("--hatched", action="store_true", help="with lines across the caps")
    arguments.add_argument("--out", type=pathlib.Path, default=".", help="the folder (default: this one)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    options.out.mkdir(parents=True, exist_ok=True)
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as socket:
        server = Server(socket)
        await socket.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        state = await server.state()
        await server.send(type="control", action="take")
        try:
            await sweep(server, state, options)
        finally:
            await server.send(type="patch", patch={"sections": {NAME: None}})

asyncio.run(main())
