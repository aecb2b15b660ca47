"""Draws pairs of measured values as SVG, in the size and the look of the plots of common/image/plot.cpp."""
import html
import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 400, 190, 615, 62, 368
MARGIN = 65  # pixels between the axis and the dots, for the values beside the dots
COLORS = ("#0072b2", "#d55e00")


def text(x, y, words, **attributes):
    extra = "".join(f' {key.replace("_", "-")}="{value}"' for key, value in attributes.items())
    return f'<text x="{x:.1f}" y="{y:.1f}"{extra}>{html.escape(words, quote=False)}</text>'


def dot(x, y, color):
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="{color}"/>'


def pairs(title, names, unit, rows):
    """Returns an SVG with a row for each (label, (a, b)): two dots on a logarithmic axis, so that their distance is the
    ratio. `names` say what the first and the second dots are. Values are written as `unit(value)`."""
    values = [value for _, pair in rows for value in pair]
    low, high = math.log10(min(values)), math.log10(max(values))

    def place(value):
        return LEFT + MARGIN + (math.log10(value) - low) / (high - low) * (RIGHT - LEFT - 2 * MARGIN)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
             f'viewBox="0 0 {WIDTH} {HEIGHT}" role="img" fill="#222" font-size="15" '
             'font-family="Helvetica, Arial, \'DejaVu Sans\', sans-serif">',
             f"<title>{html.escape(title)}</title>", '<rect width="100%" height="100%" fill="white"/>',
             text(12, 26, title, font_size=17, font_weight="bold")]
    for i, name in enumerate(names):
        x = LEFT + 10 + i * (RIGHT - LEFT) / 2
        parts += [dot(x, 46, COLORS[i]), text(x + 12, 51, name)]
    for power in range(math.floor(low), math.ceil(high) + 1):
        x = place(10 ** power)
        if LEFT <= x <= RIGHT:
            parts += [f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{BOTTOM}" stroke="#ccc"/>',
                      text(x, BOTTOM + 20, unit(10 ** power), text_anchor="middle", fill="#444")]
    for i, (label, pair) in enumerate(rows):
        y = TOP + (i + 0.5) * (BOTTOM - TOP) / len(rows)
        left, right = sorted(map(place, pair))
        parts += [text(LEFT - 10, y + 5, label, text_anchor="end"),
                  f'<line x1="{left:.1f}" y1="{y:.1f}" x2="{right:.1f}" y2="{y:.1f}" stroke="#888" stroke-width="2"/>',
                  text(left - 12, y + 5, unit(min(pair)), text_anchor="end", font_size=13),
                  text(right + 12, y + 5, unit(max(pair)), font_size=13)]
        parts += [dot(place(value), y, COLORS[j]) for j, value in enumerate(pair)]
    return "\n".join([*parts, "</svg>", ""])
