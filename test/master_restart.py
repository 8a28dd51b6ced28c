#!/usr/bin/python3
"""The node without a master, and when the master is restarted.

Starts masters of its own on a free port. Usage: master_restart.py PATH_OF_THE_NODE"""

import os
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

import rospy
from rigid_body_sim.msg import BodyStates, ImpulseStamped
from std_srvs.srv import SetBool

NODE = sys.argv.pop(1)
SCENE = '_bodies/ball/point_mass:=2.0'
START = 20.0  # [s] a master or a Python program may take, on a busy machine
BACK = 3.0    # [s] until the node is registered with a new master
END = 1.0     # [s] until SIGINT has ended the node


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def wait_for(what, condition, timeout):
    """Returns how long it took until `condition` was true."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > timeout:
            raise AssertionError('waited %g s in vain for %s' % (timeout, what))
        time.sleep(0.01)
    return time.monotonic() - start


class Program:
    """A program that is started, and all that it says."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        universal_newlines=True)
        self.said = ''
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            self.said += line

    def wait_until_it_says(self, text):
        wait_for('"%s"' % text, lambda: text in self.said, START)

    def interrupt(self, timeout):
        """Its exit code after SIGINT."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(timeout)
        finally:
            self.process.kill()
            self.process.wait()
            self.reader.join()
            self.process.stdout.close()


class Master:
    def __init__(self, uri):
        self.uri = uri
        self.program = None

    def ask(self, method, *arguments):
        """The answer; None if there is no master."""
        try:
            with xmlrpc.client.ServerProxy(self.uri) as proxy:
                return getattr(proxy, method)('/master_restart', *arguments)[2]
        except (OSError, xmlrpc.client.Error):
            return None

    def start(self):
        self.program = Program('roscore', '-p', self.uri.split(':')[-1].strip('/'))
        wait_for('a master', self.is_complete, START)

    def is_complete(self):
        return any('/rosout' in nodes for _, nodes in (self.ask('getSystemState') or [[]])[0])

    def stop(self):
        if self.program:
            self.program.interrupt(START)
            self.program = None

    def registered(self, node):
        """What a node has here: published, subscribed, services."""
        state = self.ask('getSystemState') or [[], [], []]
        return [sorted(name for name, nodes in part if node in nodes) for part in state]


def is_gapless(ticks):
    """The first may come twice: as the latched one, and because it was just being published."""
    rest = ticks[1:] if ticks[:1] == ticks[1:2] else ticks
    return rest == list(range(rest[0], rest[0] + len(rest)))


class Ear:
    """Listens to the states, here in this process."""

    def __init__(self):
        self.ticks = []
        self.velocity = 0.0
        self.subscriber = rospy.Subscriber('/states', BodyStates, self.hear, tcp_nodelay=True)

    def hear(self, states):
        self.ticks.append(states.tick)
        self.velocity = states.twists[0].linear.x

    def wait_for_ticks(self, count):
        end = len(self.ticks) + count
        wait_for('%d more ticks' % count, lambda: len(self.ticks) >= end, START)


def push(linear_x, *options):
    """A program that gives the ball an impulse, over and over or once."""
    return Program('rostopic', 'pub', *options, '/ball/impulse', ImpulseStamped._type,
                   '{header: {frame_id: world}, linear: {x: %g}}' % linear_x)


class MasterTest(unittest.TestCase):
    def setUp(self):
        self.master = Master(os.environ['ROS_MASTER_URI'])
        self.programs = []

    def tearDown(self):
        for program in reversed(self.programs):
            program.process.send_signal(signal.SIGCONT)
            program.interrupt(START)
        self.master.stop()

    def run_program(self, program):
        self.programs.append(program)
        return program

    def start_node(self, *parameters):
        return self.run_program(Program(NODE, '__name:=sim', *parameters))

    def wait_until_registered(self, timeout=START):
        return wait_for('the node at the master',
                        lambda: '/sim/reset' in self.master.registered('/sim')[2], timeout)


class WithoutAMaster(MasterTest):
    def test_the_node_waits_and_says_where_it_looks_for_one(self):
        node = self.start_node()
        node.wait_until_it_says('no master at ' + self.master.uri)
        self.assertIsNone(node.process.poll())

    def test_sigint_ends_the_waiting_node_with_zero_within_a_second(self):
        node = self.start_node()
        node.wait_until_it_says('no master')
        self.assertEqual(node.interrupt(END), 0)

    def test_sigint_ends_a_node_that_waits_with_parameters_on_its_command_line(self):
        node = self.start_node(SCENE)
        node.wait_until_it_says('Failed to contact master')  # roscpp wants to set them
        self.assertEqual(node.interrupt(END), 0)

    def test_the_waiting_node_starts_when_the_master_comes(self):
        node = self.start_node(SCENE)
        node.wait_until_it_says('Failed to contact master')
        self.master.start()
        self.wait_until_registered()

    def test_sigint_ends_a_node_whose_master_died_with_zero_within_a_second(self):
        for _ in range(3):
            self.master.start()
            node = self.start_node(SCENE)
            self.wait_until_registered()
            self.master.stop()
            self.assertEqual(node.interrupt(END), 0, node.said)


class AfterARestart(MasterTest):
    """rospy can be started once in a process, so one test listens here, and in one order."""

    def test_a_node_goes_on_and_is_found_again(self):
        self.master.start()
        node = self.start_node(SCENE)
        self.wait_until_registered()
        rospy.init_node('ear', anonymous=True, disable_signals=True, disable_rosout=True)
        ear = Ear()
        ear.wait_for_ticks(10)
        before = self.master.registered('/sim')

        with self.subTest('it goes on while there is no master'):
            self.master.stop()
            ear.wait_for_ticks(50)

        with self.subTest('topics and services are there again'):
            self.master.start()
            back = wait_for('topics and services',
                            lambda: self.master.registered('/sim') == before, BACK)
            print('registered again %.2f s after the new master came' % back, flush=True)

        with self.subTest('a new subscriber hears it'):
            echo = self.run_program(Program('rostopic', 'echo', '-n', '3', '/states/tick'))
            wait_for('three states', lambda: echo.said.count('---') == 3, START)
            ticks = [int(tick) for tick in re.findall(r'^\d+$', echo.said, re.MULTILINE)]
            self.assertTrue(is_gapless(ticks), ticks)

        with self.subTest('a new publisher pushes the ball'):
            self.assertEqual(ear.velocity, 0)
            self.run_program(push(3, '-1'))
            wait_for('the push', lambda: ear.velocity != 0, START)
            self.assertEqual(ear.velocity, 1.5)

        with self.subTest('its services answer'):
            answer = rospy.ServiceProxy('/sim/pause', SetBool)(True)
            self.assertTrue(answer.success)

        with self.subTest('the old connection has lost no tick'):
            self.assertTrue(is_gapless(ear.ticks), ear.ticks)

        with self.subTest('SIGINT ends it'):
            self.assertEqual(node.interrupt(END), 0)

    def test_a_publisher_that_the_new_master_knew_first_is_connected(self):
        self.master.start()
        node = self.start_node(SCENE)
        self.wait_until_registered()
        self.master.stop()
        node.process.send_signal(signal.SIGSTOP)
        self.master.start()
        self.run_program(push(1, '-r', '10'))
        wait_for('the publisher',
                 lambda: '/ball/impulse' in dict(self.master.ask('getSystemState')[0]), START)
        node.process.send_signal(signal.SIGCONT)
        self.wait_until_registered(BACK)
        echo = self.run_program(Program('rostopic', 'echo', '/states/twists[0]/linear/x'))
        wait_for('a push', lambda: re.search(r'^[1-9]', echo.said, re.MULTILINE), START)


if __name__ == '__main__':
    home = tempfile.mkdtemp(prefix='master_restart_')
    os.environ.update(ROS_MASTER_URI='http://localhost:%d/' % free_port(), ROS_HOSTNAME='localhost',
                      ROS_HOME=home, ROS_LOG_DIR=home)
    os.environ.pop('ROS_IP', None)
    try:
        unittest.main(verbosity=2, warnings='ignore')  # rospy has many
    finally:
        shutil.rmtree(home)
