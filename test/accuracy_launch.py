#!/usr/bin/env python3
"""accuracy.launch as its user has it: on a scene of his own it draws and ends by itself.

usage: accuracy_launch.py FOLDER     pictures, output and logs are left there
"""

import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys

SCENE = """
bodies:
  stone: {box: {size: [0.1, 0.2, 0.3], density: 2000}, angular_velocity: [1, 2, 3]}
"""
PICTURES = {"work_precision.png", "attitude_error.png", "energy.png", "side_by_side.png"}


def check(is_right, message):
    if not is_right:
        raise AssertionError(message)


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "my scene.yaml").write_text(SCENE)  # with a blank, as folders of users have
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = str(free.getsockname()[1])
    os.environ.update(PATH="/usr/bin:" + os.environ["PATH"], HOME=str(folder), ROS_HOME=str(folder),
                      ROS_LOG_DIR=str(folder / "log"), ROS_HOSTNAME="localhost",
                      ROS_MASTER_URI="http://localhost:" + port)
    launch = subprocess.run(
        ["roslaunch", "-p", port, "rigid_body_sim", "accuracy.launch",
         f"scene:={folder / 'my scene.yaml'}", "over:=2",
         "options:=--substeps 1,4 --repeats 1 --integrators semi_implicit,split2,exact"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    check(launch.returncode == 0, f"exit code {launch.returncode}: {launch.stdout}")
    check("my scene: one body, a tick of 0.02 s, over 2 s" in launch.stdout, launch.stdout)
    told = [pathlib.Path(path) for path in re.findall(r"Picture: (.+\.png)", launch.stdout)]
    check({path.name for path in told} == PICTURES, launch.stdout)
    for path in told:
        check(path.parent == folder / "accuracy", f"{path} is not below ROS_HOME")
        check(path.stat().st_size > 15000, f"{path} is empty")


main()
