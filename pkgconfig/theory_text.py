"""The theory manual as text, for pkgconfig/theory: its chapters, equations, figures and citations, and the checks of
them against the sources. Conventions of the chapters (lib/theory/*.md, in the order of lib/theory/README.md):

    $$ ... $$ {#eq:prefix.name}          an equation, one paragraph; a prefix belongs to one chapter
    eq:prefix.name                       its citation, in chapters, sources and tests; at least one test has it
    ![Caption](figures/name.svg){#fig:name}     a figure, drawn by lib/theory/figures/name.py; cited as fig:name
    [@key]                               a work of lib/theory/references.bib
    Implemented in: `lib/x.c` (`f`, `g`), `lib/y.h` (`h`).      one paragraph of each chapter
    Checked by: `physics_contact_touch`, ...        names of tests; one or more paragraphs
"""
import pathlib
import re

EQUATION = re.compile(r"^\$\$(?P<tex>(?:(?!\$\$|\n[ \t]*\n).)+)\$\$[ \t]*\{#(?P<name>eq:[^}\s]*)\}[ \t]*$", re.M | re.S)
EQUATION_NAME = re.compile(r"eq:[a-z0-9]+(?:-[a-z0-9]+)*\.[a-z0-9]+(?:-[a-z0-9]+)*")
EQUATION_CITED = re.compile(r"(?<![\w#:.])eq:[a-z0-9-]+\.[a-z0-9-]*[a-z0-9]")
FIGURE = re.compile(r"^!\[(?P<caption>(?:[^\]\\]|\\.|\](?!\())+)\]\((?P<path>[^)\s]+)\)\{#(?P<name>fig:[^}\s]*)\}[ "
                    r"\t]*$", re.M)
FIGURE_CITED = re.compile(r"(?<![\w#:.])fig:[a-z0-9-]*[a-z0-9]")
WORK_CITED = re.compile(r"(?<![\w`\\])@([A-Za-z][\w:-]*\w)")
LINK = re.compile(r"(?<!!)\[[^\]\n]*(?:\n[^\]\n]+)*\]\((?P<target>[^)\s]+)\)")
PLACE = re.compile(r"`(?P<path>[\w./-]+)`\s*(?:\((?P<names>[^)]*)\))?")
SOURCE = re.compile(r"`((?:lib|include|bindings|tests|examples|pkgconfig)/[\w./-]*\w)`")
TEST = re.compile(r"`((?:unit|physics|contract|relations|python|example|fuzz|golden|abi|fmi)_\w+)`")
SOURCES = (("lib", ("c", "h")), ("include", ("h",)), ("tests", ("c", "h", "py", "md")),
           ("bindings", ("c", "h", "hpp", "py")),
           ("examples", ("c", "py", "md")))
DRAWING = "drawing"  # the module that the scripts of figures share


class Chapter:
    """One file of the manual: number (0 for the index), title and text."""

    def __init__(self, path, number):
        self.path, self.number = path, number
        self.text = path.read_text(encoding="utf-8")
        heading = re.search(r"^# (.+)$", self.text, re.M)
        self.title = heading.group(1).strip() if heading else path.stem
        self.equations = [match.group("name") for match in EQUATION.finditer(self.text)]
        self.figures = [(match.group("name"), match.group("path")) for match in FIGURE.finditer(self.text)]

    def line(self, place):
        return f"{self.path.name}:{self.text.count(chr(10), 0, place) + 1}"

    def prose(self):
        """The text without code blocks and formulas, blank of the same length; names in `code` stay."""
        def blank(match):
            return re.sub(r"[^\n]", " ", match.group(0))
        text = re.sub(r"^```.*?^```|^    .*$", blank, self.text, flags=re.M | re.S)
        return re.sub(r"\$\$.*?\$\$|(?<![\\$])\$(?!\s)[^$\n]*(?:\n[^$\n]+)*?\$", blank, text, flags=re.S)


class Manual:
    """All of it, with the tree of sources around."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.folder = self.root / "lib" / "theory"
        self.index = Chapter(self.folder / "README.md", 0)
        self.listed = re.findall(r"^\s*(?:\d+\.|-|\*)\s+\[[^\]]+\]\(([\w-]+\.md)\)", self.index.text, re.M)
        self.chapters = [Chapter(self.folder / name, number) for number, name in enumerate(self.listed, 1)
                         if (self.folder / name).exists()]
        bib = self.folder / "references.bib"
        self.works = re.findall(r"^@\w+\{([^,\s]+),", bib.read_text(encoding="utf-8"), re.M) if bib.exists() else []
        self.numbers = {name: f"{chapter.number}.{k}" for chapter in self.chapters
                        for k, name in enumerate(chapter.equations, 1)}
        self.home = {name: chapter for chapter in self.chapters for name in chapter.equations}
        self.pictures = {name: (chapter, f"{chapter.number}.{k}") for chapter in self.chapters
                         for k, (name, _) in enumerate(chapter.figures, 1)}

    def sources(self):
        """Path below the root and text of each source file that may cite equations."""
        for folder, endings in SOURCES:
            for path in sorted((self.root / folder).rglob("*")):
                inside = path.relative_to(self.root).as_posix()
                if path.suffix[1:] in endings and not inside.startswith("lib/theory/") and path.is_file():
                    yield inside, path.read_text(encoding="utf-8", errors="replace")

    def citations(self):
        """{name of an equation: places in sources and tests, as path:line}."""
        places = {}
        for inside, text in self.sources():
            for match in EQUATION_CITED.finditer(text):
                places.setdefault(match.group(0), []).append(f"{inside}:{text.count(chr(10), 0, match.start()) + 1}")
        return places


# ---- Checks: each yields its faults ----------------------------------------------------------------------------------
def chapter_faults(manual):
    for name in manual.listed:
        if not (manual.folder / name).exists():
            yield f"README.md lists {name}, which does not exist"
        if manual.listed.count(name) > 1:
            yield f"README.md lists {name} twice"
    for path in sorted(manual.folder.glob("*.md")):
        if path.name != "README.md" and path.name not in manual.listed:
            yield f"{path.name} is not listed in README.md"


def equation_faults(manual):
    homes, prefixes = {}, {}
    for chapter in manual.chapters:
        for match in EQUATION.finditer(chapter.text):
            name = match.group("name")
            where = chapter.line(match.start())
            if not EQUATION_NAME.fullmatch(name):
                yield f"{where}: {name} is not of the form eq:prefix.name in lower case"
                continue
            if name in homes:
                yield f"{where}: {name} is defined twice, first at {homes[name]}"
            homes.setdefault(name, where)
            prefix = name.split(".")[0]
            if prefixes.setdefault(prefix, chapter.path.name) != chapter.path.name:
                yield f"{where}: {name}, but equations {prefix}.* belong to {prefixes[prefix]}"
        found = len(re.findall(r"\{#eq:", chapter.text))
        if found != len(chapter.equations):
            yield (f"{chapter.path.name}: {found} equation names, but {len(chapter.equations)} equations of the form "
                   "$$ ... $$ {#eq:prefix.name} in a paragraph of their own")


def citation_faults(manual):
    for chapter in [manual.index, *manual.chapters]:
        for match in EQUATION_CITED.finditer(chapter.prose()):
            if match.group(0) not in manual.numbers and "eq:prefix.name" != match.group(0):
                yield f"{chapter.line(match.start())}: no chapter defines {match.group(0)}"
    for name, places in sorted(manual.citations().items()):
        if name not in manual.numbers:
            yield f"{', '.join(places)}: no chapter defines {name}"


def check_faults(manual):
    places = manual.citations()
    for name, chapter in manual.home.items():
        if not any(place.startswith("tests/") or "/test_" in place for place in places.get(name, ())):
            yield f"{chapter.path.name}: no test cites {name}; name it where a test checks it, or write that test"


def defines(text, path, name):
    """True if a C function or macro, or a Python function or class of this name stands in the text."""
    if path.endswith(".py"):
        return re.search(rf"^\s*(?:async )?(?:def|class) {name}\b", text, re.M) is not None
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
    return re.search(rf"^(?:#define {name}\b|[A-Za-z_][\w *]*?\b\*?{name}\()", text, re.M) is not None


def place_faults(manual):
    for chapter in manual.chapters:
        paragraphs = re.findall(r"^Implemented in:(.*?)(?:\n\s*\n|\Z)", chapter.text, re.M | re.S)
        if not paragraphs:
            yield f"{chapter.path.name} has no paragraph 'Implemented in: `path` (`function`), ...'"
        for paragraph in paragraphs:
            places = list(PLACE.finditer(paragraph))
            if not places:
                yield f"{chapter.path.name}: 'Implemented in:' names no file"
            for match in places:
                yield from place_fault(manual, chapter, match.group("path"), match.group("names"))


def path_faults(manual):
    for chapter in [manual.index, *manual.chapters]:
        for match in SOURCE.finditer(chapter.text):
            if not (manual.root / match.group(1)).exists():
                yield f"{chapter.line(match.start())}: there is no {match.group(1)}"


def place_fault(manual, chapter, path, names):
    file = manual.root / path
    if "/" not in path or not file.is_file():
        yield f"{chapter.path.name}: there is no file {path}"
        return
    listed = re.findall(r"`(\w+)`", names or "")
    if not listed:
        yield f"{chapter.path.name}: {path} without a function: write `{path}` (`function`, ...)"
    text = file.read_text(encoding="utf-8")
    for name in listed:
        if not defines(text, path, name):
            yield f"{chapter.path.name}: {path} does not define {name}"


def test_files(manual, name):
    """The files of a test, from its name in ctest."""
    kind, _, rest = name.partition("_")
    tests = manual.root / "tests"
    if kind == "unit":
        return [path for path in (tests / "unit").rglob("test_*.c")
                if "_".join([*path.relative_to(tests / "unit").parts[:-1], path.stem[5:]]) == rest]
    paths = {"relations": [f"tests/relations/relation_{rest}.c"], "python": [f"bindings/python/test_{rest}.py"],
             "example": [f"examples/{rest}", f"examples/{rest}.c", f"examples/{rest}/{rest}.c"]}
    default = [f"tests/{kind}/test_{rest}.c", f"tests/{kind}/{rest}"]
    return [path for path in paths.get(kind, default) if (manual.root / path).exists()]


def test_faults(manual):
    for chapter in manual.chapters:
        if chapter.equations and not re.search(r"^Checked by:", chapter.text, re.M):
            yield f"{chapter.path.name} has no paragraph 'Checked by: `test`, ...'"
        for match in TEST.finditer(chapter.text):
            if not test_files(manual, match.group(1)):
                yield f"{chapter.line(match.start())}: there is no test {match.group(1)}"


def figure_faults(manual):
    drawn = {path.stem for path in manual.folder.glob("figures/*.py")} - {DRAWING}
    shown, cited = set(), set()
    for chapter in manual.chapters:
        for match in FIGURE.finditer(chapter.text):
            name, path = match.group("name"), match.group("path")
            if path != f"figures/{name[4:]}.svg":
                yield f"{chapter.line(match.start())}: {name} must show figures/{name[4:]}.svg, not {path}"
            if name in shown:
                yield f"{chapter.line(match.start())}: {name} is shown twice"
            shown.add(name)
            if name[4:] not in drawn:
                yield f"{chapter.line(match.start())}: there is no script lib/theory/figures/{name[4:]}.py"
        for match in FIGURE_CITED.finditer(chapter.prose()):
            cited.add(match.group(0))
            if match.group(0) not in manual.pictures:
                yield f"{chapter.line(match.start())}: no chapter shows {match.group(0)}"
    yield from (f"figures/{name}.py is shown by no chapter" for name in sorted(drawn - {one[4:] for one in shown}))
    yield from (f"{name} is shown, but no text cites it" for name in sorted(shown - cited))


def work_faults(manual):
    cited = {}
    for chapter in manual.chapters:
        for match in WORK_CITED.finditer(chapter.prose()):
            cited.setdefault(match.group(1), chapter.line(match.start()))
    yield from (f"{where}: references.bib has no work {key}" for key, where in sorted(cited.items())
                if key not in manual.works)
    yield from (f"references.bib: {key} is cited by no chapter" for key in manual.works if key not in cited)
    yield from (f"references.bib: {key} stands twice" for key in sorted(set(manual.works))
                if manual.works.count(key) > 1)


def link_faults(manual):
    for chapter in [manual.index, *manual.chapters]:
        for match in LINK.finditer(chapter.prose()):
            target = match.group("target")
            path = target.split("#")[0]
            if not target.startswith("https://") and path and path not in ["README.md", *manual.listed]:
                yield (f"{chapter.line(match.start())}: link to {target}, which is no chapter; name other files as "
                       "`code`")


CHECKS = (("the index lists every chapter", chapter_faults),
          ("names of equations are unique", equation_faults),
          ("every equation cited by a chapter, a source or a test exists", citation_faults),
          ("every equation is cited by a test", check_faults),
          ("every chapter names files and functions that exist", place_faults),
          ("files that the text names exist", path_faults),
          ("every chapter names tests that exist", test_faults),
          ("every figure has a script and a citation", figure_faults),
          ("every work cited is listed, every one listed is cited", work_faults),
          ("links lead to chapters", link_faults))


def faults(manual):
    """[(name of the check, its faults)]."""
    return [(name, list(check(manual))) for name, check in CHECKS]
