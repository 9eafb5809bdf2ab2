"""Writes workbooks (.xlsx) for tests by the specification (ECMA-376, part 1), without the library with which softgrip
reads them."""

import io
import zipfile
from xml.sax.saxutils import escape, quoteattr

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
# The formats of cells by index: 0 plain, 1 date and time, 2 time of day, 3 a number followed by the text "
# mm".
STYLES = (f'<styleSheet xmlns="{MAIN}"><numFmts count="3"><numFmt numFmtId="164" formatCode="yyyy\\-mm\\-dd hh:mm:ss.000"/>'
          '<numFmt numFmtId="165" formatCode="[h]:mm:ss.000"/><numFmt numFmtId="166" formatCode="0.00&quot; mm&quot;"/></numFmts>'
          '<cellXfs count="4"><xf numFmtId="0"/><xf numFmtId="164"/><xf numFmtId="165"/><xf numFmtId="166"/></cellXfs></styleSheet>')


class Cell:
    """The content of a cell: the attributes of its XML element and the elements in it."""

    def __init__(self, inside, attributes=""):
        self.inside, self.attributes = inside, attributes


def date(serial, style=1):
    return Cell(f"<v>{serial!r}</v>", f' s="{style}"')


def error(word):
    return Cell(f"<v>{word}</v>", ' t="e"')


def formula(text, value=None):
    return Cell(f"<f>{escape(text)}</f>" + ("" if value is None else f"<v>{value!r}</v>"))


def inline(text):
    return Cell(f"<is><r><t>{escape(text[:2])}</t></r><r><t>{escape(text[2:])}</t></r></is>", ' t="inlineStr"')


def letters(column):
    text = ""
    while column >= 0:
        text, column = chr(65 + column % 26) + text, column // 26 - 1
    return text


def sheet(rows, strings, first_row=1, first_column=0, below="", row_attributes=""):
    """Returns the XML of a sheet with these rows of cells. Omits cells and rows that are None. Adds new texts to
    `strings`."""
    lines = []
    for number, row in enumerate(rows, first_row):
        if row is None:
            continue
        cells = []
        for column, value in enumerate(row, first_column):
            if value is None:
                continue
            if isinstance(value, bool):
                value = Cell(f"<v>{int(value)}</v>", ' t="b"')
            elif isinstance(value, str):
                if value not in strings:
                    strings.append(value)
                value = Cell(f"<v>{strings.index(value)}</v>", ' t="s"')
            elif not isinstance(value, Cell):
                value = Cell(f"<v>{value!r}</v>")
            cells.append(f'<c r="{letters(column)}{number}"{value.attributes}>{value.inside}</c>')
        lines.append(f'<row r="{number}"{row_attributes}>{"".join(cells)}</row>')
    return f'<worksheet xmlns="{MAIN}"><sheetData>{"".join(lines)}</sheetData>{below}</worksheet>'


def package(sheets, strings=(), from_1904=False, changed=None):
    """Returns the bytes of a workbook. `sheets` maps names to XML. `changed` maps files of the workbook to their new
    content; a file that is mapped to None is omitted."""
    relations, listed, parts = [], [], {}
    for number, (name, xml) in enumerate(sheets.items(), 1):
        relations.append((f"rId{number}", "worksheet", f"worksheets/sheet{number}.xml"))
        listed.append(f'<sheet name={quoteattr(name)} sheetId="{number}" r:id="rId{number}"/>')
        parts[f"xl/worksheets/sheet{number}.xml"] = xml
    relations += [("rIdT", "sharedStrings", "sharedStrings.xml"), ("rIdS", "styles", "styles.xml")]
    parts |= {
        "_rels/.rels": f'<Relationships xmlns="{PACKAGE}"><Relationship Id="rId1" Type="{OFFICE}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><workbookPr date1904="{int(from_1904)}"/><sheets>{"".join(listed)}</sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}">' + "".join(
            f'<Relationship Id="{id}" Type="{OFFICE}/{kind}" Target="{target}"/>' for id, kind, target in relations) + "</Relationships>",
        "xl/sharedStrings.xml": f'<sst xmlns="{MAIN}">' + "".join(f"<si><t>{escape(text)}</t></si>" for text in strings) + "</sst>",
        "xl/styles.xml": STYLES,
    }
    parts |= changed or {}
    bytes_of = io.BytesIO()
    with zipfile.ZipFile(bytes_of, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            if content is not None:
                archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return bytes_of.getvalue()


def book(rows, **options):
    """Returns a workbook that has one sheet."""
    strings = []
    xml = sheet(rows, strings, **options)
    return package({"Run": xml}, strings)
