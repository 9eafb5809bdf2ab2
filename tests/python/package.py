"""Adds the folder of the package to the module path. Use `import package` before `import softgrip`."""

import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python"))
