#!/usr/bin/env python3
"""Checks the English of the project: the section "Language" of CONTRIBUTING.md as patterns.

  words_check.py                         print file:line: [rule] finding, and a summary
  words_check.py --counts                print one row per room and one column per rule
  words_check.py --budgets               exit 1 if a room has more or fewer findings than words_budgets.json states
  words_check.py --write-budgets         write today's counts to words_budgets.json; refused if their sum would rise
  words_check.py --commits RANGE         check the messages of a range of commits instead
  words_check.py --sample SEED           print 60 comments, 60 strings and 60 sentences of pages, drawn with this seed
  words_check.py --self-test             check the rules against their own examples

Options: --room NAME, --rule NAME (both may be repeated), --soft (include the soft rules), --sentences (print the
number of sentences per channel).

The script reads every .cpp, .h and .md file of the project. It splits a file into four channels: comments, string
literals, code and prose. A rule applies to the channels that it names. Block comments and adjacent string literals are
joined before the search, so that a phrase that crosses a line break is found. A line that contains "words-ok" is
exempt, and so is a public name: a name in PUBLIC_NAMES, or a deprecated name that a block or a combination of
parameters declares. Exit status: 0 done, 1 a finding against the budgets or in a commit message, 2 usage.
"""

import argparse
import bisect
import collections
import json
import math
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "tests/repository"))
import tree

BUDGETS = tree.ROOT / "scripts/words_budgets.json"
COMMENT, STRING, CODE, PROSE = "comment", "string", "code", "prose"
TEXT = (COMMENT, STRING, PROSE)
WRITTEN = (COMMENT, PROSE)
EVERYWHERE = (COMMENT, STRING, CODE, PROSE)

# Finite verbs that mark a sentence as complete. The list is incomplete: it only serves to decide if a sentence that
# begins with "Of" is a fragment.
VERB = re.compile(r"\b(is|are|was|were|has|have|had|does|do|did|can|could|may|might|must|will|would|should|shall)\b")
LONGEST_SENTENCE = 35  # longest sentence [words]
SAMPLE = 60

# Keys and columns that programs read. Most of them are deprecated and have a successor (CHANGELOG.md). Until
# the next version of their schema, the programs still write them.
PUBLIC_NAMES = {
    "deficit_mm", "doubts", "mended", "misfit", "slipped_cycles", "slips", "slips_took_long", "slips_woken_late",
    "staircase", "stands", "structure_left"}


def declared_names():
    """Returns the deprecated names that blocks, parameters and combinations of parameters declare."""
    sources = [tree.ROOT / name for name in tree.names()
               if name.startswith(("model/blocks/", "sysid/identification/")) and name.endswith((".cpp", ".h"))]
    return {name for source in sources
            for name in re.findall(r'Formerly\{"(\w+)"\}', source.read_text(errors="replace"))}


class Rule:
    """One forbidden pattern.

    pattern   regular expression, or a function from a sentence to a match object or None
    channels  where it applies
    advice    what to write instead
    hit, miss an example that must match and one that must not
    unit      "text": search the whole text of a channel; "sentence": call the pattern for every sentence
    paths     regular expression for the paths to which the rule is limited
    soft      True: a habit to reduce, not an error; counted only with --soft
    """

    def __init__(self, name, pattern, channels, advice, hit, miss, unit="text", paths="", soft=False, flags=re.I):
        self.name, self.channels, self.advice = name, channels, advice
        self.pattern = pattern if callable(pattern) else re.compile(pattern, flags)
        self.hit, self.miss, self.unit, self.soft = hit, miss, unit, soft
        self.paths = re.compile(paths) if paths else None

    def find(self, text):
        """Yields the matches of the rule in one text, each as (offset, excerpt)."""
        if self.unit == "text":
            return [(m.start(), m.group(0)) for m in self.pattern.finditer(text)]
        found = []
        for offset, sentence in sentences(text):
            hit = self.pattern(sentence) if callable(self.pattern) else self.pattern.match(sentence)
            if hit:
                found.append((offset, sentence[:60]))
        return found


def of_fragment(sentence):
    return re.match(r"Of (?!course\b)", sentence) if not VERB.search(sentence) else None


def long_sentence(sentence):
    return re.match(r".", sentence) if len(sentence.split()) > LONGEST_SENTENCE else None


def word(words, *channels, advice, hit, miss, name=None, paths="", soft=False):
    return Rule(name or words.split("|")[0].strip("(?!)\\b"), rf"\b(?:{words})\b", channels, advice, hit, miss,
                paths=paths, soft=soft)


RULES = [
    # Rules about sentence patterns.
    Rule("what-clause", r"What\b[^?]*$", WRITTEN, "name the subject: 'The reading ...', not 'What was read ...'",
         "What is slow counts less.", "What is the noise?", unit="sentence", flags=0),
    Rule("whether-fragment", r"Whether\b[^?]*$", WRITTEN, "'Returns true if ...'", "Whether the valve sticks.",
         "Returns true if the valve sticks.", unit="sentence", flags=0),
    Rule("of-fragment", of_fragment, WRITTEN, "name the quantity: 'Mean of ...', 'Duration of ...'",
         "Of the finger over all pressures.", "Of 450 worlds 217 were found, which is enough.", unit="sentence"),
    Rule("same-fragment", r"The same\b[^?]*$", (COMMENT,), "repeat what the function does",
         "The same for a process.", "Returns the same value.", unit="sentence", flags=0),
    Rule("nothing-fragment", r"(Nothing|Empty|Null|None) (where|if|when|for|without)\b", (COMMENT,),
         "'Returns nullopt if ...'", "Nothing where there is no such block.", "Returns nullopt if none exists.",
         unit="sentence", flags=0),
    Rule("who-clause", r"(Who|Whoever|Whose) (?!is\b)[^?]*$", TEXT, "name the actor", "Who reads the lines stores them.",
         "Who owns the lock?", unit="sentence", flags=0),
    Rule("long-sentence", long_sentence, WRITTEN, "split it; one idea per sentence", "a " * 40, "a short one",
         unit="sentence", soft=True),

    # Rules about actors and verbs.
    word("nobody|somebody|whoever|whosoever|whomever", COMMENT, STRING, PROSE, name="no-actor",
         advice="name the actor: the operator, a client, another Modbus client", hit="nobody knows", miss="no client"),
    word("whatever|whichever", COMMENT, STRING, PROSE, name="whatever", advice="'all', 'any', 'regardless of'",
         hit="whatever is left", miss="what is it?"),
    word(r"tells?|telling|told|untold", COMMENT, STRING, PROSE, name="tell",
         advice="distinguish, report, indicate, state", hit="no command tells them apart", miss="teller"),
    Rule("stand", r"\b(?:stands?|stood|standing)\b(?! (?:for|in for|still|alone|out)\b)(?!-)", TEXT,
         "is, is located, remains, applies", "the base stands", "it stands for a lag"),
    word(r"foretells?|foretold|foretelling", COMMENT, STRING, PROSE, name="foretell", advice="predict",
         hit="foretold from the first", miss="predicted"),
    Rule("is-another", r"\b(?:is|are|was|were|be|been) (?:another|other)\b(?= ?(?:[.,;:)\"]|than\b|$| thing\b))", TEXT,
         "has changed, differs from", "the gain is another.", "it is another block of the chain"),
    word(r"upon", COMMENT, STRING, PROSE, CODE, name="upon", advice="on, using", hit="upon another base",
         miss="based on"),
    Rule("so-many", r"\bso (?:many|much|few|long)\b(?! (?:as|that)\b)", TEXT, "give the number or name the parameter",
         "one in so many points", "so long as it runs"),
    word(r"became of|become of|becomes of", COMMENT, STRING, PROSE, CODE, name="became-of",
         advice="what has changed", hit="what became of it", miss="became larger"),
    word(r"anew|lest|whence|wherein|thereof|hither|thither|betwixt|ere|nought", COMMENT, STRING, PROSE, name="archaic",
         advice="again, so that ... not, from which, in which", hit="begins anew", miss="a new one"),
    word(r"to and fro|as it likes|by heart|astray|all the same|made up for|makes? up for|make good", COMMENT, STRING,
         PROSE, name="idiom", advice="back and forth, compensates, nevertheless", hit="makes up for it",
         miss="made up of two"),
    word(r"asked for|asks? for", COMMENT, STRING, PROSE, name="asked-for", advice="requested, commanded, required",
         hit="pressure asked for", miss="asked how"),
    word(r"nothing but|none but|next to (?:nothing|none)|save for|no less than|not without", COMMENT, STRING, PROSE,
         name="litotes", advice="only, almost no, at least", hit="nothing but noise", miss="nothing changed"),

    # Rules about private words of the project.
    word(r"wrong way(?: first)?", COMMENT, STRING, PROSE, name="wrong-way",
         advice="inverse response (initial response opposite to the command)", hit="moves the wrong way first",
         miss="a wrong value"),
    word(r"structure (?:is )?(?:left|stays)|structure_left|leftover", COMMENT, STRING, PROSE, CODE,
         name="structure-left", advice="unexplained error", hit="1.3 % structure left", miss="the structure"),
    word(r"misfit\w*", COMMENT, STRING, PROSE, CODE, name="misfit", advice="model error; error budget",
         hit="budget of the misfit", miss="misfire", paths=r"^(sysid|tools|docs)/|^README"),
    word(r"twins?|are_twins|twin_of|parts_twins", COMMENT, STRING, CODE, name="twin",
         advice="indistinguishable causes", hit="these are twins", miss="bench_twin", paths=r"^sysid/"),
    word(r"strangers?(?:_among)?", COMMENT, STRING, PROSE, CODE, name="stranger", advice="inconsistent logs",
         hit="strangers to each other", miss="strange"),
    word(r"rivals?|rivalry|\w+_rivals?|rival_\w+", COMMENT, STRING, PROSE, CODE, name="rival",
         advice="alternative (competing hypothesis)", hit="a rival of it", miss="arrival"),
    word(r"staircase(?:s|_\w+)?", COMMENT, STRING, CODE, name="staircase", advice="stick-slip valve motion",
         hit="find a staircase", miss="stair", paths=r"^sysid/diagnosis/(search|verdict|report|causes)/"),
    word(r"levell?ing\w*", COMMENT, STRING, PROSE, CODE, name="levelling", advice="saturation of the hysteretic state",
         hit="levelling_growing_per_kpa", miss="level"),
    word(r"hast(?:e|y|en|ens|ened)\w*", COMMENT, STRING, PROSE, CODE, name="haste", advice="input rate; fast input",
         hit="haste_of(record)", miss="chaste"),
    Rule("echo", r"\b(?:echo(?:es|_\w+)?|Echo\w+|weighted_echo)\b", EVERYWHERE, "filter bank, regressors",
         "echo_columns(record)", "echoed", paths=r"^sysid/", flags=0),
    Rule("slack", r"\b(?:slack(?:_\w*)?|Slack\w*)\b", EVERYWHERE, "nuisance offset and gain; backlash",
         "struct Slack", "slackness", paths=r"^sysid/", flags=0),
    word(r"mates?|mates_\w+|has_mates", COMMENT, STRING, PROSE, CODE, name="mate", advice="peer finger",
         hit="beside its mates", miss="estimate", paths=r"^(sysid/health|docs)/"),
    word(r"doubts?|doubts?_\w+", COMMENT, STRING, CODE, name="doubt", advice="plausibility warning",
         hit="doubts_among(logs)", miss="doubtful", paths=r"^(sysid|tools)/"),
    Rule("sight", r"\b(?:sighted_?|without sight|with sight|loses? sight)\b", EVERYWHERE,
         "with or without displacement feedback", "a sighted finger", "insight"),
    Rule("slip", r"(?<![Ss]tick-)(?<![Mm]axwell-)(?<![Mm]axwell )\b(?:slips?|slipped|slips_\w+|slipped_\w+)\b"
         r"(?! jump)", EVERYWHERE, "missed cycle, overrun", "2 slips in an hour", "stick-slip valve",
         paths=r"^(base|control|daemon|drivers|python|rig|tools|docs|tests/(control|daemon|tools))/"),
    word(r"deficit\w*", COMMENT, STRING, PROSE, CODE, name="deficit", advice="displacement shortfall",
         hit="deficit_mm", miss="defect"),
    word(r"wanders?|wandered|wandering|wander_\w+", COMMENT, STRING, PROSE, CODE, name="wander", advice="drift",
         hit="the zero wanders", miss="wonder"),
    word(r"passed over|pass(?:es)? over|pass_over", COMMENT, STRING, PROSE, CODE, name="passed-over",
         advice="skipped, ignored", hit="is passed over", miss="passed on"),
    word(r"mends?|mended|mending", COMMENT, STRING, PROSE, name="mend", advice="repair, service, correct",
         hit="what was mended", miss="amend"),
    word(r"courses?", COMMENT, CODE, name="course", advice="path, trajectory, hypothesis (particle)",
         hit="many courses side by side", miss="of coarse", paths=r"^sysid/"),
    Rule("metaphor", r"\b(?:nibbles?|nibbled|errands?|Errand\w*|traveller_?|playground|culprit|blame[sd]?|glance[sd]?"
         r"|outdo(?:es)?|outdone|swallow(?:s|ed)?|Teller|Namer|landings?|witness|shelf|Shelf|SequenceShelf|hair)\b",
         EVERYWHERE, "the literal engineering term", "courses nibble", "cheer", flags=0),
    Rule("room-words", r"\b(?:Wires|wires_|Facts|Orders|left_safely|leave_|Latest<|draft\(\)|Grid|grid_)", (CODE,),
         "shared state, inputs, outputs, shutdown, triple buffer, periodic schedule", "Wires wires", "fires",
         paths=r"^(base|control|daemon)/", flags=0),
    word(r"foreign", COMMENT, STRING, PROSE, name="foreign", advice="external (file, log)", hit="a foreign log",
         miss="foresight"),

    # Soft rules about habits.
    word(r"beside", COMMENT, STRING, PROSE, name="beside", advice="next to, in addition to, compared with",
         hit="beside it", miss="besides", soft=True),
    word(r"says?|said|saying", COMMENT, STRING, PROSE, name="say", advice="specifies, states, reports, shows",
         hit="the rig file says", miss="essay", soft=True),
    Rule("takes", r"\btakes? (?:more|less|most|part|nothing|what|of|a (?:twentieth|tenth|fifth|hundredth|share))\b", TEXT,
         "explains, reduces the error by", "takes a twentieth of the misfit", "takes one argument", soft=True),
    word(r"look(?:s|ed)? (?:for|at|whether|what|which)", COMMENT, STRING, PROSE, name="look",
         advice="search, read, check, inspect", hit="look whether it moves", miss="lookup", soft=True),
    word(r"goes on|go on|went on|is there|are there|is gone", COMMENT, STRING, PROSE, name="goes-on",
         advice="continues, exists, has been removed", hit="the rest goes on", miss="going", soft=True),
]


# ------------------------------------------------------------------------------------------- Reading the
# files

class Text:
    """A piece of text of one channel. The class stores the source line of each character."""

    def __init__(self, channel, text, lines):
        # `lines` is a sorted list of (offset, line number).
        self.channel, self.text, self.starts = channel, text, lines

    def line(self, offset):
        return self.starts[bisect.bisect_right(self.starts, (offset, float("inf"))) - 1][1]


class Joiner:
    """Joins pieces of text to one Text. Each character keeps its line number."""

    def __init__(self, channel):
        self.channel, self.parts, self.starts, self.size = channel, [], [], 0

    def add(self, fragment, line, separator=" "):
        if self.parts and separator:
            self.parts.append(separator)
            self.size += len(separator)
        self.starts.append((self.size, line))
        self.parts.append(fragment)
        self.size += len(fragment)

    def take(self):
        text = Text(self.channel, "".join(self.parts), self.starts) if self.parts else None
        self.parts, self.starts, self.size = [], [], 0
        return [text] if text and text.text.strip() else []


TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', re.S)
MARKUP = re.compile(r"^\s*(?:/\*+|//[/!]?<?|\*+/?)\s?|\*/$")
DIRECTIVE = re.compile(r"^[ \t]*#[^\n]*", re.M)


def cpp_texts(source):
    """Yields the texts of a C++ file: comment blocks, joined string literals, and code."""
    source = DIRECTIVE.sub(lambda m: " " * len(m.group(0)), source)
    comments, strings, texts, code, last = Joiner(COMMENT), Joiner(STRING), [], [], 0
    previous_line, previous_column = -2, None  # of the last comment; a comment alone in its line has column None
    for token in TOKEN.finditer(source):
        body, line = token.group(0), source.count("\n", 0, token.start()) + 1
        between = source[last:token.start()]
        code.append((between, source.count("\n", 0, last) + 1))
        last = token.end()
        if body.startswith(("//", "/*")):
            texts += strings.take()
            line_start = source.rfind("\n", 0, token.start()) + 1
            alone = not source[line_start:token.start()].strip()
            # A comment after code continues in the next line at the same column.
            column = token.start() - line_start
            continues = line == previous_line + 1 and previous_column in (None, column)
            if not (alone and continues):
                texts += comments.take()
            for k, row in enumerate(body.splitlines()):
                row = re.sub(r"@(param|return|tparam)\b\s*", ". ", MARKUP.sub("", row)).strip()
                if row:
                    comments.add(row, line + k)
            previous_line = line + body.count("\n")
            if not (alone and continues):
                previous_column = None if alone else column
        elif body.startswith("'"):
            continue
        else:
            if between.strip():
                texts += strings.take()
            text = body[body.index("(") + 1:body.rindex(")")] if body.startswith("R") else body[1:-1]
            strings.add(text.replace("\\n", " ").replace('\\"', '"'), line, separator="")
    code.append((source[last:], source.count("\n", 0, last) + 1))
    texts += comments.take() + strings.take()
    for piece, line in code:
        for k, row in enumerate(piece.splitlines()):
            if row.strip():
                texts.append(Text(CODE, row, [(0, line + k)]))
    return texts


def markdown_texts(source):
    """Yields the texts of a Markdown file: paragraphs, list items, table cells and headings. Omits code in
    fences and inline code."""
    texts, prose, fenced = [], Joiner(PROSE), False
    for number, row in enumerate(source.splitlines(), 1):
        if row.lstrip().startswith("```"):
            fenced = not fenced
            texts += prose.take()
            continue
        if fenced or row.startswith("    ") and not prose.parts:
            continue
        row = re.sub(r"`[^`]*`", "CODE", re.sub(r"\]\([^)]*\)", "]", row))
        if not row.strip():
            texts += prose.take()
        elif row.lstrip().startswith("|"):
            texts += prose.take()
            for cell in row.strip().strip("|").split("|"):
                if re.search(r"[A-Za-z]{3}", cell):
                    texts.append(Text(PROSE, cell.strip(), [(0, number)]))
        else:
            if re.match(r"\s*([-*#]|\d+\.)\s*", row):
                texts += prose.take()
                row = re.sub(r"^\s*([-*]|#+|\d+\.)\s*", "", row)
            prose.add(row.strip(), number)
    return texts + prose.take()


def sentences(text):
    """Yields (offset, sentence) for each sentence of a text. A sentence ends at . ! ? : ; before a capital letter, or
    at the end of the text."""
    start = 0
    for end in list(re.finditer(r"[.!?:;][\"')]*\s+(?=[\"'(]?[A-Z])", text)) + [None]:
        stop = end.start() + 1 if end else len(text)
        piece = text[start:stop].strip()
        if piece:
            yield start + len(text[start:stop]) - len(text[start:stop].lstrip()), piece.lstrip("\"'(")
        start = end.end() if end else stop


def room_of(name):
    parts = name.split("/")
    if len(parts) == 1:
        return "(top)"
    return "/".join(parts[:2]) if parts[0] in ("sysid", "tools", "docs", "tests") and len(parts) > 2 else parts[0]


def word_at(text, offset):
    """Returns the code name that contains the character at an offset. Returns "" if the word at the offset is a normal
    word of a sentence."""
    start = re.search(r"\w*$", text[:offset]).start()
    name = re.match(r"\w*", text[start:]).group(0)
    rest = text[start + len(name):]
    return name if "_" in name or name == text.strip() or rest.startswith(('"', ":", "[", "`")) else ""


# ---------------------------------------------------------------------------------------- Reporting the findings

def check(rules, rooms):
    """Returns the findings (path, line, rule, excerpt) and the number of sentences per room and channel."""
    findings, totals = [], collections.Counter()
    exempt = PUBLIC_NAMES | declared_names()
    for name in tree.names():
        if not name.endswith((".cpp", ".h", ".md")) or rooms and room_of(name) not in rooms:
            continue
        source = (tree.ROOT / name).read_text(errors="replace")
        rows = source.splitlines()
        for text in markdown_texts(source) if name.endswith(".md") else cpp_texts(source):
            if text.channel != CODE and (text.channel != STRING or " " in text.text.strip()):
                totals[room_of(name), text.channel] += sum(1 for _ in sentences(text.text))
            for rule in rules:
                if text.channel not in rule.channels or rule.paths and not rule.paths.search(name):
                    continue
                for offset, excerpt in rule.find(text.text):
                    line = text.line(offset)
                    public = text.channel != CODE and word_at(text.text, offset) in exempt
                    if not public and "words-ok" not in rows[line - 1]:
                        findings.append((name, line, text.channel, rule, excerpt))
    return findings, totals


def print_sample(seed):
    """Selects comments, strings and sentences of pages at random, for a reader who has not written them."""
    drawn = {channel: [] for channel in TEXT}
    for name in tree.names():
        if not name.endswith((".cpp", ".h", ".md")):
            continue
        source = (tree.ROOT / name).read_text(errors="replace")
        for text in markdown_texts(source) if name.endswith(".md") else cpp_texts(source):
            if text.channel == CODE:
                continue
            pieces = sentences(text.text) if text.channel == PROSE else [(0, text.text.strip())]
            drawn[text.channel] += [(name, text.line(offset), piece) for offset, piece in pieces
                                    if len(piece.split()) >= 4 and re.search(r"[a-z]{3} [a-z]", piece)]
    print(f"seed {seed}")
    for channel in TEXT:
        chance = random.Random(f"{seed} {channel}")
        print(f"\n{channel}: {SAMPLE} of {len(drawn[channel])}")
        for number, (name, line, piece) in enumerate(chance.sample(drawn[channel], SAMPLE), 1):
            print(f"{number}. {name}:{line}: {piece}")


def counts_table(findings, totals, rules):
    by_room = collections.defaultdict(collections.Counter)
    for name, _, _, rule, _ in findings:
        by_room[room_of(name)][rule.name] += 1
    rooms = sorted({room for room, _ in totals}, key=lambda room: -sum(by_room[room].values()))
    sums = collections.Counter()
    print("| room | sentences | findings | most frequent rules |\n|---|---|---|---|")
    for room in rooms:
        sums.update(by_room[room])
        most = ", ".join(f"{rule} {n}" for rule, n in by_room[room].most_common(5))
        print(f"| {room} | {sum(n for (r, _), n in totals.items() if r == room)} | {sum(by_room[room].values())} | {most} |")
    print(f"| all | {sum(totals.values())} | {sum(sums.values())} | {', '.join(f'{r} {n}' for r, n in sums.most_common())} |")


def check_commits(range_):
    log = subprocess.run(["git", "-C", str(tree.ROOT), "log", "--format=%h%x00%s%x00%b%x01", range_], check=True,
                         capture_output=True, text=True).stdout
    bad = 0
    for entry in filter(str.strip, log.split("\x01")):
        revision, subject, body = entry.strip().split("\x00")
        faults = []
        if len(subject) > 72:
            faults.append(f"subject has {len(subject)} characters, limit 72")
        if re.match(r"(What|Where|Who|Whether|A|An|The|One|Some|No|Of|From|Upon|It|They)\b", subject):
            faults.append("subject does not begin with an imperative verb")
        if subject.endswith("."):
            faults.append("subject ends with a full stop")
        if not body.strip():
            faults.append("no body that says why")
        bad += bool(faults)
        if faults:
            print(f"{revision}: {'; '.join(faults)}: {subject[:90]}")
    print(f"{bad} commit messages with findings")
    return bad


def against_budgets(counts, budgets):
    """Returns sentences about rooms that have more findings than their budget, and about rooms that have fewer."""
    counts = collections.Counter(counts)
    wrong = [f"{room}: {count} findings, budget {budgets.get(room, 0)}. Rewrite the new texts; list the findings with: "
             f"scripts/words_check.py --room '{room}'" for room, count in sorted(counts.items()) if count > budgets.get(room, 0)]
    wrong += [f"{room}: {counts[room]} findings, budget {budget}. Lower the budget in the same commit with: "
              "scripts/words_check.py --write-budgets" for room, budget in sorted(budgets.items()) if counts[room] < budget]
    return wrong


def write_budgets(counts, file):
    """Refuses counts whose sum exceeds the sum of the stored budgets. The count of a single room may increase,
    because a file can move to this room from another one."""
    total, budget = sum(counts.values()), sum(json.loads(file.read_text()).values()) if file.exists() else math.inf
    if total > budget:
        return [f"{file}: not written. {total} findings, but the sum of the budgets is {budget} and must not rise."]
    file.write_text(json.dumps(dict(sorted(counts.items())), indent=1) + "\n")
    return []


def self_test():
    wrong = [rule.name for rule in RULES if not rule.find(rule.hit) or rule.find(rule.miss)]
    joined = cpp_texts('f("the wrong "\n  "way first");  // What\n// is slow.\nint x;\n')
    found = [t.text for t in joined if t.channel == STRING]
    if found != ["the wrong way first"]:
        wrong.append(f"joined strings: {found}")
    if [t.line(len(t.text) - 1) for t in joined if t.channel == STRING] != [2]:
        wrong.append("line of a joined string")
    comments = [t.text for t in cpp_texts("int a;  ///< number\n        ///< of grips\n// another\n") if t.channel == COMMENT]
    if comments != ["number of grips", "another"]:
        wrong.append(f"joined comments: {comments}")
    rooms = [sentence.split(":")[0] for sentence in against_budgets({"a": 1, "b": 1, "c": 3}, {"a": 1, "c": 2, "d": 1})]
    if rooms != ["b", "c", "d"]:
        wrong.append(f"rooms that differ from their budgets: {rooms}")
    with tempfile.TemporaryDirectory() as folder:
        written = [not write_budgets(counts, pathlib.Path(folder) / "budgets.json")
                   for counts in ({"a": 2, "b": 1}, {"a": 1, "b": 2}, {"a": 1, "b": 3}, {"a": 1}, {"a": 2})]
    if written != [True, True, False, True, False]:
        wrong.append(f"budgets that rise are refused: {written}")
    print("self-test: " + ("ok" if not wrong else "FAILED: " + ", ".join(wrong)))
    return bool(wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in ("--counts", "--soft", "--self-test", "--sentences", "--budgets", "--write-budgets"):
        parser.add_argument(option, action="store_true")
    parser.add_argument("--commits")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--room", action="append")
    parser.add_argument("--rule", action="append")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    if options.sample is not None:
        return print_sample(options.sample)
    if options.commits:
        return check_commits(options.commits) > 0

    if (options.budgets or options.write_budgets) and (options.soft or options.room or options.rule):
        parser.error("the budgets count all rooms and all rules that are not soft")
    rules = [rule for rule in RULES if (options.soft or not rule.soft) and (not options.rule or rule.name in options.rule)]
    findings, totals = check(rules, options.room)
    if options.counts:
        counts_table(findings, totals, rules)
    elif not options.budgets and not options.write_budgets:
        for name, line, channel, rule, excerpt in sorted(findings, key=lambda f: (f[0], f[1])):
            print(f"{name}:{line}: [{rule.name}] {channel}: '{excerpt}' -> {rule.advice}")
    if options.sentences:
        for channel in TEXT:
            print(f"{channel}: {sum(n for (_, c), n in totals.items() if c == channel)} sentences")
    by_room = collections.Counter(room_of(name) for name, *_ in findings)
    print(f"{len(findings)} findings in {sum(totals.values())} sentences", file=sys.stderr)
    wrong = write_budgets(by_room, BUDGETS) if options.write_budgets else []
    if options.budgets:
        wrong += against_budgets(by_room, json.loads(BUDGETS.read_text()))
    for sentence in wrong:
        print(sentence)
    return bool(wrong)


if __name__ == "__main__":
    # If the reader of the output ends early, as `head` in `words_check.py | head` does, the program ends without an
    # error message.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
