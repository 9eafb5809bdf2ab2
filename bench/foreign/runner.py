"""Runs softgrip on the logs of data sets. The result of each call is stored (outcomes.py). Therefore, several judges
can use the result of one identification."""
import json
import re

from log_reading import Spoiled, read_log
from outcomes import Failed, checksum, described, outcome_in, output_of, write_whole

MOST_NAME = 100  # largest number of characters in the name of a folder


def slug(text):
    """Converts a text to a name for a file or a folder."""
    name = re.sub(r"[^\w-]+", "_", text).strip("_")
    return name if len(name) <= MOST_NAME else f"{name[:MOST_NAME - 9]}_{checksum(text)[:8]}"


def rms(values):
    return (sum(value * value for value in values) / len(values)) ** 0.5


class PreparedLog:
    """A log of a data set in the format of softgrip. If `drive` is "command", the measured pressure is removed."""

    def __init__(self, entry, folder, out, drive):
        self.name, self.begin, self.file = entry.name, entry.begin, entry.file
        log = read_log(entry, folder)
        self.notes, self.lines = log.notes, log.lines
        self.has_command, self.has_pressure = "command" in entry.columns, "pressure" in log.columns
        if drive == "command":
            log.columns.pop("pressure", None)
        readings = [value for value in log.columns["displacement"] if value == value]
        self.samples, self.length_s, self.span_mm = len(log.time_s), log.time_s[-1], max(readings) - min(readings)
        self.path = out / f"{slug(entry.name)}.csv"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(self.path, log.text())

    @property
    def key(self):
        """Returns the name of this log in the results of softgrip."""
        return self.path.stem

    def in_original(self, text):
        """Replaces the name and the line numbers of the prepared log in `text` by those of the original log."""
        lines = [0, *self.lines]  # line numbers of the original log; the first entry is for the header

        def original(found):
            return f"{self.file}:{lines[min(int(found[1]), len(lines)) - 1] or 1}"
        return re.sub(re.escape(str(self.path)) + r":(\d+)(:\d+)?", original, text)


class Runner:
    def __init__(self, softgrip, out, threads=1, at_most_s=3600):
        self.softgrip, self.out, self.threads, self.at_most_s = softgrip, out, threads, at_most_s
        self.program = checksum(softgrip)
        self.version = output_of([softgrip, "--version"], 60).strip()
        self.prepared, self.calls = {}, []

    def cost(self):
        """Returns the time and the highest machine load of the calls since the last call of cost(). For a stored
        outcome, these values are those of the run in which the call was made."""
        calls, self.calls = self.calls, []
        return {"wall_s": round(sum(call["wall_s"] for call in calls), 2),
                "processor_s": round(sum(call["processor_s"] for call in calls), 2),
                "load_1min": max((call["load_1min"] for call in calls), default=None)}

    def kept(self, folder, of, function, in_words=described):
        """Returns the outcome of outcome_in(), and adds its time and load to the result of the next cost()."""
        outcome = outcome_in(folder, of, function, in_words)[0]
        self.calls.append(outcome)
        return outcome

    def log(self, data_set, name, drive=""):
        """Returns the prepared log. Raises Failed if the log file, or the entry for it in the table, has a mistake."""
        key = (data_set.name, name, drive)
        if key not in self.prepared:
            folder = self.out / data_set.name / ("logs" + (f"-{drive}" if drive else ""))
            try:
                self.prepared[key] = PreparedLog(data_set.logs[name], data_set.folder, folder, drive)
            except Spoiled as spoiled:
                raise Failed(str(spoiled).replace(f"{data_set.folder}/", "")) from spoiled
        return self.prepared[key]

    def call(self, folder, command, files, words, logs):
        """Runs `softgrip COMMAND WORDS --out FOLDER`. Returns the outcome, whose result is the JSON output of the
        command."""
        of = checksum(*files, self.program, command, *words)

        def answer(out):
            text = output_of([self.softgrip, command, *words, "--out", out, "--json"], self.at_most_s)
            write_whole(out / "answer.json", text)
            return json.loads(text)

        def in_words(error):
            text = described(error)
            for log in logs:
                text = log.in_original(text)
            return text.replace(f"{self.out}/", "")
        return self.kept(folder, of, answer, in_words)

    @staticmethod
    def begin(logs):
        begins = {log.begin for log in logs}
        return begins.pop() if len(begins) == 1 else "auto"

    def identify(self, data_set, logs, validated=(), words=()):
        """Runs `softgrip identify` on `logs`. Returns the folder that contains the model, and the outcome."""
        name = " + ".join([*(log.name for log in logs), *words])
        folder = self.out / data_set.name / "identify" / slug(name + "".join(f" to {log.name}" for log in validated))
        options = ["--data", *(log.path for log in logs)]
        if validated:
            options += ["--validate", *(log.path for log in validated)]
        options += ["--begin", self.begin([*logs, *validated]), "--threads", self.threads, *words]
        files = [log.path for log in (*logs, *validated)]
        return folder, self.call(folder, "identify", files, options, (*logs, *validated))

    def diagnose(self, folder, model, logs, healthy=()):
        """Runs `softgrip diagnose` with the given model. With `healthy` logs, diagnoses the change since these logs."""
        options = ["--model", model, "--data", *(log.path for log in logs)]
        if healthy:
            options += ["--healthy", *(log.path for log in healthy)]
        options += ["--begin", self.begin([*logs, *healthy]), "--threads", self.threads, "--no-closed-loop"]
        files = [model, *(log.path for log in (*logs, *healthy))]
        return self.call(folder, "diagnose", files, options, (*logs, *healthy))


def result_of(outcome):
    """Returns the result of an outcome. If the outcome has no result, raises Failed with the message of the program."""
    if "error" in outcome:
        raise Failed(outcome["error"])
    return outcome["result"]


def names_in(diagnosis):
    """Returns verdict, named causes, alternatives and sizes of a diagnosis, as the page and the judges use them."""
    return {"verdict": diagnosis["verdict"], "named": [cause["id"] for cause in diagnosis["causes"]],
            "alternatives": diagnosis["alternatives"],
            "partial": [cause["id"] for cause in diagnosis.get("partial_causes", [])],
            "sizes": [cause.get("size") for cause in diagnosis["causes"]]}
