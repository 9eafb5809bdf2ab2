"""Stores the outcome of each program in a file, together with a checksum of the program's inputs. A repeated run calls only
the programs whose inputs have changed."""
import hashlib
import json
import os
import pathlib
import resource
import subprocess
import time

NOT_ACCEPTABLE = 6  # exit code of a program that finished, but whose result is not acceptable
UNREADABLE = (ValueError, KeyError, TypeError, IndexError, StopIteration)  # raised for output in an unexpected format


class Failed(Exception):
    """A program failed. The text is the error message of the program."""

    def __init__(self, said, code=None):
        super().__init__(said)
        self.code = code


def checksum(*parts):
    """Returns a checksum of the content of files (given as paths) and of texts."""
    whole = hashlib.sha256()
    for part in parts:
        data = part.read_bytes() if isinstance(part, pathlib.Path) else str(part).encode()
        whole.update(hashlib.sha256(data).digest())
    return whole.hexdigest()


def output_of(command, at_most_s):
    """Runs a program and returns its standard output. Raises Failed if the exit code differs from 0 and NOT_ACCEPTABLE."""
    try:
        run = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=at_most_s)
    except subprocess.TimeoutExpired as error:
        raise Failed(f"stopped after {at_most_s:g} s") from error
    except OSError as error:
        raise Failed(f"{command[0]}: {error.strerror}") from error
    if run.returncode in (0, NOT_ACCEPTABLE):
        return run.stdout
    said = run.stderr.strip() or f"{command[0]}: exit code {run.returncode}"
    raise Failed(said.splitlines()[-1] if said.startswith("Traceback") else said, run.returncode)


def processor_s():
    """Returns the processor time of all child processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return None


def write_whole(path, text):
    """Replaces the file in one step, so that an interrupted run leaves no incomplete file."""
    part = path.with_suffix(".part")
    part.write_text(text)
    os.replace(part, path)


def described(error):
    return str(error) if isinstance(error, Failed) else f"its answer was not understood: {error!r}"


def outcome_in(folder, of, function, in_words=described):
    """Returns the outcome of function(folder), and True if a stored outcome was used. The outcome is a dict with the
    keys "of", "wall_s", "processor_s", "load_1min", and "result" or "error". A stored outcome is used if it has a
    result and if its checksum of the inputs equals `of`."""
    kept = folder / "outcome.json"
    known = read_json(kept)
    if known and known.get("of") == of and "result" in known:
        return known, True
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.yaml").unlink(missing_ok=True)  # written by an earlier run
    outcome = {"of": of, "load_1min": round(os.getloadavg()[0], 2)}
    began, processor = time.monotonic(), processor_s()
    try:
        outcome["result"] = function(folder)
    except (Failed, *UNREADABLE) as error:
        outcome["error"] = in_words(error)
    outcome.update(wall_s=time.monotonic() - began, processor_s=processor_s() - processor)
    write_whole(kept, json.dumps(outcome, indent=1) + "\n")
    return outcome, False
