"""Listening sockets and buffered connections on one selector: the process has one thread."""

from __future__ import annotations

import contextlib
import errno
import selectors
import socket
from collections.abc import Callable
from typing import Final, Protocol

from runtime.controller.ports import BANNER, BUSY
from runtime.errors import ControllerError

_CHUNK: Final = 65536
_MOST_CONNECTIONS: Final = 128
_BACKLOG_LIMIT: Final = 1 << 20  # a client that reads nothing may not fill our memory


class Session(Protocol):
    """What stands behind one connection."""

    def received(self, data: bytes) -> None:
        """Take the bytes that arrived. Raises ProtocolViolation to have the line cut."""

    def closed(self) -> None:
        """Learn that the connection has ended; called once."""


class ProtocolViolation(Exception):  # noqa: N818 - what the peer did, not what we suffer
    """The peer sent what cannot be understood; its connection is closed."""


class Connection:
    """One accepted connection with an outgoing buffer."""

    __slots__ = ("_network", "_outgoing", "_socket", "closing", "peer", "session")

    def __init__(self, network: Network, accepted: socket.socket) -> None:
        self._network = network
        self._socket = accepted
        self._outgoing = bytearray()
        self.closing = False
        self.session: Session | None = None
        try:
            self.peer = "{}:{}".format(*accepted.getpeername()[:2])
        except OSError:
            self.peer = "a peer already gone"

    @property
    def backlog(self) -> int:
        """Bytes waiting for the peer to read them."""
        return len(self._outgoing)

    def send(self, data: bytes) -> None:
        """Queue bytes; what fits goes out at once. A peer that never reads is dropped."""
        if self._socket.fileno() < 0:
            return
        self._outgoing += data
        if len(self._outgoing) > _BACKLOG_LIMIT:
            self.close()
            return
        self.flush()

    def flush(self) -> None:
        """Write what the socket takes, and ask to be woken for the rest."""
        if self._outgoing:
            try:
                sent = self._socket.send(self._outgoing)
            except BlockingIOError:
                sent = 0
            except OSError:
                self.close()
                return
            del self._outgoing[:sent]
        if self.closing and not self._outgoing:
            self.close()
            return
        self._network.watch(self._socket, self, writing=bool(self._outgoing))

    def finish(self) -> None:
        """Close once everything queued has gone out."""
        self.closing = True
        self.flush()

    def close(self) -> None:
        """Close now and tell the session, once."""
        if self._socket.fileno() < 0:
            return
        self._network.forget(self._socket, self)
        self._socket.close()
        session, self.session = self.session, None
        if session is not None:
            session.closed()

    def read(self) -> None:
        """Pass what arrived to the session."""
        try:
            data = self._socket.recv(_CHUNK)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self.close()
        elif self.session is not None and not self.closing:
            self.session.received(data)


class Network:
    """All sockets of the process."""

    def __init__(self) -> None:
        self._selector = selectors.DefaultSelector()
        self._listeners: list[socket.socket] = []
        self._connections: dict[Connection, None] = {}

    def listen(self, address: str, port: int, accept: Callable[[Connection], Session]) -> None:
        """Listen on a port; each new connection gets the session `accept` makes for it.

        Raises:
            ControllerError: The port is busy or the address is not this machine's.
        """
        listener = socket.socket()
        # A restart must not wait for the last run's connections to be forgotten.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((address, port))
            listener.listen(_MOST_CONNECTIONS)
        except OSError as error:
            listener.close()
            raise ControllerError(_refusal(address, port, error)) from error
        listener.setblocking(False)  # noqa: FBT003 - the socket module's own signature
        self._listeners.append(listener)
        self._selector.register(listener, selectors.EVENT_READ, accept)

    def poll(self, timeout_s: float, violated: Callable[[Connection, str], None]) -> None:
        """Handle what is ready, waiting for it at most `timeout_s`.

        Args:
            timeout_s: How long to wait, s.
            violated: Told of each peer that broke its protocol, after its connection is closed.
        """
        for key, events in self._selector.select(timeout_s):
            if isinstance(key.data, Connection):
                self._serve(key.data, events, violated)
            else:
                self._accept(key.fileobj, key.data)

    def _serve(
        self, connection: Connection, events: int, violated: Callable[[Connection, str], None]
    ) -> None:
        if events & selectors.EVENT_WRITE:
            connection.flush()
        if events & selectors.EVENT_READ:
            try:
                connection.read()
            except ProtocolViolation as violation:
                connection.close()
                violated(connection, str(violation))

    def _accept(self, listener: object, accept: Callable[[Connection], Session]) -> None:
        assert isinstance(listener, socket.socket)
        try:
            accepted, _ = listener.accept()
        except OSError:
            return  # it gave up while waiting
        if len(self._connections) >= _MOST_CONNECTIONS:
            accepted.close()
            return
        accepted.setblocking(False)  # noqa: FBT003 - the socket module's own signature
        with contextlib.suppress(OSError):
            accepted.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection = Connection(self, accepted)
        self._connections[connection] = None
        self._selector.register(accepted, selectors.EVENT_READ, connection)
        connection.session = accept(connection)

    def watch(self, watched: socket.socket, connection: Connection, *, writing: bool) -> None:
        """Wake for incoming bytes, and for room to write when `writing`."""
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if writing else 0)
        if self._selector.get_key(watched).events != events:
            self._selector.modify(watched, events, connection)

    def forget(self, watched: socket.socket, connection: Connection) -> None:
        """Drop a connection that is being closed."""
        self._selector.unregister(watched)
        self._connections.pop(connection, None)

    def close(self) -> None:
        """Close every connection and listener."""
        for connection in tuple(self._connections):
            connection.close()
        for listener in self._listeners:
            self._selector.unregister(listener)
            listener.close()
        self._selector.close()


def _refusal(address: str, port: int, error: OSError) -> str:
    where = f"the {BANNER} cannot listen on {address}:{port}"
    if error.errno == errno.EADDRINUSE:
        return (
            f"{where}: the port {BUSY}; stop the program that holds it, or choose another "
            "loopback address, such as --address 127.0.0.3"
        )
    if error.errno == errno.EADDRNOTAVAIL:
        return (
            f"{where}: this machine has no such address; choose a loopback address, such as "
            "--address 127.0.0.2 (on macOS first: sudo ifconfig lo0 alias 127.0.0.2)"
        )
    return f"{where}: {error.strerror or error}; choose a loopback address, such as 127.0.0.2"
