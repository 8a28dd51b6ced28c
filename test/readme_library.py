#!/usr/bin/env python3
"""Builds and runs the README's library example, as printed, as a package of its own.

usage: readme_library.py DEVEL_SPACE SCRATCH_FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent


def block(language, containing):
    """The one code block of the README in this language that contains a word."""
    blocks = re.findall(rf"```{language}\n(.*?)```", (CHECKOUT / "README.md").read_text(), re.S)
    found = [text for text in blocks if containing in text]
    assert len(found) == 1, f"{len(found)} {language} blocks of the README contain {containing}"
    return found[0]


def run(*command):
    print("$", *command, flush=True)
    return subprocess.run([str(part) for part in command], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def main(devel, scratch):
    scratch = pathlib.Path(scratch)
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    (scratch / "CMakeLists.txt").write_text(block("cmake", "my_program"))
    (scratch / "main.cpp").write_text(block("cpp", "readSceneFile"))
    (scratch / "package.xml").write_text(
        "<package format='2'><name>my_package</name><version>0.0.0</version>"
        "<description>d</description><maintainer email='me@example.org'>m</maintainer>"
        "<license>l</license><buildtool_depend>catkin</buildtool_depend>"
        "<depend>rigid_body_sim</depend></package>")
    for command in (
            ("cmake", "-S", scratch, "-B", scratch / "build", f"-DCMAKE_PREFIX_PATH={devel};/usr",
             "-DPYTHON_EXECUTABLE=" + sys.executable),
            ("cmake", "--build", scratch / "build")):
        built = run(*command)
        assert built.returncode == 0, built.stdout

    program = next((scratch / "build" / "devel").rglob("my_program"))
    flown = run(program, CHECKOUT / "config" / "demo.yaml")
    assert flown.returncode == 0, flown.stdout
    # The T-handle is the first body, and nothing pushes it away.
    p_WL = [float(word) for word in flown.stdout.split()]
    assert len(p_WL) == 3 and abs(p_WL[1] + 1.3) < 0.2, flown.stdout

    refused = run(program, "/nowhere.yaml")
    assert refused.returncode == 1 and "/nowhere.yaml: cannot be read" in refused.stdout, refused.stdout
    print("1 passed, 0 failed")


if __name__ == "__main__":
    main(*sys.argv[1:])
