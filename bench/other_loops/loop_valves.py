"""Simulates control valves that stick, with four models of the literature.

All positions and commands are shares of the stroke [%]. Each model has the parameters S (deadband plus stick band: the
change of the command after a reversal at which the stem begins to move) and J (the slip jump of the stem at this moment).
The static friction is (S + J) / 2 and the sliding friction is (S - J) / 2, both divided by the stiffness of the spring.

- Choudhury: M.A.A.S. Choudhury, N.F. Thornhill, S.L. Shah, "Modelling valve stiction", Control Engineering Practice 13
  (2005) 641-658. The stem rests from a reversal of the command until the command has changed by S; then it follows the
  command at the distance (S - J) / 2. If the command pauses without a reversal, the stem moves after a change of J.
- Kano: M. Kano, H. Maruta, H. Kugemoto, K. Shimizu, "Practical model and detection algorithm for valve stiction", IFAC
  DYCOPS 2004. It has the same parameters and two states (resting, moving). In contrast to the model of Choudhury, it
  compares the command with the command at the begin of the rest in both directions, so it accepts a noisy command.
- He: Q.P. He, J. Wang, M. Pottmann, S.J. Qin, "A curve fitting method for detecting valve stiction in oscillating control
  loops", Industrial & Engineering Chemistry Research 46 (2007) 4549-4560. The force that the stem has not followed
  accumulates; if it exceeds the static friction, the stem moves until only the sliding friction remains.
- Karnopp: D. Karnopp, "Computer simulation of stick-slip friction in mechanical dynamic systems", Journal of Dynamic
  Systems, Measurement, and Control 107 (1985) 100-103, for a spring-and-diaphragm valve:
  m x'' = k (u - x) - c x' - Fc sign(x') if |x'| exceeds a small velocity; otherwise the stem rests until
  k |u - x| > Fs. The natural frequency is 20 rad/s and the damping ratio is 0.7.
The equations were written from these descriptions; the texts of the publications were not available.
"""
import math


def sign(value):
    return (value > 0) - (value < 0)


class Free:
    """A valve without friction."""

    def __init__(self, at):
        self.stem = at

    def step(self, command, step_s):
        self.stem = command
        return self.stem


class Choudhury:
    def __init__(self, at, band, jump):
        self.band, self.jump = band, jump
        self.stem = self.command = self.rested = at
        self.direction, self.moving, self.paused = 0, False, False

    def step(self, command, step_s):
        change = sign(command - self.command)
        if change == 0:
            if self.moving:
                self.rested, self.moving, self.paused = self.command, False, True
        else:
            if change != self.direction:
                self.rested, self.moving, self.paused = self.command, False, False
            self.direction = change
            self.moving = self.moving or abs(command - self.rested) > (self.jump if self.paused else self.band)
            if self.moving:
                self.stem, self.paused = command - change * (self.band - self.jump) / 2, False
        self.command = command
        return self.stem


class Kano:
    def __init__(self, at, band, jump):
        self.band, self.jump = band, jump
        self.stem = self.command = self.rested = at
        self.direction, self.resting, self.change = 1, True, 0.0

    def step(self, command, step_s):
        change = command - self.command
        if not self.resting and change * self.change <= 0:
            self.rested, self.resting = self.command, True
        self.command, self.change = command, change
        if self.resting:
            moved = self.direction * (command - self.rested)
            if moved < -self.band:
                self.direction, self.resting = -self.direction, False
            elif moved > self.jump:
                self.resting = False
        if not self.resting:
            self.stem = command - self.direction * (self.band - self.jump) / 2
        return self.stem


class He:
    def __init__(self, at, band, jump):
        self.static, self.sliding = (band + jump) / 2, (band - jump) / 2
        self.stem, self.command, self.force = at, at, 0.0

    def step(self, command, step_s):
        force = self.force + command - self.command
        self.command = command
        if abs(force) > self.static:
            rest = sign(force) * self.sliding
            self.stem += force - rest
            force = rest
        self.force = force
        return self.stem


class Karnopp:
    OMEGA, DAMPING, FINE_S, RESTING = 20.0, 0.7, 0.004, 1e-3  # rad/s, -, s, %/s

    def __init__(self, at, band, jump):
        self.static, self.sliding = (band + jump) / 2, (band - jump) / 2
        self.stem, self.velocity = at, 0.0

    def step(self, command, step_s):
        left = math.ceil(step_s / self.FINE_S)
        fine = step_s / left
        stiffness, drag = self.OMEGA ** 2, 2 * self.DAMPING * self.OMEGA
        while left:
            force = command - self.stem
            if self.velocity == 0.0:
                if abs(force) <= self.static:
                    break
                friction = sign(force) * self.sliding
            else:
                friction = sign(self.velocity) * self.sliding
            velocity = self.velocity + fine * (stiffness * (force - friction) - drag * self.velocity)
            stops = self.velocity != 0.0 and velocity * self.velocity <= 0 or abs(velocity) < self.RESTING
            self.velocity = 0.0 if stops else velocity
            self.stem += fine * self.velocity
            left -= 1
        return self.stem


STICKING = {"choudhury": Choudhury, "kano": Kano, "he": He, "karnopp": Karnopp}


def equal_percentage(stem, ratio=50.0):
    """Returns the flow through a valve whose gain is exponential in the stem position. Flow and gain are those of a linear
    valve at a stem position of 50 %."""
    return 50.0 + (ratio ** ((stem - 50.0) / 100.0) - 1) * 100.0 / math.log(ratio)
