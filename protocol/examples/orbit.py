#!/usr/bin/env python3
"""Turns the car once around and saves each view as a JPEG file: frame-000.jpg, frame-001.jpg, ...

Needs python3-websockets (Debian) or `pip install websockets`. The environment may give the server's address
and token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import json
import os
import pathlib
import urllib.parse

import websockets


def header_of(jpeg):
    """What a frame says about itself, from the COM segment behind its APP0."""
    at = 2  # SOI
    while jpeg[at + 1] != 0xFE:
        at += 2 + int.from_bytes(jpeg[at + 2:at + 4], "big")
    return json.loads(jpeg[at + 4:at + 2 + int.from_bytes(jpeg[at + 2:at + 4], "big")])


async def still_frame(server, message_id, shown):
    """The frame at rest, of full size, that shows what the message of this id did, and its number. Each `frame`
    asks for one, and acknowledges the one before (`shown`, its number; at first there is none: {})."""
    await server.send(json.dumps({"type": "frame", **shown}))
    async for message in server:
        if isinstance(message, bytes):
            header = header_of(message)
            quality = header["quality"]
            shown = {"shown": header["frame"]}
            if header["handled"] >= message_id and quality["level"] == "still" and quality["scale"] == 1:
                return message, shown
            await server.send(json.dumps({"type": "frame", **shown}))
        elif (answer := json.loads(message))["type"] == "error":
            raise SystemExit(f"orbit.py: {answer['message']}")


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--steps", type=int, default=36, help="views, at least 2 (default 36)")
    arguments.add_argument("--size", default="1280x720", help="of the pictures, in pixels (default 1280x720)")
    arguments.add_argument("--out", type=pathlib.Path, default=".", help="the folder (default: this one)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    width, height = map(int, options.size.split("x"))
    options.out.mkdir(parents=True, exist_ok=True)
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as server:
        await server.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        # Whoever holds control now has it again when this ends.
        await server.send(json.dumps({"type": "control", "action": "take"}))
        await server.send(json.dumps({"type": "resize", "width": width, "height": height, "pixelRatio": 1}))
        shown = {}
        for step in range(options.steps):
            rotate = [360 / options.steps, 0]  # degrees, as if dragged to the right
            await server.send(json.dumps({"type": "navigate", "id": step + 1, "rotate": rotate}))
            picture, shown = await still_frame(server, step + 1, shown)
            (options.out / f"frame-{step:03}.jpg").write_bytes(picture)

asyncio.run(main())
