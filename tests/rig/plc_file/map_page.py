"""Writes the tables of docs/reference/plc-map.md from config/plc.yaml: map_page.py --check | --write"""

import pathlib
import re
import sys

import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PAGE = SOURCE / "docs/reference/plc-map.md"


def table(rows):
    lines = ["| address | register | one count | meaning |", "|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['address']} | `{row['name']}` | {row.get('unit', '')} | {row['about']} |")
    return "\n".join(lines)


def finger_table(registers):
    fingers = registers["fingers"]
    rows = [dict(row, address=f"{fingers['first'] + row['address']} + {fingers['each']} n")
            for row in registers["finger"]]
    return (f"Finger n counts from 0; registers exist for {fingers['most']} fingers.\n\n" + table(rows))


def page():
    registers = yaml.safe_load((SOURCE / "config/plc.yaml").read_text())["registers"]
    text = PAGE.read_text()
    for name, made in (("command", table(registers["command"])), ("status", table(registers["status"])),
                       ("finger", finger_table(registers))):
        text, count = re.subn(rf"(<!-- {name}: from config/plc.yaml -->\n).*?(<!-- /{name} -->)",
                              lambda found: f"{found.group(1)}{made}\n{found.group(2)}", text, flags=re.S)
        assert count == 1, name
    return text


if sys.argv[1:] == ["--write"]:
    PAGE.write_text(page())
elif page() != PAGE.read_text():
    sys.exit(f"{PAGE.relative_to(SOURCE)} differs from config/plc.yaml. Update it with: {sys.argv[0]} --write")
