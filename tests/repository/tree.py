"""Lists the files of the project that git tracks. If the sources come from a tarball, lists all files that do not
belong to a build."""

import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def names():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, text=True)
    if listed.returncode == 0:
        return sorted({name for name in listed.stdout.splitlines() if (ROOT / name).exists()})
    files = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
    return sorted(str(path) for path in files if not path.parts[0].startswith((".", "build")))
