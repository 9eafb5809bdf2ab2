"""Shows a robot program that checks a sequence, grips a part, carries the part away and releases it.

The program also handles a failed grip.

    pick_part.py [SOCKET] [--sequence hand_over] [--squeeze-kpa 4]
"""

import argparse
import sys

import softgrip


def carry_away() -> None:
    """Stands for the motion of the robot with the part. In this example, the function does nothing."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("socket", nargs="?", help="socket of softgripd [$SOFTGRIP_SOCKET]")
    parser.add_argument("--sequence", default="pick_stone")
    parser.add_argument("--squeeze-kpa", type=float, default=4.0)
    arguments = parser.parse_args()

    # At its end, also after an exception, the block stops the sequences that it started and that may still run.
    with softgrip.Gripper(arguments.socket, name="pick_part") as gripper:
        gripper.check(arguments.sequence, squeeze_kpa=arguments.squeeze_kpa)
        gripper.start(arguments.sequence, squeeze_kpa=arguments.squeeze_kpa)
        try:
            gripper.wait_until(softgrip.Result.HOLDING, timeout_s=60)
        except softgrip.GripFailed as failed:
            print(f"nothing gripped: {failed}")
            gripper.wait(timeout_s=60)
            return 1
        for channel in gripper.status().channels:
            print(f"{channel.name}: {channel.result.value} at {channel.displacement_mm:.2f} mm")
        carry_away()
        gripper.release()
        print(f"let go: {gripper.wait(timeout_s=60).value}")
        return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except softgrip.SoftgripError as error:
        sys.exit(f"pick_part: {error}")
