"""A ROS master and services that tests control. A service is a function that gets the socket of each connection."""
import io
import os
import socket
import struct
import threading
import xmlrpc.server


def receive(connection, count):
    """EOFError: the other side has closed the connection."""
    parts = []
    while count > 0:
        parts.append(connection.recv(min(count, 1 << 20)))
        if not parts[-1]:
            raise EOFError
        count -= len(parts[-1])
    return b"".join(parts)


def receive_block(connection):
    return receive(connection, struct.unpack("<I", receive(connection, 4))[0])


def block(data):
    return struct.pack("<I", len(data)) + data


def shake_hands(connection, answer=b"callerid=/fake"):
    """Receives the header of a client and sends one with one field."""
    receive_block(connection)
    connection.sendall(block(block(answer)))


def answering(request_class, respond):
    """A service that works. respond: a function from a request to a response."""
    def serve(connection):
        shake_hands(connection)
        while True:
            request = request_class().deserialize(receive_block(connection))
            buffer = io.BytesIO()
            respond(request).serialize(buffer)
            connection.sendall(b"\1" + block(buffer.getvalue()))
    return serve


class FakeMaster:
    """Services of other threads, and the master that knows their addresses. Sets ROS_MASTER_URI."""

    def __init__(self):
        self._addresses = {}
        self._server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False)
        self._server.register_function(self._look_up, "lookupService")
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{self._server.server_address[1]}"

    def _look_up(self, _caller, service):
        address = self._addresses.get(service)
        return [1, "", address] if address else [-1, "unknown", ""]

    def add(self, service, serve):
        listener = socket.socket()
        listener.bind(("localhost", 0))
        listener.listen()
        self._addresses[service] = f"rosrpc://localhost:{listener.getsockname()[1]}"
        threading.Thread(target=self._accept, args=(listener, serve), daemon=True).start()

    @staticmethod
    def _accept(listener, serve):
        def run(connection):
            try:
                with connection:
                    serve(connection)
            except (EOFError, OSError):
                pass  # the client has closed the connection

        while True:
            threading.Thread(target=run, args=listener.accept()[:1], daemon=True).start()
