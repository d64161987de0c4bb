#!/usr/bin/env python3
"""Writes what the JavaScript binding takes from the public headers: layouts of the structs on wasm32, constants,
methods and their types.

usage: generate.py FOLDER    writes interface.mjs, drillmbd.d.ts, layout_check.c and exports.txt there

The headers are read by bindings/python/generate.py, which makes the Python structs too. layout_check.c holds a
_Static_assert for the size of each struct and the place of each field, so that a wrong layout does not compile."""
import importlib.util
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent


def python_generator():
    """The module bindings/python/generate.py."""
    spec = importlib.util.spec_from_file_location("generate_python", HERE.parent / "python" / "generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PYTHON = python_generator()
#: Size [byte], which is the alignment too, and letter of each scalar on wasm32.
SCALARS = {"c_int32": (4, "i"), "c_uint32": (4, "u"), "c_int64": (8, "l"), "c_uint64": (8, "L"), "c_double": (8, "d"),
           "c_size_t": (4, "u"),
           "c_char": (1, "c")}
LETTERS = {"i": "number", "u": "number", "l": "bigint", "L": "bigint", "d": "number"}
#: functions of a list of structs and its length
ARRAYS = {"dmb_model_add_time_function", "dmb_model_add_hole_sections"}
HANDLES = {"dmb_model": "Model", "dmb_sim": "Sim"}
BY_HAND = {"dmb_model_create", "dmb_model_destroy", "dmb_sim_create", "dmb_sim_destroy", "dmb_sim_hash",
           "dmb_query_profile", "dmb_sim_time", "dmb_sim_step", "dmb_sim_advance", "dmb_sim_snapshot_size",
           "dmb_model_message",
           "dmb_sim_message"}  #: drillmbd.mjs has these itself


# ---- Layouts ---------------------------------------------------------------------------------------------------------
class Layouts:
    """Offsets of the fields of all structs, by the rules of the C ABI: each field on a multiple of its alignment."""

    def __init__(self, reader):
        self.structs = {name: (fields, text) for name, fields, text in reader.structs()}
        self.by_class = {PYTHON.class_name(name): name for name in self.structs}
        self.made = {}

    def kind(self, ctype):
        """(letter or struct, count, size, alignment) of a field; letter "p" is a pointer."""
        array = re.fullmatch(r"(\w+) \* (\w+)", ctype)
        base, count = (array.group(1), int(array.group(2))) if array else (ctype, 0)
        if base in SCALARS:
            size, letter = SCALARS[base]
            return letter, count, size * max(count, 1), size
        if base in self.by_class:
            made = self.of(self.by_class[base])
            return self.by_class[base], count, made["size"] * max(count, 1), made["align"]
        return "p", 0, 4, 4

    def of(self, name):
        """{"size", "align", "fields": [[name, letter or struct, count, offset, shape]]}; shape: of a pointer to
        numbers, the field that counts them and how many numbers each is."""
        if name not in self.made:
            at, align, fields = 0, 1, []
            for field, ctype, _, text in self.structs[name][0]:
                letter, count, size, own = self.kind(ctype)
                at = -(-at // own) * own
                fields.append([field, letter, count, at, *shape_of(ctype, text)])
                at, align = at + size, max(align, own)
            self.made[name] = {"size": -(-at // align) * align, "align": align, "fields": fields}
        return self.made[name]


def shape_of(ctype, text):
    """[letter of the numbers, field that counts them, numbers each] of a pointer to numbers; [] else."""
    pointer = re.fullmatch(r"POINTER\((c_double|c_int32)\)", ctype)
    if not pointer:
        return []
    shape = re.search(r"shape \((\w+)(?:, (\d+))?\)", text)
    return [SCALARS[pointer.group(1)][1], *((shape.group(1), int(shape.group(2) or 1)) if shape else ("", 1))]


# ---- Methods ---------------------------------------------------------------------------------------------------------
def camel(name):
    first, *rest = name.split("_")
    return first + "".join(word.capitalize() for word in rest)


def method_name(c_name):
    """dmb_sim_step -> step, dmb_query_pose -> queryPose, dmb_analysis_static -> analysisStatic"""
    return camel(re.sub(r"^dmb_(?:model_|sim_)?", "", c_name))


def parameters(reader, c_name, text):
    """[[way, type, name]] of the parameters behind the handle: way "in" or "out", "list" of structs, "text"; None where
    the function needs more than these."""
    found = []
    parts = [" ".join(one.split()) for one in text.split(",")][1:]
    for part in parts:
        match = re.fullmatch(r"(const )?(\w+) (\**)(\w+)(\[(\w+)\])?", part)
        if not match:
            return None
        const, kind, stars, name, array, length = match.groups()
        if kind in reader.opaque or kind == "void" or len(stars) > 1:
            return None
        letter = SCALARS[reader.ctype(kind + " x")][1] if reader.ctype(kind + " x") in SCALARS else kind
        if letter == kind and not any(kind == one for one, _, _ in reader.structs()):
            return None
        if kind == "char":
            if not const:
                return None
            found.append(["text", "c", name])
        elif not stars and not array:
            found.append(["in", letter, name])
        elif c_name in ARRAYS and const:
            found.append(["list", letter, name])
        elif const:
            if letter != kind or array:
                return None
            found.append(["in*", letter, name])
        else:
            found.append(["out", letter, name, *([int(length)] if length else [])])
    if any(re.search(r"count$|capacity$", one[2]) for one in found) and c_name not in (*ARRAYS, "dmb_model_add_pipes"):
        return None  # arrays of a length that the prototype alone does not say
    if c_name in ARRAYS:
        found = [one for at, one in enumerate(found) if not (at and found[at - 1][0] == "list")]
    return found


def prototypes(reader):
    """[(result, name, arguments, comment)] as the headers write them."""
    plain = reader.text
    for match in re.finditer(r"^DMB_API\s+([^;{]*?)\(([^;{]*?)\);", plain, re.M | re.S):
        result, name = re.match(r"(.*?[ *])(\w+)$", " ".join(match.group(1).split())).groups()
        yield result.strip(), name, PYTHON.without_comments(match.group(2)), reader.comment_before(match.start())


def methods(reader):
    """{"Model": {method: [C name, result letter, parameters]}, "Sim": ...} of the functions that one rule can call."""
    found = {"Model": {}, "Sim": {}}
    for result, name, arguments, text in prototypes(reader):
        handle = re.match(r"(?:const )?(\w+) \*", arguments.strip())
        if not handle or handle.group(1) not in HANDLES or name in BY_HAND or \
                not re.match(r"dmb_(model|sim|query|analysis)_", name):
            continue
        given = parameters(reader, name, arguments)
        letter = {"int32_t": "s", "uint32_t": "u", "double": "d"}.get(result)
        if given is not None and letter:
            found[HANDLES[handle.group(1)]][method_name(name)] = [name, letter, given]
    return found


# ---- Types -----------------------------------------------------------------------------------------------------------
def comment(unit, text, indent="    "):
    words = " ".join(one for one in (f"[{unit}]" if unit else "", text) if one).replace("*/", "* /")
    return [f"{indent}/** {words} */"] if words else []


def field_type(letter, count, shape, given=False):
    if letter == "c":
        return "string"
    if letter == "p":
        return "ArrayLike<number> | null" if shape else "number"
    if letter in LETTERS:
        return (LETTERS[letter] if not count else "ArrayLike<number>" if given else "Float64Array" if letter == "d"
                else "number[]")
    name = PYTHON.class_name(letter)
    name = ("Place | Id | null" if name == "Place" else "Id | null" if name == "Id" else name if not given
            else f"Partial<{name}>")
    return f"({name})[]" if count else name


def struct_types(reader, layouts):
    for name, (fields, text) in layouts.structs.items():
        if name in ("dmb_id", "dmb_place"):  # drillmbd.d.ts.in has these
            continue
        docs = {field: (unit, meaning) for field, _, unit, meaning in fields}
        yield from comment("", text if len(text.split()) > 2 else reader.users(PYTHON.class_name(name)), "")
        yield f"export interface {PYTHON.class_name(name)} {{"
        for field, letter, count, _, *shape in layouts.of(name)["fields"]:
            if field != "struct_size" and not re.search(r"reserved\d*$", field):
                yield from comment(*docs[field])
                yield f"    {field}: {field_type(letter, count, shape)};"
        if name == "dmb_segment":
            yield ('    /** Of kind SEGMENT_CALLBACK: of the time [s], to the value, or to [value, rate, integral] by '
                   '`provides`. */')
            yield "    function?: (time: number) => number | number[];"
        yield "}"


def argument_type(way, letter):
    if way == "text":
        return "string"
    if letter in LETTERS:
        return LETTERS[letter]
    name = PYTHON.class_name(letter)
    if name in ("Id", "Place"):
        return "Id | null" if name == "Id" else "Place | Id"
    return f"Input<{name}>" + ("[]" if way == "list" else "")


def result_type(outs):
    def one(letter, length):
        return ("Float64Array" if length and letter == "d" else "number[]" if length else LETTERS.get(letter)
                or PYTHON.class_name(letter))
    kinds = [(name, one(letter, length[0] if length else 0)) for _, letter, name, *length in outs]
    if not kinds:
        return "number"
    return kinds[0][1] if len(kinds) == 1 else "{ " + "; ".join(f"{name}: {kind}" for name, kind in kinds) + " }"


def method_types(reader, found, kind):
    texts = {name: text for name, _, text in reader.prototypes()}
    for method, (name, letter, given) in found[kind].items():
        ins, outs = [one for one in given if one[0] != "out"], [one for one in given if one[0] == "out"]
        optional = not any(one[0] != "in*" for one in ins)
        arguments = ", ".join(f"{one[2]}{'?' if optional else ''}: {argument_type(one[0], one[1])}" for one in ins)
        yield from comment("", texts.get(name, ""))
        yield f"    {method}({arguments}): {result_type(outs) if letter == 's' else 'number'};"


def declarations(reader, layouts, found):
    """The text of drillmbd.d.ts: drillmbd.d.ts.in with the structs, methods and constants in their places."""
    made = {"structs": "\n".join(struct_types(reader, layouts)),
            "constants": "\n".join(f"    readonly {name}: {value};" for name, value in constants(reader).items()),
            **{kind: "\n".join(method_types(reader, found, kind)) for kind in found}}
    text = (HERE / "drillmbd.d.ts.in").read_text(encoding="utf-8")
    return re.sub(r"^ *//@(\w+)$", lambda match: made[match.group(1)], text, flags=re.M)


def constants(reader):
    found = {name: value for _, members in reader.enums() for name, value, _ in members}
    found.update({name: 0xFFFFFFFF for name in re.findall(r"^#define DMB_(\w+) UINT32_MAX", reader.text, re.M)})
    for name, value in re.findall(r"^#define DMB_(NOT_GIVEN|UNLIMITED) (\S+)", reader.text, re.M):
        found[name] = float(value.strip("()"))
    return found


# ---- Files -----------------------------------------------------------------------------------------------------------
def layout_check(layouts):
    lines = ["/* Each layout of interface.mjs against the compiler's. Made by bindings/web/generate.py. */",
             "#include <stddef.h>", '#include "drillmbd.h"']
    for name in layouts.structs:
        made = layouts.of(name)
        lines.append(f'_Static_assert(sizeof({name}) == {made["size"]}, "size of {name}");')
        lines += [f'_Static_assert(offsetof({name}, {field}) == {at}, "{name}, {field}");'
                  for field, _, _, at, *_ in made["fields"]]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    reader = PYTHON.Reader(PYTHON.header_text())
    structs, prototypes_read = reader.structs(), reader.prototypes()  # read once: each reading takes a second
    reader.structs, reader.prototypes = lambda: structs, lambda: prototypes_read
    layouts, found = Layouts(reader), methods(reader)
    sized = set(reader.sized)
    shown = {name: {"size": layouts.of(name)["size"], "sized": name in sized, "fields": layouts.of(name)["fields"]}
             for name in layouts.structs}
    parts = {"STRUCTS": shown, "CONSTANTS": constants(reader), "METHODS": found}
    text = "// Made from the headers by bindings/web/generate.py: do not edit, run that instead.\n" + "".join(
        f"export const {name} = {json.dumps(value, separators=(',', ':'))};\n" for name, value in parts.items())
    (folder / "interface.mjs").write_text(text, encoding="utf-8")
    (folder / "drillmbd.d.ts").write_text(declarations(reader, layouts, found), encoding="utf-8")
    (folder / "layout_check.c").write_text(layout_check(layouts), encoding="utf-8")
    names = sorted({name for name, _, _ in reader.prototypes()} - {name for name, _, _ in reader.prototypes()
                                                                   if "write_" in name})
    (folder / "exports.txt").write_text("".join(f"--export={name}\n" for name in [*names, "malloc", "free"]),
                                        encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
