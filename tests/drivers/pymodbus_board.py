"""Simulates a board with pymodbus, an implementation of Modbus that shares no code with the tested driver.

The test and this program exchange JSON objects over stdin and stdout, one object per line:
  {"set": [table, address, [values]]}     table: holding, input, coil
  {"get": [table, address, count]}        response: {"values": [...]}
  {"writes": true}                        response: {"writes": [[table, address, [values]], ...]}
The response to "writes" contains the writes of clients since the last "writes".
The first line that this program prints is {"port": N}. With the argument `serial`, it is {"device": PATH}. PATH is a
pseudo-terminal on which the units 1 and 2 respond with the same registers.
"""

import asyncio
import json
import logging
import os
import pathlib
import pty
import select
import sys
import threading
import tty

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pymodbus_versions import (  # noqa: E402
    ModbusSerialServer,
    ModbusServerContext,
    ModbusSlaveContext,
    ModbusTcpServer,
    block,
    serve,
)

TABLES = {"coil": 1, "input": 4, "holding": 3}
WRITTEN_BY = {5: "coil", 15: "coil", 6: "holding", 16: "holding", 22: "holding", 23: "holding"}


class Board(ModbusSlaveContext):
    """The registers of a board. Records all writes of clients."""

    def __init__(self):
        super().__init__(di=block(), co=block(), hr=block(), ir=block())
        self.writes = []
        self.local = threading.local()

    def setValues(self, fc_as_hex, address, values):  # noqa: N802 (pymodbus defines this name)
        if not getattr(self.local, "own", False):
            self.writes.append([WRITTEN_BY.get(fc_as_hex, str(fc_as_hex)), address, [int(v) for v in values]])
        super().setValues(fc_as_hex, address, values)


def answer(board, line):
    """Executes a line of the test and returns the response."""
    request = json.loads(line)
    if "set" in request:
        table, address, values = request["set"]
        board.local.own = True
        board.setValues(TABLES[table], address, values)
        board.local.own = False
        return {"done": True}
    if "get" in request:
        table, address, count = request["get"]
        return {"values": [int(v) for v in board.getValues(TABLES[table], address, count)]}
    writes, board.writes = board.writes, []
    return {"writes": writes}


def talk(board, loop):
    """Executes the lines of the test until the test closes the pipe."""
    for line in sys.stdin:
        print(json.dumps(answer(board, line)), flush=True)
    loop.call_soon_threadsafe(loop.stop)


async def start(board):
    """Starts a TCP server on a free port and returns the port."""
    context = ModbusServerContext(slaves={1: board}, single=False)
    return (await serve(ModbusTcpServer(context, address=("127.0.0.1", 0), ignore_missing_slaves=True))).getsockname()[1]


def wire(one, other):
    """Simulates a cable: transfers bytes between the inner ends of two pseudo-terminals."""
    while True:
        for end in select.select([one, other], [], [])[0]:
            os.write(other if end == one else one, os.read(end, 4096))


async def start_serial(board):
    """Starts a serial server on a pseudo-terminal and returns the path of the other end."""
    inner, outer = pty.openpty(), pty.openpty()
    for _, outside in (inner, outer):
        tty.setraw(outside)
    threading.Thread(target=wire, args=(inner[0], outer[0]), daemon=True).start()
    context = ModbusServerContext(slaves={1: board, 2: board}, single=False)
    server = ModbusSerialServer(context, port=os.ttyname(inner[1]), baudrate=115200, ignore_missing_slaves=True)
    await serve(server)
    return os.ttyname(outer[1])


def main():
    logging.disable(logging.CRITICAL)  # the tests end sessions intentionally, which pymodbus would log
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    board = Board()
    if sys.argv[1:] == ["serial"]:
        told = {"device": loop.run_until_complete(start_serial(board))}
    else:
        told = {"port": loop.run_until_complete(start(board))}
    print(json.dumps(told), flush=True)
    threading.Thread(target=talk, args=(board, loop), daemon=True).start()
    loop.run_forever()


if __name__ == "__main__":
    main()
