"""The words of public text, held against the patterns of .ci/words.txt (rule of .ci/source_rules). A file may have as
many matches as
.ci/words_left.txt says, none if it is not listed there; `.ci/source_rules --lower` writes lower counts into that list
and never a higher one."""
import pathlib
import re
import subprocess
import tokenize
from typing import Iterator

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
LEFT = HERE / "words_left.txt"
C_COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|/\*(.*?)\*/|//([^\n]*)', re.S)
MESSAGE = re.compile(r"\bdmb_message_set\((?!dmb_message \*)")
STRING = re.compile(r'"((?:\\.|[^"\\])*)"')
GENERATED = re.compile(r"drillmbd/(_structs|_functions|enums)\.py$")

Piece = tuple[int, str]  # line, text


def markdown(text: str) -> Iterator[Piece]:
    """Lines without code; a sentence may run over several of them."""
    text = re.sub(r"^```.*?^```", lambda match: "\n" * match.group().count("\n"), text, flags=re.S | re.M)
    text = re.sub(r"`[^`]*`", lambda match: "`" + "\n" * match.group().count("\n"), text)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    for match in re.finditer(r"(?:^(?! {4}).*\S.*\n?)+", text, re.M):
        yield text.count("\n", 0, match.start()) + 1, match.group()


def header(text: str) -> Iterator[Piece]:
    """Comments, without what they quote as code."""
    for match in C_COMMENT.finditer(text):
        inside = next((one for one in match.groups() if one), "")
        yield (text.count("\n", 0, match.start()) + 1,
               re.sub(r"`[^`\n]*`", "`", re.sub(r"^\s*\*", "", inside, flags=re.M)))


def python(text: str) -> Iterator[Piece]:
    """String literals, of which messages and descriptions are made; a single word is a key."""
    for token in tokenize.generate_tokens(iter(text.splitlines(True)).__next__):
        if token.type == tokenize.STRING:
            literal = re.sub(r"^[rRbBuUfF]*", "", token.string)
            quote = literal[:3] if literal[:3] in ('"""', "'''") else literal[:1]
            inside = re.sub(r"`[^`]*`|\{[^{}\n]*\}", "`", literal[len(quote):-len(quote)])
            if re.search(r"\w\W*\s\W*\w", inside) or inside == "likewise":
                yield token.start[0], inside


def messages(text: str) -> Iterator[Piece]:
    """Literals of messages of the library."""
    for match in MESSAGE.finditer(text):
        end = text.find(");", match.end())
        for literal in STRING.finditer(text, match.end(), end):
            yield text.count("\n", 0, literal.start()) + 1, literal.group(1)


READERS = [
    (re.compile(r"(README|CHANGELOG)\.md$|examples/.*README\.md$"), markdown),
    (re.compile(r"include/drillmbd/\w+\.h$|bindings/cpp/drillmbd\.hpp$"), header),
    (re.compile(r"bindings/python/drillmbd/.*\.py$|pkgconfig/(manual|reference)\w*(\.py)?$"), python),
    (re.compile(r"lib/.*\.[ch]$"), messages),
]
FOLDERS = ["README.md", "CHANGELOG.md", "examples", "include", "bindings/cpp", "bindings/python/drillmbd", "pkgconfig",
           "lib"]


class Pattern:
    def __init__(self, line: str):
        before, self.instead = (part.strip() for part in re.split(r"\s\|\s", line, maxsplit=1))
        self.question = before.startswith("statement:")
        self.match = re.compile(before.removeprefix("statement:").strip(), re.I)

    def found(self, text: str) -> Iterator[tuple[int, str]]:
        for match in self.match.finditer(text):
            end = re.compile(r"[.?!:;|](\s|$)|$").search(text, match.end())
            if not (self.question and end and end.group().startswith("?")):
                yield match.start(), match.group()


def patterns() -> list[Pattern]:
    lines = (HERE / "words.txt").read_text(encoding="utf-8").splitlines()
    return [Pattern(line) for line in lines if line.strip() and not line.startswith("#")]


def faults_of(text: str, read, known: list[Pattern]) -> Iterator[tuple[int, str]]:
    for line, piece in read(text):
        for pattern in known:
            for at, word in pattern.found(piece):
                yield line + piece.count("\n", 0, at), f'"{" ".join(word.split())}" (write: {pattern.instead})'


def counted_under(name: str) -> str:
    """Messages of the library are counted together, because its files change their names."""
    return "lib" if name.startswith("lib/") else name


def all_faults() -> dict[str, list[str]]:
    known, found = patterns(), {}
    names = subprocess.run(["git", "ls-files", *FOLDERS], cwd=ROOT, check=True, capture_output=True,
                           text=True).stdout.split()
    for name in names:
        read = next((reader for pattern, reader in READERS if pattern.match(name)), None)
        if read and not GENERATED.search(name) and (ROOT / name).exists():
            text = (ROOT / name).read_text(encoding="utf-8")
            for line, fault in faults_of(text, read, known):
                found.setdefault(counted_under(name), []).append(f"{name}:{line}: {fault}")
    return found


def allowed() -> dict[str, int]:
    lines = LEFT.read_text(encoding="utf-8").splitlines() if LEFT.exists() else []
    return {name: int(count) for count, name in (line.split() for line in lines if line and not line.startswith("#"))}


def planted_rules(known: list[Pattern]) -> Iterator[str]:
    """The readers find planted words, and do not find those of code and of questions."""
    samples = [(markdown, "The check\ntells it.\n", 1), (markdown, "```c\ntold\n```\nA `told` b.\n\n    told\n", 0),
               (markdown, "What is it?\n", 0), (markdown, "It is what it is.\n", 1),
               (markdown, "a guide\nthe user's guide\n", 1),
               (header, 'int told; /* told */ char *a = "told"; /* see `told` */\n', 1),
               (python, 'told = f"it is told {told}"  # told\nkey = "told"\n', 1),
               (messages, 'told = 1; dmb_message_set(m, "it is told", told);', 1)]
    for read, text, count in samples:
        found = len(list(faults_of(text, read, known)))
        if found != count:
            yield f"public_text: {found} matches instead of {count} in {text!r}"


def rule() -> Iterator[str]:
    yield from planted_rules(patterns())
    found, limit = all_faults(), allowed()
    for name, faults in sorted(found.items()):
        if len(faults) > limit.get(name, 0):
            yield from faults
            yield (f"{name}: {len(faults)} matches of .ci/words.txt, allowed are {limit.get(name, 0)} "
                   "(.ci/words_left.txt)")


def lower() -> None:
    """Writes the counts that have fallen."""
    found, limit = all_faults(), allowed()
    counts = {name: min(len(faults), limit.get(name, 0)) for name, faults in found.items()}
    lines = [f"{count:4} {name}" for name, count in sorted(counts.items()) if count]
    LEFT.write_text("\n".join(["# Matches of .ci/words.txt in texts that are not revised yet. Counts only fall: "
                               ".ci/source_rules --lower",
                               *lines]) + "\n", encoding="utf-8")
