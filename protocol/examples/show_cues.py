#!/usr/bin/env python3
"""Shows the cues of a list one after the other and saves a JPEG file of each: 01-Arrival.jpg, 02-Door.jpg, ...

The list is a file that the page saves. The script checks it against the scene first, and prints what does not
go with that. Without a list it shows the cues that are there.

It takes control, and gives it back at its end; cues that it brought are taken away again, and what was shown
before is shown again. Needs python3-websockets (Debian) or `pip install websockets`. The environment may give the server's address and
token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import json
import os
import pathlib
import re
import urllib.parse

import websockets

HERE = "show_cues.py began here"


class Server:
    """One connection: requests that are answered one after the other."""

    def __init__(self, socket):
        self.socket, self.requests = socket, 0

    async def until(self, accept):
        """The first message that counts; pictures are bytes."""
        async for received in self.socket:
            message = received if isinstance(received, bytes) else json.loads(received)
            if isinstance(message, dict) and message["type"] == "error":
                raise SystemExit(f"show_cues.py: {message['message']}")
            if accept(message):
                return message
        raise SystemExit("show_cues.py: the server has ended the connection")

    async def send(self, answered_by=None, **message):
        """Returns the answer: of type `answered_by` where that is not the first one."""
        self.requests += 1
        request = self.requests
        await self.socket.send(json.dumps({"id": request, **message}))
        if message["type"] == "snapshot":
            return await self.until(lambda answer: isinstance(answer, bytes))
        return await self.until(lambda answer: isinstance(answer, dict) and answer.get("id") == request
                                and answer["type"] == (answered_by or answer["type"]))


def in_order(cues):
    return sorted(cues, key=lambda name: (cues[name].get("order", float("inf")), name))


def exactly(wanted, now):
    """The patch that makes the cue `now` exactly the wanted one: as tables merge, what that lacks of them is removed."""
    if not wanted or not now:
        return wanted

    def replacing(table, present):
        return {**{name: None for name in present if name not in table}, **table}

    cue = {"order": None, **wanted}
    if wanted.get("sections") is not None:
        cue["sections"] = replacing(wanted["sections"], now.get("sections") or {})
    if wanted.get("nodes") is not None:
        present = now.get("nodes") or {}
        nodes = {node: replacing(members, present.get(node) or {}) if members is not None else None
                 for node, members in wanted["nodes"].items()}
        cue["nodes"] = replacing(nodes, present)
    if wanted.get("selection") is not None:
        cue["selection"] = {"node": wanted["selection"].get("node")}
    return cue


async def bring(server, path, before):
    """Brings the cues of a list that go with the scene, where they replace those before; returns them."""
    cues = json.loads(path.read_text(encoding="utf-8"))
    checked = await server.send(type="check", cues=cues)
    for problem in checked["problems"]:
        print(f"show_cues.py: {problem['message']}")
    brought = {name: cues["cues"][name] for name in checked["fitting"]}
    for name, cue in brought.items():  # each in a message of its own: those may not be long
        await server.send(type="patch", patch={"cues": {name: exactly(cue, before.get(name))}})
    return brought


async def show(server, names, options):
    width, height = map(int, options.size.split("x"))
    for number, name in enumerate(names, 1):
        await server.send(type="cue", name=name, answered_by="flown")
        await asyncio.sleep(options.hold)
        picture = await server.send(type="snapshot", width=width, height=height)
        (options.out / f"{number:02}-{re.sub(r'[^A-Za-z0-9]+', '-', name)}.jpg").write_bytes(picture)


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("list", type=pathlib.Path, nargs="?", help="the list of cues (default: those of the scene)")
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--hold", type=float, default=0, help="seconds at each cue (default 0)")
    arguments.add_argument("--size", default="1280x720", help="of the pictures, in pixels (default 1280x720)")
    arguments.add_argument("--out", type=pathlib.Path, default=".", help="the folder (default: this one)")
    options = arguments.parse_args()
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}/ws"
    options.out.mkdir(parents=True, exist_ok=True)
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as socket:
        server = Server(socket)
        await socket.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        message = await server.until(lambda message: isinstance(message, dict) and message["type"] == "state")
        before = message["state"]["cues"]
        await server.send(type="control", action="take")
        cues = await bring(server, options.list, before) if options.list else before
        await server.send(type="patch", patch={"cues": {HERE: {"ms": 0}}})
        try:
            await show(server, in_order(cues), options)
        finally:
            await server.send(type="cue", name=HERE)
            await server.send(type="patch", patch={"cues": {HERE: None}})
            for name, cue in cues.items() if options.list else ():
                was = before.get(name)
                await server.send(type="patch", patch={"cues": {name: exactly(was, {**(was or {}), **cue})}})

asyncio.run(main())
