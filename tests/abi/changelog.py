#!/usr/bin/python3
"""Holds differences of the interface against CHANGELOG.md: each function, struct and member that libabigail tells as new,
gone or changed must be named under *ABI*, else its name is printed and the exit status is 1. There `_name` after a name
stands for that name with another end, `dmb_name_*` for all that begin so, `a` .. `b` for the members from a to b.

usage: abidiff --leaf-changes-only --harmless OLD NEW | changelog.py CHANGELOG.md
"""
import pathlib
import re
import sys


def items(text):
    """The items of all sections *ABI*."""
    for section in re.findall(r"^### ABI\n(.*?)(?=^##|\Z)", text, re.M | re.S):
        yield from re.split(r"^- ", section, flags=re.M)[1:]


def names_of(item):
    """All names that an item can stand for, and beginnings of names."""
    names, beginnings, last = set(), set(), ""
    for token in re.findall(r"`([A-Za-z_]\w*\*?)", item):
        if token.endswith("*"):
            beginnings.add(token[:-1])
        elif token.startswith("_"):
            ends = [i for i, letter in enumerate(last) if letter == "_"] + [len(last)]
            names.update(last[:end] + token for end in ends)
        else:
            names.add(token)
            last = token
    return names, beginnings


class Changelog:
    def __init__(self, text):
        self.items = [(item, *names_of(item)) for item in items(text)]

    def of(self, name):
        """The items that name it."""
        return [item for item, names, beginnings in self.items
                if name in names or any(name.startswith(beginning) for beginning in beginnings)]

    def has(self, name):
        return bool(self.of(name) or (name.endswith("_init") and self.of(name.removesuffix("_init"))))

    def has_member(self, struct, members, i):
        """Member number i of those that are new."""
        for item in self.of(struct):
            if re.search(rf"`{members[i]}`", item):
                return True
            for first, last in re.findall(r"`(\w+)`\s*\.\.\s*`(\w+)`", item):
                if first in members and last in members and members.index(first) <= i <= members.index(last):
                    return True
        return False


def differences(report):
    """Functions and structs by name, and new members of structs in their order."""
    names, members, struct = [], {}, None
    for line in report.splitlines():
        function = re.match(r"\s*\[[ADC]\] '(?:function|variable) .*\{([\w@.]+)\}", line)
        changed = re.match(r"\s*\[C\] 'function \S.*?(\w+)\(", line)
        kind = re.match(r"'(?:struct|union|enum|typedef) (\w+)", line)
        member = re.match(r"\s+'.*?(\w+)(?:\[\d+\])*', at offset", line)
        if function or changed:
            names.append((function or changed).group(1).split("@")[0])
        elif kind:
            struct = kind.group(1)
            names.append(struct)
        elif member and struct:
            members.setdefault(struct, []).append(member.group(1))
    return names, members


def main():
    changelog = Changelog(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    names, members = differences(sys.stdin.read())
    missing = [name for name in names if not changelog.has(name)]
    for struct, new in members.items():
        missing += [f"{struct}.{name}" for i, name in enumerate(new)
                    if "reserved" not in name and not changelog.has_member(struct, new, i)]
    for name in missing:
        print(f"{name} is not what it was in the first headers of the series: CHANGELOG.md tells nothing under ABI")
    return bool(missing)


sys.exit(main())
