"""Compares the rooms (source folders with permitted includes) of cmake/rooms.cmake with the code and with
docs/explanation/architecture.md.

    rooms.py            fails if a folder with code belongs to no room, if a room names another room after USES
                        whose headers it does not include, if a room uses a room of its own or a higher layer of the
                        page, or if the table of the page differs from rooms.cmake
    rooms.py --write    updates the first and the last column of the page; the content of a room is written by hand
"""

import pathlib
import re
import sys

source = pathlib.Path(__file__).resolve().parents[2]
page = source / "docs/explanation/architecture.md"
begin, end = "<!-- rooms: kept up to date by tests/repository/rooms.py --write -->\n", "<!-- /rooms -->\n"


def rooms():
    """Returns [(folder, further folders of the room, rooms whose headers it may include)] in the order of the
    file."""
    text = re.sub(r"#.*", "", (source / "cmake/rooms.cmake").read_text())
    found = []
    for call in re.findall(r"softgrip_room\(([^)]*)\)", text):
        words, key, lists = call.split(), "FOLDER", {"FOLDER": [], "FOLDERS": [], "USES": [], "LIBRARIES": [], "PRECOMPILE": []}
        for word in words:
            if word in lists:
                key = word
            else:
                lists[key].append(word)
        found.append((lists["FOLDER"][0], lists["FOLDERS"], lists["USES"]))
    return found


def included_by(folders):
    """Returns the folders of the project from which the files in `folders` include headers."""
    folders_included = set()
    for folder in folders:
        for file in [*(source / folder).glob("*.h"), *(source / folder).glob("*.cpp")]:
            for header in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M):
                folders_included.add(str(pathlib.PurePosixPath(header).parent))
    return folders_included


def layers(text):
    """Returns {top-level folder: height of its layer} for the text of the page."""
    lines = re.search(r"^```layers\n(.*?)^```$", text, re.M | re.S)[1].splitlines()
    return {folder: height for height, line in enumerate(reversed(lines))
            for folder in re.split(r"  +", line)[0].split(", ")}


def upward(heights):
    """Returns a message for each use of a room that is not in a lower layer, and for each folder without a layer."""
    for folder, _, uses in rooms():
        top = folder.split("/")[0]
        if top not in heights:
            yield f"docs/explanation/architecture.md: no layer contains {top}"
            continue
        for other in {one.split("/")[0] for one in uses} - {top}:
            if heights.get(other, 0) >= heights[top]:
                yield f"docs/explanation/architecture.md: the layer of {top} is not above the layer of {other}"


def table(known):
    """Returns the table of rooms for docs/explanation/architecture.md. `known` maps the folder of each room to the
    text that describes its content."""
    lines = ["| room | content | may include |\n", "|---|---|---|\n"]
    for folder, _, uses in rooms():
        lines.append(f"| `{folder}` | {known.get(folder, '')} | {', '.join(uses)} |\n")
    return "".join(lines)


def main():
    wrong, home = [], {}
    for folder, others, _ in rooms():
        for one in [folder, *others]:
            home[one] = folder
    heights = layers(page.read_text())
    wrong += upward(heights)
    for top in heights:
        for path in sorted({file.parent for file in (source / top).rglob("*.h")}):
            name = str(path.relative_to(source))
            if name not in home and name not in ("bench", "tools/programs"):
                wrong.append(f"cmake/rooms.cmake has no room {name}")
    for folder, others, uses in rooms():
        needed = {home.get(one, one) for one in included_by([folder, *others])}
        for idle in [one for one in uses if one not in needed]:
            wrong.append(f"cmake/rooms.cmake: {folder} may use {idle}, but includes no header of it")
    text = page.read_text()
    before, rest = text.split(begin)
    now, after = rest.split(end)
    known = dict(re.findall(r"^\| `([^`]+)` \| (.*?) \| [^|]*\|$", now, re.M))
    wanted = table(known)
    if "--write" in sys.argv:
        page.write_text(before + begin + wanted + end + after)
    elif now != wanted:
        wrong.append("docs/explanation/architecture.md: the table of rooms differs from cmake/rooms.cmake "
                     "(tests/repository/rooms.py --write updates it)")
    wrong += [f"docs/explanation/architecture.md does not describe the content of {room}" for room, _, _ in rooms()
              if not known.get(room)]
    print("\n".join(wrong) or f"{len(rooms())} rooms agree with docs/explanation/architecture.md")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
