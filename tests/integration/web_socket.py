"""A WebSocket for tests, on the standard library alone: JSON out, JSON and frames in, blocking."""
import json
import os
import socket
import struct


class WebSocket:
    """`status` is 101 once it is open. `context`: of TLS."""

    def __init__(self, port, path, subprotocols="lightwell.v1", context=None):
        self.line = socket.create_connection(("127.0.0.1", port), timeout=60)
        if context:
            self.line = context.wrap_socket(self.line, server_hostname="localhost")
        self.line.sendall((f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                           f"Sec-WebSocket-Protocol: {subprotocols}\r\n\r\n").encode())
        self.stream = self.line.makefile("rb")
        words = self.stream.readline().split()
        self.status = int(words[1]) if len(words) > 1 else 0
        while self.stream.readline().strip():
            pass

    def close(self):
        self.stream.close()
        self.line.close()

    def send(self, message):
        payload, mask = json.dumps(message).encode(), os.urandom(4)
        length = bytes([0x80 | len(payload)]) if len(payload) < 126 else struct.pack(">BH", 0xfe, len(payload))
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        self.line.sendall(b"\x81" + length + mask + masked)

    def receive(self):
        """A text message as what its JSON means, a binary one as bytes; None at the end. Pings are passed over."""
        while len(head := self.stream.read(2)) == 2:
            length = head[1]
            if length > 125:
                length = int.from_bytes(self.stream.read(2 if length == 126 else 8), "big")
            payload = self.stream.read(length)
            opcode = head[0] & 15
            if opcode == 8 or len(payload) < length:
                return None
            if opcode < 8:
                return json.loads(payload) if opcode == 1 else payload
        return None


class Viewer:
    """One stream of a session: says hello by itself and acknowledges what it is sent."""

    def __init__(self, port, session, resume=None):
        self.socket = WebSocket(port, f"/v1/sessions/{session}/stream")
        self.welcome = None
        if self.socket.status != 101:
            return
        self.socket.send({"type": "hello", "codecs": ["jpeg"], "width": 48, "height": 32, "resume": resume})
        self.welcome = self.next(lambda message: isinstance(message, dict) and message["type"] == "welcome")

    def next(self, wanted):
        """The first message for which `wanted` holds; None if the stream ends before it."""
        try:
            while (message := self.socket.receive()) is not None:
                if isinstance(message, bytes):
                    self.socket.send({"type": "ack", "frame": struct.unpack_from("<I", message, 8)[0]})
                if wanted(message):
                    return message
        except ConnectionError:  # nobody is there to be told
            pass
        return None

    def frame_of_input(self, seq):
        """Whether a picture came that shows the input."""
        return self.next(lambda message: isinstance(message, bytes) and
                         struct.unpack_from("<I", message, 12)[0] == seq) is not None

    def close(self):
        self.socket.close()
