"""Simulates the buttons and lamps of a rig. A GPIO chip in user space is preloaded into softgripd
(gpio_chips.cpp)."""

import time

import bench

PRELOADED = bench.BUILD / "tests" / "system" / "libgpio_chips.so"
DEBOUNCE_S = 0.005
STALE_AFTER_S = 0.2
SECTION = f"""
gpio:
  debounce_s: {DEBOUNCE_S}
  stale_after_s: {STALE_AFTER_S}
  emergency_stop: {{chip: gpiochip0, line: ESTOP, active: high, bias: pull_up}}
  enable: {{chip: gpiochip0, line: ENABLE, active: high, on_fault: drop}}
  ready_lamp: {{chip: gpiochip0, line: READY, active: high}}
  fault_lamp: {{chip: gpiochip0, line: FAULT, active: high}}
"""


def environment(folder):
    """Returns the environment variables with which softgripd uses the simulated chip."""
    (folder / "gpio").mkdir()
    return {"GPIO_CHIPS": str(folder / "gpio"), "LD_PRELOAD": str(PRELOADED)}


class Lines:
    """Presses the simulated buttons and reads the simulated lamps."""

    def __init__(self, folder):
        self.wire = bench.Lines(folder / "gpio/lines")

    def press(self, name="ESTOP"):
        self.wire.ask(f"high {name} {time.monotonic_ns()}")

    def release(self, name="ESTOP"):
        self.wire.ask(f"low {name} {time.monotonic_ns()}")

    def press_for(self, for_s, name="ESTOP"):
        """Presses a button for `for_s` seconds. Does not wait for a confirmation, because a paused softgripd
        sends none."""
        self.wire.file.write(f"high {name} {time.monotonic_ns()}\n")
        self.wire.file.flush()
        time.sleep(for_s)
        self.wire.file.write(f"low {name} {time.monotonic_ns()}\n")
        self.wire.file.flush()

    def heard(self):
        """Waits until softgripd has received the button press of press_for()."""
        for _ in range(2):
            self.wire.file.readline()

    def pull_out_the_chip(self):
        self.wire.ask("gone")

    def on(self):
        """Returns the names of the lines whose level is high."""
        return set(self.wire.ask("levels").split())

    def close(self):
        self.wire.close()
