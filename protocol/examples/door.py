#!/usr/bin/env python3
"""Opens a door of the car within a second, holds it, and closes it: gives it back to the scene's file.

Needs python3-websockets (Debian) or `pip install websockets`. The environment may give the server's address
and token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import json
import math
import os
import urllib.parse

import websockets


async def ask(server, message):
    """Sends a message that has an id, and returns its answer."""
    await server.send(json.dumps(message))
    async for text in server:
        answer = json.loads(text)
        if answer["type"] == "error":
            raise SystemExit(f"door.py: {answer['message']}")
        if answer.get("id") == message["id"]:
            return answer


def turned(degrees, hinge):
    """Row by row: a rotation about the vertical through the hinge, where the closed door has its origin."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [c, 0, s, hinge[0], 0, 1, 0, hinge[1], -s, 0, c, hinge[2], 0, 0, 0, 1]


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--door", default="Front left", help="the node's name (default 'Front left')")
    arguments.add_argument("--hinge", type=float, nargs=3, default=[0.8, 0, 0.84], help="as in the scene")
    arguments.add_argument("--angle", type=float, default=-65, help="degrees (default -65)")
    arguments.add_argument("--hold", type=float, default=1, help="seconds (default 1)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as server:
        await server.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        found = await ask(server, {"type": "tree", "id": 1, "search": options.door})
        doors = [n for n in found["nodes"] if n["name"] == options.door and n["type"] == "assembly"]
        if not doors:
            raise SystemExit(f"door.py: the scene has no assembly that is called '{options.door}'")
        steps = 25
        matrices = [turned(options.angle * step / steps, options.hinge) for step in range(1, steps + 1)]
        for number, matrix in enumerate(matrices + [None], 2):  # None: as the file has it
            await asyncio.sleep(1 / steps if matrix else options.hold)
            patch = {"nodes": {str(doors[0]["id"]): {"matrix": matrix}}}
            await ask(server, {"type": "patch", "id": number, "patch": patch})

asyncio.run(main())
