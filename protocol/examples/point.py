#!/usr/bin/env python3
"""Points everybody to a place of the picture, by a small circle around it, and prints what is there in space.

It only watches, and needs no control. Needs python3-websockets (Debian) or `pip install websockets`. The
environment may give the server's address and token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import json
import math
import os
import urllib.parse

import websockets

APART = 1 / 30  # seconds; more are not passed on
TURNS = 1  # a second


async def until(socket, accept):
    async for received in socket:
        message = {"type": "frame"} if isinstance(received, bytes) else json.loads(received)
        if message["type"] == "error":
            raise SystemExit(f"point.py: {message['message']}")
        if accept(message):
            return message
    raise SystemExit("point.py: the server has ended the connection")


async def print_points(socket, client):
    async for received in socket:
        message = {"type": "frame"} if isinstance(received, bytes) else json.loads(received)
        if message["type"] == "error":
            raise SystemExit(f"point.py: {message['message']}")
        if message["type"] == "pointed" and message["client"] == client and "point" in message:
            print(*(f"{number:.4f}" for number in message["point"]), flush=True)


async def circle(socket, view, options):
    x, y = (float(part) for part in options.at.split(","))
    for step in range(max(1, round(options.seconds / APART))):
        angle = 2 * math.pi * TURNS * step * APART
        away = options.radius * view["height"]
        await socket.send(json.dumps({"type": "point", "x": x * view["width"] + away * math.cos(angle),
                                      "y": y * view["height"] + away * math.sin(angle)}))
        await asyncio.sleep(APART)
    await socket.send(json.dumps({"type": "point"}))


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--at", default="0.5,0.5", help="where, in parts of the picture (default 0.5,0.5)")
    arguments.add_argument("--radius", type=float, default=0.02, help="in parts of its height (default 0.02)")
    arguments.add_argument("--seconds", type=float, default=3, help="how long (default 3)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as socket:
        await socket.send(json.dumps({"type": "hello", "role": "view", "name": "point.py", "token": token}))
        client = (await until(socket, lambda message: message["type"] == "welcome"))["client"]
        await socket.send(json.dumps({"type": "frame"}))
        frame = None
        async for received in socket:
            if isinstance(received, bytes):
                frame = received
                break
        # The header stands in the JPEG file's first comment; see FRAMES.md.
        start = frame.index(b"\xff\xfe")
        length = int.from_bytes(frame[start + 2:start + 4], "big")
        view = json.loads(frame[start + 4:start + 2 + length])["view"]
        printing = asyncio.create_task(print_points(socket, client))
        await circle(socket, view, options)
        await asyncio.sleep(2 * APART)
        if printing.done():
            printing.result()
        printing.cancel()

asyncio.run(main())
