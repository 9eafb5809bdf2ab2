"""Grips a part and watches the daemon's events for the loss of the part.

    guard_grip.py [SOCKET] [--sequence pick_stone] [--for-s 2]
"""

import argparse
import asyncio
import sys
from typing import Optional

import softgrip


async def watch(gripper: softgrip.AsyncGripper) -> None:
    async for event in gripper.events(timeout_s=3600):
        print(f"{event.time_s:8.2f} s  {event.text}")


async def grip(path: Optional[str], sequence: str, hold_s: float) -> int:
    async with softgrip.AsyncGripper(path, name="guard_grip") as gripper:
        watcher = asyncio.create_task(watch(gripper))
        try:
            await gripper.start(sequence)
            await gripper.wait_until(softgrip.Result.HOLDING, timeout_s=60)
            try:
                # If the part is lost during this time, the wait ends at once.
                await gripper.wait_until(softgrip.Result.PART_LOST, timeout_s=hold_s)
                print("the part is lost")
                return 1
            except softgrip.NotAnswered:
                print("held")
                return 0
        finally:
            watcher.cancel()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("socket", nargs="?", help="socket of softgripd [$SOFTGRIP_SOCKET]")
    parser.add_argument("--sequence", default="pick_stone")
    parser.add_argument("--for-s", type=float, default=2.0)
    arguments = parser.parse_args()
    return asyncio.run(grip(arguments.socket, arguments.sequence, arguments.for_s))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except softgrip.SoftgripError as error:
        sys.exit(f"guard_grip: {error}")
