#!/usr/bin/python3
"""Builds test/effect_package against the installed package, as users do, and flies its scene.

usage: effect_package_test.py BUILD_FOLDER DEVEL_SPACE
"""
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client

import yaml

PACKAGE = pathlib.Path(__file__).resolve().parent / "effect_package"
BUILD, DEVEL = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
# Not within the checkout: roslaunch would find the installed files there, too.
SCRATCH = pathlib.Path(tempfile.mkdtemp(prefix="effect_package."))
SCENE = PACKAGE / "nesc_case_3.yaml"
LIBRARY = "librigid_body_sim_effect_rate_damping.so"

# Attitude at 30 s relative to the start, w x y z: integrated to 1e-13 with NASA's models (J2, rotating
# Earth and air). Six tools of NASA and partners are spread over 0.31 deg; the best of them is 0.0037
# deg from this.
REFERENCE = (0.5192936263888952, -0.297088044604505, -0.15148544110667117, -0.7868449558061994)
CYCLE = (0.5, 0.5, 0.5, 0.5)  # takes x to y, y to z, z to x
START = (0, math.sqrt(0.5), math.sqrt(0.5), 0)
# Measured: 0.0031 deg at steps of 0.01 s, 0.0032 deg at short ones. The scene's model is what leaves
# them: an independent Runge-Kutta integration leaves 0.0032 deg with the scene's uniform gravity and
# air, and 0.0003 deg with central gravity, J2 and air that turns with the Earth.
MOST_DEG = 0.0035

MOST_S = 30  # until the node has said what it flies, on a busy machine

# Libraries that do not fit: source, and what is said of it.
EXTERN = 'extern "C" const int* rigidBodySimEffect() '
UNFIT = {
    "version": (EXTERN + "{ static const int v[] = {1000, 16}; return v; }",
                "was built for version 1000 of the interface, and this is 3; build it again"),
    "alignment": (EXTERN + "{ static const int v[] = {3, 1024}; return v; }",
                  "was built with matrices aligned to 1024 bytes"),
    "symbol": ("", "offers no effect; its source must end with RIGID_BODY_SIM_EFFECT(...)"),
    "undefined": ("int missing(); int there = missing();", "cannot be loaded: "),
}


def run(*command, **environment):
    print("$", *command, flush=True)
    return subprocess.run([str(part) for part in command], check=False, text=True,
                          env=dict(os.environ, **environment), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)


def succeed(*command, **environment):
    done = run(*command, **environment)
    assert done.returncode == 0, done.stdout
    return done.stdout


def forget_devel_space():
    """So that the example can only find what is installed."""
    for name in ("CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PKG_CONFIG_PATH", "PYTHONPATH", "PATH",
                 "ROS_PACKAGE_PATH"):
        entries = [pathlib.Path(entry) for entry in os.environ.get(name, "").split(":") if entry]
        os.environ[name] = ":".join(str(entry) for entry in entries
                                    if DEVEL not in (entry, *entry.parents))


def install_and_build():
    """The prefixes of rigid_body_sim and of the example."""
    # Not by --prefix: catkin's setup files would go to the configured prefix all the same.
    succeed("cmake", "--install", BUILD, DESTDIR=str(SCRATCH / "root"))
    configured = re.search(r"^CMAKE_INSTALL_PREFIX:PATH=(.*)$", (BUILD / "CMakeCache.txt").read_text(),
                           re.M).group(1)
    prefix = SCRATCH / "root" / configured.lstrip("/")
    own = SCRATCH / "own"
    succeed("cmake", "-S", PACKAGE, "-B", SCRATCH / "build", f"-DCMAKE_PREFIX_PATH={prefix};/usr",
            f"-DCMAKE_INSTALL_PREFIX={own}", "-DPYTHON_EXECUTABLE=" + sys.executable)
    succeed("cmake", "--build", SCRATCH / "build", "--target", "install")
    return prefix, own


def product(a, b):
    (w, x, y, z), (s, t, u, v) = a, b
    return (w * s - x * t - y * u - z * v, w * t + x * s + y * v - z * u,
            w * u - x * v + y * s + z * t, w * v + x * u - y * t + z * s)


def inverse(q):
    return (q[0], -q[1], -q[2], -q[3])


def angle_deg(q):
    return math.degrees(2 * math.atan2(math.hypot(*q[1:]), abs(q[0])))


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(shutil.rmtree, SCRATCH, ignore_errors=True)
        forget_devel_space()
        cls.prefix, cls.own = install_and_build()
        usual = os.environ["LD_LIBRARY_PATH"]
        usual = ":" + usual if usual else ""  # an empty entry would be the working folder
        cls.path = {"LD_LIBRARY_PATH": f"{cls.prefix}/lib:{cls.own}/lib{usual}"}
        cls.path_without = {"LD_LIBRARY_PATH": f"{cls.prefix}/lib{usual}"}

    def fly(self, scene=SCENE, **environment):
        return run(self.own / "lib/effect_package/fly", scene, 30, **(environment or self.path))

    def fly_changed(self, *changes):
        """Flies the scene with words replaced."""
        text = SCENE.read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        scene = SCRATCH / "changed.yaml"
        scene.write_text(text)
        return self.fly(scene)

    def attitude(self, *changes):
        """q_WL at 30 s, w x y z."""
        flown = self.fly_changed(*changes)
        self.assertEqual(flown.returncode, 0, flown.stdout)
        name, x, y, z, w = flown.stdout.split()
        self.assertEqual(name, "brick")
        return float(w), float(x), float(y), float(z)

    def test_its_library_is_the_installed_one(self):
        loads = succeed("ldd", self.own / "lib" / LIBRARY, **self.path)
        self.assertIn(f"{self.prefix}/lib/librigid_body_sim.so", loads)

    def test_each_header_that_an_effect_needs_compiles_alone(self):
        eigen = succeed("pkg-config", "--cflags", "eigen3").split()
        for name in ("effect_plugin", "members", "instant", "body_frame"):
            succeed("c++", "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                    f"-I{self.prefix}/include", *eigen, "-include", f"rigid_body_sim/{name}.hpp",
                    "-x", "c++", "/dev/null")

    def test_a_scene_with_the_effect_flies_as_nasa_says(self):
        turn = product(inverse(START), self.attitude())
        error = angle_deg(product(inverse(REFERENCE), turn))
        print("off by %.5f deg" % error, flush=True)
        self.assertLess(error, MOST_DEG)

    def test_flow_and_wrench_are_one_motion_to_second_order(self):
        tensor = ("[0.00256821747, 0.00842101104, 0.00975465594]",
                  "[0.004, -0.001, 0.0005, 0.008, 0.0012, 0.009]")
        coefficients = ("[-1, -1, -1]", "[-1, -0.3, -0.7]")
        truth = self.attitude(tensor, coefficients, ("step_s: 0.01", "step_s: 0.01\nintegrator: rk8"))
        errors = []
        for step in "0.02", "0.01":
            flown = self.attitude(tensor, coefficients, ("step_s: 0.01", "step_s: " + step))
            errors.append(angle_deg(product(inverse(truth), flown)))
        slope = math.log2(errors[0] / errors[1])
        print("errors %.2e and %.2e deg, slope %.3f" % (*errors, slope), flush=True)
        self.assertAlmostEqual(slope, 2, delta=0.1)

    def test_coefficients_are_along_the_axes_of_the_root_link(self):
        """The brick as another link sees it, whose x is the brick's y, y its z, z its x."""
        chord = ("chord: 0.203201016", "chord: 0.101598984")  # as the span
        one = self.attitude(chord, ("[-1, -1, -1]", "[-1, -2, -3]"))
        x, y, z, w = *product(START, CYCLE)[1:], product(START, CYCLE)[0]
        other = self.attitude(
            chord, ("[-1, -1, -1]", "[-2, -3, -1]"),
            ("[0.00256821747, 0.00842101104, 0.00975465594]",
             "[0.00842101104, 0.00975465594, 0.00256821747]"),
            ("[0.7071067811865476, 0.7071067811865476, 0, 0]", f"[{x}, {y}, {z}, {w}]"),
            ("[0.17453292519943295, 0.3490658503988659, 0.5235987755982988]",
             "[0.3490658503988659, 0.5235987755982988, 0.17453292519943295]"))
        error = angle_deg(product(inverse(product(one, CYCLE)), other))
        print("seen otherwise: %.1e deg" % error, flush=True)
        self.assertLess(error, 1e-9)  # rounding of 3000 steps, measured 1e-11

    def test_no_parameter_makes_it_unstable(self):
        q = self.attitude(("[-1, -1, -1]", "[-1.0e+12, -1.0e+3, -1.0e+15]"))
        turn = angle_deg(product(inverse(START), q))
        # Pitch goes on at 20 deg/s until 57/s^2 t^2 is about 1; a body that had been frozen would not turn.
        self.assertGreater(turn, 1)
        self.assertLess(turn, 4)

    def test_a_method_that_would_be_unstable_is_refused(self):
        refused = self.fly_changed(("[-1, -1, -1]", "[-100, -100, -100]"),
                                   ("  brick:", "  brick:\n    linear_velocity: [0, 0, -300]"),
                                   ("step_s: 0.01", "step_s: 0.01\nintegrator: rk4"))
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn("'rate_damping' is too stiff", refused.stdout)
        self.assertIn("the largest stable step is", refused.stdout)

    def test_bad_parameters_are_refused_with_path_value_and_unit(self):
        path = "effects.rate_damping."
        for old, new, words in (
                ("span: 0.101598984", "span: 0", path + "span: 0 is not a finite number > 0 [m]"),
                ("[-1, -1, -1]", "[-1, 0.5, -1]",
                 path + "coefficients[1]: 0.5 is not a finite number <= 0 [no unit]"),
                ("chord: 0", "cord: 0", "rate_damping.chord: is missing"),
                ("span:", "air_density: -1\n    span:",
                 path + "air_density: -1 is not a finite number >= 0 [kg/m^3]"),
                ("span:", "sweep: 1\n    span:", path + "sweep: unknown key")):
            refused = self.fly_changed((old, new))
            self.assertEqual(refused.returncode, 1, refused.stdout)
            self.assertIn(words, refused.stdout)

    def test_without_the_library_the_scene_is_refused(self):
        refused = self.fly(**self.path_without)
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn("effects.rate_damping: unknown key; ", refused.stdout)
        self.assertIn(f"no built-in effect of this name, and no library {LIBRARY} on the dynamic "
                      "linker's path", refused.stdout)

    def test_libraries_that_do_not_fit_are_refused(self):
        folder = SCRATCH / "unfit"
        for what, (source, words) in UNFIT.items():
            with self.subTest(what):
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
                (folder / "source.cpp").write_text(source)
                succeed("c++", "-shared", "-fPIC", folder / "source.cpp", "-o", folder / LIBRARY)
                self.refuses(folder, words)
        with self.subTest("name"):
            shutil.copy(self.own / "lib" / LIBRARY, folder / LIBRARY.replace("rate", "other"))
            scene = SCRATCH / "other.yaml"
            scene.write_text(SCENE.read_text().replace("rate_damping", "other_damping"))
            self.refuses(folder, "offers 'rate_damping' instead", scene, "other_damping")
        with self.subTest("no library at all"):
            (folder / LIBRARY).write_text("x" * 4096)
            self.refuses(folder, "cannot be loaded: ")

    def refuses(self, folder, words, scene=SCENE, name="rate_damping"):
        path = f"{folder}:{self.path_without['LD_LIBRARY_PATH']}"
        refused = self.fly(scene, LD_LIBRARY_PATH=path)
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn(f"effects.{name}: its plug-in ", refused.stdout)
        self.assertIn(words, refused.stdout)

    def test_the_node_flies_the_scene_too(self):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        uri = f"http://localhost:{port}/"
        os.environ.update(ROS_MASTER_URI=uri, ROS_HOSTNAME="localhost", ROS_HOME=str(SCRATCH),
                          ROS_LOG_DIR=str(SCRATCH))
        os.environ.pop("ROS_IP", None)
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        try:
            self.set_parameters(uri)
            self.assertIn("rate_damping (1 body)", self.said_by_node(self.path))
            self.assertIn(f"no library {LIBRARY}", self.said_by_node(self.path_without))
        finally:
            master.terminate()
            master.wait()

    @staticmethod
    def set_parameters(uri):
        for key, value in yaml.safe_load(SCENE.read_text()).items():
            for _ in range(200):  # the master takes a second to start
                try:
                    with xmlrpc.client.ServerProxy(uri) as proxy:
                        proxy.setParam("/test", "/sim/" + key, value)
                    break
                except OSError:
                    time.sleep(0.1)

    def said_by_node(self, environment):
        """What it says until it names the effect."""
        node = subprocess.Popen([str(self.prefix / "lib/rigid_body_sim/rigid_body_sim_node"),
                                 "__name:=sim"],
                                env=dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1", **environment),
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        alarm = threading.Timer(MOST_S, node.kill)
        alarm.start()
        said = ""
        for line in node.stdout:
            said += line
            if "rate_damping" in line:
                node.send_signal(signal.SIGINT)
        node.stdout.close()
        node.wait()
        alarm.cancel()
        return said


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
