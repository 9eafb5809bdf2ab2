"""Simulated rigs with their own dynamics in the drive: piezo stage, tendon arm, long tube, bellows with a PI regulator."""
import numpy as np

import rig_elements as elements
import rig_signals as signals
from rig_lines import integrating_regulator
from rig_runs import Change, Rig
from rigs_bending import OF_A_GAIN, OF_A_LOOP_WITHOUT_PRESSURE, OF_A_SHIFT, OF_A_SLOW_FLOW


def piezo(step_s, command, run):
    """Piezo stage: play operators whose radius grows with the rate of the voltage (Ang et al. 2007), logarithmic creep and
    a resonance."""
    volts = elements.lag(command, step_s, 0.004)
    rate = elements.lag(np.abs(np.gradient(volts, step_s)), step_s, 0.05)
    out = 0.72 * volts
    for radius, weight in ((4.0, 0.12), (12.0, 0.1), (25.0, 0.06)):
        widened = radius * run.friction * run("loop", 1.0) * (1 + 0.25 * np.log1p(rate / 50))
        out = out + weight * moving_play(volts, widened)
    stroke = out * 0.0008 / run.stiffness * run("poling", 1.0)
    stroke = elements.memory(stroke, 1 + 0.014 * run("creep", 1.0) * elements.logarithmic(len(stroke), step_s, 0.1))
    return elements.second_order(stroke, step_s, 18.0 / run("mass", 1.0) ** 0.5, 0.06 / run("mass", 1.0) ** 0.5), None


def moving_play(values, radii):
    """Returns the output of a play operator whose radius varies."""
    out, state = [], float(values[0])
    for value, radius in zip(values.tolist(), radii.tolist()):
        state = min(max(state, value - radius), value + radius)
        out.append(state)
    return np.array(out)


def tendon(step_s, command, run):
    """Arm that a motor pulls with an elastic tendon: gear backlash, friction in the sheath (capstan), gravity and mass."""
    reel = elements.play(elements.lag(command, step_s, 0.06), 0.9 + run("slack", 0.0)).tolist()
    angle, speed, out = 0.0, 0.0, []
    load, stop = 1.0 + run("load", 0.0), run("object_deg", np.inf)
    for wound in reel:
        pull = max(wound - 0.55 * angle, 0.0) * 6.0 * run.stiffness
        pull *= 1 - 0.07 * run.friction * np.tanh(speed / 4)
        torque = pull - load * 22 * np.sin(np.radians(angle + 15)) - 1.1 * angle - 2.6 * speed
        if angle > stop:
            torque -= 30 * (angle - stop)
        speed += torque / (0.8 * load) * step_s
        angle += speed * step_s
        out.append(angle)
    return np.array(out) * 0.9, None


def tube(step_s, command, run):
    """Actuator at the end of a long tube: dead time of the wave, second-order line, play and a weakly progressive spring.
    The pressure is measured at the actuator."""
    line = elements.second_order(elements.delayed(np.minimum(command, run("limit", np.inf)), step_s, 0.035), step_s,
                                 1.7 * run("narrow", 1.0), min(0.55 / run("narrow", 1.0), 0.98))
    lost = run("lost", 0.0)
    pressure = line * (1 - lost)
    share = elements.prandtl_ishlinskii(pressure / 150, np.array([0.01, 0.05]) * run.friction, (0.12, 0.12))
    free = 20 * (1.25 * share - 0.25 * share**2) / run.stiffness
    return elements.pressed(elements.lag(free, step_s, 0.05), run("object_mm", np.inf), 4), pressure


def regulated_bellows(step_s, command, run):
    """Bellows behind a regulator with its own PI loop and a limited flow. The fabric relaxes with a stretched exponential."""
    pressure = integrating_regulator(command, step_s, 7.0 / run("slow", 1.0), 2.5 / run("slow", 1.0),
                                     130 * run.supply * run("flow", 1.0), run("limit", np.inf), run("leak_per_s", 0.0),
                                     run("band", 0.0))
    share = pressure / 200
    free = 60 * (share + 0.5 * share**2) / 1.5 / run.stiffness * run("material", 1.0)
    loop = elements.dahl(free, 2.2 * run.friction, 1.1)
    position = elements.memory(free - loop * 0.8, 1 + 0.06 * elements.stretched(len(free), step_s, 12.0, 0.6))
    return position, pressure


RIGS = (
    Rig("piezo", "piezo stage with resonance and creep, voltage in V", piezo, 0.005, 60, 0.0025, 0, 100, 0.08, 0.00005, 0.00001,
        signals.multisine, signals.triangles, 0.25, (
            Change("inertia", "9 times the mass on the stage", {"mass": 9.0}),
            Change("transport_delay", "command 0.02 s later", {"delay_s": 0.02}, OF_A_SHIFT),
            Change("sensor_drift", "zero of the sensor drifts by 0.012 mm", {"drift_mm": 0.012}),
            Change("ageing", "loss of polarisation: 15 % less stroke", {"poling": 0.85}, OF_A_GAIN),
            Change("hysteresis_shape", "3.5 times the widths of the loops", {"loop": 3.5}, OF_A_LOOP_WITHOUT_PRESSURE))),
    Rig("tendon", "arm with an elastic tendon and gear backlash", tendon, 0.025, 90, 0.005, 0, 45, 55, 0.05, 0.05,
        signals.triangles, signals.binary, 3, (
            Change("backlash", "additional backlash of 5 mm at the motor", {"slack": 2.5},
                   ("hysteresis_shape", "asymmetric_hysteresis", "valve_deadband")),
            Change("payload", "load of 0.55 times the arm", {"load": 0.55}),
            Change("contact", "object at 35 degrees", {"object_deg": 35.0}),
            Change("sensor_drift", "zero of the sensor drifts by 8 mm", {"drift_mm": 8.0}),
            Change("transport_delay", "command 0.2 s later", {"delay_s": 0.2}, OF_A_SHIFT))),
    Rig("tube", "actuator at the end of a long tube", tube, 0.015, 75, 0.005, 0, 150, 20, 0.02, 0.005,
        signals.steps_and_ramps, signals.binary, 2, (
            Change("transport_delay", "wave 0.05 s later (longer tube)", {"delay_s": 0.05}, OF_A_SHIFT),
            Change("leak", "leak at the actuator, 6 % of the pressure", {"lost": 0.06}),
            Change("valve_lag", "narrow tube: frequency of the line 0.75 times", {"narrow": 0.75}, OF_A_SLOW_FLOW),
            Change("pressure_saturation", "pressure limited to 125 kPa", {"limit": 125.0}),
            Change("contact", "object at 14 mm, 3 times as stiff as the actuator", {"object_mm": 14.0})), 0.2),
    Rig("regulated_bellows", "bellows with a PI regulator of limited flow", regulated_bellows, 0.025, 100, 0.005, 0, 200, 60,
        0.08, 0.02, signals.staircase, signals.steps_and_ramps, 3, (
            Change("pressure_saturation", "pressure limited to 160 kPa", {"limit": 160.0}),
            Change("leak", "leak that the regulator compensates only slowly", {"leak_per_s": 0.6}),
            Change("valve_deadband", "sticking spool of the regulator", {"band": 65.0}),
            Change("valve_lag", "regulator 4 times slower", {"slow": 4.0}),
            Change("ageing", "fabric 17 % softer", {"material": 1.17}, OF_A_GAIN)), 0.3),
)
