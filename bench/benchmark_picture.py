"""Draws error against time of a step: every engine and every integrator in one plot."""

import textwrap

import matplotlib

matplotlib.use("Agg")  # no screen
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import patheffects, ticker  # noqa: E402

OURS = "rigid_body_sim"
# After Paul Tol's "bright" and "muted" colours (2021): one an engine, ours black.
COLOURS = {"rigid_body_sim": "#000000", "Bullet": "#CC3311", "ODE": "#0077BB", "MuJoCo": "#117733",
           "DART": "#AA4499", "Simbody": "#B8720B"}
LEAST = 1e-16  # no error of exactly nothing on a logarithmic axis
LOST = 0.3  # rad
HALO = [patheffects.withStroke(linewidth=3, foreground="white")]


def colour(way):
    return COLOURS.get(way[0].split(" ")[0], "#555555")


def label(way):
    if way[0] == OURS:
        return way[1]
    engine = way[0].split(" ")
    return " ".join([engine[0], *engine[2:]]) + ", " + way[1]


def apart(places, least):
    """The places, moved as little as it takes to be `least` apart."""
    order, moved = np.argsort(places), np.array(places, dtype=float)
    for _ in range(500):
        for a, b in zip(order, order[1:]):
            gap = moved[b] - moved[a]
            if gap < least:
                moved[a] -= (least - gap) / 2
                moved[b] += (least - gap) / 2
    return moved


def points(results):
    """(way, ns, error) of the ways that are drawn; of Simulator none, as it is the same rungs."""
    return [(way, results.time(way), max(results.error(way), LEAST)) for way in results.ways
            if results.time(way) and results.error(way) is not None and "Simulator" not in way[1]
            and way[1] != "bare loop"]


def draw_ways(axes, results, ways):
    for way, time, error in ways:
        finer = results.finer(way)
        best = min(range(len(finer)), key=lambda k: finer[k][1])
        finer = finer[:best + 1]  # from there on rounding grows
        axes.plot([time * cost for cost, _ in finer],
                  [max(one, LEAST) for _, one in finer], "-", color=colour(way), lw=0.8, alpha=0.35,
                  zorder=2)
        axes.plot(time, error, "D" if way[0] == OURS else "o", ms=9 if way[0] == OURS else 8,
                  color=colour(way), mec="white", mew=0.8, zorder=4)


def label_lost(axes, ways, top):
    """Names of those that have lost the attitude: side by side above, as they lie on one line."""
    places = apart([np.log10(time) for _, time, _ in ways], 0.088)
    for (way, time, error), place in zip(ways, places):
        axes.annotate(label(way), (time, error * 1.25), (10 ** place, top), rotation=52,
                      rotation_mode="anchor", ha="left", va="bottom", fontsize=9.5,
                      color=colour(way), weight="bold" if way[0] == OURS else "normal",
                      arrowprops={"arrowstyle": "-", "color": colour(way), "lw": 0.6,
                                  "shrinkA": 0, "shrinkB": 0}, annotation_clip=False)


def label_others(axes, ways):
    """Names beside their points; those that would overlap stand together."""
    groups = []
    for way, time, error in ways:
        for group in groups:
            if (abs(np.log10(group[0][1] / time)) < 0.35
                    and abs(np.log10(group[0][2] / error)) < 0.45):
                group.append((way, time, error))
                break
        else:
            groups.append([(way, time, error)])
    for group in groups:
        way, time, error = max(group, key=lambda one: one[1])
        is_left = time > axes.get_xlim()[1] / 12  # of its point, where there is no room beside
        axes.annotate(", ".join(label(one[0]) for one in group), (time, error),
                      (-9 if is_left else 9, 0), textcoords="offset points", va="center",
                      ha="right" if is_left else "left", fontsize=10, color=colour(way),
                      weight="bold" if way[0] == OURS else "normal", path_effects=HALO, zorder=6)


def draw(results, path):
    ways = points(results)
    lost = [one for one in ways if one[2] > LOST]
    figure, axes = plt.subplots(figsize=(11, 8.9), dpi=110)
    figure.subplots_adjust(left=0.085, right=0.97, bottom=0.075, top=0.705)
    draw_ways(axes, results, ways)
    times = [time for _, time, _ in ways]
    axes.set(xscale="log", yscale="log", xlim=(min(times) / 1.7, max(times) * 2.2),
             ylim=(LEAST * 3, 8), ylabel="attitude error after 10 s [rad]",
             xlabel="processor time of 0.02 s of one body [ns]")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.yaxis.set_major_locator(ticker.LogLocator(base=10, numticks=20))
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{x:,.0f}"))
    axes.grid(True, which="major", color="#dddddd", lw=0.7)
    axes.set_axisbelow(True)
    axes.axhspan(LOST, 8, color="#bbbbbb", alpha=0.3, lw=0)
    axes.text(0.005, LOST * 1.25, "attitude lost", transform=axes.get_yaxis_transform(), ha="left",
              fontsize=9.5, color="#444444")
    label_lost(axes, lost, 14)
    label_others(axes, [one for one in ways if one[2] <= LOST])
    figure.text(0.012, 0.985, "Error against time: free rigid bodies in this package and in other "
                "engines", va="top", fontsize=14, weight="bold")
    text = ("A tumbling body, I = (1, 2, 3) kg m², 5 rad/s, a step of 0.02 s. Down is more accurate, "
            "left is faster. Black diamonds: the integrators of rigid_body_sim. Coloured circles: "
            "other engines. Faint lines: the same with 2, 4 ... 64 times shorter steps, at 2, 4 ... "
            f"64 times the price. {results.machine['cpu']}, 256 bodies, one thread.")
    figure.text(0.012, 0.952, textwrap.fill(text, 165), va="top", fontsize=9.5, color="#333333",
                linespacing=1.35)
    figure.savefig(path)
    plt.close(figure)
