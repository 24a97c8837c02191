"""Pictures by matplotlib."""

from __future__ import annotations

import numpy as np

_UNITS = {"u": "m", "v": "m/s", "a": "m/s²", "contact_force": "N", "theta": "rad", "theta_v": "rad/s", "theta_a": "rad/s²"}


def plot_history(result, columns, axes):
    import matplotlib.pyplot as plt

    names = columns or [name for name in result.columns if name not in ("t", "h")]
    arrays = [result[name] for name in names]
    if axes is None:
        _, axes = plt.subplots(len(names), 1, sharex=True, squeeze=False, figsize=(7.0, 1.2 + 2.0 * len(names)))
        axes = axes[:, 0]
        axes[0].set_title(result.title)
        axes[-1].set_xlabel("t / s")
    for ax, name, array in zip(axes, names, arrays):
        unit = _UNITS.get(name.rpartition(".")[2])
        ax.plot(result.t, array, linewidth=0.8)
        ax.set_ylabel(f"{name} / {unit}" if unit else name)
    return axes


def plot_rows(study, result, axes):
    import matplotlib.pyplot as plt

    values, keys = study[result], study.keys_varied
    if values.dtype.kind == "U" or not keys:
        raise ValueError(f"{result}: is not a result over a key that varies")
    if axes is None:
        _, axes = plt.subplots()
    unit = study.units[result]
    label = f"{result} / {unit}" if unit not in ("", "1") else result
    x = study[keys[0]]
    if x.dtype.kind == "U":
        raise ValueError(f"{keys[0]}: has strings, which cannot be an axis")
    axes.set_xlabel(keys[0])
    if values.ndim > 1:
        axes.plot(np.repeat(x, values.shape[1]), values.ravel(), ".", markersize=1)
    elif "direction" in study.units:
        for direction, name in ((1, "up"), (-1, "down")):
            chosen = study["direction"] == direction
            if chosen.any():
                axes.plot(x[chosen], values[chosen], ".-", label=name)
        axes.legend()
    elif len(keys) == 2 and study[keys[1]].dtype.kind != "U":
        mesh = axes.scatter(x, study[keys[1]], c=values) if _is_spread(x) else _map(axes, x, study[keys[1]], values)
        axes.figure.colorbar(mesh, label=label)
        axes.set_ylabel(keys[1])
        return axes
    else:
        order = np.argsort(x, kind="stable")
        axes.plot(x[order], values[order], ".-" if len(keys) == 1 else ".")
    axes.set_ylabel(label)
    return axes


def _is_spread(x) -> bool:
    return np.unique(x).size == x.size


def _map(axes, x, y, values):
    rows, columns = np.unique(x), np.unique(y)
    field = np.full((columns.size, rows.size), np.nan)
    field[np.searchsorted(columns, y), np.searchsorted(rows, x)] = values
    return axes.pcolormesh(rows, columns, field, shading="nearest")
