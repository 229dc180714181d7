"""A headless Chromium, driven by its DevTools protocol: with the standard library only, on pages that live."""

import base64
import json
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import time


def http(port, request):
    """Status and head of what the server at 127.0.0.1 answers; the request as it goes over the line."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as line:
        line.sendall(request.encode())
        said = b""
        while b"\r\n\r\n" not in said:
            more = line.recv(4096)
            if not more:
                break
            said += more
    head = said.decode(errors="replace").split("\r\n\r\n")[0]
    return int(head.split()[1]) if head.startswith("HTTP/") else 0, head


class WebSocket:
    """The client's end: text messages, whole."""

    def __init__(self, port, path, protocol="", timeout_s=30):
        self.line = socket.create_connection(("127.0.0.1", port), timeout=timeout_s)
        key = base64.b64encode(os.urandom(16)).decode()
        self.line.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                          f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
                          f"{f'Sec-WebSocket-Protocol: {protocol}' if protocol else 'Accept: */*'}\r\n\r\n".encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            self._more()
        head, self.rest = self.rest.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ConnectionError(head.decode(errors="replace"))

    def _more(self):
        more = self.line.recv(1 << 16)
        if not more:
            raise ConnectionError("closed by the other side")
        self.rest += more

    def _take(self, count):
        while len(self.rest) < count:
            self._more()
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def send(self, text):
        payload, mask = text.encode(), os.urandom(4)
        length = len(payload)
        head = (bytes([0x81, 0x80 | length]) if length < 126 else struct.pack("!BBH", 0x81, 0xFE, length) if length < 1 << 16
                else struct.pack("!BBQ", 0x81, 0xFF, length))
        self.line.sendall(head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload)))

    def receive(self):
        message = b""
        while True:
            first, second = self._take(2)
            length = second & 0x7F
            if length == 126:
                length = struct.unpack("!H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack("!Q", self._take(8))[0]
            payload = self._take(length)
            if first & 0x0F == 8:
                raise ConnectionError("closed by the other side")
            if first & 0x0F in (0, 1, 2):
                message += payload
                if first & 0x80:
                    return message.decode()


class Browser:
    """One tab. Close it."""

    def __init__(self, folder, size=(1500, 1150)):
        program = shutil.which("chromium")
        if program is None:
            raise FileNotFoundError("chromium is not installed: apt-get install chromium")
        profile = pathlib.Path(folder) / "profile"
        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage",
             f"--user-data-dir={profile}", f"--window-size={size[0]},{size[1]}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "HOME": str(folder)})
        address = profile / "DevToolsActivePort"
        for _ in range(600):
            if address.exists() and len(address.read_text(encoding="utf-8").split()) == 2:
                break
            time.sleep(0.1)
        port, path = address.read_text(encoding="utf-8").split()
        self.socket, self.number, self.session, self.said = WebSocket(int(port), path), 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.socket.send(json.dumps(message))
        while True:
            answer = json.loads(self.socket.receive())
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            if answer.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded", "Runtime.consoleAPICalled"):
                self.said.append(json.dumps(answer["params"])[:600])

    def open(self, address):
        self.call("Page.navigate", url=address)
        if not self.wait("document.readyState === 'complete' && location.href !== 'about:blank'"):
            raise TimeoutError(f"{address} does not load")

    def ask(self, expression):
        """The value of an expression in the page."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait(self, expression, seconds=30):
        """Until it holds. \\return whether it did"""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.ask(expression):
                return True
            time.sleep(0.05)
        return False

    def picture(self, file):
        pathlib.Path(file).write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
