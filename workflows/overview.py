"""Writes the results of all rows of a table to one page and to a JSON file: overview.py TABLE FOLDER."""
import collections
import html
import json
import pathlib
import sys

import table

STATUSES = ("done", "not_acceptable", "failed")
WORDS = {"done": "done", "not_acceptable": "finished, not acceptable", "failed": "failed"}
HEAD = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Overview of {name}</title>
<style>
body {{ font: 15px/1.45 system-ui, sans-serif; margin: 2rem; color: #222; background: #fff }}
table {{ border-collapse: collapse; width: 100% }}
th, td {{ text-align: left; vertical-align: top; padding: .3rem .7rem; border-bottom: 1px solid #ddd }}
th button {{ font: inherit; font-weight: 600; border: 0; background: none; padding: 0; cursor: pointer }}
th[aria-sort=ascending] button::after {{ content: " \\25B2" }} th[aria-sort=descending] button::after {{ content: " \\25BC" }}
td.number {{ text-align: right; font-variant-numeric: tabular-nums }}
pre {{ margin: 0; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 13px }}
tr.failed td {{ background: #fdecea }} tr.not_acceptable td {{ background: #fff6e0 }}
@media (prefers-color-scheme: dark) {{
 body {{ color: #ddd; background: #191919 }} th, td {{ border-color: #444 }} a {{ color: #8ab4f8 }} th button {{ color: inherit }}
 tr.failed td {{ background: #4a2320 }} tr.not_acceptable td {{ background: #463a17 }} }}
</style>
<h1>{name}</h1>
<p>{counts}; {seconds} s of commands in all. A click on a heading sorts.</p>
<table><thead><tr>{headings}</tr></thead><tbody>
"""
TAIL = """</tbody></table>
<script>
document.querySelectorAll("th button").forEach((button, column) => button.onclick = () => {
  const heading = button.parentNode, body = document.querySelector("tbody");
  const down = heading.getAttribute("aria-sort") === "ascending";
  document.querySelectorAll("th").forEach(other => other.removeAttribute("aria-sort"));
  heading.setAttribute("aria-sort", down ? "descending" : "ascending");
  const key = row => row.cells[column].dataset.key ?? row.cells[column].textContent;
  const order = new Intl.Collator(undefined, {numeric: true}).compare;
  [...body.rows].sort((a, b) => (down ? -1 : 1) * order(key(a), key(b))).forEach(row => body.append(row));
});
</script>
</html>
"""


def line_of(told, folder):
    name = html.escape(told["name"])
    links = [html.escape(str(folder / report)) for report in told.get("reports", [])]
    name = f'<a href="{links[0]}">{name}</a>' if links else name
    name += "".join(f' <a href="{link}">{i}</a>' for i, link in enumerate(links[1:], 2))
    error = f"<pre>{html.escape(told['error'])}</pre>" if told.get("error") else ""
    status = told["status"]
    return (f'<tr class="{status}"><td>{name}</td><td>{html.escape(told["task"])}</td>'
            f'<td data-key="{STATUSES.index(status)}">{WORDS[status]}</td><td>{html.escape(told.get("found") or "")}{error}</td>'
            f'<td class="number">{told["seconds"]:.2f}</td></tr>')


def main():
    rows = table.read(sys.argv[1])
    folder = pathlib.Path(sys.argv[2])
    told = [(json.loads((folder / row.result()).read_text()), pathlib.Path(row.result()).parent) for row in rows]
    counts = collections.Counter(one["status"] for one, _ in told)
    seconds = sum(one["seconds"] for one, _ in told)
    text = HEAD.format(
        name=html.escape(pathlib.Path(sys.argv[1]).name), seconds=f"{seconds:.0f}",
        counts=", ".join([f"{len(rows)} rows", *(f"{counts[s]} {WORDS[s]}" for s in STATUSES if counts[s])]),
        headings="".join(f"<th><button>{heading}</button></th>" for heading in ("name", "task", "status", "found", "seconds")))
    text += "\n".join(line_of(one, place) for one, place in told) + TAIL
    (folder / "overview.json").write_text(json.dumps({"schema": 1, "counts": {s: counts[s] for s in STATUSES},
                                                     "rows": [one for one, _ in told]}, indent=1) + "\n")
    (folder / "overview.html").write_text(text)


if __name__ == "__main__":
    main()
