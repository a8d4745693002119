#!/usr/bin/env python3
"""Opens a door of the car, holds it, and closes it.

Needs python3-websockets (Debian) or `pip install websockets`. The environment may give the server's address
and token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import itertools
import json
import os
import urllib.parse

import websockets


ids = itertools.count(1)


async def ask(server, message):
    """Sends a message with an id, and returns its answer."""
    message = {**message, "id": next(ids)}
    await server.send(json.dumps(message))
    async for text in server:
        answer = json.loads(text)
        if answer["type"] == "error":
            raise SystemExit(f"door.py: {answer['message']}")
        if answer.get("id") == message["id"]:
            return answer


async def node_at(server, path):
    """The node at a path of names below the root, as a page of the tree describes it."""
    node = {"id": 0}
    for name in path.split("/"):
        message = {"type": "tree", "node": node["id"]}
        found = []
        while not found:
            page = await ask(server, message)
            found = [n for n in page["nodes"] if n["name"] == name and n.get("parent") == node["id"]]
            if not found and "next" not in page:
                raise SystemExit(f"door.py: the scene has no '{path}'")
            message["after"] = page.get("next")
        node = found[0]
    return node


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--door", default="Body/Doors/Front left", help="its path (default 'Body/Doors/Front left')")
    arguments.add_argument("--open", type=float, default=1, help="how far, from 0 to 1 (default 1)")
    arguments.add_argument("--seconds", type=float, default=1, help="to open it (default 1)")
    arguments.add_argument("--hold", type=float, default=1, help="seconds (default 1)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as server:
        await server.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        door = await node_at(server, options.door)
        if "hinge" not in door:
            raise SystemExit(f"door.py: '{options.door}' has no hinge")
        # Whoever holds control now has it again when this ends.
        await ask(server, {"type": "control", "action": "take"})
        swing = {"type": "swing", "node": door["id"], "ms": 1000 * options.seconds}
        await ask(server, {**swing, "open": options.open})
        await asyncio.sleep(options.seconds + options.hold)
        await ask(server, {**swing, "open": 0})

asyncio.run(main())
