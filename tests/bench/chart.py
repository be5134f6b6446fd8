#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""chart.py SVG <MARKS: run time against error, as pareto.c has noted it: panels of named marks over the same logarithmic axes.

A line of MARKS is "panel<tab>name<tab>x<tab>y<tab>high": a full mark at y, a hollow one at `high`, with a bar between them; what is
not positive and finite is not shown. Colours are O. Okabe's and K. Ito's, which colour-blind readers can tell apart; marks differ in
shape as well. A name is put where it covers no mark, bar or other name: beside its mark, below or above it; red where there is no
such place.
"""
import math
import sys

WIDTH, LEFT, RIGHT, TOP, TITLE, HEIGHT, GAP, NAME_LINE = 1020, 80, 1000, 60, 26, 270, 30, 15
LETTER = 6.6  # the width of a letter of a name, in its 11 pixels: the average of a wide font, DejaVu Sans
COLOURS = ('#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000', '#999999', '#8c564b', '#6a3d9a', '#b15928',
           '#e31a1c')
TITLES = ('calls: arrays in, arrays out', 'runs: from file to file')


def shown(value):
    return math.isfinite(value) and value > 0


class Axis:
    def __init__(self, values, begin, end):
        values = [value for value in values if shown(value)] or [1]
        self.low, self.high = 10 ** math.floor(math.log10(min(values))), 10 ** math.ceil(math.log10(max(values)))
        self.high *= 10 if self.low == self.high else 1
        self.begin, self.end = begin, end

    def place(self, value):
        return self.begin + math.log10(value / self.low) / math.log10(self.high / self.low) * (self.end - self.begin)


def label(x, y, attributes, text):
    print('<text x="%.0f" y="%.0f" %s>%s</text>' % (x, y, attributes, text.replace('&', '&amp;').replace('<', '&lt;')), file=out)


def draw_ticks(axis, vertical, across):
    decades = math.log10(axis.high / axis.low)
    step = 10 if decades > 24 else 5 if decades > 12 else 2 if decades > 8 else 1
    for i in range(int(decades + 0.5) // step + 1):
        value = axis.low * 10 ** (i * step)
        at, text = axis.place(value), ('%.0e' if value < 0.009 or value > 2000 else '%g') % value
        if vertical:
            print('<path class="grid" d="M%d %.1fH%d"/>' % (across.begin, at, across.end), file=out)
            label(across.begin - 6, at + 4, 'text-anchor="end"', text)
        else:
            print('<path class="grid" d="M%.1f %dV%d"/>' % (at, across.end, across.begin), file=out)
            label(at, across.begin + 16, 'text-anchor="middle"', text)


def draw_mark(x, y, shape, hollow, colour):
    r, style = (3.5, 'fill="#fff" stroke="%s"' % colour) if hollow else (4.5, 'fill="%s"' % colour)
    if shape % 4 == 0:
        print('<circle cx="%.1f" cy="%.1f" r="%.1f" %s/>' % (x, y, r, style), file=out)
    elif shape % 4 == 1:
        print('<path d="M%.1f %.1fh%.1fv%.1fh%.1fz" %s/>' % (x - r, y - r, 2 * r, 2 * r, -2 * r, style), file=out)
    elif shape % 4 == 2:
        print('<path d="M%.1f %.1fl%.1f %.1fh%.1fz" %s/>' % (x, y - r - 1, r + 1, 2 * r + 1, -2 * r - 2, style), file=out)
    else:
        print('<path d="M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz" %s/>' % (
            x, y - r - 1, r + 1, r + 1, -r - 1, r + 1, -r - 1, -r - 1, style), file=out)


def draw_marks(places, number, taken):
    colour, (_, x, y, top) = COLOURS[number % len(COLOURS)], places
    if top is not None:
        print('<path stroke="%s" stroke-opacity="0.4" d="M%.1f %.1fV%.1f"/>' % (colour, x, y, top), file=out)
        draw_mark(x, top, number, True, colour)
        taken.append((x - 6, top - 6, x + 6, top + 6))
    draw_mark(x, y, number, False, colour)
    taken += [(x - 6, y - 6, x + 6, y + 6), (x - 1, y if top is None else top, x + 1, y)]


def draw_name(places, right, top_edge, bottom_edge, taken):
    """In a row from its mark: 0 is beside it, 1 and 2 are below, -1 and -2 above the bar."""
    name, x, y, top = places
    width = LETTER * len(name)
    for row in (0, 1, -1, 2, -2):
        at = (y if row >= 0 or top is None else top) + NAME_LINE * row
        aside = -4 if row else 9
        for place, left, anchor in ((x + aside, x + aside, ''), (x - aside, x - aside - width, ' text-anchor="end"')):
            box = left, at - 6.5, left + width, at + 6.5
            if (box[0] >= LEFT + 2 and box[2] <= right and box[1] >= top_edge and box[3] <= bottom_edge and not any(
                    box[0] < b[2] and b[0] < box[2] and box[1] < b[3] and b[1] < box[3] for b in taken)):
                label(place, at + 4, 'font-size="11"' + anchor, name)
                taken.append(box)
                return
    label(x, y + NAME_LINE, 'font-size="11" fill="#d00"', name)


def draw_panel(title, marks, top, bottom):
    ax, ay = Axis([mark[2] for mark in every], LEFT, RIGHT), Axis([value for mark in every for value in mark[3:]], bottom, top)
    draw_ticks(ax, False, ay)
    draw_ticks(ay, True, ax)
    print('<path fill="none" stroke="#333" d="M%d %dV%dH%d"/>' % (LEFT, top, bottom, RIGHT), file=out)
    label(LEFT, top - 8, 'font-weight="bold"', title)
    taken, placed = [], []
    for number, (name, x, y, high) in enumerate(marks):
        if shown(x) and shown(y):
            placed.append((number, (name, ax.place(x), ay.place(y), ay.place(high) if shown(high) else None)))
    for number, places in placed:
        draw_marks(places, number, taken)
    for _, places in placed:
        draw_name(places, RIGHT, top, bottom, taken)


every = [[float(word) if i > 1 else word for i, word in enumerate(line.rstrip('\n').split('\t'))] for line in sys.stdin]
height = TOP + len(TITLES) * (TITLE + HEIGHT + GAP)
with open(sys.argv[1], 'w', encoding='utf-8') as out:
    print('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">\n'
          '<style>.grid{stroke:#ddd}</style>\n<rect width="100%%" height="100%%" fill="#fff"/>' % (
              (WIDTH, height + 30) * 2), file=out)
    label(LEFT, 24, 'font-size="16"', "Run time against the error of a normal map's round trip")
    label(LEFT, 44, 'fill="#555" font-size="11"', 'One thread, a map of 16 bits. Full marks: median, hollow ones: 99.9 % of the points. '
          'Left and low is good.')
    top = TOP
    for number, title in enumerate(TITLES):
        top += TITLE
        draw_panel(title, [mark[1:] for mark in every if mark[0] == str(number)], top, top + HEIGHT)
        label(20, top + HEIGHT / 2, 'text-anchor="middle" transform="rotate(-90 20 %d)"' % (top + HEIGHT // 2), 'degrees')
        top += HEIGHT + GAP
    label((LEFT + RIGHT) / 2, height + 10, 'text-anchor="middle"', 'nanoseconds a triangle')
    print('</svg>', file=out)
