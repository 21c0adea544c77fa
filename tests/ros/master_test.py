#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ROS 1 under a running master.

master_test.py NODES GENERATED BIN DATA: the folder of the programs, the Python folder of their
generated services, the folder of the tools and that of the data.
"""

import json
import math
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

NODES, GENERATED, BIN, DATA = sys.argv[1:5]
NODE = os.path.join(NODES, "excavplan_node")
JOB_NODE = os.path.join(NODES, "excavplan_job_node")
JOINTS = ["boom_joint", "arm_joint", "bucket_joint", "swing_joint"]
PATIENCE = 60.0  # [s]


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


HOME = tempfile.TemporaryDirectory()
PORT = free_port()
os.environ.update(ROS_MASTER_URI=f"http://localhost:{PORT}", ROS_HOSTNAME="localhost",
                  ROS_HOME=HOME.name, ROS_LOG_DIR=HOME.name, EXCAVPLAN_DATA=DATA)
sys.path.insert(0, GENERATED)

import actionlib  # noqa: E402
import rosgraph  # noqa: E402
import rospy  # noqa: E402
from actionlib_msgs.msg import GoalStatus  # noqa: E402
from excavplan_ros.msg import DoStepAction, DoStepActionFeedback, DoStepGoal  # noqa: E402
from excavplan_ros.srv import DigAndPlan, Estimate, Plan, StepDone, StepDoneRequest  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from rosgraph_msgs.msg import Log  # noqa: E402
from sensor_msgs.msg import JointState, PointCloud2, PointField  # noqa: E402
from std_msgs.msg import Bool, String  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402
from trajectory_msgs.msg import JointTrajectory  # noqa: E402


def wait_until(holds, what):
    end = time.monotonic() + PATIENCE
    while not holds():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain for {what}")
        time.sleep(0.02)


def tool(*words):
    done = subprocess.run([os.path.join(BIN, words[0]), *words[1:], "--json", "--quiet"],
                          stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def shipped(name):
    return os.path.join(DATA, "quickstart", name + ".pcd")


def points_of(name):
    with open(shipped(name), "rb") as file:
        return file.read().split(b"DATA binary\n", 1)[1]


def cloud(data, frame="site"):
    """Points of three float32."""
    message = PointCloud2()
    message.header.frame_id = frame
    message.fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1)
                      for i, axis in enumerate("xyz")]
    message.point_step = 12
    message.width = len(data) // 12
    message.height = 1
    message.row_step = 12 * message.width
    message.data = data
    return message


class Junk(PointCloud2):
    """Bytes that are no message."""

    def serialize(self, buff):
        buff.write(self.data)


def garbage():
    good = cloud(points_of("before")[:12000])

    def changed(**values):
        message = cloud(good.data)
        for name, value in values.items():
            setattr(message, name, value)
        return message

    fields = good.fields
    yield changed(fields=[])
    yield changed(fields=fields[:2])
    yield changed(fields=fields + fields)
    yield changed(fields=[PointField(f.name, f.offset, 9, 1) for f in fields])
    yield changed(fields=[PointField(f.name, 0xFFFFFFFF, 7, 1) for f in fields])
    yield changed(height=2, row_step=1)
    yield changed(width=1000000000)
    yield changed(width=1000000000, height=1000000000, row_step=0xFFFFFFFF)
    yield changed(point_step=0)
    yield changed(data=b"")
    yield Junk(data=b"")
    yield Junk(data=b"\xff" * 40)
    yield Junk(data=struct.pack("<IIII", 1, 2, 3, 0xFFFFFFFF) + b"x" * 100)


def unreadable_points():
    """What is a message, but shows no ground."""
    yield cloud(struct.pack("<fff", math.nan, math.nan, math.nan) * 1000)
    yield cloud(b"")
    swapped = cloud(points_of("before")[:12000])
    swapped.is_bigendian = True
    yield swapped


class Node:
    """The program with these private parameters."""

    def __init__(self, **parameters):
        words = [f"_{key}:={value}" for key, value in parameters.items()]
        self.process = subprocess.Popen([NODE, "__name:=excavplan", *words],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.parameters = parameters
        self.state = ""
        self.trajectory = None
        self.heard = rospy.Subscriber("/excavplan/trajectory", JointTrajectory,
                                      self.take_trajectory)
        self.told = rospy.Subscriber("/excavplan/state", String, self.take_state)
        self.publishers = {
            "points": rospy.Publisher("/points", PointCloud2, queue_size=10),
            "start": rospy.Publisher("/start_dig", Bool, queue_size=10),
            "end": rospy.Publisher("/end_dig", Bool, queue_size=10),
            "joints": rospy.Publisher("/joint_states", JointState, queue_size=10),
            "tf": rospy.Publisher("/tf_static", TFMessage, queue_size=10),
        }
        for topic, publisher in self.publishers.items():
            wait_until(lambda p=publisher: p.get_num_connections() > 0, f"{topic} to be heard")
        wait_until(lambda: self.state != "", "the first state")
        wait_until(lambda: self.heard.get_num_connections() > 0, "the trajectory's topic")

    def take_state(self, message):
        self.state = message.data

    def take_trajectory(self, message):
        self.trajectory = message

    def send(self, topic, message, age=0.0):
        if topic in ("points", "joints"):
            message.header.stamp = rospy.Time.from_sec(time.time() - age)
        self.publishers[topic].publish(message)

    def stand(self, angles, times=4):
        """The joints stand there, by messages of 0.6 s."""
        for _ in range(times):
            self.send("joints", JointState(name=JOINTS, position=angles))
            time.sleep(0.2)

    def seconds_computed(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as line:
            user, system = line.read().rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def stand_until_it_searches(self, angles):
        """A search is what the node computes longer than 0.2 s for."""
        begin = self.seconds_computed()
        wait_until(lambda: self.stand(angles, 1) or self.seconds_computed() > begin + 0.2, "the search")

    def send_until(self, topic, message, state):
        self.send(topic, message)
        wait_until(lambda: self.state == state, f"'{state}' after '{self.state}'")

    def call(self, name, kind):
        rospy.wait_for_service("/excavplan/" + name, PATIENCE)
        return rospy.ServiceProxy("/excavplan/" + name, kind)()

    def dig(self, before, after):
        if self.state == "before 1 of 1":  # further points would not show in it
            self.send_until("start", Bool(True), "digging 0 of 1")
            self.send_until("end", Bool(True), "after 0 of 1")
            self.send_until("points", before, "done 1 of 1")
        else:
            self.send_until("points", before, "before 1 of 1")
        self.send_until("start", Bool(True), "digging 0 of 1")
        self.send_until("end", Bool(True), "after 0 of 1")
        self.send_until("points", after, "done 1 of 1")

    def alive(self):
        return self.process.poll() is None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.told.unregister()
        self.heard.unregister()
        for publisher in self.publishers.values():
            publisher.unregister()
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=PATIENCE)
        for key in self.parameters:
            if rospy.has_param("/excavplan/" + key):
                rospy.delete_param("/excavplan/" + key)


class JobNode:
    """The program of a job in this folder, and a client of its action."""

    def __init__(self, folder, **parameters):
        words = [f"_{key}:={value}" for key, value in {"job": folder, **parameters}.items()]
        self.parameters = ["job", *parameters]
        self.process = subprocess.Popen([JOB_NODE, "__name:=job", *words],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.trajectories = []
        self.shown = []
        self.steps = []
        self.angles = None
        self.standing = threading.Thread(target=self.send_joints)
        self.is_over = threading.Event()
        self.heard = [rospy.Subscriber("/job/trajectory", JointTrajectory, self.trajectories.append),
                      rospy.Subscriber("/job/step", String, self.take_step)]
        self.publishers = {
            "points": rospy.Publisher("/points", PointCloud2, queue_size=10),
            "joints": rospy.Publisher("/joint_states", JointState, queue_size=10),
        }
        for topic, publisher in self.publishers.items():
            wait_until(lambda p=publisher: p.get_num_connections() > 0, f"{topic} to be heard")
        for heard in self.heard:
            wait_until(lambda h=heard: h.get_num_connections() > 0, f"the topic {heard.name}")
        self.client = actionlib.SimpleActionClient("/job/do_step", DoStepAction)
        if not self.client.wait_for_server(rospy.Duration(PATIENCE)):
            raise AssertionError("no server of the action")

    def take_step(self, message):
        self.steps.append(json.loads(message.data))

    @property
    def step(self):
        """The one that was shown last."""
        wait_until(lambda: self.steps, "a step")
        return self.steps[-1]

    def stand(self, angles):
        """From now on the joints stand there."""
        self.angles = angles
        self.standing.start()
        time.sleep(0.8)

    def send_joints(self):
        while not self.is_over.wait(0.1):
            message = JointState(name=JOINTS, position=self.angles)
            message.header.stamp = rospy.Time.from_sec(time.time())
            self.publishers["joints"].publish(message)

    def scan(self, data):
        message = cloud(data)
        message.header.stamp = rospy.Time.from_sec(time.time())
        self.publishers["points"].publish(message)

    def begin(self):
        self.shown, self.trajectories[:] = [], []
        self.client.send_goal(DoStepGoal(), feedback_cb=self.shown.append)

    def states(self):
        return [feedback.state for feedback in self.shown]

    def wait_for(self, state):
        wait_until(lambda: state in self.states() or self.client.get_result(), f"'{state}'")
        if state not in self.states():
            raise AssertionError(f"the goal ended: {self.client.get_result().message}")
        return self.shown[-1]

    def report(self, step, **told):
        rospy.wait_for_service("/job/step_done", PATIENCE)
        return rospy.ServiceProxy("/job/step_done", StepDone)(StepDoneRequest(step=step, **told))

    def result(self):
        if not self.client.wait_for_result(rospy.Duration(PATIENCE)):
            raise AssertionError("no result")
        return self.client.get_result()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.is_over.set()
        if self.angles:
            self.standing.join()
        for each in (*self.heard, *self.publishers.values()):
            each.unregister()
        self.process.send_signal(signal.SIGKILL)
        self.process.communicate(timeout=PATIENCE)
        for key in self.parameters:
            rospy.delete_param("/job/" + key)


class Job(unittest.TestCase):
    STANDS = [-0.6, 1.6, 0.5, 0.4]

    @classmethod
    def setUpClass(cls):
        places = [0.1 * i - 9.5 for i in range(191)]
        cls.level = b"".join(struct.pack("<fff", x + 3, y, 0) for x in places for y in places)

    def begun(self):
        """The folder of a short trench in level ground, as plan-site begins it."""
        folder = tempfile.mkdtemp(dir=HOME.name)
        scan = os.path.join(folder, "level.xyz")
        with open(scan, "w", encoding="ascii") as file:
            file.writelines("%.2f %.2f %.2f\n" % point
                            for point in struct.iter_unpack("<fff", self.level))
        job = os.path.join(folder, "job")
        tool("plan-site", "new", job, "--trench", "2.5x1x0.4", "--from", "4,0", "--heading", "0",
             "--scan", scan, "--soil", "loam", "--windrow", "0,1.5,9,1.5,9,5,0,5")
        return job

    def do_move(self, node):
        node.begin()
        shown = node.wait_for("driving")
        self.assertEqual((shown.what, shown.step), ("move", node.step["step"]))
        base = node.step["base"]
        told = node.report(shown.step, base=[base["x_m"], base["y_m"], base["heading_rad"]])
        self.assertTrue(told.success, told.message)
        return node.result()

    def test_does_steps_with_feedback(self):
        folder = self.begun()
        with JobNode(folder, scans=2) as node:
            moved = self.do_move(node)
            self.assertTrue(moved.success and moved.trustworthy, moved.message)
            # A client misses what comes before it knows that its goal was accepted.
            self.assertIn(node.states(), (["planning", "driving"], ["driving"]))
            self.assertEqual(json.loads(moved.progress_json)["moves"], 1)

            node.stand(self.STANDS)
            node.begin()
            shown = node.wait_for("driving")
            self.assertEqual(shown.what, "dig")
            wait_until(lambda: node.trajectories, "the trajectory")
            self.assertGreater(len(node.trajectories[0].points), 10)
            for one, other in zip(node.trajectories[0].points[0].positions, self.STANDS):
                self.assertAlmostEqual(one, other, 9)
            self.assertEqual(node.step["trajectory_points"], len(node.trajectories[0].points))
            self.assertEqual(node.client.get_state(), GoalStatus.ACTIVE)
            told = node.report(shown.step, payload_kg=[40.0], energy_kj=[90.0])  # little: it looks
            self.assertTrue(told.success, told.message)
            dug = node.result()
            self.assertTrue(dug.success, dug.message)
            self.assertEqual(json.loads(dug.progress_json)["payload_kg"], 40.0)

            node.begin()
            shown = node.wait_for("driving")
            self.assertEqual(shown.what, "scan")
            self.assertTrue(node.report(shown.step).success)
            node.wait_for("scan 0 of 2")
            self.send_junk(node)
            node.scan(self.level)
            self.assertGreaterEqual(node.wait_for("scan 1 of 2").share_done, 0.0)
            node.scan(self.level)
            seen = node.result()
            self.assertTrue(seen.success, seen.message)
            self.assertIn("no_hole_found: ", " ".join(seen.warnings))  # none was dug
            self.assertFalse(seen.trustworthy)
            self.assertEqual(json.loads(seen.progress_json)["scans"], 1)
        shown = tool("plan-site", "show", folder)["progress"]
        self.assertEqual((shown["moves"], shown["digs"], shown["scans"]), (1, 1, 1))

    def send_junk(self, node):
        told = []
        log = rospy.Subscriber("/rosout", Log, lambda message: told.append(message.msg))
        self.addCleanup(log.unregister)
        wait_until(lambda: log.get_num_connections() > 0, "rosout")
        wait_until(lambda: node.publishers["points"].publish(Junk(data=b"\xff" * 40)) or
                   time.sleep(0.2) or any("/points: " in text for text in told), "the refusal")

    def test_same_step_as_plan_site_after_cancel_and_kill(self):
        folder = self.begun()
        with JobNode(folder, scans=1) as node:
            self.do_move(node)
            node.stand(self.STANDS)
            node.begin()
            dig = node.wait_for("driving")
            wrong = node.report(dig.step + 7, payload_kg=[300.0])
            self.assertFalse(wrong.success)
            self.assertIn(f"the present one is {dig.step}", wrong.message)
            self.assertIn("more than one", node.report(dig.step, payload_kg=[1.0, 2.0]).message)
            self.assertEqual(node.client.get_state(), GoalStatus.ACTIVE)
            node.client.cancel_goal()
            cancelled = node.result()
            self.assertEqual(node.client.get_state(), GoalStatus.PREEMPTED)
            self.assertFalse(cancelled.success)
            wait_until(lambda: len(node.trajectories) > 1, "a trajectory without points")
            self.assertEqual(node.trajectories[-1].points, [])
            node.begin()
            self.assertEqual(node.wait_for("driving").step, dig.step)
            step = node.step
        with JobNode(folder, scans=1) as node:  # the one before was killed
            node.begin()  # without joint states
            refused = node.result()
            self.assertEqual(node.client.get_state(), GoalStatus.ABORTED)
            self.assertIn("posture_unknown: ", refused.message)
            wait_until(lambda: node.trajectories, "a trajectory without points")
            self.assertEqual(node.trajectories[-1].points, [])
            for key in ("step", "what", "path", "dump", "predicted", "base"):
                self.assertEqual(node.step[key], step[key], key)
            self.assertTrue(node.report(dig.step, payload_kg=[300.0]).success)
            self.assertFalse(node.report(dig.step, payload_kg=[300.0]).success)
        shown = tool("plan-site", "next", folder)
        self.assertGreater(shown["step"], dig.step)

    def test_a_goal_cancelled_while_it_is_planned_sends_no_motion(self):
        with JobNode(self.begun(), scans=1) as node:
            self.do_move(node)
            node.stand(self.STANDS)
            planning = threading.Event()

            def stop(message):  # the client itself does not show feedback of a goal so early
                if message.feedback.state == "planning" and not planning.is_set():
                    node.process.send_signal(signal.SIGSTOP)
                    planning.set()

            shown = rospy.Subscriber("/job/do_step/feedback", DoStepActionFeedback, stop)
            self.addCleanup(shown.unregister)
            wait_until(lambda: shown.get_num_connections() > 0, "feedback")
            node.trajectories.clear()
            node.client.send_goal(DoStepGoal())
            self.assertTrue(planning.wait(PATIENCE))
            node.client.cancel_goal()
            time.sleep(0.5)  # it waits where the node is going to find it
            node.process.send_signal(signal.SIGCONT)
            self.assertFalse(node.result().success)
            self.assertEqual(node.client.get_state(), GoalStatus.PREEMPTED)
            node.client.send_goal(DoStepGoal())
            sent = node.trajectories
            wait_until(lambda: len(sent) > 1 and sent[-1].points, "that of the other goal")
            self.assertEqual([bool(each.points) for each in sent], [False, True])

    def test_a_scan_whose_transforms_do_not_come_ends(self):
        with JobNode(self.begun(), scans=1, site_frame="map") as node:
            self.do_move(node)
            node.begin()  # without joint states
            node.result()
            self.assertTrue(node.report(node.step["step"], stalled=True).success)
            node.begin()
            scan = node.wait_for("driving")
            self.assertEqual(scan.what, "scan")
            self.assertTrue(node.report(scan.step).success)
            self.assertTrue(node.report(scan.step).success)
            self.assertIn("reported otherwise", node.report(scan.step, energy_kj=[1.0]).message)
            node.wait_for("scan 0 of 1")
            node.scan(self.level)
            self.assertIn("the step is to be reported again", node.result().message)

    def test_another_goal_ends_the_first(self):
        with JobNode(self.begun(), scans=1) as node:
            node.begin()
            node.wait_for("driving")
            other = actionlib.SimpleActionClient("/job/do_step", DoStepAction)
            self.assertTrue(other.wait_for_server(rospy.Duration(PATIENCE)))
            other.send_goal(DoStepGoal())
            self.assertIn("another goal", node.result().message)
            wait_until(lambda: other.get_state() == GoalStatus.ACTIVE, "the other goal")
            self.assertTrue(node.report(node.step["step"]).success)
            self.assertTrue(other.wait_for_result(rospy.Duration(PATIENCE)))
            self.assertTrue(other.get_result().success)

    def test_refuses_bad_parameters(self):
        for name, value, told in (("job", "", "parameter job: is missing"), ("job", "/nowhere", "/nowhere"),
                                  ("scans", 0, "parameter scans is 0")):
            rospy.set_param("/bad/" + name, value)
            done = subprocess.run([JOB_NODE, "__name:=bad"], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=PATIENCE, check=False)
            rospy.delete_param("/bad/" + name)
            self.assertEqual(done.returncode, 1, name)
            self.assertIn(told, done.stdout.decode())


class Master(unittest.TestCase):
    def check_trajectory(self, trajectory, limits_of):
        self.assertEqual(trajectory.joint_names, JOINTS)
        self.assertGreater(len(trajectory.points), 10)
        times = [point.time_from_start.to_nsec() for point in trajectory.points]
        self.assertEqual(times[0], 0)
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        for point in trajectory.points:
            self.assertEqual((point.positions[3], point.velocities[3]), (0.0, 0.0))
            for name, at, rate in zip(JOINTS[:3], point.positions, point.velocities):
                limits = limits_of[name[:-len("_joint")]]
                self.assertGreaterEqual(at, limits["lower_rad"] - 1e-9)
                self.assertLessEqual(at, limits["upper_rad"] + 1e-9)
                self.assertLessEqual(abs(rate), limits["speed_rad_per_s"])

    def test_same_numbers_as_the_tools(self):
        with open(os.path.join(DATA, "machines", "zx120.json"), encoding="utf-8") as file:
            limits = json.load(file)["joints"]
        with Node(scans=1) as node:
            node.dig(cloud(points_of("before")), cloud(points_of("after")))
            estimated = node.call("estimate", Estimate)
            answer = node.call("dig_and_plan", DigAndPlan)
            wait_until(lambda: node.trajectory, "the trajectory")
            results = [rospy.wait_for_message(f"/excavplan/{name}_result", String, PATIENCE).data
                       for name in ("estimate", "plan")]
        expected = tool("estimate-density", shipped("before"), shipped("after"), "--soil", "loam")
        self.assertEqual(answer.estimate_message, "")
        found = json.loads(answer.estimate_json)
        for key in ("bulking_factor", "bulking_factor_sd", "density_percent", "law",
                    "density_sd_percent", "density_interval_percent", "trustworthy"):
            self.assertEqual(found[key], expected[key], key)
        for key, value in found["volume"].items():
            self.assertEqual(value, expected["volume"][key], key)
        self.assertTrue(estimated.success and estimated.trustworthy, estimated.message)
        self.assertEqual(estimated.density_percent, expected["density_percent"])
        self.assertEqual(estimated.bulking_factor, expected["bulking_factor"])
        self.assertEqual(results, [answer.estimate_json, answer.json])

        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(found, file)
            file.flush()
            planned = tool("plan-path", "--density-from", file.name, "--terrain", shipped("after"))
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(answer.previous_density)
        self.assertEqual(answer.density_percent, expected["density_percent"])
        given = json.loads(answer.json)
        for key in ("path", "payload_mass_kg", "energy_kj", "efficiency_kg_per_kj", "source",
                    "duration_s", "start_rule"):
            self.assertEqual(given[key], planned[key], key)
        self.check_trajectory(answer.trajectory, limits)
        self.assertEqual(node.trajectory.joint_names, JOINTS)
        self.assertEqual(node.trajectory.points, [])  # it does not begin where the machine stands
        self.assertTrue(any(text.startswith("posture_unknown: ") for text in answer.warnings))

    def test_an_estimate_not_to_be_trusted_keeps_the_previous_density(self):
        with Node(scans=1, density_percent=33.0, density_sd_percent=4.0) as node:
            node.dig(cloud(points_of("before")), cloud(points_of("before")))
            answer = node.call("dig_and_plan", DigAndPlan)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(answer.previous_density)
        self.assertEqual(answer.density_percent, 33.0)
        self.assertIn("previous_density", " ".join(answer.warnings))

    def test_transforms_and_joint_states(self):
        raw = points_of("before"), points_of("after")
        lifted = []
        for data in raw:  # the sensor frame: x forward, z down, 3 m up
            points = struct.iter_unpack("<fff", data)
            lifted.append(b"".join(struct.pack("<fff", x, -y, 3.0 - z) for x, y, z in points))
        transform = TransformStamped()
        transform.header.frame_id = "base_link"
        transform.child_frame_id = "camera"
        transform.transform.translation.z = 3.0
        transform.transform.rotation.x = 1.0
        with Node(scans=1, site_frame="base_link") as node:
            node.send("tf", TFMessage([transform]))
            plan = node.call("plan", Plan)
            self.assertTrue(plan.success, plan.message)
            node.send("joints", JointState(name=JOINTS,
                                           position=plan.trajectory.points[0].positions))
            node.dig(cloud(lifted[0], "camera"), cloud(lifted[1], "camera"))
            answer = node.call("estimate", Estimate)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("dug_path_doubtful", " ".join(answer.warnings))  # it had planned another dig
        expected = tool("estimate-density", shipped("before"), shipped("after"), "--soil", "loam")
        self.assertAlmostEqual(answer.bulking_factor, expected["bulking_factor"], delta=0.02)

    def test_sends_a_trajectory_once_and_only_from_where_the_machine_stands(self):
        present = [-0.6, 1.6, 0.5, 0.4]
        with Node(scans=1, density_percent=40, density_sd_percent=2.0, level_ground=True) as node:
            node.stand(present)
            answer = node.call("plan", Plan)
            self.assertTrue(answer.trustworthy, answer.warnings)
            wait_until(lambda: node.trajectory, "the trajectory")
            self.assertEqual(node.trajectory.points, answer.trajectory.points)
            for one, other in zip(node.trajectory.points[0].positions, present):
                self.assertAlmostEqual(one, other, 9)
            with self.assertRaises(rospy.ROSException):  # not latched
                rospy.wait_for_message("/excavplan/trajectory", JointTrajectory, 1.0)
            time.sleep(1.0)  # nothing comes
            warnings = self.sends_nothing(node)
            self.assertIn("posture_unknown: no joint states of boom_joint came within 1 s", warnings)
            node.stand([-0.6, 1.6, 0.5, 0.2], 1)
            node.stand([-0.6, 1.6, 0.5, 0.3], 1)
            self.assertIn("not_standing: ", self.sends_nothing(node))
        with Node(scans=1, send_doubtful=True) as node:
            answer = node.call("plan", Plan)
            wait_until(lambda: node.trajectory, "the trajectory")
            self.assertEqual(node.trajectory.points, answer.trajectory.points)
            self.assertGreater(len(answer.trajectory.points), 10)

    def sends_nothing(self, node):
        """A plan whose trajectory has no points; its warnings."""
        node.trajectory = None
        answer = node.call("plan", Plan)
        wait_until(lambda: node.trajectory, "the trajectory")
        self.assertEqual(node.trajectory.points, [])
        return " ".join(answer.warnings)

    def test_a_machine_that_moves_during_a_search_is_sent_nothing(self):
        for moves in (False, True):
            with Node(scans=1, density_percent=40.0, density_sd_percent=2.0, level_ground=True,
                      search=True, search_seconds=5) as node:
                node.stand([-0.6, 1.6, 0.5, 0.4])
                answers = []
                plan = threading.Thread(target=lambda: answers.append(node.call("plan", Plan)))
                plan.start()
                node.stand_until_it_searches([-0.6, 1.6, 0.5, 0.4])
                while not answers:
                    node.stand([-0.6, 1.6, 0.5, 0.8 if moves else 0.4], 1)
                plan.join()
                wait_until(lambda: node.trajectory, "the trajectory")
                self.assertGreater(len(answers[0].trajectory.points), 10)
                self.assertEqual(answers[0].trustworthy, not moves, answers[0].warnings)
                self.assertEqual(len(node.trajectory.points) == 0, moves)
                self.assertEqual("start_left: " in " ".join(answers[0].warnings), moves)

    def test_ground_that_is_assumed_or_outdated_is_not_trusted(self):
        with Node(scans=1, density_percent=40.0, density_sd_percent=2.0) as node:
            node.stand([-0.6, 1.6, 0.5, 0.4])
            self.assertIn("level_ground: ", self.sends_nothing(node))
            node.send_until("points", cloud(points_of("before")), "before 1 of 1")
            node.send_until("start", Bool(True), "digging 0 of 1")
            node.send_until("end", Bool(True), "after 0 of 1")
            node.stand([-0.6, 1.6, 0.5, 0.4])
            node.trajectory = None
            answer = node.call("dig_and_plan", DigAndPlan)
            wait_until(lambda: node.trajectory, "the trajectory")
        self.assertEqual(node.trajectory.points, [])
        self.assertTrue(answer.success and answer.previous_density)
        self.assertFalse(answer.trustworthy)
        self.assertIn("0 of 1 messages", answer.estimate_message)
        self.assertIn("ground_before_dig: ", " ".join(answer.warnings))

    def test_an_earlier_scan_shows_where_the_machine_swings(self):
        around = os.path.join(HOME.name, "around.xyz")
        with open(around, "w", encoding="ascii") as file:
            places = [0.1 * i - 9.5 for i in range(191)]
            file.writelines(f"{x:.2f} {y:.2f} 0\n" for x in places for y in places)
        for surroundings in ("", around):
            with Node(scans=1, density_percent=40.0, density_sd_percent=2.0, whole_cycle=True,
                      surroundings=surroundings, joint_age_seconds=60.0) as node:
                node.send_until("points", cloud(points_of("before")), "before 1 of 1")
                node.stand([-0.6, 1.6, 0.5, 0.4])
                answer = node.call("plan", Plan)
            self.assertGreater(len(answer.trajectory.points), 10, answer.warnings)
            self.assertEqual("unseen_way: " in " ".join(answer.warnings), not surroundings)
            self.assertEqual(answer.trustworthy, bool(surroundings), answer.warnings)

    def test_a_site_remembers_the_dig(self):
        site = os.path.join(HOME.name, "pit")
        with Node(scans=1, site=site) as node:
            node.dig(cloud(points_of("before")), cloud(points_of("after")))
            answer = node.call("dig_and_plan", DigAndPlan)
            again = node.call("estimate", Estimate)
        self.assertEqual(answer.estimate_message, "")
        found = json.loads(answer.estimate_json)
        self.assertEqual((found["site"]["digs"], found["site"]["taken"]), (1, True))
        self.assertEqual(again.json, answer.estimate_json)
        self.assertEqual(answer.density_percent, json.loads(answer.json)["density_percent"])
        told = tool("estimate-density", "--site", site)
        self.assertEqual((told["site"]["updates"], told["site"]["digs"]), (1, 1))

    def test_a_machine_with_a_kit(self):
        kit = os.path.join(HOME.name, "zx200-kit")
        tool("machine-kit", "zx200", "--output", kit, "--soil", "loam", "--densities", "0,50,100",
             "--slopes", "0", "--draws", "20")
        with Node(scans=1, machine=kit, level_ground=True, whole_cycle=True) as node:
            node.stand([-0.6, 1.6, 0.5, 0.4])
            answer = node.call("plan", Plan)
        self.assertTrue(answer.success, answer.message)
        self.assertGreater(len(answer.trajectory.points), 10)
        planned = tool("plan-path", "--machine", kit, "--density", "50", "--density-sd", "25")
        self.assertEqual(json.loads(answer.json)["path"], planned["path"])

    def test_points_of_the_dig_that_come_late_are_left_out_and_told(self):
        told = []
        log = rospy.Subscriber("/rosout", Log, lambda message: told.append(message.msg))
        self.addCleanup(log.unregister)
        with Node(scans=1) as node:
            wait_until(lambda: log.get_num_connections() > 0, "rosout")
            node.send_until("points", cloud(points_of("before")), "before 1 of 1")
            node.send_until("start", Bool(True), "digging 0 of 1")
            node.send_until("end", Bool(True), "after 0 of 1")
            node.send("points", cloud(points_of("before")), age=20.0)
            wait_until(lambda: node.state == "after 0 of 1, 1 too early", "the state")
            wait_until(lambda: "are left out" in " ".join(told), "the warning")
            node.send("points", cloud(points_of("after")))
            wait_until(lambda: node.state == "done 1 of 1, 1 too early", "the state")
            answer = node.call("estimate", Estimate)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("early_points", " ".join(answer.warnings))

    def test_a_search_ends_in_time(self):
        with Node(search=True, search_seconds=0.2) as node:
            answer = node.call("plan", Plan)
        self.assertIn("search_stopped", " ".join(answer.warnings))

    def test_survives_garbage(self):
        told = []
        log = rospy.Subscriber("/rosout", Log, lambda message: told.append(message.msg))
        self.addCleanup(log.unregister)
        with Node(scans=1) as node:
            wait_until(lambda: log.get_num_connections() > 0, "rosout")
            answer = node.call("estimate", Estimate)
            self.assertFalse(answer.success)
            self.assertIn("before the first dig", answer.message)
            node.send("start", Bool(True))
            node.send("end", Bool(True))
            for message in garbage():  # one at a time: a queue of ROS drops what it cannot hold
                refused = len(told)
                node.send("points", message)
                wait_until(lambda: any(text.startswith("/points: ") for text in told[refused:]),
                           "the points to be refused")
            node.send("joints", JointState(name=["boom_joint"], position=[1.0, 2.0]))
            node.send("joints", JointState(name=JOINTS, position=[math.nan] * 4))
            node.send("tf", TFMessage([TransformStamped()] * 3))
            wait_until(lambda: "2 positions" in " ".join(told), "the joint states to be refused")
            self.assertTrue(node.alive())
            self.assertEqual(node.state, "before 0 of 1")
            self.assertIn("field x 0 times", " ".join(told))
            self.assertTrue(node.call("plan", Plan).success)
            for message in unreadable_points():
                node.send("points", message)
                time.sleep(0.2)
                answer = node.call("plan", Plan)
                self.assertFalse(answer.success)
                self.assertNotEqual(answer.message, "")
            self.assertTrue(node.alive())
            node.dig(cloud(points_of("before")), cloud(points_of("after")))
            answer = node.call("estimate", Estimate)
            self.assertTrue(answer.success, answer.message)

    def test_refuses_bad_parameters(self):
        for name, value, told in (("scans", 0, "scans is 0"), ("scan", 3, "is not known"),
                                  ("soil", "snow", "snow"), ("joint_names", ["a"], "4: boom"),
                                  ("scans", "many", "not of its type"),
                                  ("rate_hz", 5, "parameter rate_hz: "),
                                  ("max_jerk", 0.0, "parameter max_jerk: "),
                                  ("speed_fraction", 2, "parameter speed_fraction: "),
                                  ("density_sd_percent", -1, "parameter density_sd_percent: "),
                                  ("machine", "zx200", "make one with machine-kit"),
                                  ("dump_height", 30.0, "the dump height is 30 m")):
            rospy.set_param("/bad/" + name, value)
            done = subprocess.run([NODE, "__name:=bad"], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=PATIENCE, check=False)
            self.assertEqual(done.returncode, 1, name)
            self.assertIn(told, done.stdout.decode())
            rospy.delete_param("/bad/" + name)


def main():
    core = subprocess.Popen(["/usr/bin/roscore", "-p", str(PORT)], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        wait_until(rosgraph.is_master_online, "the master")
        rospy.init_node("client", anonymous=True, disable_signals=True)
        result = unittest.main(argv=sys.argv[:1], exit=False, verbosity=2, warnings="ignore").result
        rospy.signal_shutdown("done")
    finally:
        core.send_signal(signal.SIGINT)
        core.wait(PATIENCE)
    sys.exit(not result.wasSuccessful())


if __name__ == "__main__":
    main()
