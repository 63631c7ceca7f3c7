"""Writes the drawings of the gestures as SVG files beside this one: ``python draw.py``.

The shapes are those that the application paints (``ui/arm_figure.py``), at the end of the movement.
The colours are the theme's; a viewer that is asked for a dark scheme gets the dark ones.
"""

from pathlib import Path

from ui.arm_figure import FIGURES, Look, Shape, box_of, figure, words_of
from ui.theme import DARK, LIGHT, Colours, mixed

HERE = Path(__file__).resolve().parent
_PX_PER_M = 1000.0
_MARGIN_PX = 12.0


def file_name(name: str) -> str:
    """The file of a figure: ``x-plus.svg``, ``left-start.svg``."""
    for sign, word in (("+", "-plus"), ("-", "-minus")):
        if name.endswith(sign):
            return f"{name[:-1].lower()}{word}.svg"
    return f"{name.replace(' ', '-')}.svg"


def svg_of(name: str) -> str:
    """The drawing of a figure as the text of an SVG file.

    Raises:
        KeyError: nothing of this name can be drawn.
    """
    box = box_of(name)
    width = (box.right - box.left) * _PX_PER_M + 2 * _MARGIN_PX
    height = (box.top - box.bottom) * _PX_PER_M + 2 * _MARGIN_PX
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        'role="img" stroke-linejoin="round">',
        f"<title>{name}: {words_of(name)}</title>",
        f"<style>{_style(LIGHT)}@media (prefers-color-scheme: dark){{{_style(DARK)}}}</style>",
    ]
    lines += [_line(shape, box.left, box.top) for shape in figure(name, 1.0)]
    return "\n".join([*lines, "</svg>", ""])


def _line(shape: Shape, left: float, top: float) -> str:
    corners = " ".join(
        f"{(x - left) * _PX_PER_M + _MARGIN_PX:.1f},{(top - y) * _PX_PER_M + _MARGIN_PX:.1f}"
        for x, y in shape.points
    )
    element = "polyline" if shape.look is Look.EDGE else "polygon"
    return f'<{element} class="{shape.look.value}" points="{corners}"/>'


def _style(colours: Colours) -> str:
    text, base, line, panel = colours.text, colours.base, colours.line, colours.panel
    rules = {
        Look.FLOOR: ("none", line, 1),
        Look.SHADOW: (mixed(line, panel, 0.35).name(), "none", 0),
        Look.GHOST: (mixed(line, panel, 0.2).name(), line, 3),
        Look.SKIN: (base, text, 4),
        Look.SIDE: (mixed(line, base, 0.5).name(), "none", 0),
        Look.EDGE: ("none", text, 2),
        Look.SENSOR: (text, base, 2),
        Look.ARROW: (colours.info, base, 2),
    }
    return "".join(
        f".{look.value}{{fill:{fill};stroke:{stroke};stroke-width:{width}}}"
        for look, (fill, stroke, width) in rules.items()
    )


def main() -> None:
    """Write them all."""
    for name in FIGURES:
        (HERE / file_name(name)).write_text(svg_of(name), encoding="utf-8")


if __name__ == "__main__":
    main()
