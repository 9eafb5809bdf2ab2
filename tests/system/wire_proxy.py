"""A Modbus TCP proxy between daemon and board. It can disturb the connection, and it records the written values.

The proxy uses the addresses of the shipped ADAM-6024 map: six inputs from 0, two outputs from 10, input status from
20. KINDS contains the names of the disturbances. For each disturbance, fault_matrix.yaml describes the class of
faults that it represents."""

import contextlib
import functools
import math
import random
import select
import socket
import struct
import threading
import time

INPUTS, OUTPUTS, STATUS = 0, 10, 20
# Scales of the board. Displacements of -5 to 45 mm are 0 to 10 V on a 16-bit input with a range of -10 to 10
# V. Pressures of 0 to 100 kPa are the full range of a 12-bit output.
RAW_PER_MM = 65535 / 20 * 10 / 50
RAW_PER_KPA = 4095 / 100
HIGHEST_INPUT = 65535
# Permitted difference between a written value and its read-back (tolerance_raw of the board map).
TOLERATED_RAW = 1


class Frame:
    """One Modbus TCP message whose parts can be changed."""

    def __init__(self, raw):
        self.transaction, self.protocol, self.length, self.unit = struct.unpack(">HHHB", raw[:7])
        self.pdu = bytearray(raw[7:])

    def bytes(self):
        return struct.pack(">HHHB", self.transaction, self.protocol, len(self.pdu) + 1, self.unit) + bytes(self.pdu)

    @property
    def function(self):
        return self.pdu[0]

    def address(self):
        return struct.unpack(">H", self.pdu[1:3])[0]

    def words(self):
        """Returns the register values in the reply to a read."""
        return list(struct.unpack(f">{self.pdu[1] // 2}H", self.pdu[2:2 + self.pdu[1]]))

    def set_words(self, words):
        self.pdu[2:] = struct.pack(f">{len(words)}H", *words)

    def written(self):
        """Returns the register values in a request that writes several registers."""
        return list(struct.unpack(f">{self.pdu[5] // 2}H", self.pdu[6:6 + self.pdu[5]]))

    def set_written(self, words):
        self.pdu[6:] = struct.pack(f">{len(words)}H", *words)


class Fault:
    """A fault of the connection. `times` is the number of messages that the fault affects."""

    def __init__(self, kind, times=None, seed=1, **keys):
        self.kind = KINDS[kind]
        self.left = math.inf if times is None else times
        self.keys = keys
        self.random = random.Random(seed)
        self.first_touch = None  # time.monotonic() of the first message that the fault changed
        self.memory = {}  # values that a disturbance stores between messages

    def touch(self):
        """Returns True if the fault must change this message."""
        if self.left <= 0:
            return False
        self.left -= 1
        self.differs()
        return True

    def differs(self):
        """Records that the fault has changed a message."""
        if self.first_touch is None:
            self.first_touch = time.monotonic()

    def key(self, name, default):
        return self.keys.get(name, default)


class Session:
    """One connection of the daemon to the proxy, with the proxy's connection to the board."""

    def __init__(self, proxy, client):
        self.proxy = proxy
        self.client = client
        self.board = socket.create_connection(("127.0.0.1", proxy.board_port), 10)
        for end in (self.client, self.board):
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.previous = None  # the reply to the previous request

    def read(self, end):
        header = self.read_exactly(end, 7)
        return header and Frame(header + self.read_exactly(end, struct.unpack(">H", header[4:6])[0] - 1))

    @staticmethod
    def read_exactly(end, count):
        data = b""
        while len(data) < count:
            more = end.recv(count - len(data))
            if not more:
                return b""
            data += more
        return data

    def send(self, data):
        self.client.sendall(data)

    def ask_board(self, request):
        self.board.sendall(request.bytes())
        reply = self.read(self.board)
        if not reply:
            raise ConnectionError("the board is gone")
        return reply

    def execute(self, request):
        """Sends a request to the board, records the values that it writes, and returns the reply."""
        reply = self.ask_board(request)
        self.proxy.note(request)
        return reply

    def run(self):
        while not self.proxy.closed:
            request = self.read(self.client)
            if not request:
                return
            fault = self.proxy.fault
            if fault is not None and fault.left > 0 and fault.kind(self, fault, request):
                continue
            self.pass_on(request)

    def pass_on(self, request):
        self.previous = self.execute(request)
        self.send(self.previous.bytes())

    def wait_until_gone(self):
        """Stops sending messages in this session. Returns when the daemon closes the session."""
        while not self.proxy.closed:
            ready, _, _ = select.select([self.client], [], [], 0.05)
            if ready and not self.client.recv(4096):
                raise ConnectionError("given up")

    def close(self):
        for end in (self.client, self.board):
            end.close()


# Functions that disturb a request and its reply. A function returns True if it has handled the message, and False if
# the fault does not apply to this message.

def to_touched(disturb):
    """Applies a function to each message that the fault must change. Other messages are not handled."""
    @functools.wraps(disturb)
    def handle(session, fault, request):
        if not fault.touch():
            return False
        disturb(session, fault, request)
        return True
    return handle


def noticeable(words, others):
    return any(abs(a - b) > TOLERATED_RAW for a, b in zip(words, others))


def is_read_of(request, address):
    return request.function == 4 and request.address() == address


def lost_request(session, fault, request):
    return fault.touch()


@to_touched
def lost_reply(session, fault, request):
    session.execute(request)


@to_touched
def delayed(session, fault, request):
    reply = session.execute(request)
    time.sleep(fault.key("delay_s", 0.2))
    session.send(reply.bytes())


@to_touched
def repeated(session, fault, request):
    reply = session.execute(request).bytes()
    session.send(reply + reply)


def replayed(session, fault, request):
    """Replies with old contents in a valid frame, like a gateway with a cache."""
    reply = session.execute(request)
    if request.function == 4:
        old = fault.memory.setdefault((request.address(), len(reply.pdu)), bytes(reply.pdu))
        # Old sensor readings differ from new ones by noise only, so the daemon cannot detect them. However, the daemon
        # can detect old outputs that do not follow its commands.
        true = reply.words()
        reply.pdu = bytearray(old)
        if request.address() == OUTPUTS and noticeable(true, reply.words()):
            fault.differs()
    session.send(reply.bytes())
    return True


@to_touched
def inserted(session, fault, request):
    reply = session.execute(request)
    stranger = Frame(reply.bytes())
    stranger.transaction = (reply.transaction + 0x4000) & 0xFFFF
    session.send(stranger.bytes() + reply.bytes())


@to_touched
def other_function(session, fault, request):
    """Replies with a valid answer to a different request."""
    reply = session.execute(request)
    reply.pdu = bytearray(b"\x03\x04\x00\x00\x00\x00")
    session.send(reply.bytes())


def twin(session, fault, request):
    """Replies like a board of the same type that is at rest and vented. The messages have the correct format."""
    reply = session.execute(request)
    if request.function == 4 and fault.touch():
        rest_mm = round((0 + 5) * RAW_PER_MM + HIGHEST_INPUT / 2)
        zero = round(HIGHEST_INPUT / 2)
        words = {INPUTS: [rest_mm, rest_mm, zero, zero, zero, zero], OUTPUTS: [0, 0], STATUS: [0] * 6}[request.address()]
        if request.address() == INPUTS:
            words = [w + fault.random.randint(-3, 3) for w in words]
        reply.set_words(words[:reply.pdu[1] // 2])
    session.send(reply.bytes())
    return True


@to_touched
def to_other_unit(session, fault, request):
    request.unit += 1
    reply = session.ask_board(request)
    reply.unit -= 1
    session.send(reply.bytes())


@to_touched
def from_other_unit(session, fault, request):
    reply = session.execute(request)
    reply.unit += 1
    session.send(reply.bytes())


@to_touched
def out_of_order(session, fault, request):
    """Answers each request with the reply to the previous request."""
    reply = session.execute(request)
    session.send((session.previous or reply).bytes())
    session.previous = reply


@to_touched
def wrong_sequence(session, fault, request):
    reply = session.execute(request)
    reply.transaction = (reply.transaction - 1) & 0xFFFF
    session.send(reply.bytes())


@to_touched
def corrupted_header(session, fault, request):
    """Changes one bit of the first 8 bytes of the frame."""
    raw = bytearray(session.execute(request).bytes())
    bit = fault.random.randrange(64)
    raw[bit // 8] ^= 1 << (bit % 8)
    session.send(bytes(raw))


def to_inputs(change):
    """Forwards all replies. If a request reads the inputs, `change` first changes the register values of the reply."""
    @functools.wraps(change)
    def handle(session, fault, request):
        reply = session.execute(request)
        if is_read_of(request, INPUTS) and len(reply.pdu) > 2 and reply.function == 4 and fault.touch():
            words = reply.words()
            change(fault, words)
            reply.set_words([min(max(int(round(w)), 0), HIGHEST_INPUT) for w in words])
        session.send(reply.bytes())
        return True
    return handle


@to_inputs
def corrupted_value(fault, words):
    """Changes one bit of the reading of the left finger's displacement."""
    words[0] ^= 1 << fault.key("bit", 14)


@to_inputs
def sensor_stuck(fault, words):
    words[0] = fault.memory.setdefault("words", words[0])


@to_inputs
def sensor_jump(fault, words):
    words[0] += fault.key("by_mm", 15) * RAW_PER_MM


@to_inputs
def sensor_drift(fault, words):
    words[0] += (time.monotonic() - fault.first_touch) * fault.key("mm_per_s", 0.5) * RAW_PER_MM


@to_inputs
def sensor_noise(fault, words):
    words[0] += fault.random.gauss(0, fault.key("sigma_mm", 0.3)) * RAW_PER_MM


@to_inputs
def sensor_dropout(fault, words):
    """Removes the signal of the sensor from some of the readings."""
    fault.memory["n"] = fault.memory.get("n", 0) + 1
    if fault.memory["n"] % fault.key("every", 3) == 0:
        words[0] = HIGHEST_INPUT / 2  # an input of 0 V, as from a broken wire


@to_inputs
def sensor_out_of_range(fault, words):
    words[0] = HIGHEST_INPUT


def sensor_error(session, fault, request):
    """Sets the status word of the left input to `over` (over range)."""
    reply = session.execute(request)
    if is_read_of(request, STATUS) and fault.touch():
        words = reply.words()
        words[0] = 1
        reply.set_words(words)
    session.send(reply.bytes())
    return True


def to_outputs(change):
    """Applies `change` to the register values of each request that writes the outputs."""
    @functools.wraps(change)
    def handle(session, fault, request):
        if request.function != 16 or request.address() != OUTPUTS:
            return False
        words = request.written()
        change(fault, words)
        if noticeable(words, request.written()):
            fault.differs()
        request.set_written(words)
        session.pass_on(request)
        return True
    return handle


@to_outputs
def asymmetric(fault, words):
    """Changes the value for the left output. The value for the right output stays unchanged."""
    words[0] = min(4095, round(words[0] + fault.key("by_kpa", 10) * RAW_PER_KPA))


@to_outputs
def received_by_some(fault, words):
    """Forwards the value for the right output. The left output keeps the value that it had at the beginning of the
    fault."""
    words[0] = fault.memory.setdefault("word", words[0])


@to_touched
def blocked(session, fault, request):
    """Simulates another sender on the line. It sends without a pause, so that no reply arrives."""
    session.execute(request)
    noise = Frame(struct.pack(">HHHB", 0x7FFF, 0, 5, 1) + b"\x04\x02\x00\x00").bytes()
    while not session.proxy.closed and session.proxy.fault is fault:
        session.send(noise * 8)
        time.sleep(0.002)
    raise ConnectionError("the channel is free again")


@to_touched
def reset(session, fault, request):
    session.client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    raise ConnectionError("reset")


def half_open(session, fault, request):
    """Stops this session without a message to the daemon or the board. New sessions work normally."""
    sessions = fault.memory.setdefault("dead", set())
    if not sessions:
        sessions.add(id(session))
        fault.touch()
    if id(session) not in sessions:
        return False
    session.wait_until_gone()
    return True


@to_touched
def silent(session, fault, request):
    """Keeps the sessions open and accepts new sessions, but answers no request."""
    session.wait_until_gone()


@to_touched
def dripped(session, fault, request):
    reply = session.execute(request).bytes()
    for i in range(len(reply)):
        session.send(reply[i:i + 1])
        time.sleep(fault.key("interval_s", 0.02))


@to_touched
def stalled(session, fault, request):
    reply = session.execute(request).bytes()
    session.send(reply[:len(reply) // 2])
    session.wait_until_gone()


@to_touched
def exception(session, fault, request):
    """Answers every request with a Modbus exception and executes no request."""
    request.pdu = bytearray([request.function | 0x80, fault.key("code", 4)])
    session.send(request.bytes())


@to_touched
def refused(session, fault, request):
    """Closes all sessions, and closes new sessions immediately."""
    raise ConnectionError("refused")


KINDS = {f.__name__: f for f in (
    lost_request, lost_reply, delayed, repeated, replayed, inserted, other_function, twin, to_other_unit, from_other_unit,
    out_of_order, wrong_sequence, corrupted_header, corrupted_value, asymmetric, received_by_some, blocked, reset,
    half_open, silent, dripped, stalled, exception, refused, sensor_stuck, sensor_jump, sensor_drift, sensor_noise,
    sensor_dropout, sensor_out_of_range, sensor_error)}


class Proxy:
    """Accepts the connection of the daemon and connects to the board. `writes` contains (time.monotonic(), [raw
    outputs]) of each write that the proxy has forwarded."""

    def __init__(self, board_port):
        self.board_port = board_port
        self.fault = None
        self.writes = []
        self.closed = False
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.sessions = set()
        self.thread = threading.Thread(target=self.accept, daemon=True)
        self.thread.start()

    def note(self, request):
        if request.function == 16 and request.address() == OUTPUTS:
            self.writes.append((time.monotonic(), request.written()))

    def begin(self, fault):
        self.fault = fault

    def clear(self):
        self.fault = None

    def accept(self):
        while not self.closed:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return
            threading.Thread(target=self.serve, args=(client,), daemon=True).start()

    def serve(self, client):
        try:
            session = Session(self, client)
        except OSError:
            client.close()
            return
        self.sessions.add(session)
        with contextlib.suppress(OSError, struct.error, IndexError):
            session.run()
        self.sessions.discard(session)
        session.close()

    def close(self):
        self.closed = True
        self.listener.close()
        for session in list(self.sessions):
            with contextlib.suppress(OSError):
                session.client.shutdown(socket.SHUT_RDWR)
