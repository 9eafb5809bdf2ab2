"""Runs softgrip-plc with the other processes of a test, and a Modbus client (master) that commands the gateway like a
PLC."""

import re
import struct

import bench
import yaml
from pymodbus.client import ModbusTcpClient

SOFTGRIP_PLC = bench.BUILD / "tools" / "softgrip-plc"
START, STOP, VENT, RELEASE, ACKNOWLEDGE = range(1, 6)
ACCEPTED, REFUSED, UNKNOWN = 2, 3, 4
FIRST_AFTER_START, NO_DAEMON, NO_SUCH_COMMAND, NO_SUCH_RECIPE, MASTER_SILENT = range(1, 6)
NOT_NEXT = 10
NO_DAEMON_STATE, IDLE, RESYNCHRONISING, RUNNING, FAULTED = 0, 2, 3, 4, 6
HOLDING, NO_PART, PART_LOST, RELEASED = range(1, 5)
NOT_GIVEN = 0x8000


class Map:
    """Maps the names of registers to their addresses. Reads them from the map file that the gateway uses."""

    def __init__(self, path):
        registers = yaml.safe_load(path.read_text())["registers"]
        self.address = {r["name"]: r["address"] for block in ("command", "status") for r in registers[block]}
        self.finger = {r["name"]: r["address"] for r in registers["finger"]}
        self.fingers = registers["fingers"]


class Plc(bench.Process):
    def __init__(self, folder, port=0, changes=(), name="softgrip-plc", socket=None):
        path = folder / "config" / "plc.yaml"
        text = path.read_text()
        for pattern, replacement in changes:
            text, count = re.subn(pattern, replacement, text)
            assert count, pattern
        path.write_text(text)
        self.map = Map(path)
        super().__init__(name, [SOFTGRIP_PLC, "--config", path, "--port", port,
                                "--socket", socket or folder / "softgripd.sock"], folder)
        self.port = self.listening_port()


def block(counter, command, recipe=0):
    """Returns the Modbus request with which a PLC writes counter, command and recipe in every cycle."""
    pdu = struct.pack(">BHHB3H", 16, 0, 3, 6, counter, command, recipe)
    return struct.pack(">HHHB", 7, 0, len(pdu) + 1, 1) + pdu


class Master:
    """A Modbus client that counts its commands and reads the result of each command, like a PLC."""

    def __init__(self, plc, synchronise=True):
        self.map = plc.map
        self.client = ModbusTcpClient("127.0.0.1", port=plc.port, timeout=bench.PATIENCE_S)
        if not self.client.connect():
            raise ConnectionError("softgrip-plc")
        self.beats = self.counter = 0
        if synchronise:
            self.synchronise()

    def close(self):
        self.client.close()

    def answered(self, answer):
        if answer.isError():
            raise ConnectionError(str(answer))
        return answer

    def read(self, name):
        return self.words(self.map.address[name], 1)[0]

    def words(self, address, count):
        return self.answered(self.client.read_holding_registers(address, count=count, slave=1)).registers

    def finger(self, number, name):
        return self.words(self.map.fingers["first"] + number * self.map.fingers["each"] + self.map.finger[name], 1)[0]

    def write(self, name, *values):
        self.answered(self.client.write_registers(self.map.address[name], list(values), slave=1))

    def beat(self):
        self.beats = (self.beats + 1) % 65536
        self.write("master_heartbeat", self.beats)

    def synchronise(self):
        """Waits until no command is in progress, and then reads the counter value of the gateway. Does not send
        a command."""
        bench.wait_for("the end of the command in progress", lambda: self.read("outcome") != 1)
        self.counter = self.read("done_counter")
        self.write("command_counter", self.counter, 0)

    def put(self, command, recipe=0, squeeze=NOT_GIVEN):
        """Writes the next counter value and a command with one request, like a PLC."""
        self.counter = (self.counter + 1) % 65536
        self.write("command_counter", self.counter, command, recipe, squeeze)
        return self.counter

    def done(self, counter, patience_s=bench.PATIENCE_S):
        """Returns (outcome, reason) of the command with this counter value."""
        first = self.map.address["done_counter"]

        def look():
            done, outcome, reason = self.words(first, 3)
            return (outcome, reason) if done == counter and outcome != 1 else None
        return bench.wait_for(f"the end of command {counter}", look, patience_s, pause_s=0.005)

    def command(self, *arguments, **keys):
        return self.done(self.put(*arguments, **keys))

    def wait(self, name, *values, patience_s=bench.PATIENCE_S):
        return bench.wait_for(f"{name} {values}", lambda: self.read(name) in values, patience_s)

    def beat_until(self, condition):
        def look():
            self.beat()
            return condition()
        return bench.wait_for("it", look, pause_s=0.05)


def started(daemon, since=0):
    """Returns the request ids of the sequences that the gateway has started in this daemon."""
    return [event["request"] for event in daemon.events(since)
            if event["kind"] == "sequence_started" and event.get("client") == "softgrip-plc"]
