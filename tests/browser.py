"""A headless Chromium, spoken to through its DevTools pipe: no port, no package."""

from __future__ import annotations

import itertools
import json
import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next((path for path in map(shutil.which, NAMES) if path), None)
MISSING = f"no browser on PATH: none of {', '.join(NAMES)}"
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
]
HARMLESS = ("GL Driver Message",)  # remarks of the software renderer on its speed
PATIENCE = 120.0
"""Longest wait for an answer [s]."""
LAUNCH = """
import fcntl, os, sys
ends = [fcntl.fcntl(int(end), fcntl.F_DUPFD, 10) for end in sys.argv[1:3]]
for place, end in zip((3, 4), ends):
    os.dup2(end, place)
os.execv(sys.argv[3], sys.argv[3:])
"""
"""The browser reads what it is told from file 3, and answers on file 4."""


class Browser:
    """One process; pages are opened one after another."""

    def __init__(self, profile: Path, width: int = 900, height: int = 600) -> None:
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()
        command = [
            *(sys.executable, "-c", LAUNCH, str(to_browser), str(from_browser)),
            *(str(BROWSER), *FLAGS, "--remote-debugging-pipe"),
            *(f"--window-size={width},{height}", f"--user-data-dir={profile}"),
        ]
        self._process = subprocess.Popen(
            command, pass_fds=(to_browser, from_browser), stderr=subprocess.DEVNULL
        )
        os.close(to_browser)
        os.close(from_browser)
        self._numbers, self._rest = itertools.count(1), b""
        self._events: list[dict[str, Any]] = []

    def run(self, page: Path, script: str) -> tuple[Any, list[str]]:
        """Open a page, and wait for a promise.

        Returns:
            what `script` comes to, and what the page complained about.
        """
        self._events.clear()
        target = self._call("Target.createTarget", {"url": "about:blank"})["targetId"]
        whole = {"targetId": target, "flatten": True}
        session = self._call("Target.attachToTarget", whole)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._call(f"{domain}.enable", {}, session)
        self._call("Page.bringToFront", {}, session)  # hidden pages draw nothing
        self._call("Page.navigate", {"url": page.as_uri()}, session)
        wish = {"expression": script, "awaitPromise": True, "returnByValue": True}
        answer = self._call("Runtime.evaluate", wish, session)
        self._call("Target.closeTarget", {"targetId": target})
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value"), list(self._complaints())

    def close(self) -> None:
        """End the process."""
        self._call("Browser.close", {})
        self._process.wait(PATIENCE)
        os.close(self._write)
        os.close(self._read)

    def _complaints(self):
        for event in self._events:
            said = json.dumps(event["params"])
            told = event["method"] in (
                "Runtime.exceptionThrown",
                "Runtime.consoleAPICalled",
                "Log.entryAdded",
            )
            if told and not any(harmless in said for harmless in HARMLESS):
                yield said

    def _call(self, method: str, params: dict, session: str = "") -> dict[str, Any]:
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while True:
            heard = self._hear(until)
            if heard.get("id") == number:
                assert "error" not in heard, (method, heard["error"])
                return heard["result"]
            if "method" in heard:
                self._events.append(heard)

    def _hear(self, until: float) -> dict[str, Any]:
        """The next message, an answer or an event."""
        while b"\0" not in self._rest:
            waited = select.select([self._read], [], [], until - time.monotonic())
            assert waited[0], f"the browser has not answered for {PATIENCE:.0f} s"
            self._rest += os.read(self._read, 1 << 20)
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)
