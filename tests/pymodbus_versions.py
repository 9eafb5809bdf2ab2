"""Provides the same interface for pymodbus 3.0 of Debian 12 and for pymodbus 3.8 of Debian 13."""

import asyncio

from pymodbus import datastore
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext

try:
    from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer

    OLD = True
except ModuleNotFoundError:
    from pymodbus.server import ModbusSerialServer, ModbusTcpServer

    OLD = False

#: First address of a data block. In pymodbus 3.8 and later, data blocks begin at 1.
FIRST_REGISTER = 0 if OLD else 1

__all__ = [
    "FIRST_REGISTER",
    "ModbusSerialServer",
    "ModbusServerContext",
    "ModbusSlaveContext",
    "ModbusTcpServer",
    "block",
    "serve",
]


class ModbusSlaveContext(datastore.ModbusSlaveContext):
    """A server context. Its registers have the addresses that Modbus messages contain, which begin at 0."""

    def __init__(self, **blocks):
        super().__init__(**blocks, **({"zero_mode": True} if OLD else {}))


def block():
    """Returns a data block with the 65536 registers of one Modbus table."""
    return ModbusSequentialDataBlock(FIRST_REGISTER, [0] * 65536)


async def serve(server):
    """Starts a server in the background. Returns the listening socket if it is a TCP server."""
    if not OLD:
        await server.serve_forever(background=True)
        return server.transport.sockets[0] if isinstance(server, ModbusTcpServer) else None
    if isinstance(server, ModbusSerialServer):
        await server.start()
        asyncio.ensure_future(server.serve_forever())
        return None
    asyncio.ensure_future(server.serve_forever())
    await server.serving
    return server.server.sockets[0]
