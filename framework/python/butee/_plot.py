"""Pictures by matplotlib."""

from __future__ import annotations

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
