#!/usr/bin/env python3
"""What the benchmark writes into the README: only between its markers, and only numbers it measured."""
import csv
import pathlib
import sys
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(CHECKOUT / "bench"))
import benchmark_report as report  # noqa: E402

ENGINE, OURS = ("Engine 1.0", "world"), ("rigid_body_sim", "exact")


def write(path, *rows):
    with path.open("w", newline="") as file:
        csv.writer(file).writerows(rows)


def made_up_results(folder):
    write(folder / "machine.csv", ["key", "value"], ["cpu", "A Processor, of 1 core"],
          ["compiler", "GNU 12.2"], ["flags", "-O3"], ["commit", "abc1234"], ["system", "A System"],
          ["left_out", "other"])
    write(folder / "limits.csv", ["engine", "way", "most_bodies", "why"],
          [*ENGINE, 4096, "it is slow"])
    write(folder / "times.csv", ["engine", "way", "about", "load", "bodies", "ns_per_body_step"],
          *([*way, "about it", load, 256, time] for way, time in ((ENGINE, 123), (OURS, 41))
            for load in ("gyroscopic", "wrench")), [*OURS, "about it", "gravity", 256, 39],
          *([OURS[0], way, "about it", "gyroscopic", 256, time] for way, time in (
              ("bare loop", 2.5), ("semi_implicit, Simulator", 6), ("rk4, Simulator", 12),
              ("exact, Simulator", 8.25))))
    write(folder / "errors.csv", ["engine", "way", "load", "step_s", "attitude_error_rad"],
          [*ENGINE, "gyroscopic", "0.02", 2.5], [*OURS, "gyroscopic", "0.02", 3e-14],
          [*OURS, "gravity", "0.02", 3.1])
    return report.Results(folder)


class Readme(unittest.TestCase):
    def setUp(self):
        self.readme = (CHECKOUT / "README.md").read_text()

    def test_has_a_section_between_its_markers(self):
        before, rest = self.readme.split(report.BEGIN)
        section, after = rest.split(report.END)
        self.assertIn("| **`exact`** |", section)
        self.assertIn("config/benchmark.png", section)
        self.assertTrue((CHECKOUT / "config" / "benchmark.png").exists())

    def test_is_changed_only_between_its_markers(self):
        once = report.rewritten(self.readme, "new\n")
        self.assertEqual(once.split(report.BEGIN)[0], self.readme.split(report.BEGIN)[0])
        self.assertEqual(once.split(report.END)[1], self.readme.split(report.END)[1])
        self.assertIn(f"{report.BEGIN}\nnew\n{report.END}\n", once)
        self.assertEqual(report.rewritten(once, "new"), once)

    def test_without_its_markers_is_refused(self):
        for text in ("", report.BEGIN, report.END + report.BEGIN, 2 * (report.BEGIN + report.END)):
            with self.assertRaises(ValueError):
                report.rewritten(text, "new")


class Section(unittest.TestCase):
    def test_says_what_was_measured(self):
        with tempfile.TemporaryDirectory() as folder:
            results = made_up_results(pathlib.Path(folder))
        text = report.section(results, "picture.png")
        for part in ("| **`exact`** | 41 | 3.0 | 3e-14 |", "| Engine 1.0, world | 123 | 1.0 | 2.5 |",
                     "| Engine 1.0, world | – | 123 | 123 |", "| **`exact`** | 39 | 41 | 41 |",
                     "Engine (*world*) beyond 4,096 bodies, as it is slow", "Not installed: other.",
                     "With 256 a `Simulator` takes 6.0 ns with `semi_implicit`, 12.0 ns with `rk4`, "
                     "8.2 ns with `exact`", "the fastest other way 123 ns, and `bare loop` 2.5 ns.",
                     "A Processor, of 1 core; GNU 12.2, -O3; commit abc1234", "(picture.png)"):
            self.assertIn(part, text)

    def test_is_not_written_when_one_of_ours_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            made_up_results(pathlib.Path(folder))
            with (pathlib.Path(folder) / "errors.csv").open("a") as file:
                csv.writer(file).writerow([*OURS, "gyroscopic", "0.01", "nan"])
            with self.assertRaisesRegex(ValueError, "exact left no attitude under gyroscopic"):
                report.Results(pathlib.Path(folder))


if __name__ == "__main__":
    unittest.main()
