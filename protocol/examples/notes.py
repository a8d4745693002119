#!/usr/bin/env python3
"""Lists the notes of a scene: what is open, what is done, who wrote it and when. With --done it marks a note, by
its name or its text; with --report it saves the report that the server makes (.html), or a table (.csv).

To mark a note it takes control, and gives it back at its end. Needs python3-websockets (Debian) or `pip install
websockets`. The environment may give the server's address and token as VRUT_PREVIEW_URL and VRUT_PREVIEW_TOKEN."""
import argparse
import asyncio
import datetime
import json
import os
import pathlib
import urllib.error
import urllib.parse
import urllib.request

import websockets


class Server:
    """One connection: requests that are answered one after the other."""

    def __init__(self, socket):
        self.socket, self.requests = socket, 0

    async def until(self, accept):
        async for received in self.socket:
            message = {} if isinstance(received, bytes) else json.loads(received)
            if message.get("type") == "error":
                raise SystemExit(f"notes.py: {message['message']}")
            if accept(message):
                return message
        raise SystemExit("notes.py: the server has ended the connection")

    async def send(self, **message):
        self.requests += 1
        await self.socket.send(json.dumps({"id": self.requests, **message}))
        return await self.until(lambda answer: answer.get("id") == self.requests)


def line(name, note):
    time = ""
    if "time" in note:
        time = datetime.datetime.fromtimestamp(note["time"] / 1000).strftime("%Y-%m-%d %H:%M")
    words = [("done" if note.get("done") else "open"), name, note["text"], note.get("author", ""), time]
    return "\t".join(words)


async def mark(server, notes, wanted):
    name = wanted if wanted in notes else next((name for name in notes if notes[name]["text"] == wanted), None)
    if name is None:
        raise SystemExit(f"notes.py: there is no note '{wanted}'; without options the script lists them")
    await server.send(type="control", action="take")
    await server.send(type="patch", patch={"markers": {name: {"done": True}}})
    notes[name]["done"] = True


def save(page, token, path):
    address = urllib.parse.urljoin(f"{page.scheme}://{page.netloc}{page.path}", f"report{path.suffix}")
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=headers)) as answer:
            path.write_bytes(answer.read())
    except urllib.error.HTTPError as error:
        raise SystemExit(f"notes.py: {error.read().decode().strip()}") from None


async def main():
    home = os.environ.get("VRUT_PREVIEW_URL", "http://127.0.0.1:8080/")
    token = os.environ.get("VRUT_PREVIEW_TOKEN", "")
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--url", default=home, help="as the server prints it")
    arguments.add_argument("--token", default=token, help="if the URL has none")
    arguments.add_argument("--done", metavar="NOTE", help="marks this one as done")
    arguments.add_argument("--report", type=pathlib.Path, metavar="FILE", help="saves FILE.html or FILE.csv")
    options = arguments.parse_args()
    if options.report and options.report.suffix not in (".html", ".csv"):
        arguments.error(f"--report: '{options.report}' must end with .html or .csv")
    page = urllib.parse.urlsplit(options.url)
    token = page.fragment.removeprefix("token=") or options.token
    address = f"{page.scheme.replace('http', 'ws')}://{page.netloc}{page.path.rstrip('/')}/ws"
    async with websockets.connect(address, subprotocols=["vrut-preview.v1"], max_size=None) as socket:
        server = Server(socket)
        await socket.send(json.dumps({"type": "hello", "role": "control", "token": token}))
        state = (await server.until(lambda message: message.get("type") == "state"))["state"]
        notes = state["markers"]
        if options.done is not None:
            await mark(server, notes, options.done)
        for name, note in sorted(notes.items(), key=lambda entry: entry[1].get("time", 0)):
            print(line(name, note))
        if options.report:
            await asyncio.to_thread(save, page, token, options.report)

asyncio.run(main())
