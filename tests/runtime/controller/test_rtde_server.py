from __future__ import annotations

import struct

import pytest

from runtime.controller.arm import HOME
from runtime.controller.connections import ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.rtde_server import RtdeServer
from runtime.controller.rtde_wire import PackageType, frame, take_packages
from runtime.kinematics import UR5, UR16E


class Line:
    """A connection that keeps what was sent."""

    peer = "test"
    backlog = 0

    def __init__(self) -> None:
        self.sent = bytearray()
        self.closes = 0

    def send(self, data):
        self.sent += data

    def close(self):
        self.closes += 1

    def take(self):
        return list(take_packages(self.sent))


class Client:
    def __init__(self, server: RtdeServer, protocol: int = 2) -> None:
        self.line = Line()
        self.session = server.accept(self.line)
        if protocol == 2:
            assert self.ask(PackageType.PROTOCOL_VERSION, b"\x00\x02") == b"\x01"

    def ask(self, kind, payload=b""):
        self.session.received(frame(kind, payload))
        ((answered, answer),) = self.line.take()
        assert answered == kind
        return answer

    def outputs(self, names, frequency=125.0):
        return self.ask(PackageType.SETUP_OUTPUTS, struct.pack(">d", frequency) + names.encode())

    def inputs(self, names):
        return self.ask(PackageType.SETUP_INPUTS, names.encode())


@pytest.fixture
def server():
    return RtdeServer(ControlBox(UR5, lambda: 0.0, HOME))


def test_the_version_played_is_the_arm_series_own(server):
    assert struct.unpack(">4I", Client(server).ask(PackageType.CONTROLLER_VERSION))[:2] == (3, 15)
    e_series = RtdeServer(ControlBox(UR16E, lambda: 0.0, HOME))
    assert struct.unpack(">4I", Client(e_series).ask(PackageType.CONTROLLER_VERSION))[:2] == (5, 17)


def test_a_protocol_nobody_speaks_is_refused(server):
    assert Client(server).ask(PackageType.PROTOCOL_VERSION, b"\x00\x09") == b"\x00"


def test_states_are_streamed_as_agreed_from_start_to_pause(server):
    client = Client(server)
    assert client.outputs("timestamp,actual_q,") == b"\x01DOUBLE,VECTOR6D"
    server.publish()
    assert client.line.take() == []
    assert client.ask(PackageType.START) == b"\x01"
    server.publish()
    ((kind, payload),) = client.line.take()
    assert kind == PackageType.DATA
    assert struct.unpack(">B7d", payload) == (1, 0.0, *HOME)
    assert client.ask(PackageType.PAUSE) == b"\x01"
    server.publish()
    assert client.line.take() == []


def test_a_lower_frequency_gets_fewer_states(server):
    client = Client(server)
    client.outputs("timestamp", 25.0)
    client.ask(PackageType.START)
    for _ in range(50):
        server.publish()
    assert len(client.line.take()) == 10


def test_protocol_1_has_no_frequency_and_no_recipe_id(server):
    client = Client(server, protocol=1)
    assert client.ask(PackageType.SETUP_OUTPUTS, b"runtime_state") == b"UINT32"
    client.ask(PackageType.START)
    server.publish()
    assert client.line.take() == [(PackageType.DATA, struct.pack(">I", 1))]


def test_variables_of_a_later_version_are_not_found(server):
    client = Client(server)
    assert client.outputs("timestamp,ft_raw_wrench") == b"\x00DOUBLE,NOT_FOUND"
    assert client.ask(PackageType.START) == b"\x00"


def test_an_input_belongs_to_its_first_client_until_that_has_gone(server):
    first, second = Client(server), Client(server)
    assert first.inputs("input_int_register_0,input_double_register_0") == b"\x01INT32,DOUBLE"
    assert first.inputs("input_int_register_0") == b"\x02INT32"
    assert second.inputs("input_int_register_0,input_int_register_1") == b"\x00IN_USE,INT32"
    assert second.inputs("nothing") == b"\x00NOT_FOUND"
    first.session.closed()
    assert second.inputs("input_int_register_0") == b"\x01INT32"


def test_what_is_written_arrives(server):
    client = Client(server)
    client.inputs("input_int_register_5,tool_digital_output_mask,tool_digital_output")
    client.inputs("speed_slider_mask,speed_slider_fraction")
    client.session.received(frame(PackageType.DATA, struct.pack(">BiBB", 1, -7, 1, 1)))
    client.session.received(frame(PackageType.DATA, struct.pack(">BId", 2, 1, 0.25)))
    assert server.box.signals.input_ints[5] == -7
    assert server.box.signals.output_is_on("tool", 0)
    assert server.box.arm.speed_fraction == 0.25
    client.session.received(frame(PackageType.DATA, struct.pack(">BId", 2, 1, float("nan"))))
    assert server.box.arm.speed_fraction == 0.25


def test_packages_that_do_not_fit_are_ignored(server):
    client = Client(server)
    client.inputs("input_int_register_5")
    for payload in (b"", b"\x01", b"\x01" + bytes(96), b"\x09\x00\x00\x00\x01"):
        client.session.received(frame(PackageType.DATA, payload))
    client.session.received(frame(PackageType.TEXT_MESSAGE, b"hello"))
    client.session.received(b"\x00\x03z")
    assert server.box.signals.input_ints[5] == 0
    assert client.line.take() == []


def test_a_broken_stream_is_cut(server):
    client = Client(server)
    with pytest.raises(ProtocolViolation):
        client.session.received(b"\x00\x00\x00")
    with pytest.raises(ProtocolViolation, match="without its frequency"):
        Client(server).session.received(frame(PackageType.SETUP_OUTPUTS, b"x"))


def test_a_client_that_reads_nothing_gets_no_more(server):
    client = Client(server)
    client.outputs("timestamp")
    client.ask(PackageType.START)
    client.line.backlog = 1 << 20
    server.publish()
    assert client.line.take() == []


def test_all_clients_can_be_dropped(server):
    clients = [Client(server), Client(server)]
    server.drop_all()
    assert [client.line.closes for client in clients] == [1, 1]
