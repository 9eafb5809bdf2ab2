"""Simulated rigs with active materials and muscles: pneumatic muscle, dielectric elastomer, shape-memory wire, wax motor."""
import numpy as np

import rig_elements as elements
import rig_signals as signals
from rig_lines import orifice_regulator
from rig_runs import Change, Rig
from rigs_bending import OF_A_GAIN, OF_A_LOOP, OF_A_LOOP_WITHOUT_PRESSURE, OF_A_SHIFT, OF_A_SLOW_FLOW


def muscle(step_s, command, run):
    """Pneumatic muscle (Chou and Hannaford 1996) that lifts a mass against a spring: force balance with friction that has
    presliding (LuGre without the Stribeck term)."""
    pressure = orifice_regulator(command, step_s, 11 / run("slow", 1.0), 90 * run.supply / run("slow", 1.0),
                                 70 / run("slow", 1.0), 700 * run.supply, run("leak_per_s", 0.0))
    mass, stop, most = 4.0 + run("load_kg", 0.0), run("object_mm", np.inf), run.friction * run("friction", 1.0)
    x, speed, bristle, out = 0.0, 0.0, 0.0, []
    for kpa in pressure.tolist():
        pull = 1.2 * max(kpa - 15, 0.0) * max(1 - x / 52, 0.0) ** 1.5
        friction = most * (7 + 0.025 * kpa)
        bristle += (speed - abs(speed) * bristle / 0.3) * step_s
        force = pull - 4.0 * run.stiffness * x - 9.81 * mass - friction * bristle / 0.3 - 0.12 * speed
        if x < 0:
            force -= 60 * x + 0.3 * speed
        if x > stop:
            force -= 25 * (x - stop) + 0.3 * speed
        speed += 1000 * force / mass * step_s
        x += speed * step_s
        out.append(x)
    return np.array(out), pressure


def dielectric(step_s, command, run):
    """Dielectric elastomer: the stress is proportional to the square of the voltage, the material creeps with a power law."""
    stress = (command / 5) ** 2 / run.stiffness * run("material", 1.0)
    strain = 1.55 * stress / (1 - 0.22 * stress)
    kernel = 0.85 + 0.1 * elements.power_law(len(strain), step_s, 1.0, 0.18)
    kernel = kernel + run("late", 0.0) * elements.stretched(len(strain), step_s, 40.0, 0.8)
    kernel[0] = 0.85
    return elements.lag(elements.memory(strain, kernel), step_s, 0.02), None


def wire(step_s, command, run):
    """Shape-memory wire: the current heats, the surrounding air cools, and a Preisach model gives the transformation."""
    heat, state, out = (command / 1.5) ** 2, 0.0, []
    for power in heat.tolist():
        state += (power * 1.05 - state * (1 + 0.15 * state)) / 1.6 * step_s
        out.append(state)
    warm = np.array(out) + 0.003 * run.warmer_k - run("bias", 0.0)
    transformed = elements.preisach(np.clip(warm, 0, 1), 60, 0.22, run("width", 0.25))
    return 6.0 * transformed / run.stiffness * run("material", 1.0) + 0.25 * warm - 0.8 * run("bias", 0.0), None


def wax(step_s, command, run):
    """Wax motor: heater, heat capacity with melting, loss by convection and radiation, then a return spring."""
    state, out, ambient = 0.0, [], 0.2 * run.warmer_k
    mass = run("capacity", 1.0)
    for power in command.tolist():
        melting = 1 + 2.2 * np.exp(-((state - 42) / 12) ** 2)
        loss = (state - ambient) * (0.1 + 0.00035 * max(state, 0.0))
        state += (power * run.supply**0.5 - loss) / (0.62 * mass * melting) * step_s
        out.append(state)
    warm = np.array(out)
    melted = 1 / (1 + np.exp(-(warm - 42) / 9)) - 1 / (1 + np.exp(42 / 9))
    free = (0.012 * warm + 5.0 * melted) / run.stiffness
    return elements.pressed(elements.play(free, 0.03), run("object_mm", np.inf), 6), None


RIGS = (
    Rig("muscle", "pneumatic muscle that lifts a mass against a spring", muscle, 0.02, 90, 0.001, 70, 400, 24, 0.03, 0.01,
        signals.steps_and_ramps, signals.multisine, 4, (
            Change("payload", "3 kg more", {"load_kg": 3.0}),
            Change("contact", "stop at 17 mm", {"object_mm": 17.0}),
            Change("leak", "leak of the muscle, 8 % of the pressure at rest", {"leak_per_s": 0.95}),
            Change("hysteresis_shape", "4 times the friction", {"friction": 4.0}, OF_A_LOOP),
            Change("valve_lag", "narrow valve: air flows 4 times slower", {"slow": 4.0}, OF_A_SLOW_FLOW)), 0.5),
    Rig("dielectric", "dielectric elastomer, voltage in kV", dielectric, 0.04, 120, 0.01, 0, 5, 2.1, 0.003, 0.001,
        signals.steps_and_ramps, signals.sines, 6, (
            Change("ageing", "material 17 % stiffer", {"material": 0.83}, OF_A_GAIN),
            Change("slow_creep", "additional creep of 20 % with a time constant of 40 s", {"late": 0.2}, ("stress_softening",)),
            Change("sensor_nonlinearity", "scale of the sensor curved by 0.2 mm", {"bow_mm": 0.2}, ("stiffening",)),
            Change("periodic_disturbance", "vibration of 0.11 mm at 1.7 Hz", {"hum_mm": 0.11, "hum_hz": 1.7}),
            Change("sensor_lag", "filter of 0.5 s behind the sensor", {"sensor_lag_s": 0.5}, ("valve_lag",)))),
    Rig("wire", "shape-memory wire, current in A", wire, 0.06, 180, 0.03, 0, 1.5, 6.2, 0.015, 0.005,
        signals.triangles, signals.staircase, 9, (
            Change("ageing", "transformation strain 38 % smaller", {"material": 0.62}, OF_A_GAIN),
            Change("payload", "larger bias load: transformation at higher temperature, elastic sag", {"bias": 0.12}),
            Change("sensor_drift", "zero of the sensor drifts by 1 mm", {"drift_mm": 1.0}),
            Change("transport_delay", "command 2.3 s later", {"delay_s": 2.3}, OF_A_SHIFT),
            Change("hysteresis_shape", "hysteresis 1.7 times as wide", {"width": 0.43}, OF_A_LOOP_WITHOUT_PRESSURE))),
    Rig("wax", "wax motor, heater power in W", wax, 0.1, 180, 0.05, 0, 9, 5.5, 0.012, 0.005,
        signals.steps_and_ramps, signals.binary, 14, (
            Change("ageing", "gain of the sensor 22 % lower", {"sensor_gain": 0.78}, OF_A_GAIN),
            Change("contact", "object at 1.8 mm, 5 times as stiff as the spring", {"object_mm": 1.8}),
            Change("sensor_drift", "zero of the sensor drifts by -0.9 mm", {"drift_mm": -0.9}),
            Change("valve_lag", "2 times the heat capacity", {"capacity": 2.0}, ("sensor_lag",)),
            Change("sensor_nonlinearity", "scale of the sensor curved by 0.7 mm", {"bow_mm": 0.7}, ("stiffening",)))),
)
