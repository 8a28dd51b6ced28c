#!/usr/bin/env python3
"""Writes what compare_peers.py measured into a README, and draws it.

usage: benchmark_report.py RESULTS README PICTURE

RESULTS holds times.csv, errors.csv and limits.csv; machine.csv with what it was measured on; and,
if Google Benchmark was there, rungs.json of rungs_benchmark.
Replaces what stands in README between the two lines

    <!-- benchmark: begin -->
    <!-- benchmark: end -->

and writes PICTURE, a PNG to which the README refers by its path from there.
"""

import csv
import json
import math
import os
import pathlib
import sys

BEGIN, END = "<!-- benchmark: begin -->", "<!-- benchmark: end -->"
OURS = "rigid_body_sim"
BARE_LOOP = OURS, "bare loop"
MIDDLE = 256  # bodies that fit into a cache: rows are sorted, and drawn, by their time
STEP_S = "0.02"


def rewritten(text, section):
    """The README with the section between its markers. Refuses one whose markers are not these."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        raise ValueError(f"the README needs one line {BEGIN} and after it one line {END}")
    before, rest = text.split(BEGIN)
    return before + BEGIN + "\n" + section.strip("\n") + "\n" + END + rest.split(END)[1]


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


class Results:
    def __init__(self, folder):
        self.machine = {row["key"]: row["value"] for row in read(folder / "machine.csv")}
        self.limits = read(folder / "limits.csv")
        self.times, self.about, self.errors, self.rungs = {}, {}, {}, {}
        for row in read(folder / "times.csv"):
            way = row["engine"], row["way"]
            self.about[way] = row["about"]
            self.times[way, row["load"], int(row["bodies"])] = float(row["ns_per_body_step"])
        for row in read(folder / "errors.csv"):
            way = row["engine"], row["way"]
            error = float(row["attitude_error_rad"])
            if way[0] == OURS and not math.isfinite(error):
                raise ValueError(f"{way[1]} left no attitude under {row['load']}")
            self.errors[way, row["load"], row["step_s"]] = error
        if (folder / "rungs.json").exists():
            for row in json.loads((folder / "rungs.json").read_text())["benchmarks"]:
                if row.get("aggregate_name", "median") == "median":
                    self.rungs[tuple(row["run_name"].split("/")[:3])] = row["ns_per_body_step"]
        self.bodies = sorted({bodies for _, _, bodies in self.times})
        self.ways = sorted(self.about, key=lambda way: self.time(way) or float("inf"))

    def time(self, way, load="gyroscopic", bodies=MIDDLE):
        return self.times.get((way, load, bodies))

    def fastest_peer(self, load="gyroscopic", bodies=MIDDLE):
        return min(time for (way, of, count), time in self.times.items()
                   if way[0] != OURS and of == load and count == bodies)

    def error(self, way, load="gyroscopic", step=STEP_S):
        return self.errors.get((way, load, step))

    def finer(self, way):
        """(relative cost, error) at the default step and shorter ones, from the longest on."""
        steps = sorted((float(step), error) for (other, load, step), error in self.errors.items()
                       if other == way and load == "gyroscopic")
        return [(float(STEP_S) / step, error) for step, error in reversed(steps)]


def named(way):
    return f"**`{way[1]}`**" if way[0] == OURS else f"{way[0]}, {way[1]}"


def number(value):
    if value is None:
        return "–"
    return f"{value:,.0f}" if value >= 9.95 else f"{value:.1f}"


def ratio(value):
    return f"{value:.0f}" if value >= 9.95 else f"{value:.1f}" if value >= 1 else f"{value:.2g}"


def small(value):
    return "–" if value is None else f"{value:.2g}"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


IN_SIMULATOR = [f"{rung}, Simulator" for rung in ("semi_implicit", "rk4", "exact")]


def is_shown(way):
    """Of Simulator, which all integrators have about them, three stand for all."""
    return way[0] != OURS or "Simulator" not in way[1] or way[1] in IN_SIMULATOR


def main_table(results):
    fastest = results.fastest_peer()
    rows = []
    for way in results.ways:
        if results.time(way) and is_shown(way):
            rows.append([named(way), *(number(results.time(way, bodies=bodies))
                                       for bodies in results.bodies),
                         ratio(fastest / results.time(way)), small(results.error(way))])
    header = ["", *(f"{bodies:,}" for bodies in results.bodies), "speed", "error [rad]"]
    return table(header, rows)


def loads_table(results):
    """The fastest way of each engine, and ours that are used most."""
    ours = ["semi_implicit", "rk4", "exact", *IN_SIMULATOR, "exact, Simulator, inputs"]
    chosen, seen = [], set()
    for way in results.ways:
        if way[1] in ours if way[0] == OURS else way[0] not in seen:
            chosen.append(way)
            seen.add(way[0])
    counts = [bodies for bodies in (MIDDLE, 65536) if bodies in results.bodies]
    rows = [[named(way), *(number(results.time(way, load, bodies)) for bodies in counts
                           for load in ("gravity", "gyroscopic", "wrench"))] for way in chosen]
    header = ["", *(f"{bodies:,}: {load}" for bodies in counts for load in
                    ("gravity alone", "+ gyroscopic term", "+ a wrench each"))]
    return table(header, rows)


def summary(results):
    """One sentence a claim, of the numbers measured."""
    fastest = results.fastest_peer()
    peer = next(way for way in results.ways if way[0] != OURS)
    best = min((way for way in results.ways if way[0] != OURS and results.time(way)),
               key=lambda way: results.error(way))
    exact = (OURS, "exact")
    without = sorted({f"{error:.3g}" for (way, load, step), error in results.errors.items()
                      if load == "gravity" and step == STEP_S})
    return (f"With {MIDDLE} bodies the fastest other way, {named(peer)}, takes {fastest:.0f} ns a "
            f"body and step, and is {results.error(peer):.2g} rad off after 10 s; `exact` takes "
            f"{results.time(exact):.0f} ns and is {results.error(exact):.1g} rad off. The most "
            f"accurate other one, {named(best)}, takes {results.time(best):,.0f} ns for "
            f"{results.error(best):.1g} rad. Without the gyroscopic term all are "
            f"{' to '.join(dict.fromkeys([without[0], without[-1]]))} rad off.")


def summary_of_many(results):
    """What of this is left with the most bodies, which no cache holds."""
    most = results.bodies[-1]
    if not results.time(BARE_LOOP, bodies=most):
        return ""
    ours = [f"{results.time((OURS, way), bodies=most):.1f} ns with `{way.split(',')[0]}`"
            for way in IN_SIMULATOR]
    return (f" With {most:,} a `Simulator` takes {', '.join(ours)}, sixteen ticks at a time; the "
            f"fastest other way {results.fastest_peer(bodies=most):.0f} ns, and `bare loop` "
            f"{results.time(BARE_LOOP, bodies=most):.1f} ns.")


def rungs_table(results):
    """Of Google Benchmark: what the loads cost each of our integrators."""
    loads = ["free", "gravity", "wrench"]
    rungs = dict.fromkeys(name for name, _, _ in results.rungs if "Simulator" not in name)
    rows = [[f"`{rung}`", *(number(results.rungs.get((rung + around, load, str(MIDDLE))))
                            for around in ("", ", Simulator") for load in loads)]
            for rung in rungs]
    return table(["", "`Bodies`: free", "+ gravity", "+ a wrench each", "`Simulator`: free",
                  "+ gravity", "+ a wrench each"], rows)


def ways_in_words(results):
    """`Bullet`: per body: what that is; ... One sentence an engine."""
    sentences = {}
    for way, about in results.about.items():
        if way[0] != OURS:
            sentences.setdefault(way[0].split(" ")[0], {})[way[1]] = about
    return " ".join(f"{engine}: " + "; ".join(f"*{name}* is {about}"
                                              for name, about in ways.items()) + "."
                    for engine, ways in sentences.items())


def not_measured(results):
    limits = {}
    for row in results.limits:
        if row["engine"] != OURS:
            limit = row["engine"].split(" ")[0], int(row["most_bodies"]), row["why"]
            limits.setdefault(limit, []).append(f"*{row['way']}*")
    texts = [f"{engine} ({', '.join(ways)}) beyond {most:,} bodies, as {why}"
             for (engine, most, why), ways in limits.items()]
    left_out = results.machine.get("left_out", "")
    text = "Not measured: " + "; ".join(texts) + "." if texts else ""
    return text + (f" Not installed: {left_out}." if left_out else "")


def intro(results, picture):
    return f"""## Beside other engines

![Error against time of a step, every engine and every integrator]({picture})

```bash
scripts/benchmark              # installs the engines, builds, measures, writes this section; some 20 minutes
scripts/benchmark --quick      # to try it out: a minute, and this section stays as it is
```

{summary(results)}{summary_of_many(results)}
"""


def at_all_sizes(results):
    return f"""Nanoseconds a body and step, by the number of bodies, under gravity and with the gyroscopic
term; the speed with {MIDDLE} bodies, that of the fastest other way being 1; and the attitude error
after 10 s of a tumbling body, I = (1, 2, 3) kg m², ω = (0.1, 5, 0.1) rad/s, at a step of 0.02 s. In
bold what is ours: integrators on bare `Bodies`, a step of all after the other, and in a `Simulator`,
which also latches inputs and freezes what becomes infinite, and takes the bodies in blocks through
several ticks, here at least sixteen, while they are in the processor's cache. `bare loop` is a measure
for both: semi-implicit Euler in one loop over arrays of state, moments and wrenches that the compiler
vectorises, with nothing around it (`bench/bare_loop.cpp`).

{main_table(results)}
"""


def under_loads(results):
    return f"""The same with other loads: gravity alone (the gyroscopic term left out), with that term,
and with a wrench on every body in every step besides. A dash: the engine cannot leave the term out.
Ours are slower without it where angular momenta would else stay as they are, and now have to be turned.
*inputs*: every wrench by `Simulator::apply`, as messages bring them; the other rows of ours have
them from an effect.

{loads_table(results)}
"""


def rungs_alone(results):
    if not results.rungs:
        return ""
    return f"""What the loads cost our own integrators, {MIDDLE} bodies, by Google Benchmark
(`build/benchmark/rungs_benchmark` has the other numbers of bodies):

{rungs_table(results)}
"""


def small_print(results):
    machine = results.machine
    return f"""{machine['cpu']}; {machine['compiler']}, {machine['flags']}; commit {machine['commit']}.
One thread; times are the processor's, medians of rounds in which all take turns. Nothing touches,
nothing sleeps. The engines are those of {machine['system']}. {ways_in_words(results)}
{not_measured(results)} `bench/peers/` has a file for each.
"""


def section(results, picture):
    parts = [intro(results, picture), at_all_sizes(results), under_loads(results),
             rungs_alone(results), small_print(results)]
    return "\n".join(part for part in parts if part)


def main(folder, readme, picture):
    results = Results(folder)
    from benchmark_picture import draw  # here, as a README can be rewritten without matplotlib
    draw(results, picture)
    link = os.path.relpath(picture, readme.parent)
    readme.write_text(rewritten(readme.read_text(), section(results, link)))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    try:
        main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:]))
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"benchmark_report: {error}")
