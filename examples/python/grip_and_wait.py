"""Grips a part, waits for the grip result and releases the part: grip_and_wait.py [SOCKET] [SEQUENCE]. Exit code 1: the
gripper holds no part, or an error occurred."""

import sys
from typing import Optional

import softgrip


def main(socket: Optional[str] = None, sequence: str = "pick_stone") -> int:
    # At its end, also after an exception, the block stops the sequence if the sequence still runs.
    with softgrip.Gripper(socket, name="grip_and_wait") as gripper:
        gripper.check(sequence)  # checks the sequence as a start does, but does not start it
        gripper.start(sequence)
        try:
            result = gripper.wait_until(softgrip.Result.HOLDING, timeout_s=60)
        except softgrip.GripFailed as failed:
            print(failed)
            return 1
        print(f"result: {result.value}")
        for channel in gripper.status().channels:
            print(f"{channel.name}: {channel.result.value} at {channel.displacement_mm:.2f} mm")
        gripper.release()
        print(f"end: {gripper.wait(timeout_s=60).value}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except softgrip.SoftgripError as error:
        sys.exit(f"grip_and_wait: {error}")
