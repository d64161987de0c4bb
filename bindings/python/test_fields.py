"""The list of fields in C (lib/fields/lists.h) against the public header: each member has a row with the unit of its comment, and the
default that the comment states is that of the library."""
import ctypes
import enum
import math
import pathlib
import re
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import generate  # noqa: E402
import drillmbd  # noqa: E402
from drillmbd import _structs, enums  # noqa: E402
from drillmbd.scene.fields import fields_of  # noqa: E402

LISTS = HERE.parents[1] / "lib" / "fields"
NUMBER = r"-?(?:\d[\d.]*(?:e[+-]?\d+)?|[A-Z][A-Z0-9_]+|NaN)(?![\w/])"
# "default 0.5", "default (0, 0, -9.81)", "default AXIAL and ROTATION"; "-1 (default)", "FEED (X, default)"
STATED = re.compile(rf"default:? (?:DMB_)?\(?({NUMBER}(?:(?:,| and) {NUMBER})*)|({NUMBER}) \((?:\w+, )?default\)")
PREFIXES = ("", "STUCK_", "DRIVE_", "SPRING_")


def lists():
    """{struct: {field: unit}} of the lists of fields and of options."""
    found = {}
    for name in ("lists.h", "options.h"):
        for struct, fields in generate.rows((LISTS / name).read_text(encoding="utf-8")).items():
            found[struct] = {field: unit for field, unit, _, _ in fields}
    return found


def value_of(word):
    """A number or the name of a constant; None: neither."""
    if word == "NaN":
        return math.nan
    for prefix in PREFIXES:
        if hasattr(enums, prefix + word.lstrip("-")):
            return float(getattr(enums, prefix + word.lstrip("-"))) * (-1.0 if word[0] == "-" else 1.0)
    try:
        return float(word)
    except ValueError:
        return None


def stated(text):
    """The numbers of the default that a comment states; []: it states none, or one in words."""
    match = STATED.search(text)
    if match is None:
        return []
    words = re.split(r", | and ", match[1] or match[2])
    values = [value_of(word) for word in words]
    if " and " in (match[1] or "") and None not in values and words[0].isidentifier():  # bits of a mask
        return [sum(values)]
    return [] if None in values else values


def given(value):
    """The numbers of a field; []: of a struct or a pointer."""
    if isinstance(value, ctypes.Array) and value._type_ in (ctypes.c_double, ctypes.c_int32, ctypes.c_uint32):
        return [float(one) for one in value]
    return [float(value)] if isinstance(value, (int, float)) else []


def same(wanted, found):
    """The numbers that are stated; they may be the first ones of an array."""
    return all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(wanted, found))


class Fields(unittest.TestCase):
    """Lists in C, header, and structs of the library."""

    @classmethod
    def setUpClass(cls):
        reader = generate.Reader(generate.header_text())
        cls.structs = {name: fields for name, fields, _ in reader.structs()}
        cls.lists = lists()

    def members(self, struct):
        """Members of a struct, without those that are reserved."""
        return [field for field in self.structs[struct] if field[0] != "struct_size" and not re.search(r"reserved\d*$", field[0])]

    def test_every_member_has_a_row(self):
        self.assertEqual(len(self.lists), 21 + 12)
        for struct, rows in self.lists.items():
            self.assertEqual({name for name, *_ in self.members(struct)}, set(rows), struct)

    def test_every_description_has_a_list(self):
        self.assertEqual({name for name in self.structs if name.endswith("_def")} - set(self.lists), set())

    def test_units(self):
        for struct, rows in self.lists.items():
            for name, _, unit, _ in self.members(struct):
                if "," not in unit:  # one comment of several members
                    self.assertEqual(rows[name], unit, f"{struct}.{name}")

    def test_stated_defaults(self):
        compared = 0
        for struct in self.lists:
            blank = getattr(_structs, generate.class_name(struct))()
            comments = [text for _, _, _, text in self.members(struct)]
            for number, (name, _, _, text) in enumerate(self.members(struct)):
                wanted, found = stated(text), given(getattr(blank, name))
                if len(wanted) > len(found) == 1:  # a comment of several members
                    wanted = wanted[number - comments.index(text):][:1]
                if wanted and found:
                    compared += 1
                    self.assertTrue(same(wanted, found), f"{struct}.{name}: default {wanted} in the header, {found} in the library")
        self.assertGreater(compared, 130)

    def test_ranges_of_options(self):
        """Each range of the structs of Python is that which the library refuses by, as data of its error."""
        model = drillmbd.Model()
        model.add_wall()
        string = model.add_pipes(2)
        model.compile()
        sim = model.sim()
        output, order = (drillmbd.station(string, 1, 0.5), "vibration_z"), _structs.Order()
        calls = {_structs.SimOptions: model.sim, _structs.StaticOptions: sim.static, _structs.BucklingOptions: sim.buckling,
                 _structs.PathOptions: sim.path, _structs.ModesOptions: sim.modes, _structs.TorqueDragOptions: sim.torque_drag,
                 _structs.ResponseOptions: lambda **one: sim.response([_structs.Excitation()], [output], **one),
                 _structs.SteppedSineOptions: lambda **one: sim.stepped_sine(1.0, [output], **one),
                 _structs.SpeedsOptions: lambda **one: sim.speeds([order], [output], [1.0], **one),
                 _structs.StateSpaceOptions: lambda **one: sim.state_space([_structs.Excitation()], [output], **one)}
        checked = 0
        for struct, call in calls.items():
            self.assertGreater(len(struct.bounds), 2)
            for field, (kind, low, high) in struct.bounds.items():
                outside = low if kind == "above" else 1.5 * high + 1.0
                if isinstance(getattr(struct(), field), int):
                    outside = int(min(high + 1, 0xFFFFFFFF))
                value = [outside, outside] if field == "band" else outside
                with self.assertRaises(drillmbd.Error, msg=f"{struct.__name__}.{field}") as caught:
                    call(**{field: value})
                self.assertEqual((caught.exception.field.split("[")[0], caught.exception.low), (field, low), caught.exception.message)
                if kind == "within":
                    self.assertEqual(caught.exception.high, high, caught.exception.message)
                checked += 1
        self.assertGreater(checked, 80)

    def test_ends_of_ranges(self):
        """The loader of scene files accepts both ends of a range and refuses the next number beyond each."""
        checked = 0
        for struct in (one for one in vars(_structs).values() if isinstance(one, type) and getattr(one, "bounds", None)):
            for key, field in fields_of(struct).items():
                if field.bound is None:
                    continue
                kind, low, high = field.bound
                inside = [math.nextafter(low, math.inf)] if kind == "above" else [low, high]
                outside = [low, math.inf] if kind == "above" else [math.nextafter(high, math.inf)]
                outside += [math.nextafter(low, -math.inf)] if low > 0.0 and kind != "above" else []
                for value in inside:
                    self.assertEqual(field.outside(value), "", f"{struct.__name__}.{key} = {value!r}")
                for value in (*outside, math.nan):
                    self.assertIn("must be", field.outside(value), f"{struct.__name__}.{key} = {value!r}")
                checked += 1
        self.assertGreater(checked, 80)

    def test_words_of_keys(self):
        """A key of a scene file has the words of the enumeration by which the list of fields bounds it."""
        checked = 0
        for name in ("lists.h", "options.h"):
            for struct, rows in generate.rows((LISTS / name).read_text(encoding="utf-8")).items():
                known = fields_of(getattr(_structs, generate.class_name(struct)))
                for field, _, bound, arguments in rows:
                    member = getattr(enums, arguments.split(",")[0].removeprefix("DMB_"), None) if bound == "WITHIN" else None
                    if isinstance(member, enum.IntEnum) and known.get(field) is not None:
                        self.assertIs(known[field].enum, type(member), f"{struct}.{field}")
                        checked += 1
        self.assertGreater(checked, 20)

    def test_comments_of_several_members(self):
        for names, text, wanted in ((["a", "b"], "one; two; default 1, 2", ["one; default 1", "two; default 2"]),
                                    (["a", "b"], "of both; default 1", ["of both; default 1"] * 2),
                                    (["a", "b"], "X_...; Y_...", ["X_...", "Y_..."]), (["a"], "one; two", ["one; two"]),
                                    (["a", "reserved"], "one; two", ["one; two"] * 2), (["struct_size", "a", "b"], "one; two", ["one; two", "one", "two"])):
            self.assertEqual(list(generate.texts_of(names, text).values()), wanted)

    def test_defaults_that_are_read(self):
        """The reader of comments itself."""
        for text, wanted in (("x; default 0", [0.0]), ("default (0, 0, -9.81), shape (3)", [0.0, 0.0, -9.81]), ("0 .. ; NOT_GIVEN (default): as outside", [-1.0]),
                             ("PIPE_..., default PIPE_FLEXIBLE", [0.0]), ("mask; default AXIAL and ROTATION", [3.0]), ("none here", []),
                             ("default 1e-3 on the diagonal", [1e-3]), ("default -UNLIMITED and UNLIMITED", [-1e30, 1e30])):
            self.assertEqual(stated(text), wanted, text)


if __name__ == "__main__":
    unittest.main()
