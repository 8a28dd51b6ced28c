#!/usr/bin/env python3
"""The demo as its user has it: four bodies that move in rviz, the README's push, Ctrl-C.

usage: demo_test.py FOLDER     screenshots, output and logs are left there
"""

import contextlib
import ctypes
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

import rosgraph
import rospy
import yaml
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

PACKAGE = pathlib.Path(__file__).resolve().parent.parent
SCENE = yaml.safe_load((PACKAGE / "config/demo.yaml").read_text())
RVIZ = yaml.safe_load((PACKAGE / "config/demo.rviz").read_text())["Visualization Manager"]
URDF = {body: ElementTree.parse(PACKAGE / f"config/bodies/{body}.urdf")
        for body in ("t_handle", "astrobee", "nesc_brick", "ball")}

HOLD_S = 1.0  # ~wrench_timeout_s
RATE_TICKS = 300  # 6 s
SHOTS_TICKS = 25  # at least, between two screenshots
# Around the home of a body [m]: below the labels, and as wide as it moves.
BOTTOM, TOP, HALF_WIDTH = 0.15, 1.55, 0.40
DRAWN = NEW = 100  # pixels of the body's colour; measured: 180 to 3900, new ones 220 to 2000
# rviz writes a display's name in the colour of its status (1.14, Display and StatusProperty).
OK, WARN, ERROR = (40, 120, 197), (192, 128, 0), (192, 32, 32)
DISPLAYS_OK = (len(RVIZ["Displays"]), 0)
COMPLAINT = re.compile(
    r"\[ ?(?:WARN|ERROR|FATAL)\]|^\S+ (?:WARN|ERROR|FATAL) |^(?:Warning|Error):|TF_[A-Z]+_DATA"
    r"|Traceback|has died|[Cc]ould not|[Uu]nable to|[Cc]annot|[Nn]o such|[Nn]ot found")
# rviz asks for plugins of a package that it does not need.
NO_COMPLAINT = "[rospack] Error: no such package media_export"
PRCTL, PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = ctypes.CDLL(None).prctl, 1, 36


def check(is_right, message):
    if not is_right:
        raise AssertionError(message)


def wait_until(condition, deadline_s, what):
    end = time.monotonic() + deadline_s
    while not condition():
        check(time.monotonic() < end, f"waited {deadline_s} s for {what()}")
        time.sleep(0.02)


def start(command, end_signal, output, **options):
    """A child that gets `end_signal` when this process dies, however it dies."""
    with open(output, "w") as file:
        return subprocess.Popen(
            command, start_new_session=True, stdout=file, stderr=file,
            preexec_fn=lambda: PRCTL(PR_SET_PDEATHSIG, end_signal), **options)


def run(*command):
    return subprocess.run(command, check=True, timeout=60, stdout=subprocess.PIPE).stdout


def kill_what_is_left():
    """All children; orphans are adopted. Returns the command lines of what still ran."""
    left = []
    while True:
        try:
            if os.waitpid(-1, os.WNOHANG)[0]:
                continue
        except ChildProcessError:  # there is none
            return left
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):  # ended meanwhile
                parent = (process / "stat").read_text().rpartition(")")[2].split()[1]
                if int(parent) == os.getpid():
                    left.append((process / "cmdline").read_text().replace("\0", " "))
                    os.kill(int(process.name), signal.SIGKILL)
        os.waitpid(-1, 0)


def set_environment(folder):
    """Of this process and its children: a master of their own, nothing written elsewhere."""
    for name in ("WAYLAND_DISPLAY", "XAUTHORITY", "ROS_NAMESPACE", "ROS_IP"):
        os.environ.pop(name, None)
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = str(free.getsockname()[1])
    os.environ.update(
        PATH="/usr/bin:" + os.environ["PATH"], HOME=str(folder), XDG_RUNTIME_DIR=str(folder),
        ROS_HOME=str(folder), ROS_LOG_DIR=str(folder / "log"), ROS_HOSTNAME="localhost",
        ROS_MASTER_URI="http://localhost:" + port, LIBGL_ALWAYS_SOFTWARE="1",
        QT_QPA_PLATFORM="xcb")
    return port


def start_screen(output):
    """Xvfb takes a free display, and says which."""
    reader, writer = os.pipe()
    xvfb = start(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1280x800x24"],
                 signal.SIGTERM, output, pass_fds=[writer])
    os.close(writer)
    with os.fdopen(reader) as display:
        os.environ["DISPLAY"] = ":" + display.readline().strip()
    check(os.environ["DISPLAY"] != ":", f"Xvfb did not start: see {output}")
    return xvfb


class Screenshot:
    """Rectangles are (left, top, width, height) [pixel]."""

    def __init__(self, path):
        self.path = str(path)
        # rviz's 3D view is the innermost window; left of it are the displays.
        tree = run("xwininfo", "-root", "-tree").decode()
        windows = re.findall(r"^( +)0x.* (\d+)x(\d+)\S+  \+(\d+)\+(\d+)$", tree, re.MULTILINE)
        innermost = max(windows, default=(0,) * 5, key=lambda window: len(window[0]))
        self.width, self.height, self.left, self.top = map(int, innermost[1:])
        run("import", "-window", "root", self.path)
        self.bodies = {body: self.pixels(self.surroundings(body), is_colour_of(body))
                       for body in URDF}

    def pixels(self, rectangle, is_like):
        """The places (x, y) in the rectangle where is_like(r, g, b)."""
        left, top, width, height = rectangle
        crop = ["-crop", f"{width}x{height}+{left}+{top}", "+repage"]
        raw = run("convert", self.path, *crop, "-depth", "8", "rgb:-")
        if len(raw) != 3 * width * height:
            return set()  # not yet all on the screen
        colours = zip(raw[::3], raw[1::3], raw[2::3])
        return {(i % width, i // width) for i, rgb in enumerate(colours) if is_like(*rgb)}

    def surroundings(self, body):
        """Where the camera of demo.rviz, which looks along -x, sees those of its home."""
        camera = RVIZ["Views"]["Current"]
        focal_length = self.height / 2 / math.tan(camera["Field of View"] / 2)

        def pixel(y, z):  # of the point (0, y, z) in the world
            y, z = y - camera["Focal Point"]["Y"], z - camera["Focal Point"]["Z"]
            scale = focal_length / (camera["Distance"] - z * math.sin(camera["Pitch"]))
            return (round(self.left + self.width / 2 + scale * y),
                    round(self.top + self.height / 2 - scale * z * math.cos(camera["Pitch"])))

        home_y = SCENE["bodies"][body]["position"][1]
        left, top = pixel(home_y - HALF_WIDTH, TOP)
        right, bottom = pixel(home_y + HALF_WIDTH, BOTTOM)
        return left, top, right - left, bottom - top

    def displays(self):
        """How many are Ok, a name a line, and how many pixels say something else."""
        panel = (0, self.top, self.left, self.height)
        rows = {y for _, y in self.pixels(panel, lambda *rgb: rgb == OK)}
        return len(rows - {y + 1 for y in rows}), len(
            self.pixels(panel, lambda *rgb: rgb in (WARN, ERROR)))


def is_colour_of(body):
    """The first one of its URDF, in bright light or in less of it."""
    rgb = [float(c) for c in URDF[body].find("material/color").get("rgba").split()[:3]]

    def is_like(*pixel):
        top = max(pixel)  # 46 of the background, 88 at most of the grid
        return top > 100 and all(abs(p / top - c / max(rgb)) < 0.05 for p, c in zip(pixel, rgb))

    return is_like


def numbers(message):
    return tuple(getattr(message, name) for name in message.__slots__)


def rotate(q, v):
    """By the quaternion (x, y, z, w)."""
    def cross(a, b):
        return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]

    t = cross(q, v)
    return tuple(a + 2 * (q[3] * b + c) for a, b, c in zip(v, t, cross(q, t)))


def readme_command(beginning):
    """With its continued lines, as a reader copies it."""
    text = (PACKAGE / "README.md").read_text()
    return re.search(f"^{beginning}" + r"(?:.*\\\n)*.*$", text, re.MULTILINE).group()


class User:
    def __init__(self):
        self.arrivals, self.brick = [], []  # of /tf, by the steady clock [s]; its odometry
        wait_until(rosgraph.is_master_online, 30, lambda: "the master")
        rospy.init_node("demo_test", disable_signals=True, disable_rosout=True)
        rospy.Subscriber("/tf", TFMessage, lambda _: self.arrivals.append(time.monotonic()))
        rospy.Subscriber("/nesc_brick/odom", Odometry, self.brick.append)
        wait_until(lambda: self.brick, 30, lambda: "odometry of the brick")

    def look(self, folder):
        """All bodies are drawn and all displays Ok; some time later all bodies are elsewhere."""
        shots, drawn, new = {}, {}, {}

        def all_are_drawn():
            shots[1] = Screenshot(folder / "first.png")
            drawn.update((body, len(pixels)) for body, pixels in shots[1].bodies.items())
            return min(drawn.values()) > DRAWN and shots[1].displays() == DISPLAYS_OK

        def all_are_elsewhere():
            shots[2] = Screenshot(folder / "second.png")
            new.update((body, len(shots[2].bodies[body] - shots[1].bodies[body])) for body in URDF)
            return min(new.values()) > NEW

        wait_until(all_are_drawn, 60, lambda: f"all bodies and displays: {drawn}, "
                   f"(Ok, pixels that are not) {shots[1].displays()}")
        later = len(self.brick) + SHOTS_TICKS
        wait_until(lambda: len(self.brick) > later, 30, lambda: f"{SHOTS_TICKS} ticks")
        wait_until(all_are_elsewhere, 30, lambda: f"new pixels of all bodies: {new}")
        check(shots[2].displays() == DISPLAYS_OK, "a display is not Ok any more")

    def push(self):
        """Changes the brick's velocity by F t / m, along the brick's x axis as that turns."""
        command = readme_command("rostopic pub -1 /nesc_brick/wrench")
        force_n = float(re.search(r"force: {x: ([0-9.]+)}", command).group(1))
        mass_kg = float(URDF["nesc_brick"].find("link/inertial/mass").get("value"))
        run("bash", "-c", command)  # it stays for 3 s, so the push is over
        brick = list(self.brick)
        turns = [numbers(odom.pose.pose.orientation) for odom in brick]
        x_axes = [rotate(q, (1, 0, 0)) for q in turns]
        velocities = [rotate(q, numbers(o.twist.twist.linear)) for q, o in zip(turns, brick)]
        pushed = [k for k in range(len(brick) - 1)
                  if math.dist(velocities[k], velocities[k + 1]) > 1e-9]  # 1.8e-3 m/s a tick
        check(len(pushed) == HOLD_S / SCENE["step_s"], f"pushed for {len(pushed)} ticks")
        # A tick gives half of its impulse at its start, and half at its end.
        axes = [a for k in pushed for a in (x_axes[k], x_axes[k + 1])]
        expected = [force_n * SCENE["step_s"] / mass_kg * sum(a) / 2 for a in zip(*axes)]
        error = math.dist(velocities[-1], expected)  # measured: up to 6e-17
        check(error < 1e-14, f"pushed to {velocities[-1]} m/s, not {expected}")

    def reset(self):
        def way():
            home = SCENE["bodies"]["nesc_brick"]["position"]
            return math.dist(numbers(self.brick[-1].pose.pose.position), home)

        check(way() > 0.05, f"the push moved the brick by {way()} m")
        run("bash", "-c", readme_command("rosservice call /rigid_body_sim/reset"))
        wait_until(lambda: way() == 0, 10, lambda: f"the brick, {way()} m from home")

    def rate_hz(self):
        """Of the line that fits the last arrivals best: one that came late hardly turns it."""
        times = self.arrivals[-RATE_TICKS:]
        steps = [k - (len(times) - 1) / 2 for k in range(len(times))]
        slope = sum(k * t for k, t in zip(steps, times)) / sum(k * k for k in steps)
        return 1 / slope if len(times) == RATE_TICKS else 0


def test(folder):
    port = set_environment(folder)
    xvfb = start_screen(folder / "xvfb.txt")
    demo = start(["roslaunch", "-p", port, "rigid_body_sim", "demo.launch"], signal.SIGINT,
                 folder / "demo.txt")
    user = User()
    user.look(folder)
    user.push()
    user.reset()
    wait_until(lambda: 49.5 < user.rate_hz() < 50.5, 30, lambda: f"/tf: {user.rate_hz()} Hz")
    last = Screenshot(folder / "last.png")
    check(last.displays() == DISPLAYS_OK, "a display is not Ok in the end")
    rospy.signal_shutdown("before its master ends")
    demo.send_signal(signal.SIGINT)
    check(demo.wait(60) == 0, f"roslaunch ended with exit code {demo.returncode}")
    xvfb.terminate()
    check(xvfb.wait(20) == 0, f"Xvfb ended with exit code {xvfb.returncode}")
    # Complete only now that the nodes have ended.
    text = (folder / "demo.txt").read_text() + (folder / "log/latest/rosout.log").read_text()
    complaints = [t for t in text.splitlines() if COMPLAINT.search(t) and t != NO_COMPLAINT]
    check(not complaints, "\n".join(["complaints:", *complaints]))


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder / "log", ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)  # as XDG_RUNTIME_DIR has to be
    PRCTL(PR_SET_CHILD_SUBREAPER, 1)  # whatever loses its parent becomes a child of this
    try:
        test(folder)
    finally:
        rospy.signal_shutdown("the end")
        left = kill_what_is_left()
    check(not left, f"left running: {left}")


main()
