"""Reads the public headers: structs, constants, functions.

usage: interface.py INCLUDE program      a C program that prints the layout of every struct and every constant
       interface.py INCLUDE functions    the names of all exported functions, one a line, sorted
       interface.py INCLUDE prototypes   their prototypes, and the types of callbacks
       interface.py INCLUDE rules        breaches of the rules for structs; exit status 1 if there are any
       interface.py INCLUDE stubs        C definitions of all functions that do nothing
INCLUDE is a folder with the headers in drillmbd/, or one file with all of them.
"""
import pathlib
import re
import sys

MEMBER_TYPE = re.compile(r"(u?int(8|16|32|64)_t|char|double|dmb_\w+|(const )?(double|int32_t|void|dmb_\w+) "
                         r"?\*|function)$")


def headers(folder):
    return sorted(pathlib.Path(folder, "drillmbd").glob("*.h"))


def read(include):
    texts = []
    for path in [pathlib.Path(include)] if pathlib.Path(include).is_file() else headers(include):
        text = path.read_text(encoding="utf-8")
        texts.append(re.sub(r"/\*.*?\*/", " ", text, flags=re.S))
    return "\n".join(texts)


def without_directives(text):
    text = re.sub(r"\\\n", " ", text)
    return re.sub(r"^\s*#.*$", " ", text, flags=re.M)


def declared_names(declaration):
    """'double x0, x1[3]' -> ('double', ['x0', 'x1']); a function pointer has the type 'function'."""
    declaration = " ".join(declaration.split())
    function = re.match(r".*?\(\*\s*(\w+)\)\s*\(", declaration)
    if function:
        return "function", [function.group(1)]
    first, *rest = declaration.split(",")
    match = re.match(r"(.*?[\s*])(\w+)\s*((\[[^]]*\])*)(\s*:.*)?$", first.strip())
    kind = match.group(1).strip() + (" bit-field" if match.group(5) else "")
    return kind, [match.group(2)] + [re.match(r"\s*\**(\w+)", part).group(1) for part in rest]


def structs(text):
    """[(name, [(member, type)])] in the order of the headers."""
    found = []
    for match in re.finditer(r"typedef struct (\w+)\s*\{(.*?)\}\s*\1\s*;", without_directives(text), re.S):
        members = []
        for declaration in match.group(2).split(";"):
            if declaration.strip():
                kind, names = declared_names(declaration)
                members += [(name, kind) for name in names]
        found.append((match.group(1), members))
    return found


def constants(text):
    names = re.findall(r"^\s*X\((DMB_\w+),", text, re.M)
    for body in re.findall(r"\benum\s*\w*\s*\{(.*?)\}", without_directives(text), re.S):
        for entry in body.split(","):
            match = re.match(r"\s*(DMB_\w+)\s*(=|$)", entry)
            if match and not match.group(1).endswith("_"):
                names.append(match.group(1))
    return names


def sized_structs(text):
    return re.findall(r"^DMB_SIZED_STRUCT\((\w+)\)", text, re.M)


def prototypes(text):
    found = []
    for match in re.finditer(r"^DMB_API\s+([^;{]*?);", without_directives(text), re.S | re.M):
        found.append(" ".join(match.group(1).split()))
    found += [f"int32_t {name}_init({name} *out, uint32_t size)" for name in sized_structs(text)]
    return found


def callbacks(text):
    return [" ".join(match.split())
            for match in re.findall(r"^(typedef [^;{]*\(\*\w+\)\([^;]*\));", without_directives(text), re.S | re.M)]


def function_names(text):
    return sorted(re.search(r"(\w+)\(", prototype).group(1) for prototype in prototypes(text))


def program(text):
    lines = ["#include INTERFACE", "#include <stdio.h>", "int main(void)", "{"]
    for name, members in structs(text):
        lines.append(f'    printf("struct {name}: %zu\\n", sizeof({name}));')
        for member, _ in members:
            lines.append(f'    printf("    {member}: at %zu, %zu\\n", offsetof({name}, {member}), '
                         f"sizeof((({name} *)0)->{member}));")
    for name in constants(text):
        lines.append(f'    printf("constant {name} = %ld\\n", (long)({name}));')
    return "\n".join(lines + ["    return 0;", "}"])


def stubs(text):
    """The interface as a library that does nothing, for libabigail to read."""
    bodies = [f"{prototype}\n{{\n    {'' if prototype.startswith('void ') else 'return 0;'}\n}}"
              for prototype in prototypes(text)]
    return "\n".join(["#include INTERFACE", *bodies])


def frozen_structs(include):
    """Those whose comment, the one before them, begins with 'Frozen'."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in headers(include))
    return set(re.findall(r"/\* Frozen(?:(?!\*/).)*\*/\s*typedef struct (\w+)", text, re.S))


def breaches(text, frozen):
    sized, found = set(sized_structs(text)), []
    for name, members in structs(text):
        if name in sized and members[0] != ("struct_size", "uint32_t"):
            found.append(f"{name} does not begin with uint32_t struct_size")
        if name not in sized and name not in frozen:
            found.append(f"{name} has no struct_size: its comment must say that it is frozen")
        if name not in sized and any(member == "struct_size" for member, _ in members):
            found.append(f"{name} has a struct_size and no DMB_SIZED_STRUCT")
        for member, kind in members:
            if not MEMBER_TYPE.match(kind):
                found.append(f"{name}.{member} is of type {kind}")
    by_value = re.compile(r"\b(" + "|".join(map(re.escape, sized)) + r")\s+\w+\s*[,)]")
    for prototype in prototypes(text):
        if by_value.search(prototype) or prototype.split("(")[0].split()[0] in sized:
            found.append(f"takes or returns a struct by value: {prototype}")
    return found


def main():
    text, task = read(sys.argv[1]), sys.argv[2]
    if task == "program":
        print(program(text))
    elif task == "functions":
        print("\n".join(function_names(text)))
    elif task == "stubs":
        print(stubs(text))
    elif task == "prototypes":
        print("\n".join(callbacks(text) + sorted(prototypes(text), key=lambda p: re.search(r"(\w+)\(", p).group(1))))
    elif task == "rules":
        found = breaches(text, frozen_structs(sys.argv[1]))
        print("\n".join(found))
        return 1 if found else 0
    else:
        print(__doc__)
        return 2
    return 0


sys.exit(main())
