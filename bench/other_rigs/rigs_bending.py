"""Simulated rigs that bend or bulge under pressure: PneuNet finger, fibre-reinforced finger, soft arm, membrane, vacuum
bellows."""
import math

import numpy as np

import rig_elements as elements
import rig_signals as signals
from rig_lines import orifice_regulator
from rig_runs import Change, Rig

# Causes that give the same readings as the labelled cause. Without a measured pressure, friction, play and a dead band of the
# valve all delay the motion after a reversal. The vocabulary of softgrip has no cause "friction".
OF_A_GAIN = ("thermal_gain", "stress_softening", "payload")
OF_A_SHIFT = ("clock_offset",)
OF_A_LOOP = ("asymmetric_hysteresis", "rate_dependent_hysteresis", "backlash")
OF_A_LOOP_WITHOUT_PRESSURE = (*OF_A_LOOP, "valve_deadband")
OF_A_LIMIT = ("contact", "pressure_saturation")
OF_A_SLOW_FLOW = ("blocked_line",)


def pneunet(step_s, command, run):
    """Silicone finger: play operators, hyperelastic curve, stretched exponential relaxation."""
    pressure = orifice_regulator(command, step_s, gain_per_s=9, fill=25 * run.supply, vent=16, supply=180 * run.supply,
                                 leak_per_s=run("leak_per_s", 0.0))
    share = elements.prandtl_ishlinskii(pressure / 80, np.array([0.02, 0.06, 0.12]) * run.friction, (0.15, 0.1, 0.06))
    free = 40 * (0.55 * share + 0.9 * share**2 - 0.45 * share**3) / (run.stiffness * run("stiffness", 1.0))
    position = elements.memory(free, 1 + 0.12 * elements.stretched(len(free), step_s, 6.0, 0.5))
    return elements.pressed(position, run("object_mm", np.inf), 4), pressure


def fibre_finger(step_s, command, run):
    """Fibre-reinforced finger: cubic stiffness, viscous material and Dahl friction between the fibres."""
    push, stiff = command.tolist(), run.stiffness * run("stiffness", 1.0)
    cubic, friction = 0.00028 * stiff * run("cubic", 1.0), 5.0 * run.friction * run("friction", 1.0)
    weight, out, y, force = run("weight", 0.0), [], 0.0, 0.0
    for kpa in push:
        speed = (kpa - weight * math.cos(y / 25) - stiff * 2.6 * y - cubic * y**3 - force) / 0.45
        move = speed * step_s
        force += 14 * move * (1 - force / friction * (1 if move > 0 else -1))
        force = min(max(force, -friction), friction)
        y += move
        out.append(y)
    return np.array(out), None


def soft_arm(step_s, command, run):
    """Heavy soft arm: a bending mode at about 1.1 Hz, a material that stiffens, viscous damping, slow valve."""
    push, y, speed, out = elements.lag(command, step_s, 0.12 / run.supply), 0.0, 0.0, []
    mass, stiff = 0.02 * run("mass", 1.0), run.stiffness * run("stiffness", 1.0)
    weight, stop = run("weight", 0.0), run("object_mm", np.inf)
    for kpa in push.tolist():
        force = kpa - weight - stiff * (0.85 * y + 0.00006 * y**3) - 0.045 * run.friction * speed
        if y > stop:
            force -= 3.0 * (y - stop) + 0.05 * speed
        speed += force / mass * step_s
        y += speed * step_s
        out.append(y)
    return np.array(out), None


def membrane(step_s, command, run):
    """Membrane that is soft close to its flat position (buckling), with viscous damping and a logarithmic creep."""
    push, y, out = command.tolist(), 0.0, []
    weight, seat = run("weight", 0.0), run("seat", 0.0)
    for kpa in push:
        net = max(kpa - seat, 0.0) - weight
        cube = (y - 3.5) ** 3 + 3.5**3
        y += (net - run.stiffness * (1.1 * y + 0.33 * cube)) / 1.6 * step_s
        out.append(y)
    kernel = 1 + 0.03 * elements.logarithmic(len(out), step_s, 1.0)
    return elements.memory(np.array(out), kernel), None


def vacuum_bellows(step_s, command, run):
    """Bellows that contract under vacuum. The pump becomes slower at low pressures; the folds jam at the end."""
    state, pressure, leak = 0.0, [], run("leak_per_s", 0.0)
    pump, vent = 45 * run.supply * run("pump", 1.0), 70 * run("pump", 1.0)
    for kpa in command.tolist():
        error = 7 * run("pump", 1.0) * (kpa - state)
        rate = max(error, -pump * max(1 + state / 88, 0)) if error < 0 else min(error, vent * (0.15 - state / 90))
        state += (rate - leak * state) * step_s
        pressure.append(state)
    pressure = np.array(pressure)
    share = elements.play(-pressure / 60, 0.015 * run.friction) / run.stiffness
    contraction = 30 * np.tanh(1.5 * share) / np.tanh(1.5)
    jammed = np.maximum(contraction - run("jam_mm", np.inf), 0)
    contraction = contraction - jammed + jammed / (1 + jammed / 6)
    contraction = elements.memory(contraction, 1 + 0.02 * elements.logarithmic(len(contraction), step_s, 0.5))
    return elements.pressed(contraction, run("object_mm", np.inf), 5), pressure


RIGS = (
    Rig("pneunet", "PneuNet finger, regulator with two orifices", pneunet, 0.03, 120, 0.01, 0, 80, 40, 0.06, 0.01,
        signals.steps_and_ramps, signals.triangles, 5, (
            Change("ageing", "silicone 18 % softer", {"stiffness": 0.82}, OF_A_GAIN),
            Change("contact", "object at 24 mm, 3 times as stiff as the finger", {"object_mm": 24.0}),
            Change("leak", "leak behind the regulator, 5 % of the pressure at rest", {"leak_per_s": 0.5}),
            Change("sensor_drift", "zero of the sensor drifts by 7 mm", {"drift_mm": 7.0}),
            Change("transport_delay", "command 0.15 s later", {"delay_s": 0.15}, OF_A_SHIFT)), 0.15),
    Rig("fibre_finger", "fibre-reinforced finger with Dahl friction", fibre_finger, 0.03, 100, 0.005, 0, 120, 35, 0.04, 0.02,
        signals.triangles, signals.staircase, 4, (
            Change("hysteresis_shape", "3 times the friction", {"friction": 3.0}, OF_A_LOOP_WITHOUT_PRESSURE),
            Change("payload", "weight at the tip that needs 14 kPa when the finger is straight", {"weight": 14.0}),
            Change("stiffening", "4 times the cubic stiffness", {"cubic": 4.0}, ("sensor_nonlinearity",)),
            Change("sensor_lag", "filter of 0.4 s behind the sensor", {"sensor_lag_s": 0.4}, ("valve_lag",)),
            Change("ageing", "material 15 % stiffer", {"stiffness": 1.15}, OF_A_GAIN))),
    Rig("soft_arm", "heavy soft arm with a bending mode", soft_arm, 0.03, 90, 0.005, 0, 50, 50, 0.1, 0.05,
        signals.steps_and_ramps, signals.sines, 4, (
            Change("inertia", "2.5 times the mass", {"mass": 2.5}),
            Change("payload", "weight at the tip: 5 kPa and 1.3 times the mass", {"weight": 5.0, "mass": 1.3}),
            Change("contact", "stop at 30 mm", {"object_mm": 30.0}),
            Change("sensor_saturation", "reading clipped at 36 mm", {"clip_mm": 36.0}, OF_A_LIMIT),
            Change("ageing", "material 15 % softer", {"stiffness": 0.85}, OF_A_GAIN))),
    Rig("membrane", "buckling membrane", membrane, 0.025, 80, 0.005, 0, 60, 7.5, 0.008, 0.002,
        signals.triangles, signals.binary, 3, (
            Change("payload", "weight that needs 6 kPa", {"weight": 6.0}),
            Change("transport_delay", "command 0.2 s later", {"delay_s": 0.2}, OF_A_SHIFT),
            Change("ageing", "gain of the sensor 14 % lower", {"sensor_gain": 0.86}, OF_A_GAIN),
            Change("sensor_nonlinearity", "scale of the sensor curved by 0.7 mm", {"bow_mm": 0.7}, ("stiffening",)),
            Change("actuator_threshold", "no motion below 9 kPa", {"seat": 9.0}))),
    Rig("vacuum_bellows", "vacuum bellows with a pump", vacuum_bellows, 0.05, 150, 0.01, 0, -60, 30, 0.03, 0.01,
        signals.staircase, signals.steps_and_ramps, 4, (
            Change("leak", "leak of the bellows, 4 % of the vacuum at rest", {"leak_per_s": 0.3}),
            Change("contact", "object at 18 mm, 4 times as stiff as the bellows", {"object_mm": 18.0}),
            Change("sensor_drift", "zero of the sensor drifts by -5 mm", {"drift_mm": -5.0}),
            Change("stiffening", "folds jam gradually beyond 10 mm", {"jam_mm": 10.0}, ("sensor_nonlinearity",)),
            Change("valve_lag", "clogged filter: air flows 3 times slower", {"pump": 0.33}, OF_A_SLOW_FLOW)), 0.1),
)
