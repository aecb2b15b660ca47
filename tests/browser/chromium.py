"""A real browser without a library: headless Chromium driven over the DevTools protocol
(https://chromedevtools.github.io/devtools-protocol/), through a pair of pipes: --remote-debugging-pipe, JSON messages
that end in a zero byte. Keys, mouse and fingers are real input events, not calls of the page's functions."""

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def find():
    """The path of a Chromium that runs, or None. (Ubuntu's chromium-browser may be a stub that asks for a snap.)"""
    for name in NAMES:
        path = shutil.which(name)
        if path and subprocess.run([path, "--version"], capture_output=True).returncode == 0:
            return path
    return None


class Browser:
    def __init__(self, path):
        self.profile = tempfile.TemporaryDirectory(prefix="duet-browser-", ignore_cleanup_errors=True)
        # The browser reads from its descriptor 3 and writes to 4; our ends lie above, so that none is overwritten.
        reads, self._to = (fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, 10) for fd in os.pipe())
        self._from, writes = (fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, 10) for fd in os.pipe())

        def give_pipes():
            os.dup2(reads, 3)
            os.dup2(writes, 4)

        flags = ["--headless", "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}", "--disable-gpu",
                 "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--disable-quic", "--disable-dev-shm-usage", "--force-color-profile=srgb", "--hide-scrollbars"]
        if os.geteuid() == 0:
            flags.append("--no-sandbox")  # Chromium refuses to run its sandbox as root
        self._process = subprocess.Popen([path, *flags, "about:blank"], stdin=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                         preexec_fn=give_pipes, close_fds=False)
        os.close(reads)
        os.close(writes)
        self._received = b""
        self._last_id = 0
        self._pages = {}

    def close(self):
        try:
            self.send("Browser.close")
        except (OSError, RuntimeError):
            pass
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self.profile.cleanup()

    def send(self, method, session=None, timeout=20, **parameters):
        """Calls a method of the protocol and returns its result; events that come meanwhile go to their pages."""
        self._last_id += 1
        message = {"id": self._last_id, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + timeout
        while True:
            answer = self._next(end)
            if answer is None:
                raise RuntimeError(f"{method}: no answer in {timeout} s")
            if answer.get("id") == self._last_id:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._dispatch(answer)

    def pump(self, seconds):
        """Lets events come in for a while."""
        end = time.monotonic() + seconds
        while True:
            event = self._next(end)
            if event is None:
                return
            self._dispatch(event)

    def _next(self, end):
        while b"\0" not in self._received:
            ready, _, _ = select.select([self._from], [], [], max(0, end - time.monotonic()))
            if not ready:
                return None
            piece = os.read(self._from, 1 << 20)
            if not piece:
                raise RuntimeError("the browser has gone")
            self._received += piece
        message, self._received = self._received.split(b"\0", 1)
        return json.loads(message)

    def _dispatch(self, event):
        page = self._pages.get(event.get("sessionId"))
        if page and "method" in event:
            page.on_event(event["method"], event["params"])

    def open(self, url, width=1200, height=900, phone=False, dark=False, hash_state="", ready="html[data-ready]"):
        """Opens a page of a file and waits until an element that matches `ready` is there."""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = Page(self, target, session)
        self._pages[session] = page
        page.open(url + ("#" + hash_state if hash_state else ""), width, height, phone, dark, ready)
        return page


# What the keys' events carry: code, Windows key code, and the text they type.
KEYS = {"Tab": ("Tab", 9, ""), "Enter": ("Enter", 13, "\r"), "Escape": ("Escape", 27, ""), " ": ("Space", 32, " "),
        "ArrowLeft": ("ArrowLeft", 37, ""), "ArrowUp": ("ArrowUp", 38, ""), "ArrowRight": ("ArrowRight", 39, ""),
        "ArrowDown": ("ArrowDown", 40, ""), "Home": ("Home", 36, ""), "End": ("End", 35, "")}
SHIFT = 8


class Page:
    def __init__(self, browser, target, session):
        self.browser, self.target, self.session = browser, target, session
        self.faults = []    # exceptions, failed assertions, errors and warnings of the console
        self.requests = []  # every address asked for

    def send(self, method, **parameters):
        return self.browser.send(method, self.session, **parameters)

    def open(self, url, width, height, phone, dark, ready):
        for domain in ("Page", "Runtime", "Log", "Network", "Accessibility"):
            self.send(domain + ".enable")
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if phone else 1,
                  mobile=phone)
        self.send("Emulation.setTouchEmulationEnabled", enabled=phone)
        self.send("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.send("Page.navigate", url=url)
        self.wait(f"document.querySelector({json.dumps(ready)})")

    def close(self):
        self.browser.send("Target.closeTarget", targetId=self.target)

    def on_event(self, method, event):
        if method == "Runtime.exceptionThrown":
            details = event["exceptionDetails"]
            self.faults.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and event["type"] in ("error", "warning", "assert"):
            self.faults.append(f"console.{event['type']}: {[a.get('value') for a in event['args']]}")
        elif method == "Log.entryAdded" and event["entry"]["level"] in ("error", "warning"):
            if "willReadFrequently" not in event["entry"]["text"]:  # the tests' own reading of the canvas
                self.faults.append(event["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(event["request"]["url"])

    def js(self, expression):
        """The value of an expression (a promise's, once it is there), as JSON carries it."""
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(f"{expression}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def wait(self, condition, timeout=15):
        """Until a condition holds."""
        end = time.monotonic() + timeout
        while not self.js(f"Boolean({condition})"):
            if time.monotonic() > end:
                raise RuntimeError(f"waited {timeout} s for {condition}; faults: {self.faults}")
            self.browser.pump(0.02)

    def settle(self):
        """Until what was last done has been drawn."""
        self.js("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def front(self):
        """Only the page in front draws; the last one opened is."""
        self.send("Page.bringToFront")

    # ---- what is there

    def text(self, selector):
        return self.js(f"document.querySelector({json.dumps(selector)}).textContent")

    def visible(self, selector):
        return self.js(f"(e => Boolean(e) && e.checkVisibility())(document.querySelector({json.dumps(selector)}))")

    def box(self, selector):
        """[left, top, width, height] in the window, after scrolling there."""
        return self.js(f"""(e => {{ e.scrollIntoView({{block: "center"}}); const b = e.getBoundingClientRect();
            return [b.left, b.top, b.width, b.height]; }})(document.querySelector({json.dumps(selector)}))""")

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.send("Page.captureScreenshot", captureBeyondViewport=True)["data"]))

    # ---- hands

    def key(self, key, modifiers=0):
        code, number, text = KEYS[key] if key in KEYS else ("", ord(key.upper()), key)
        event = {"key": key, "code": code, "windowsVirtualKeyCode": number, "modifiers": modifiers}
        self.send("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", text=text, **event)
        self.send("Input.dispatchKeyEvent", type="keyUp", **event)
        self.settle()

    def _mouse(self, kind, x, y, button="none", **more):
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, **more)

    def move(self, x, y):
        self._mouse("mouseMoved", x, y)
        self.settle()

    def click(self, selector, at=(0.5, 0.5)):
        """Clicks into an element, at a place in shares of its size."""
        left, top, width, height = self.box(selector)
        self.click_at(left + width * at[0], top + height * at[1])

    def click_at(self, x, y):
        self._mouse("mouseMoved", x, y)
        self._mouse("mousePressed", x, y, "left", clickCount=1, buttons=1)
        self._mouse("mouseReleased", x, y, "left", clickCount=1)
        self.settle()

    def drag(self, start, end):
        self._mouse("mouseMoved", *start)
        self._mouse("mousePressed", *start, "left", clickCount=1, buttons=1)
        for f in (0.25, 0.5, 0.75, 1):
            self._mouse("mouseMoved", *(s + f * (e - s) for s, e in zip(start, end)), "left", buttons=1)
        self._mouse("mouseReleased", *end, "left", clickCount=1)
        self.settle()

    def wheel(self, x, y, turn):
        self._mouse("mouseWheel", x, y, deltaX=0, deltaY=turn)
        self.settle()

    def touch(self, *steps):
        """Fingers: each step is a list of places; the first puts them down, the last lifts them there."""
        for k, places in enumerate(steps):
            self.send("Input.dispatchTouchEvent", type="touchMove" if k else "touchStart",
                      touchPoints=[{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(places)])
        self.send("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.settle()


if __name__ == "__main__":  # is there one?
    print(find() or "")
    sys.exit(0 if find() else 1)
