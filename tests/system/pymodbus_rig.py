"""Simulates an ADAM-6024 with two soft fingers. Serves the registers with pymodbus and shares no code with the
emulator.

pymodbus_rig.py [OBJECT_MM]     an object stops both fingers at this displacement
Prints {"port": N}. Then the program answers each line on stdin with a line of JSON. This line contains the written
values and the number of writes.
"""

import asyncio
import collections
import json
import logging
import math
import pathlib
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pymodbus_versions import (  # noqa: E402
    FIRST_REGISTER,
    ModbusServerContext,
    ModbusSlaveContext,
    ModbusTcpServer,
    block,
    serve,
)

FIRST_OUTPUT = 10
INPUT_REGISTERS = 4  # function code of a read of input registers, as pymodbus passes it to setValues()
STEP_S = 0.001
NOISE_COUNTS = 3
YIELDING = 0.1  # motion of a finger after contact with the object, as a fraction of its free motion beyond the object


class Finger:
    """A finger of the model bench_twin (config/models/bench_twin.yaml), integrated with explicit Euler steps of 1
    ms."""

    ALPHA, BETA, GAMMA, ETA = 0.21105, 0.1713, 0.01625, 0.02428
    K0, BRANCHES = 325.9, ((18.16, 299.8), (2.761, 1.621))
    LAG_S, DELAY_S = 0.044, 0.130

    def __init__(self, object_mm):
        self.object_mm = object_mm
        self.command_kpa = 0.0
        self.pressure_kpa = 0.0
        self.hysteresis_mm = 0.0
        self.creep_mm = [0.0, 0.0]
        self.line = collections.deque([0.0] * round(self.DELAY_S / STEP_S))
        self.moved_at = time.monotonic()

    def move(self):
        now = time.monotonic()
        while self.moved_at + STEP_S <= now:
            self.step()
            self.moved_at += STEP_S

    def step(self):
        self.line.append(self.command_kpa)
        change = (self.line.popleft() - self.pressure_kpa) * (1 - math.exp(-STEP_S / self.LAG_S))
        h = self.hysteresis_mm
        self.hysteresis_mm += self.BETA * change - self.GAMMA * change * abs(h) - self.ETA * abs(change) * h
        self.pressure_kpa += change
        for i, (stiffness, damping) in enumerate(self.BRANCHES):
            self.creep_mm[i] += (self.pressure_kpa - stiffness * self.creep_mm[i]) / damping * STEP_S

    def displacement_mm(self):
        free_mm = self.ALPHA * self.pressure_kpa - self.hysteresis_mm + self.pressure_kpa / self.K0 + sum(self.creep_mm)
        beyond_mm = max(free_mm - self.object_mm, 0)
        return free_mm - beyond_mm * (1 - YIELDING)

    def raw(self, count):
        """Returns the raw reading of a 16-bit input with a range of -10 to 10 V. The sensor outputs 0 to 10 V for -5
        to 45 mm. Noise is added, so that successive readings always differ."""
        volts = (self.displacement_mm() + 5) / 50 * 10
        return round((volts + 10) / 20 * 65535) + count % NOISE_COUNTS - 1

    def pressure_raw(self):
        volts = self.pressure_kpa / 10
        return round((volts + 10) / 20 * 65535)


class Board(ModbusSlaveContext):
    def __init__(self, object_mm):
        super().__init__(di=block(), co=block(), hr=block(), ir=block())
        self.fingers = [Finger(object_mm), Finger(object_mm)]
        self.reads = 0
        self.writes = 0
        self.highest_kpa = 0.0

    def getValues(self, fc_as_hex, address, count=1):  # noqa: N802 (pymodbus names it)
        if fc_as_hex == INPUT_REGISTERS:
            self.reads += 1
            for index, finger in enumerate(self.fingers):
                finger.move()
                self.store["i"].setValues(FIRST_REGISTER + index, [finger.raw(self.reads)])
                self.store["i"].setValues(FIRST_REGISTER + 4 + index, [finger.pressure_raw()])
        return super().getValues(fc_as_hex, address, count)

    def setValues(self, fc_as_hex, address, values):  # noqa: N802
        self.writes += 1
        for offset, value in enumerate(values):
            index = address + offset - FIRST_OUTPUT
            if 0 <= index < len(self.fingers):
                self.fingers[index].move()
                self.fingers[index].command_kpa = value / 4095 * 100
                self.highest_kpa = max(self.highest_kpa, self.fingers[index].command_kpa)
        self.store["i"].setValues(FIRST_REGISTER + address, list(values))  # makes the outputs readable with function
                                                                           # code 4
        super().setValues(fc_as_hex, address, values)

    def told(self):
        return {"reads": self.reads, "writes": self.writes, "highest_kpa": self.highest_kpa,
                "commands_kpa": [finger.command_kpa for finger in self.fingers],
                "displacements_mm": [finger.displacement_mm() for finger in self.fingers]}


async def start(board):
    context = ModbusServerContext(slaves={1: board}, single=False)
    return (await serve(ModbusTcpServer(context, address=("127.0.0.1", 0)))).getsockname()[1]


def main():
    logging.disable(logging.CRITICAL)
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    board = Board(float(sys.argv[1]) if len(sys.argv) > 1 else math.inf)
    print(json.dumps({"port": loop.run_until_complete(start(board))}), flush=True)

    def talk():
        for _ in sys.stdin:
            print(json.dumps(board.told()), flush=True)
        loop.call_soon_threadsafe(loop.stop)

    threading.Thread(target=talk, daemon=True).start()
    loop.run_forever()


if __name__ == "__main__":
    main()
