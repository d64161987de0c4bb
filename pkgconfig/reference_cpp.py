"""The C++ header as Doxygen reads it, for pkgconfig/reference: declarations without their bodies, and the description
of each: the // comment right before it or behind it, else the C function that it calls, else that of all owners."""
import re

OWNERS = (  # of a class with a handle: pattern of the declaration, what it does
    (r"^{name}\({name} &&", "Takes over the object of the other."),
    (r"^{name} &operator=\({name} &&", "Destroys its object and takes over that of the other."),
    (r"=\s*delete$", "There is one owner: it is moved, not copied."),
    (r"^~{name}\(\)", "Destroys its object."),
    (r"^explicit {name}\(dmb_\w+ \*", "Takes over a handle, or nothing."),
)
SILENT = re.compile(r"dmb_(?:status_\w+|\w+_default|\w+_init)$")


def closing(text, place):
    """Behind the bracket that closes the one at `place`."""
    depth = 0
    for match in re.compile(r"[{}]").finditer(text, place):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.end()
    raise SystemExit("reference: braces of the C++ header do not match")


def head_of(text, place):
    """Where the head of a declaration ends: at the ; or the { of a body, not at those of defaults and arguments."""
    depth = 0
    for match in re.compile(r"[()\[\];{}]").finditer(text, place):
        sign = match.group()
        if sign in "([":
            depth += 1
        elif sign in ")]":
            depth -= 1
        elif depth == 0 and sign in ";{":
            return match.start()
    raise SystemExit("reference: a declaration of the C++ header has no end")


def items(text):
    """(kind, text, body): blank, comment, directive, access, open, close or declaration."""
    place = 0
    patterns = (("blank", r"[ \t]*\n"), ("comment", r"[ \t]*//[^\n]*\n"), ("directive", r"#(?:[^\n]*\\\n)*[^\n]*\n"),
                ("access", r"[ \t]*(?:public|protected|private):\n"), ("close", r"[ \t]*\};?(?:[ \t]*//[^\n]*)?\n"),
                ("open", r"[ \t]*(?:template <[^;{]*?>\s*)?(?:class|struct|namespace) \w+[^;{(]*\{\n"))
    while place < len(text):
        for kind, pattern in patterns:
            match = re.compile(pattern).match(text, place)
            if match:
                yield kind, match.group(), ""
                place = match.end()
                break
        else:
            end = head_of(text, place)
            body, after = "", end + 1
            if text[end] == "{":
                after = closing(text, end)
                body = text[end:after]
            line = re.compile(r";?[ \t]*(//[^\n]*)?\n?").match(text, after)
            yield "declaration", text[place:end] + "\n" + (line.group(1) or ""), body
            place = line.end()


def without_initialisers(head):
    """A constructor without its `: member(...)`; no colon of :: or of a default is meant."""
    return re.sub(r"\)(\s*noexcept)?\s*:(?!:).*$", r")\1", head, flags=re.S)


class CppWriter:
    """prose, marked and known functions come from the writer of the C headers."""

    def __init__(self, writer):
        self.c = writer
        self.out, self.said, self.scopes = [], [], []
        self.hidden = False
        self.calls = {}  # functions of C, by class and member

    def words(self, lines):
        text = " ".join(re.sub(r"^\s*//\s?", "", line).strip() for line in lines)
        return self.c.marked(text, "") if text else ""

    def links(self, functions):
        return ", ".join(f'@ref {one} "{one}"' for one in functions)

    def by_calls(self, name, body):
        """The functions of C behind a member, also by way of another member of the class."""
        found = [one for one in dict.fromkeys(re.findall(r"\bdmb_\w+", body))
                 if one in self.c.functions and not SILENT.match(one)]
        for other in re.findall(r"\b(try_\w+|info|size|add_\w+)\(", body):
            found += [one for one in self.calls.get((tuple(self.scopes), other), []) if one not in found]
        self.calls.setdefault((tuple(self.scopes), name), []).extend(found)
        return found

    def own_words(self, head, body):
        """Description of a declaration without a comment."""
        if "= part_id<" in head:
            return "The id of a part of this kind."
        names = re.findall(r"(\w+|operator\s*\S+?)\(", head)
        owner = self.scopes[-1] if self.scopes else ""
        for pattern, text in OWNERS:
            if owner and re.search(pattern.format(name=owner), head):
                return text
        found = self.by_calls(names[0], body) if names else []
        if not found:
            return ""
        throws = "" if "noexcept" in head else "; throws @ref drillmbd::error where that fails"
        return f"Calls {self.links(found)}{throws}."

    def declaration(self, text, body):
        head, _, behind = text.rpartition("\n")
        head = re.sub(r"//[^\n]*", "", head)
        head = " ".join(without_initialisers(head.replace("DRILLMBD_NODISCARD ", "")).split())
        if head.startswith("static_assert"):
            return
        own = self.own_words(head, body)  # notes what it calls in any case
        said = self.words(self.said + ([behind] if behind else []))
        if not said or (own.startswith("Calls") and "dmb_" not in said):
            said = f"{said} {own}".strip()
        if said:
            self.out.append(f"/** {said} */\n")
        self.out.append(f"{head};\n")

    def open(self, text):
        head = " ".join(text.replace("{", "").split())
        name = re.search(r"(?:class|struct|namespace) (\w+)", head).group(1)
        said = self.words(self.said)
        if name == "drillmbd":
            said = "Everything in C++: owners, results and failures."
        if said:
            self.out.append(f"/** {said} */\n")
        self.out.append(f"{head} {{\n" + ("public:\n" if re.search(r"\bclass \w+( :|$)", head) else ""))
        self.scopes.append("" if head.startswith("namespace") else name)

    def header(self, text):
        first = re.match(r"(?://[^\n]*\n)+", text).group()
        paragraphs = re.split(r"^//\s*$", first, flags=re.M)
        code = "".join(line[2:] + "\n" for line in first.splitlines() if line.startswith("//     "))
        told = [self.words(part.strip().splitlines()) for part in paragraphs if not part.strip().startswith("//     ")]
        self.out.append(f"/** @file drillmbd.hpp\n * {told[0]}\n@code{{.cpp}}\n{code}@endcode\n" + "\n\n".join(told[1:])
                        + " */\n")
        private = []  # of each open scope: in a part that is not public
        for kind, part, body in items(text[len(first):]):
            if kind == "access":
                private[-1] = "public" not in part
            elif kind == "open":
                private.append(any(private))
                if not any(private):
                    self.open(part)
                else:
                    self.scopes.append("")
            elif kind == "close":
                if not any(private[:-1]):
                    self.out.append("};\n" if self.scopes[-1] else "}\n")
                private.pop()
                self.scopes.pop()
            elif kind == "declaration" and not any(private):
                self.declaration(part, body)
            if kind == "comment" and "// ----" not in part:
                self.said.append(part)
            elif kind != "directive":
                self.said = []
        return "".join(self.out)
