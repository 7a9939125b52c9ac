"""Small drawings in SVG: points of space in a fixed view, and plots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
INK = "currentColor"
WIDTH, HEIGHT = 240.0, 180.0


class Drawing:
    """A drawing around the middle of 240 by 180; space is seen from one side.

    Args:
        centre: (3,) what is in the middle [m].
        scale: pixels a metre.
        azimuth: from where one looks [deg], anticlockwise from x.
        elevation: from how high [deg].
    """

    def __init__(
        self,
        centre: Sequence[float] = (0.0, 0.0, 0.0),
        scale: float = 500.0,
        azimuth: float = -62.0,
        elevation: float = 20.0,
    ) -> None:
        a, b = np.radians([azimuth, elevation])
        right = [-np.sin(a), np.cos(a), 0.0]
        up = [-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)]
        self._view = scale * np.array([right, up]) * [[1.0], [-1.0]]
        self._centre = np.array(centre, dtype=float)
        self._parts: list[str] = []
        self._seen: list[np.ndarray] = []

    def at(self, p: Sequence[float]) -> np.ndarray:
        """Where a point (3,) of space is seen, (2,); points of the page stay."""
        p = np.asarray(p, dtype=float)
        if p.size == 3:
            p = self._view @ (p - self._centre) + [WIDTH / 2.0, HEIGHT / 2.0]
        self._seen.append(p)
        return p

    def line(
        self, points, colour: str = INK, width: float = 1.5, dash: str = "", fill="none"
    ) -> None:
        """A line through points of space or of the page; filled where asked."""
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self.at, points))
        kind = "polyline" if fill == "none" else "polygon"
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self._parts.append(
            f'<{kind} points="{path}" fill="{fill}" fill-opacity="0.16" '
            f'stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" '
            f'stroke-linecap="round"{dashes}/>'
        )

    def arrow(self, start, end, colour: str = ORANGE, width: float = 2.0) -> None:
        """An arrow, if it is long enough to be seen."""
        a, b = self.at(start), self.at(end)
        way = b - a
        length = float(np.linalg.norm(way))
        if length < 3.0:
            return
        way = way / length
        size = min(7.0, 0.6 * length)
        across = np.array([-way[1], way[0]])
        foot = b - size * way
        self.line([a, foot], colour, width)
        self._head(
            [b, foot + 0.45 * size * across, foot - 0.45 * size * across], colour
        )

    def _head(self, points, colour: str) -> None:
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self._parts.append(f'<polygon points="{path}" fill="{colour}"/>')

    def dot(self, p, colour: str = INK, radius: float = 3.5) -> None:
        """A point."""
        x, y = self.at(p)
        self._parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>'
        )

    def ring(self, centre, normal, radius: float, colour: str = BLUE, **style) -> None:
        """A circle in space."""
        n = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
        a = np.cross(n, np.eye(3)[int(np.argmin(np.abs(n)))])
        a /= np.linalg.norm(a)
        b = np.cross(n, a)
        turn = np.linspace(0.0, 2.0 * np.pi, 49)[:, None]
        points = np.asarray(centre) + radius * (np.cos(turn) * a + np.sin(turn) * b)
        self.line(points, colour, **style)

    def text(self, p, words: str, colour: str = INK, anchor: str = "start") -> None:
        """Words."""
        x, y = self.at(p)
        self._parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" font-size="11" fill="{colour}" '
            f'font-family="sans-serif" text-anchor="{anchor}">{words}</text>'
        )

    def svg(self, title: str) -> str:
        """All of it, with a margin."""
        low, high = np.min(self._seen, axis=0) - 14.0, np.max(self._seen, axis=0) + 14.0
        box = f"{low[0]:.0f} {low[1]:.0f} {high[0] - low[0]:.0f} {high[1] - low[1]:.0f}"
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" '
            f'style="width:{(high[0] - low[0]) / 16.0:.1f}em" '
            f'role="img" aria-label="{title}"><title>{title}</title>'
            f"{''.join(self._parts)}</svg>"
        )


class Plot(Drawing):
    """Curves over an axis, in the same space.

    Args:
        x: least and largest abscissa.
        y: least and largest ordinate.
        names: of the two axes.
    """

    def __init__(self, x, y, names: tuple[str, str]) -> None:
        super().__init__()
        self._x, self._y = x, y
        left, right, top, bottom = 34.0, 228.0, 20.0, 150.0
        self._box = left, right, top, bottom
        self.line([(left, top), (left, bottom), (right, bottom)], width=1.0)
        self.text((right, bottom + 24.0), names[0], anchor="end")
        self.text((left - 20.0, top - 8.0), names[1])
        for value in x:
            place = self.point(value, y[0])
            self.text((place[0], bottom + 12.0), f"{value:g}", anchor="middle")
        for value in y:
            place = self.point(x[0], value)
            self.text((left - 4.0, place[1] + 4.0), f"{value:g}", anchor="end")

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Where a value is on the page."""
        left, right, top, bottom = self._box
        u = (x - self._x[0]) / (self._x[1] - self._x[0])
        w = (y - self._y[0]) / (self._y[1] - self._y[0])
        return left + u * (right - left), bottom + w * (top - bottom)

    def curve(self, x, y, colour: str = BLUE, **style) -> None:
        """A curve."""
        self.line(
            [self.point(a, b) for a, b in zip(x, y, strict=True)], colour, **style
        )
