"""Factors to a panel that turns through 12 angles; only what it may change is computed anew: turned_panel.py"""

import numpy as np

import exactff

# A floor of 4 x 4 tiles, lamps above two corners, and a panel that turns about a vertical axis at the third.
tiles = [[[x, y, 0], [x + 1, y, 0], [x + 1, y + 1, 0], [x, y + 1, 0]] for x in range(4) for y in range(4)]
lamps = [[[x, y, 3], [x, y + 1, 3], [x + 1, y + 1, 3], [x + 1, y, 3]] for x, y in ((0, 0), (3, 0))]
names = [f"tile{i}" for i in range(16)] + ["lamp0", "lamp1", "panel"]


def corners(angle):
    along = 0.6 * np.array([np.cos(angle), np.sin(angle), 0])
    low, high = np.array([3, 3, 0.5]), np.array([3, 3, 2.5])
    return [low - along, low + along, high + along, high - along]


def scene(angle):
    shape = np.array([*tiles, *lamps, corners(angle)], float)
    return exactff.Scene(shape.reshape(-1, 3), np.arange(shape.size // 3).reshape(-1, 4), range(19), names)


def may_enter(a, b, box):  # whether a box meets the box around all sight between two patches: else the factor is the same
    both = np.concatenate([a, b])
    return (both.min(0) < box.max(0)).all() and (box.min(0) < both.max(0)).all()


sweep, shapes = np.linspace(0, np.pi, 12, endpoint=False), [np.array(s, float) for s in [*tiles, *lamps]]
factors, kept = {}, 0
for before, angle in zip([None, *sweep], sweep):
    room = scene(angle)
    touched = np.array(corners(angle) if before is None else [*corners(before), *corners(angle)])
    for i, j in ((i, j) for i in range(16) for j in (16, 17)):
        keep = before is not None and not may_enter(shapes[i], shapes[j], touched)
        kept += keep
        factors[i, j] = factors[i, j] if keep else exactff.view_factor(room, names[i], names[j], 1e-4).value
    print(f"{np.degrees(angle):5.1f} degrees: {sum(factors.values()) / 16:.6f} of the tiles' light reaches the lamps")
print(f"{kept} of {11 * 32} factors were kept")
