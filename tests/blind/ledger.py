"""Stores the results of worlds as lines of JSON, so that a long campaign can be stopped and continued."""
import json


class Ledger:
    """The results in a file. `rows` contains the rows of the file. A world counts as done if a row and the world
    have the same values of `keys`. A missing key counts as None, so that files of earlier versions stay valid."""

    def __init__(self, path, keys):
        self.path, self.keys = path, keys
        path.parent.mkdir(parents=True, exist_ok=True)
        self.rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
        self.known = {self.key(row) for row in self.rows}

    def key(self, world):
        values = (world.get(key) for key in self.keys)
        return tuple(tuple(value) if isinstance(value, list) else value for value in values)

    def __contains__(self, world):
        return self.key(world) in self.known

    def add(self, row):
        self.rows.append(row)
        self.known.add(self.key(row))
        with self.path.open("a") as out:
            out.write(json.dumps(row) + "\n")
