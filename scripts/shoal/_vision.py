"""What a fish sees of the others: those within range and field of view that no body hides, with the errors of an eye."""

from __future__ import annotations

from typing import Mapping

import numpy as np

from ._library import CaseError, choice_of, kind, number_of, numbers_of

_USUAL = {"range": 5.0, "angle": 300.0, "noise": (0.0, 0.0), "occlusion": True}


def _crosses(eye, points, start, end):
    """Whether each line of sight from the eye to one of points (n, 2) crosses one of the edges start, end (m, 2)."""
    def side(a, b, c):
        return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])

    points, start, end = points[:, None], start[None], end[None]
    return ((side(eye, points, start) * side(eye, points, end) < 0)
            & (side(start, end, eye) * side(start, end, points) < 0)).any(axis=1)


class Vision:
    """An eye at the nose of a fish.

    range: how far it sees, in body lengths. angle: its field of view, degree, symmetric about the heading; the rest is the
    blind zone behind. noise: standard deviations of the distance, as a fraction of it, and of the direction, rad.
    occlusion: whether bodies hide what is behind them. The centre line of a body stands for the body: a fish is seen if the
    eye sees at least one of its nodes.
    """

    def __init__(self, wanted):
        wanted = {} if wanted is None else wanted
        if not isinstance(wanted, Mapping):
            raise TypeError(f'vision is a dict {{"range": 5, "angle": 300}}, not {kind(wanted)}')
        for name in wanted:
            choice_of(name, list(_USUAL), "vision: a property")
        values = {**_USUAL, **wanted}
        self.range, self.angle = number_of(values["range"], "vision: range"), number_of(values["angle"], "vision: angle")
        self.noise = numbers_of(values["noise"], "vision: noise")
        self.occlusion = values["occlusion"]
        if not self.range > 0:
            raise CaseError(f"vision: range is a distance above 0, in lengths, not {self.range:g}")
        if not 0 < self.angle <= 360:
            raise CaseError(f"vision: angle is above 0 and at most 360 degrees, not {self.angle:g}")
        if self.noise.shape != (2,) or not np.all(np.isfinite(self.noise)) or np.any(self.noise < 0):
            raise CaseError("vision: noise is two numbers from 0, of the distance (a fraction of it) and of the direction "
                            f"(rad), not {values['noise']!r}")
        if not isinstance(self.occlusion, bool):
            raise CaseError(f"vision: occlusion is True or False, not {self.occlusion!r}")

    def sees(self, eye, heading, length, bodies, j):
        """Whether the eye (2,), m, which looks along heading, rad, sees body j of bodies, each (n, 2), m. bodies[j] is None
        for the fish whose eye it is."""
        way = bodies[j] - eye
        away = np.abs((np.arctan2(way[:, 1], way[:, 0]) - heading + np.pi) % (2 * np.pi) - np.pi)
        seen = (np.hypot(way[:, 0], way[:, 1]) <= self.range * length) & (away <= np.radians(self.angle) / 2)
        if self.occlusion:
            for k, body in enumerate(bodies):
                if body is not None and k != j and seen.any():
                    seen[seen] = ~_crosses(eye, bodies[j][seen], body[:-1], body[1:])
        return bool(seen.any())

    def look(self, eye, heading, length, bodies, places, headings, random):
        """What the eye sees of each body that is not None, (n, 5): 1 if it is seen and 0 if not; its centre of mass
        relative to the eye, forwards and to the left, in lengths; cosine and sine of its heading relative to the own. A
        fish that is not seen has five zeros. places (n, 2), m, and headings (n), rad, are those of all fish."""
        seen = []
        for j, body in enumerate(bodies):
            if body is None:
                continue
            # draw for every fish, so that what is seen of one does not depend on whether another is seen
            error = self.noise * random.standard_normal(2)
            if not self.sees(eye, heading, length, bodies, j):
                seen.append((0, 0, 0, 0, 0))
                continue
            way = places[j] - eye
            distance = np.hypot(*way) / length * (1 + error[0])
            direction = np.arctan2(way[1], way[0]) - heading + error[1]
            turned = headings[j] - heading
            seen.append((1, distance * np.cos(direction), distance * np.sin(direction), np.cos(turned), np.sin(turned)))
        return np.array(seen, float).reshape(-1, 5)
