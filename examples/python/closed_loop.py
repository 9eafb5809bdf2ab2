"""Runs a controller with the simulated board. `closed_loop.py MODEL.yaml` tracks a sine with feedforward and PID at 200
Hz."""

import math
import sys

import softgrip

TICK = 0.005  # period of the controller [s]


def main(model_file: str) -> None:
    model = softgrip.Model.load(model_file)
    board = softgrip.SimulatedBoard([softgrip.SimulatedFinger(model, noise=0.03)], TICK)
    controller = softgrip.Controller(
        model, softgrip.Limits(pressure_max=80), softgrip.PidSettings(kp=2.7, ki=13),
        extra_latency=TICK, tick=TICK)  # a command reaches the board one period after its computation
    reference = softgrip.Reference(0, start=1)  # the clock of the board starts at 1 s
    reference.ramp_to(6, duration=3)
    reference.sine(mean=9, amplitude=3, frequency=0.1, cycles=3)
    controller.follow(reference)

    board.connect()
    command = 0.0
    errors = []
    while board.now < reference.end:
        reading, = board.exchange([command])
        output = controller.tick(board.now, reading)
        command = output.command
        if board.now > reference.end - 10:  # the last cycle of the sine
            errors.append(board.displacement() - output.reference)
        board.advance(TICK)
    rmse = math.sqrt(sum(error**2 for error in errors) / len(errors))
    print(f"RMSE of the last cycle: {rmse:.3f} {model.unit}")


if __name__ == "__main__":
    main(sys.argv[1])
