"""Where a ray meets the column and the boxes: against a march of small steps along it."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gestureapp.robot.obstacles import Column, KeepOut, plane_distance

COLUMN = Column(350.0, 800.0)
BOX = KeepOut("fixture", (600.0, -200.0, -300.0), (900.0, 100.0, 50.0))


@st.composite
def units(draw):
    """Directions of length 1, those along the axes among them."""
    parts = draw(st.tuples(*[st.sampled_from([-1.0, 0.0, 1.0]) | st.floats(-1, 1)] * 3))
    length = math.hypot(*parts)
    assume(length > 0.1)
    return tuple(part / length for part in parts)


POINTS = st.tuples(*[st.floats(-1500, 1500)] * 3)
CORNERS = st.tuples(st.floats(-1500, 1500), st.floats(1, 800))


@st.composite
def bodies(draw):
    if draw(st.booleans()):
        return Column(draw(st.floats(1, 1000)), draw(st.floats(-1000, 1000)))
    sides = [draw(CORNERS) for _ in range(3)]
    return KeepOut("x", tuple(low for low, _ in sides), tuple(low + size for low, size in sides))


def on_ray(start, unit, mm):
    return tuple(s + u * mm for s, u in zip(start, unit, strict=True))


@given(POINTS, units(), bodies())
def test_a_body_is_met_where_the_ray_first_comes_into_it(start, unit, body):
    assume(not body.holds(start, 0.01))

    met = body.distance(start, unit)

    # Up to there the ray is outside, but for the skin; there it is on the skin.
    reach = min(met, 6000.0)
    assert not any(body.holds(on_ray(start, unit, reach * i / 300), -0.001) for i in range(300))
    if math.isfinite(met):
        assert met >= 0
        assert body.holds(on_ray(start, unit, met), 0.001)
        assert not body.holds(on_ray(start, unit, met), -0.001)


SHARES = st.floats(0.01, 0.99)


@given(st.tuples(SHARES, SHARES, SHARES), units(), bodies(), st.floats(0, 4000))
def test_a_ray_through_a_place_inside_meets_the_body_before_it(shares, unit, body, mm):
    place = inside(body, shares)
    assert body.holds(place, 0.0)
    start = on_ray(place, unit, -mm)

    assert body.distance(start, unit) <= mm + 1e-6


def inside(body, shares):
    if isinstance(body, KeepOut):
        sides = zip(body.low_mm, body.high_mm, shares, strict=True)
        return tuple(low + (high - low) * share for low, high, share in sides)
    radius, angle = body.radius_mm * shares[0], math.tau * shares[1]
    return (
        radius * math.cos(angle),
        radius * math.sin(angle),
        body.top_mm - 1000 * shares[2],
    )


@pytest.mark.parametrize(
    ("body", "start", "unit", "met"),
    [
        (COLUMN, (800, 0, 300), (-1, 0, 0), 450),
        (COLUMN, (800, 0, 300), (1, 0, 0), math.inf),
        (COLUMN, (800, 350, 300), (-1, 0, 0), 800),  # touches
        (COLUMN, (800, 350.001, 300), (-1, 0, 0), math.inf),
        (COLUMN, (800, 0, 800), (-1, 0, 0), 450),
        (COLUMN, (800, 0, 800.001), (-1, 0, 0), math.inf),  # over it
        (COLUMN, (100, 0, 1000), (0, 0, -1), 200),  # onto it
        (COLUMN, (350.001, 0, 1000), (0, 0, -1), math.inf),
        (COLUMN, (100, 0, 1000), (0, 0, 1), math.inf),
        (COLUMN, (100, 0, 500), (0, 0, 1), 0),  # inside
        (BOX, (750, 0, 300), (0, 0, -1), 250),
        (BOX, (750, 0, 300), (0, 0, 1), math.inf),
        (BOX, (0, 0, 0), (1, 0, 0), 600),
        (BOX, (0, 100, 50), (1, 0, 0), 600),  # along an edge
        (BOX, (0, 100.001, 50), (1, 0, 0), math.inf),
        (BOX, (1000, 0, 0), (1, 0, 0), math.inf),
        (BOX, (700, 0, 0), (1, 0, 0), 0),  # inside
    ],
)
def test_known_rays(body, start, unit, met):
    assert body.distance(start, unit) == met


@pytest.mark.parametrize(
    ("z", "unit", "met"),
    [
        (300, (0, 0, -1), 600),
        (300, (0, 0, 1), math.inf),
        (300, (1, 0, 0), math.inf),
        (-300, (0, 0, -1), math.inf),
        (300, (0.8, 0, -0.6), 1000),
    ],
)
def test_a_plane_is_met_only_on_the_way_to_it(z, unit, met):
    assert plane_distance((0, 0, z), unit, -300.0) == met


@pytest.mark.parametrize(("radius", "top"), [(0, 1), (-1, 1), (math.inf, 1), (1, math.nan)])
def test_a_column_needs_a_size(radius, top):
    with pytest.raises(ValueError, match="column"):
        Column(radius, top)


@pytest.mark.parametrize(
    ("label", "low", "high"),
    [
        ("", (0, 0, 0), (1, 1, 1)),
        ("x", (0, 0, 0), (1, 0, 1)),
        ("x", (0, 2, 0), (1, 1, 1)),
        ("x", (0, 0, -math.inf), (1, 1, 1)),
        ("x", (0, 0, 0), (1, 1, math.nan)),
    ],
)
def test_a_keep_out_needs_a_name_and_a_size(label, low, high):
    with pytest.raises(ValueError, match="keep-out"):
        KeepOut(label, low, high)
