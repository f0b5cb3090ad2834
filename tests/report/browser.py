"""A headless Chromium over the pipe of its DevTools protocol: nothing but Python's own library."""

import base64
import itertools
import json
import os
import shutil
import struct
import subprocess
import tempfile
import time
import zlib


class Browser:
    """`flags` are Chromium's; WebGL runs in software, so that no graphics card is needed."""

    def __init__(self, program, *flags):
        self.profile = tempfile.mkdtemp()
        (there, self.write), (self.read, back) = os.pipe(), os.pipe()
        usual = ["--headless=new", "--no-sandbox", "--no-first-run", "--hide-scrollbars", "--disable-background-networking", "--disable-dev-shm-usage"]
        graphics = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
        arguments = [program, *usual, *graphics, *flags, f"--user-data-dir={self.profile}", "--remote-debugging-pipe", "about:blank"]
        command = ["/bin/sh", "-c", f'exec "$0" "$@" 3<&{there} 4>&{back}', *arguments]
        self.process = subprocess.Popen(command, pass_fds=(there, back), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(there)
        os.close(back)
        self.numbers, self.buffer, self.events = itertools.count(1), b"", []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.write)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.read)
        shutil.rmtree(self.profile, ignore_errors=True)

    def message(self):
        """The next message of the browser."""
        while b"\0" not in self.buffer:
            chunk = os.read(self.read, 1 << 20)
            if not chunk:
                raise RuntimeError("Chromium has ended")
            self.buffer += chunk
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        """A command's result; events that come meanwhile are kept."""
        number = next(self.numbers)
        command = {"id": number, "method": method, "params": parameters}
        if hasattr(self, "session"):
            command["sessionId"] = self.session
        os.write(self.write, json.dumps(command).encode() + b"\0")
        while True:
            message = self.message()
            if message.get("id") == number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def run(self, script):
        """The value of a script in the page."""
        done = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in done:
            raise RuntimeError(f"{script}: {done['exceptionDetails']}")
        return done["result"].get("value")

    def until(self, script, seconds=60):
        """Waits for a script to be true in the page."""
        end = time.monotonic() + seconds
        while not self.run(script):
            if time.monotonic() > end:
                raise AssertionError(f"not within {seconds} s: {script}")
            time.sleep(0.05)

    def open(self, file, width=1280, height=900, scale=1, phone=False, **media):
        """Loads a file in a window of this size; `media` as prefers_color_scheme="dark". Waits until the spins are drawn."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=phone)
        self.call("Emulation.setTouchEmulationEnabled", enabled=phone)
        features = [{"name": name.replace("_", "-"), "value": value} for name, value in media.items()]
        self.call("Emulation.setEmulatedMedia", features=features)
        self.events.clear()
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=f"file://{os.path.abspath(file)}")
        self.until("document.readyState === 'complete' && !!document.querySelector('#view[aria-label], #problem:not([hidden]), .view[hidden]')")
        self.settle()

    def settle(self, seconds=0.4):
        """Until what was asked for is on the screen."""
        time.sleep(seconds)
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def complaints(self):
        """Errors and warnings of the console, exceptions, and everything that was asked from elsewhere."""
        self.run("0")
        found = []
        for event in self.events:
            method, p = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(p["exceptionDetails"].get("exception", {}).get("description", str(p)))
            elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
                found.append(" ".join(str(a.get("value", a.get("description"))) for a in p["args"]))
            elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
                found.append(p["entry"]["text"])
            elif method == "Network.requestWillBeSent" and not p["request"]["url"].startswith(("file:", "about:", "data:", "blob:")):
                found.append(f"asked for {p['request']['url']}")
        return found

    def press(self, key, text=None, shift=False):
        """A key, down and up; `key` as in KeyboardEvent.key."""
        codes = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Tab": 9, "Enter": 13, " ": 32, "Home": 36, "End": 35, "PageUp": 33, "PageDown": 34, "Escape": 27}
        texts = {"Enter": "\r", " ": " "}
        text = text or texts.get(key) or (key if len(key) == 1 else None)
        common = {"key": key, "windowsVirtualKeyCode": codes.get(key, ord(key[0].upper())), "modifiers": 8 if shift else 0}
        self.call("Input.dispatchKeyEvent", type="keyDown", **common, **({"text": text} if text else {}))
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def mouse(self, *points, wheel=None):
        """Presses at the first point, moves over the others and lets go there; or turns the wheel at a point."""
        def event(kind, point, **more):
            self.call("Input.dispatchMouseEvent", type=kind, x=point[0], y=point[1], **more)
        event("mouseMoved", points[0])
        if wheel is not None:
            return event("mouseWheel", points[0], deltaX=0, deltaY=wheel)
        held = {"button": "left", "buttons": 1, "clickCount": 1}
        event("mousePressed", points[0], **held)
        for point in points[1:]:
            event("mouseMoved", point, **held)
        event("mouseReleased", points[-1], **{**held, "buttons": 0})

    def box(self, selector):
        """Left, top, width, height of an element in the window."""
        return self.run(f"(() => {{ const b = document.querySelector({json.dumps(selector)}).getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; }})()")

    def picture(self, selector=None, keep=None):
        """What is on the screen, of an element or the whole window, at two fifths of its size; kept in full as a file where asked for."""
        left, top, width, height = self.box(selector or "html")
        x, y = self.run("[scrollX, scrollY]")
        if not selector:
            left, top, (width, height) = 0, 0, self.run("[innerWidth, innerHeight]")
        area = {"x": left + x, "y": top + y, "width": width, "height": height}
        if keep:
            with open(keep, "wb") as file:
                file.write(self.capture({**area, "scale": 1}))
        return Image(self.capture({**area, "scale": 0.4}))

    def capture(self, clip):
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", clip=clip)["data"])


class Image:
    """The pixels of a PNG of 8 bits, RGB or RGBA, without interlace: what Chromium writes."""

    def __init__(self, data):
        at, packed = 8, b""
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            if kind == b"IHDR":
                self.width, self.height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
                assert (depth, interlace) == (8, 0) and colour in (2, 6)
                step = 3 if colour == 2 else 4
            elif kind == b"IDAT":
                packed += body
            at += size + 12
        raw, wide = zlib.decompress(packed), self.width * step
        self.rows, above = [], bytes(wide)
        for r in range(self.height):
            start = r * (wide + 1)
            above = unfiltered(raw[start], raw[start + 1:start + 1 + wide], above, step)
            self.rows.append([tuple(above[k:k + 3]) for k in range(0, wide, step)])

    def colours(self):
        """How many different ones there are."""
        return len({pixel for row in self.rows for pixel in row})

    def differs(self, other):
        """The share of pixels that are visibly others."""
        assert (self.width, self.height) == (other.width, other.height)
        pairs = ((p, q) for a, b in zip(self.rows, other.rows) for p, q in zip(a, b))
        return sum(max(abs(p[c] - q[c]) for c in range(3)) > 24 for p, q in pairs) / (self.width * self.height)

    def mean(self):
        """The mean lightness, from 0 to 255."""
        return sum(sum(p) for row in self.rows for p in row) / (3 * self.width * self.height)


def unfiltered(kind, line, above, step):
    """A line of a PNG as it was before its filter."""
    out = bytearray(line)
    for k in range(len(out)):
        a = out[k - step] if k >= step else 0
        b, c = above[k], above[k - step] if k >= step else 0
        if kind == 1:
            out[k] = (out[k] + a) & 255
        elif kind == 2:
            out[k] = (out[k] + b) & 255
        elif kind == 3:
            out[k] = (out[k] + (a + b) // 2) & 255
        elif kind == 4:
            near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))
            out[k] = (out[k] + near[2]) & 255
    return out
