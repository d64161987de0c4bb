"""Names of units: those of the SI and those of the trade, with the factor to SI and the powers of metre, kilogram,
second and radian. A line is: names, value, names of the unit that the value counts, prefixes. The first name is the
usual one."""
from __future__ import annotations

import functools
from dataclasses import dataclass
from decimal import Decimal

Powers = tuple[float, float, float, float]  # of m, kg, s, rad

PI = Decimal("3.14159265358979323846264338327950288419716939937511")
GRAVITY = Decimal("9.80665")  # [m/s2] standard gravity, ISO 80000-3

_PREFIXES = {"n": "1e-9", "μ": "1e-6", "u": "1e-6", "m": "1e-3", "c": "1e-2", "d": "1e-1", "da": "10", "h": "1e2",
             "k": "1e3",
             "M": "1e6", "G": "1e9", "nano": "1e-9", "micro": "1e-6", "milli": "1e-3", "centi": "1e-2", "kilo": "1e3",
             "mega": "1e6", "giga": "1e9", "千": "1e3", "兆": "1e6", "毫": "1e-3", "厘": "1e-2", "微": "1e-6"}
_WORDS = ("nano", "micro", "milli", "centi", "kilo", "mega", "giga")

# Prefixes: those that exist; of these, in front of "!", those that are tried where capitals are wrong.
_TABLE = """
m metre meter metres meters mtr | 1 | m | k c m ! n μ u d
米 | 1 | m | 千 厘 毫 ! 微
in inch inches ins ″ 英寸 吋 | 0.0254 | m |
ft foot feet ′ 英尺 呎 | 0.3048 | m | k
usft ftUS US_ft survey_foot | 1200/3937 | m |
yd yard yards 码 | 0.9144 | m |
mi mile miles | 1609.344 | m |
mil mils thou | 2.54e-5 | m |
g gram grams gramme grammes | 0.001 | kg | k m ! n μ u c d M
kg kilogramme kilogrammes kilos kgs 公斤 千克 | 1 | kg |
t tonne tonnes metric_ton metric_tons metric_tonne metric_tonnes 吨 | 1000 | kg |
short_ton short_tons ton_US US_ton | 907.18474 | kg |
long_ton long_tons ton_UK UK_ton | 1016.0469088 | kg |
lb lbs lbm lbms pound pounds # 磅 | 0.45359237 | kg | k
oz ounce ounces | 0.028349523125 | kg |
slug slugs | 14.593902937206364829 | kg |
s sec secs second seconds 秒 | 1 | s | m ! n μ u
min mins minute minutes мин 分 分钟 | 60 | s |
h hr hrs hour hours 时 小时 | 3600 | s |
d day days 天 | 86400 | s |
rad radian radians 弧度 | 1 | rad | m ! n μ u
deg degr degs degree degrees ° 度 | pi/180 | rad | m
arcmin | pi/10800 | rad |
arcsec | pi/648000 | rad |
gon grad grads | pi/200 | rad |
rev revs revolution revolutions turn turns r U об 转 | 2 pi | rad |
rpm 转每分 | pi/30 | rad s-1 |
rps | 2 pi | rad s-1 |
Hz hertz 赫兹 赫 | 1 | s-1 | k ! m M
N newton newtons | 1 | kg m s-2 | k da M ! n μ u m c d h G
daN | 10 | kg m s-2 | k
牛 牛顿 | 1 | kg m s-2 | 千 兆
kgf kilogramforce kp kilopond 公斤力 千克力 | g | kg m s-2 |
gf | 0.001 g | kg m s-2 |
tf tonne_force 吨力 | 1000 g | kg m s-2 |
lbf lbfs pound_force | 0.45359237 g | kg m s-2 | k
kip kips | 453.59237 g | kg m s-2 |
dyn dyne | 1e-5 | kg m s-2 |
Pa pascal | 1 | kg m-1 s-2 | k M G ! n μ u m h d c
帕 帕斯卡 | 1 | kg m-1 s-2 | 千 兆
bar bars 巴 | 1e5 | kg m-1 s-2 | m ! k
psi psig psia | 0.45359237 g/0.00064516 | kg m-1 s-2 | k M
ksi | 453.59237 g/0.00064516 | kg m-1 s-2 |
atm | 101325 | kg m-1 s-2 |
mmHg | 133.322387415 | kg m-1 s-2 |
J joule | 1 | kg m2 s-2 | k M ! m
W watt | 1 | kg m2 s-3 | k M ! m
hp | 550 0.3048 0.45359237 g | kg m2 s-3 |
l L liter litre liters litres ltr 升 | 0.001 | m3 | m ! c d h
cc | 1e-6 | m3 |
cbm 立方米 方 | 1 | m3 |
平方米 | 1 | m2 |
gal gals gallon gallons USgal USgallon USgallons USG | 0.003785411784 | m3 | k
UKgal UKgallon UKgallons impgal | 0.00454609 | m3 |
bbl bbls barrel barrels | 0.158987294928 | m3 | k
ppg ppga | 0.45359237/0.003785411784 | kg m-3 |
pcf | 0.45359237/0.028316846592 | kg m-3 |
ppf plf | 0.45359237/0.3048 | kg m-1 |
sg specific_gravity | 1000 | kg m-3 |
gpm USgpm | 0.003785411784/60 | m3 s-1 |
lpm slpm | 0.001/60 | m3 s-1 |
bpm | 0.158987294928/60 | m3 s-1 |
fph | 0.3048/3600 | m s-1 |
fpm | 0.3048/60 | m s-1 |
mph | 1609.344/3600 | m s-1 |
P poise | 0.1 | kg m-1 s-1 | c
percent pct % | 0.01 | |
permil ‰ | 0.001 | |
ppm | 1e-6 | |
unit | 1 | |
"""

# Written without a sign between: "kNm", "ftlbf".
_TOGETHER = (("N", "kN", "daN", "MN", "mN", "kgf", "牛", "千牛"), ("m", "mm", "米"))
_TOGETHER_BRITISH = (("lb", "lbs", "lbf", "klb", "klbf", "kip"), ("ft", "in", "kft"))

REFUSED = {word: "may be a tonne (1000 kg), a short ton (907 kg, US) or a long ton (1016 kg, UK); write tonne, "
                 "short_ton or "
                 "long_ton" for word in ("ton", "tons", "kton", "tonf", "ton_force", "tonsf")}

# Examples for messages, by what is wanted.
USUAL = {"m": ("mm", "cm", "m", "in", "ft"), "N": ("N", "kN", "daN", "kgf", "tf", "lbf", "klbf"),
         "N m": ("N m", "kN m", "daN m", "kgf m", "ft lbf", "kft lbf", "in lbf"),
         "kg/m3": ("kg/m3", "g/cm3", "sg", "ppg", "lb/ft3"), "kg/m": ("kg/m", "lb/ft", "ppf"),
         "kg": ("kg", "g", "t", "lb"),
         "Pa": ("Pa", "kPa", "MPa", "GPa", "bar", "psi", "ksi", "kgf/cm2"),
         "rad/s": ("rpm", "r/min", "rev/s", "rad/s", "deg/s"),
         "m3/s": ("l/min", "l/s", "m3/h", "m3/min", "gpm", "bbl/min"),
         "m/s": ("m/s", "mm/s", "m/min", "m/h", "ft/min", "ft/h"),
         "rad": ("deg", "rad", "gon"), "s": ("ms", "s", "min", "h"), "Hz": ("Hz", "1/s", "1/min"),
         "rad/m": ("deg/30 m", "deg/100 ft", "rad/m"), "N/m": ("N/m", "kN/m", "N/mm", "lbf/in"),
         "Pa s": ("Pa s", "mPa s", "cP"),
         "m3": ("m3", "l", "gal", "bbl"), "m2": ("mm2", "cm2", "m2", "in2")}


@dataclass(frozen=True)
class Unit:
    """A unit: its factor to SI and the powers of m, kg, s, rad."""
    factor: Decimal
    powers: Powers

    def times(self, other: Unit, power: float = 1.0) -> Unit:
        """Its product with a power of another one."""
        whole = int(power) if power == int(power) else None
        factor = self.factor * (other.factor ** (Decimal(power) if whole is None else whole))
        a, b = self.powers, other.powers
        return Unit(factor, (a[0] + power * b[0], a[1] + power * b[1], a[2] + power * b[2], a[3] + power * b[3]))


NOTHING = Unit(Decimal(1), (0.0, 0.0, 0.0, 0.0))


def _value(text: str) -> Decimal:
    """A product with at most one quotient."""
    above, _, below = text.partition("/")
    found = Decimal(1)
    for word in above.split():
        found *= {"pi": PI, "g": GRAVITY}.get(word) or Decimal(word)
    return found / Decimal(below) if below else found


def _powers(text: str) -> Powers:
    found = {"m": 0.0, "kg": 0.0, "s": 0.0, "rad": 0.0}
    for word in text.split():
        name = word.rstrip("-0123456789")
        found[name] = float(word[len(name):] or 1)
    return found["m"], found["kg"], found["s"], found["rad"]


@functools.lru_cache(maxsize=1)
def tables() -> tuple[dict[str, Unit], dict[str, dict[str, tuple[Unit, str]]]]:
    """All units by their names; and by their names in small letters those that wrong capitals may mean, each with
    the prefix that must be right ("mpa" may be mPa, "Mpa" may not)."""
    exact: dict[str, Unit] = {}
    loose: dict[str, dict[str, tuple[Unit, str]]] = {}
    lines = [[part.strip() for part in line.split("|")] for line in _TABLE.strip().splitlines()]
    for names, value, counts, _ in lines:
        unit = Unit(_value(value), _powers(counts))
        for name in names.split():
            exact[name] = unit
            loose.setdefault(name.casefold(), {})[name] = unit, ""
    for names, _, _, prefixes in lines:
        usual, _, rare = prefixes.partition("!")
        for prefix in [*usual.split(), *(_WORDS if usual else ()), *rare.split()]:
            for name in names.split():
                base = exact[name]
                if prefix + name not in exact:
                    unit = Unit(Decimal(_PREFIXES[prefix]) * base.factor, base.powers)
                    exact[prefix + name] = unit
                    loose.setdefault((prefix + name).casefold(),
                                     {})[prefix + name] = unit, prefix if prefix in rare.split() else ""
    _add_together(exact, loose)
    return exact, loose


def _add_together(exact: dict[str, Unit], loose: dict[str, dict[str, tuple[Unit, str]]]) -> None:
    pairs = [(a, b) for a in _TOGETHER[0] for b in _TOGETHER[1]]
    for a in _TOGETHER_BRITISH[0]:
        pairs += [pair for b in _TOGETHER_BRITISH[1] for pair in ((a, b), (b, a))]
    for a, b in pairs:
        if a + b not in exact:
            exact[a + b] = exact[a].times(exact[b])
            loose.setdefault((a + b).casefold(), {})[a + b] = exact[a + b], ""
