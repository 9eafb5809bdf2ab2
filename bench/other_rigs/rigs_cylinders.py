"""Simulated rigs with pistons and valves: hydraulic cylinder, pneumatic cylinder, control valve, magneto-rheological damper."""
import math

import numpy as np

import rig_elements as elements
import rig_signals as signals
from rig_lines import orifice_regulator
from rig_runs import Change, Rig
from rigs_bending import OF_A_LIMIT, OF_A_LOOP, OF_A_LOOP_WITHOUT_PRESSURE, OF_A_SHIFT, OF_A_SLOW_FLOW


def hydraulic(step_s, command, run):
    """Hydraulic cylinder with a spring load. A servo valve with a spool lag controls the pressure; the seals have Stribeck
    friction with presliding (LuGre)."""
    constant_s, limit = 0.03 * run("slow", 1.0), run("relief", np.inf)
    supply, leak, stop = 14000 * run.supply, run("leak_per_s", 0.0), run("object_mm", np.inf)
    seal, pressure, x, speed, bristle = run.friction * run("friction", 1.0), 0.0, 0.0, 0.0, 0.0
    spool, pressures, out = 0.0, [], []
    for kpa in (100 * command).tolist():  # the command has the unit bar
        spool += (min(max((kpa - pressure) / 1500, -1.0), 1.0) - spool) * step_s / constant_s
        drop = supply - pressure if spool > 0 else pressure + 100
        flow = 330 * spool * math.sqrt(max(drop, 0.0)) * run("slow_flow", 1.0)
        pressure = min(max(pressure + (flow - 12 * speed - leak * pressure) * step_s, 0.0), limit)
        friction = seal * (350 + 250 * math.exp(-(speed / 4) ** 2))
        bristle += (speed - abs(speed) * bristle / 0.15) * step_s
        force = pressure - 195 * x - friction * bristle / 0.15 - 6 * speed
        if x > stop:
            force -= 600 * (x - stop)
        speed += force / 0.9 * step_s
        x += speed * step_s
        pressures.append(pressure)
        out.append(x)
    return np.array(out), np.array(pressures) / 100


def pneumatic(step_s, command, run):
    """Pneumatic cylinder with a return spring: orifice flow, stiction of the seals (LuGre), no pressure sensor."""
    pressure = orifice_regulator(np.minimum(command, run("limit", np.inf)), step_s, 14, 60 * run.supply, 45, 800 * run.supply)
    seal, stop = run.friction * run("friction", 1.0), run("object_mm", np.inf)
    x, speed, bristle, out = 0.0, 0.0, 0.0, []
    for kpa in pressure.tolist():
        friction = seal * (14 + 10 * math.exp(-(speed / 6) ** 2))
        bristle += (speed - abs(speed) * bristle / 0.2) * step_s
        force = kpa - 60 - 7 * x - friction * bristle / 0.2 - 0.5 * speed
        if x < 0:
            force -= 60 * x + 3 * speed
        if x > stop:
            force -= 40 * (x - stop) + 3 * speed
        speed += force / 0.05 * step_s
        x += speed * step_s
        out.append(x)
    return elements.play(np.array(out), run("slack_mm", 0.0) / 2), None


def control_valve(step_s, command, run):
    """Control valve with a positioner: the positioner, a PI controller with a slow drive, moves a stem with packing
    friction."""
    band, jump = 1.2 * run.friction + run("band", 0.0), 0.4 + run("jump", 0.0)
    drive, total, stem, push, out = 0.0, 0.0, 0.0, 0.0, []
    slow = run("slow", 1.0)
    for kpa in command.tolist():
        wanted = (kpa - 20) / 80 * 100
        error = wanted - stem
        total += 0.12 / slow * error * step_s
        total = min(max(total, -20.0), 120.0)
        drive = min(max(0.9 * error + total, -20.0), 130.0)
        push += (drive - push) * step_s / (0.9 * slow) * run.supply
        if push - stem > band:
            stem = push - (band - jump)
        elif stem - push > band:
            stem = push + (band - jump)
        stem = min(max(stem, 0.0), 100.0)
        out.append(stem)
    return np.array(out) * 0.3, None


def damper(step_s, command, run):
    """Sprung mass with a magneto-rheological damper: hyperbolic tangent of the speed and of the position
    (after Kwok et al. 2006)."""
    yielding = run.friction * run("yield", 1.0) * 18
    stop, weight, y, speed, out = run("object_mm", np.inf), run("weight", 0.0), 0.0, 0.0, []
    for push in command.tolist():
        resisting = yielding * math.tanh(1.4 * speed + 0.06 * (y - 14))
        force = push - weight - 8 * run.stiffness * y - 5.5 * speed - resisting
        if y > stop:
            force -= 40 * (y - stop)
        speed += force / (1.2 + weight / 9.81) * step_s
        y += speed * step_s
        out.append(y)
    return np.array(out), None


RIGS = (
    Rig("hydraulic", "hydraulic cylinder with servo valve and spring load, pressure in bar", hydraulic, 0.015, 70, 0.001, 0,
        90, 45, 0.03, 0.01, signals.steps_and_ramps, signals.sines, 3, (
            Change("pressure_saturation", "relief valve opens at 72 bar", {"relief": 7200.0}),
            Change("leak", "leak past the piston", {"leak_per_s": 1.6}),
            Change("hysteresis_shape", "3 times the friction of the seals", {"friction": 3.0}, OF_A_LOOP),
            Change("valve_lag", "worn servo valve: spool 3 times slower, a third of the flow",
                   {"slow": 3.0, "slow_flow": 0.33}, OF_A_SLOW_FLOW),
            Change("contact", "object at 30 mm", {"object_mm": 30.0})), 0.08),
    Rig("pneumatic", "pneumatic cylinder with return spring and sticking seals", pneumatic, 0.02, 90, 0.001, 0, 400, 46, 0.05,
        0.05, signals.triangles, signals.steps_and_ramps, 4, (
            Change("contact", "object at 30 mm", {"object_mm": 30.0}),
            Change("backlash", "play of 5 mm in the joint", {"slack_mm": 5.0},
                   ("hysteresis_shape", "asymmetric_hysteresis", "valve_deadband")),
            Change("transport_delay", "command 0.25 s later", {"delay_s": 0.25}, OF_A_SHIFT),
            Change("pressure_saturation", "pressure limited to 290 kPa", {"limit": 290.0},
                   ("sensor_saturation", "contact")),
            Change("hysteresis_shape", "2.5 times the friction of the seals", {"friction": 2.5}, OF_A_LOOP_WITHOUT_PRESSURE))),
    Rig("control_valve", "control valve with packing friction and positioner", control_valve, 0.1, 180, 0.02, 20, 100, 30,
        0.03, 0.03, signals.staircase, signals.multisine, 12, (
            Change("valve_deadband", "sticking packing: band 25 %, jump 10 %", {"band": 24.0, "jump": 10.0}, ("backlash",)),
            Change("transport_delay", "command 2.5 s later", {"delay_s": 2.5}, OF_A_SHIFT),
            Change("valve_lag", "leaking diaphragm: drive 4 times slower", {"slow": 4.0}, ("sensor_lag",)),
            Change("sensor_drift", "zero of the sensor drifts by 4 mm", {"drift_mm": 4.0}),
            Change("sensor_saturation", "reading clipped at 20 mm", {"clip_mm": 20.0}, OF_A_LIMIT))),
    Rig("damper", "sprung mass with a magneto-rheological damper, force in N", damper, 0.02, 80, 0.002, 0, 250, 28, 0.03, 0.01,
        signals.steps_and_ramps, signals.multisine, 3, (
            Change("hysteresis_shape", "2 times the yield force of the damper", {"yield": 2.0}, OF_A_LOOP_WITHOUT_PRESSURE),
            Change("payload", "weight of 18 N", {"weight": 18.0}),
            Change("contact", "object at 18 mm", {"object_mm": 18.0}),
            Change("sensor_drift", "zero of the sensor drifts by -4 mm", {"drift_mm": -4.0}),
            Change("transport_delay", "command 0.25 s later", {"delay_s": 0.25}, OF_A_SHIFT))),
)
