#!/usr/bin/env python3
"""Draws conventions.svg: frames, azimuth, inclination and dip, toolface and rotation, forces and numbers of pipes.

usage: draw.py            writes the drawing beside this file
       draw.py --check    exit status 1 if the drawing there is another one
"""
import math
import pathlib
import sys

PLACE = pathlib.Path(__file__).resolve().parent / "conventions.svg"
BLUE, RED, GREEN, GREY = "#1f5fa8", "#b3261e", "#1b7a3d", "#777"


class Panel:
    """A part of the drawing with its origin in the middle; angles clockwise from up, as a compass has them."""

    def __init__(self, parts, x, y, title):
        self.parts, self.x, self.y = parts, x, y
        self.text(0, -128, title, "#111", 15, "bold")

    def place(self, angle, length):
        return length * math.sin(math.radians(angle)), -length * math.cos(math.radians(angle))

    def line(self, a, b, colour, width=2, arrow=False, dash=False):
        more = ' marker-end="url(#tip)"' if arrow else ""
        more += ' stroke-dasharray="5 4"' if dash else ""
        self.parts.append(f'<line x1="{self.x + a[0]:.1f}" y1="{self.y + a[1]:.1f}" x2="{self.x + b[0]:.1f}" '
                          f'y2="{self.y + b[1]:.1f}" '
                          f'stroke="{colour}" stroke-width="{width}"{more}/>')

    def ray(self, angle, length, colour, label, width=2, dash=False):
        self.line((0, 0), self.place(angle, length), colour, width, not dash, dash)
        x, y = self.place(angle, length + 16 + 3.2 * len(label) * abs(math.sin(math.radians(angle))) ** 2)
        self.text(x, y + 4, label, colour)

    def arc(self, start, end, radius, colour, label):
        """Clockwise for end > start."""
        a, b = self.place(start, radius), self.place(end, radius)
        self.parts.append(f'<path d="M {self.x + a[0]:.1f} {self.y + a[1]:.1f} A {radius} {radius} 0 '
                          f'{int(abs(end - start) > 180)} {int(end > start)} '
                          f'{self.x + b[0]:.1f} {self.y + b[1]:.1f}" fill="none" stroke="{colour}" stroke-width="2" '
                          'marker-end="url(#tip)"/>')
        x, y = self.place(0.5 * (start + end), radius + 14 + 3.2 * len(label))
        self.text(x, y + 4, label, colour)

    def circle(self, radius, colour, fill="none", dx=0.0, dy=0.0):
        self.parts.append(f'<circle cx="{self.x + dx:.1f}" cy="{self.y + dy:.1f}" r="{radius}" fill="{fill}" '
                          f'stroke="{colour}" stroke-width="2"/>')

    def text(self, x, y, words, colour="#111", size=13, weight="normal"):
        self.parts.append(f'<text x="{self.x + x:.1f}" y="{self.y + y:.1f}" fill="{colour}" font-size="{size}" '
                          f'font-weight="{weight}" '
                          f'text-anchor="middle">{words}</text>')


def from_above(parts):
    panel = Panel(parts, 165, 165, "Seen from above")
    panel.ray(0, 92, GREY, "x, north")
    panel.ray(270, 80, GREY, "y, west")
    panel.ray(90, 70, GREY, "east", dash=True)
    panel.ray(50, 95, BLUE, "hole", 4)
    panel.arc(4, 46, 60, RED, "")
    panel.text(30, -70, "azimuth", RED)
    panel.circle(5, GREY, GREY)
    panel.text(-24, 24, "z, up, to the reader", GREY)
    panel.text(0, 112, "azimuth 50 deg: clockwise from north")


def from_the_side(parts):
    panel = Panel(parts, 495, 165, "Seen from the side")
    panel.ray(0, 92, GREY, "z, up")
    panel.ray(180, 66, GREY, "down", dash=True)
    panel.ray(90, 100, GREY, "level", dash=True)
    panel.ray(65, 105, BLUE, "hole", 4)
    panel.arc(176, 69, 48, RED, "")
    panel.text(100, 48, "inclination 115 deg", RED)
    panel.arc(88, 68, 84, GREEN, "")
    panel.text(125, -18, "dip +25 deg", GREEN)
    panel.text(0, 112, "dip = inclination - 90 deg; dip &gt; 0 rises")


def from_the_rig(parts):
    panel = Panel(parts, 825, 165, "Seen from the rig, along the hole")
    panel.circle(82, GREY)
    panel.circle(28, BLUE)
    panel.ray(0, 92, GREY, "z, high side")
    panel.ray(270, 92, GREY, "y, left")
    panel.ray(60, 70, GREEN, "")
    panel.text(112, -64, "toolface 60 deg", GREEN)
    panel.arc(4, 56, 46, GREEN, "")
    panel.arc(130, 235, 40, RED, "")
    panel.text(0, 70, "rotation &gt; 0", RED)
    panel.text(0, 112, "all angles clockwise; x points away from the rig")


def along_the_string(parts):
    panel = Panel(parts, 495, 450, "Along the string")
    for number in range(3):
        parts.append(f'<rect x="{panel.x - 270 + 170 * number}" y="{panel.y - 62}" width="160" height="26" '
                     f'fill="#e8eef6" stroke="{BLUE}"/>')
        panel.text(-190 + 170 * number, -44, f"pipe {number}, fraction 0 .. 1", BLUE)
        parts.append(f'<rect x="{panel.x - 110 + 170 * number}" y="{panel.y - 66}" width="10" height="34" '
                     f'fill="{BLUE}"/>')
    panel.text(-335, -44, "rig", "#111", 14, "bold")
    panel.text(270, -44, "bit", "#111", 14, "bold")
    panel.line((-300, -15), (-220, -15), RED, 3, True)
    panel.text(-130, -11, "thrust: hook load &lt; 0", RED)
    panel.line((-220, 12), (-300, 12), GREEN, 3, True)
    panel.text(-140, 16, "pull: hook load &gt; 0", GREEN)
    panel.line((60, -15), (0, -15), GREEN, 3, True)
    panel.line((90, -15), (150, -15), GREEN, 3, True)
    panel.text(235, -11, "tension &gt; 0", GREEN)
    panel.line((0, 12), (60, 12), RED, 3, True)
    panel.line((150, 12), (90, 12), RED, 3, True)
    panel.text(240, 16, "compression &lt; 0", RED)
    panel.text(0, 44,
               "the torque of a section is that of the far side on the near side: negative while a string that turns "
               "clockwise drills")


def drawing():
    """The text of the file."""
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 990 510" font-family="Helvetica, Arial, '
             'sans-serif">',
             '<defs><marker id="tip" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="6" markerHeight="6" '
             'orient="auto-start-reverse">'
             '<path d="M 0 0 L 10 5 L 0 10 z" fill="context-stroke"/></marker></defs>',
             '<rect width="990" height="510" fill="white"/>']
    for panel in (from_above, from_the_side, from_the_rig, along_the_string):
        panel(parts)
    return "\n".join([*parts, "</svg>"]) + "\n"


def main():
    if sys.argv[1:] == ["--check"]:
        return 0 if PLACE.read_text(encoding="utf-8") == drawing() else 1
    PLACE.write_text(drawing(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
