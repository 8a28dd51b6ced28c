#!/usr/bin/env python3
"""Measures this package's integrators and other engines side by side.

usage: compare_peers.py PROGRAMS RESULTS [--quick]

PROGRAMS is the folder with the programs peer_*, one an engine. They hold their scenes at the same
time and are timed in turn, round after round, so that whatever slows the machine for a while slows
all of them; medians of the rounds are kept. Writes into the folder RESULTS: times.csv (a row each
load, number of bodies and way of stepping), errors.csv (a row each length of a step) and
limits.csv (what was left out, and why).
"""

import csv
import pathlib
import statistics
import subprocess
import sys

STEP_S, SPAN_S = 0.02, 10
LOADS = ["gravity", "gyroscopic", "wrench"]
FINER = [1, 2, 4, 8, 16, 32, 64]  # steps so many times shorter: error against cost
# From so many bodies on only one scene at a time, as their memory adds up; made anew every round.
ALONE_FROM = 65536
# Of ours, over 2 us a step: minutes, for what 65,536 tell as well.
TOO_SLOW_FOR_A_MILLION = ["rk8", "adaptive"]


class Full:
    bodies = [1, 16, 256, 4096, 65536, 1000000]
    rounds = {1: 9, 16: 9, 256: 9, 4096: 7, 65536: 3, 1000000: 2}
    least_ns = 2e7


class Quick:
    bodies = [1, 256]
    rounds = {1: 3, 256: 3}
    least_ns = 2e6


class Worker:
    """The program of one engine."""

    def __init__(self, program):
        self.program = program
        self.process = subprocess.Popen([str(program)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True,
                                        cwd=program.parent)  # MuJoCo leaves a log file there
        self.rows = [line.split("\t") for line in self.ask("list").splitlines()]

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = []
        for text in self.process.stdout:
            if text == ".\n":
                return "".join(answer).strip("\n")
            answer.append(text)
        raise RuntimeError(f"{self.program.name} ended when asked: {line}")


class Way:
    """A row of one engine."""

    def __init__(self, worker, index):
        (self.engine, self.name, self.about, most, self.limit, has_gyroscopic_switch,
         needs_wrenches) = worker.rows[index]
        self.worker, self.index, self.most = worker, index, int(most)
        self.loads = [load for load in LOADS
                      if (load != "gravity" or has_gyroscopic_switch == "1")
                      and (load == "wrench" or needs_wrenches == "0")]

    def open(self, load, bodies):
        self.handle = self.worker.ask(f"open {self.index} {load} {bodies}")

    def close(self):
        self.worker.ask(f"close {self.handle}")

    def time(self, least_ns):
        return float(self.worker.ask(f"time {self.handle} {least_ns}"))

    def error(self, load, step_s):
        return float(self.worker.ask(f"error {self.index} {load} {step_s:.17g} {SPAN_S}"))

    def is_ours(self):
        return self.engine == "rigid_body_sim"


def time_all(ways, load, bodies, plan):
    """{way: [ns per body-step of each round]}"""
    times = {way: [] for way in ways}
    is_alone = bodies >= ALONE_FROM
    if not is_alone:
        for way in ways:
            way.open(load, bodies)
    for _ in range(plan.rounds[bodies]):
        for way in ways:
            if is_alone:
                way.open(load, bodies)
            times[way].append(way.time(plan.least_ns))
            if is_alone:
                way.close()
    if not is_alone:
        for way in ways:
            way.close()
    return times


def is_measured(way, load, bodies):
    if load not in way.loads or bodies > way.most:
        return False
    # A million bodies: one load, of what is quick enough. Simulator, whose scene takes long to make: those that are shown.
    is_shown = load == "gyroscopic" and way.name not in TOO_SLOW_FOR_A_MILLION
    return (bodies < 1000000 or is_shown) and (
        bodies < ALONE_FROM or not way.name.endswith(", Simulator")
        or way.name.split(",")[0] in ("semi_implicit", "rk4", "exact"))


def measure_times(ways, plan, writer):
    for bodies in plan.bodies:
        for load in LOADS:
            flown = [way for way in ways if is_measured(way, load, bodies)]
            if not flown:
                continue
            print(f"  {bodies} bodies, {load}", flush=True)
            times = time_all(flown, load, bodies, plan)
            medians = {way: statistics.median(times[way]) for way in flown}
            fastest_peer = min((medians[way] for way in flown if not way.is_ours()), default=None)
            for way in flown:
                writer.writerow([
                    way.engine, way.name, way.about, load, bodies, f"{medians[way]:.6g}",
                    f"{min(times[way]):.6g}", f"{max(times[way]):.6g}",
                    f"{fastest_peer / medians[way]:.6g}" if fastest_peer else ""])


def measure_errors(ways, finer, writer):
    for way in ways:
        for load in way.loads:
            if load == "wrench":  # has no closed answer
                continue
            for parts in finer if load == "gyroscopic" else [1]:
                writer.writerow([way.engine, way.name, load, f"{STEP_S / parts:.6g}",
                                 f"{way.error(load, STEP_S / parts):.6g}"])


def write(path, header, fill):
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        fill(writer)


def main(programs, results, is_quick):
    plan = Quick if is_quick else Full
    workers = [Worker(program) for program in sorted(programs.glob("peer_*"))]
    ways = [Way(worker, k) for worker in workers for k in range(len(worker.rows))]
    results.mkdir(parents=True, exist_ok=True)
    print("Measuring errors", flush=True)
    write(results / "errors.csv", ["engine", "way", "load", "step_s", "attitude_error_rad"],
          lambda writer: measure_errors(ways, FINER[:3] if is_quick else FINER, writer))
    print("Measuring times", flush=True)
    write(results / "times.csv", ["engine", "way", "about", "load", "bodies", "ns_per_body_step",
                                  "least", "most", "speed_fastest_peer_is_1"],
          lambda writer: measure_times(ways, plan, writer))
    write(results / "limits.csv", ["engine", "way", "most_bodies", "why"],
          lambda writer: writer.writerows([way.engine, way.name, way.most, way.limit]
                                          for way in ways if way.limit))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--quick"]):
        sys.exit(__doc__.strip())
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(),
         len(sys.argv) == 4)
