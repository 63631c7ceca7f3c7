"""Where names stand in a drawing: beside what they name, in sight, over as little as can be."""

from collections.abc import Iterable, Iterator

from PySide6.QtCore import QRectF, QSizeF

NAME_LENGTH = 12
"""Letters of a name at the most; the whole name stands in the tooltip."""
_GAP_PX = 2
_GRAVE = 20.0
"""A name over another name or over the tool counts this much more than one over a box."""


def short_name(name: str) -> str:
    """A name in at most ``NAME_LENGTH`` letters, with an ellipsis where it was cut."""
    return name if len(name) <= NAME_LENGTH else f"{name[: NAME_LENGTH - 1].rstrip()}…"


def beside(size: QSizeF, box: QRectF, view: QRectF) -> Iterator[QRectF]:
    """Places for a name above, below, right and left of a box, the best first; all in the view.

    Args:
        size: Of the name, px.
        box: What it names, px.
        view: What can be seen, px.
    """
    seen = box.intersected(view)
    width, height = size.width(), size.height()
    middle = seen.center()
    for y in (seen.top() - _GAP_PX - height, seen.bottom() + _GAP_PX):
        for x in (middle.x() - width / 2, seen.left(), seen.right() - width):
            yield _inside(QRectF(x, y, width, height), view)
    for x in (seen.right() + _GAP_PX, seen.left() - _GAP_PX - width):
        for y in (middle.y() - height / 2, seen.top(), seen.bottom() - height):
            yield _inside(QRectF(x, y, width, height), view)


def within(size: QSizeF, area: QRectF, view: QRectF, apart_px: float) -> Iterator[QRectF]:
    """Places inside an area, right and left of the view's middle; all in the view.

    Args:
        size: Of the name, px.
        area: What it names, px.
        view: What can be seen, px.
        apart_px: How far from the middle, where the axis is.
    """
    width, height = size.width(), size.height()
    y = area.intersected(view).center().y() - height / 2
    for x in (view.center().x() + apart_px, view.center().x() - apart_px - width):
        yield _inside(QRectF(x, y, width, height), view)


def best_place(
    places: Iterable[QRectF], kept_free: Iterable[QRectF], boxes: Iterable[QRectF]
) -> QRectF:
    """The place that covers least; the first of those that are alike.

    Args:
        places: To choose from; at least one.
        kept_free: Other names and the tool.
        boxes: What had better be seen, too.
    """
    kept_free, boxes = list(kept_free), list(boxes)

    def cost(place: QRectF) -> float:
        return _GRAVE * _covered(place, kept_free) + _covered(place, boxes)

    return min(places, key=cost)


def _covered(place: QRectF, areas: Iterable[QRectF]) -> float:
    common = (place.intersected(area) for area in areas)
    return sum(each.width() * each.height() for each in common)


def _inside(place: QRectF, view: QRectF) -> QRectF:
    left = max(view.left(), min(place.left(), view.right() - place.width()))
    top = max(view.top(), min(place.top(), view.bottom() - place.height()))
    return QRectF(left, top, place.width(), place.height())
