"""Reads the public headers: structs, constants, functions.

usage: interface.py INCLUDE_FOLDER program      a C program that prints the layout of every struct and every constant
       interface.py INCLUDE_FOLDER functions    the names of all exported functions, one a line, sorted
       interface.py INCLUDE_FOLDER prototypes   their prototypes, and the types of callbacks
       interface.py INCLUDE_FOLDER rules        breaches of the rules for structs; exit status 1 if there are any
"""
import pathlib
import re
import sys

MEMBER_TYPE = re.compile(r"(u?int(8|16|32|64)_t|char|double|dmb_\w+|(const )?(double|int32_t|void|dmb_\w+) ?\*|function)$")


def read(folder):
    texts = []
    for path in sorted(pathlib.Path(folder, "drillmbd").glob("*.h")):
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
    lines = ["#include <drillmbd/drillmbd.h>", "#include <stdio.h>", "int main(void)", "{"]
    for name, members in structs(text):
        lines.append(f'    printf("struct {name}: %zu\\n", sizeof({name}));')
        for member, _ in members:
            lines.append(f'    printf("    {member}: at %zu, %zu\\n", offsetof({name}, {member}), '
                         f"sizeof((({name} *)0)->{member}));")
    for name in constants(text):
        lines.append(f'    printf("constant {name} = %ld\\n", (long)({name}));')
    return "\n".join(lines + ["    return 0;", "}"])


def breaches(text):
    sized, found = set(sized_structs(text)), []
    for name, members in structs(text):
        if name in sized and members[0] != ("struct_size", "uint32_t"):
            found.append(f"{name} does not begin with uint32_t struct_size")
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
    elif task == "prototypes":
        print("\n".join(callbacks(text) + sorted(prototypes(text), key=lambda p: re.search(r"(\w+)\(", p).group(1))))
    elif task == "rules":
        found = breaches(text)
        print("\n".join(found))
        return 1 if found else 0
    else:
        print(__doc__)
        return 2
    return 0


sys.exit(main())
