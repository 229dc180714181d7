#!/usr/bin/env python3
"""TELE-031 What is on the wire while Fast DDS reads the topics, captured by Cyclone DDS and decoded by tshark.

    capture_test.py DDS_TESTS         needs Debian's tshark; says so and fails without it
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TOPICS = {
    "rt/s4tp/tracked_objects": "autoware_perception_msgs::msg::dds_::TrackedObjects_",
    "rt/s4tp/predicted_objects": "autoware_perception_msgs::msg::dds_::PredictedObjects_",
    "rt/s4tp/trajectory": "autoware_planning_msgs::msg::dds_::Trajectory_",
    "rt/s4tp/fail_safe": "autoware_planning_msgs::msg::dds_::Trajectory_",
    "rt/s4tp/candidates": "visualization_msgs::msg::dds_::MarkerArray_",
    "rt/s4tp/control": "autoware_control_msgs::msg::dds_::Control_",
    "rt/s4tp/risk": "nav_msgs::msg::dds_::OccupancyGrid_",
    "rt/s4tp/path": "nav_msgs::msg::dds_::Path_",
    "rt/s4tp/lanes": "visualization_msgs::msg::dds_::MarkerArray_",
    "rt/s4tp/explanation": "std_msgs::msg::dds_::String_",
    "rt/diagnostics": "diagnostic_msgs::msg::dds_::DiagnosticArray_",
    "rt/tf": "tf2_msgs::msg::dds_::TFMessage_",
}
LOOPBACK = """<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>120</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
<Tracing><PacketCaptureFile>FILE</PacketCaptureFile></Tracing>"""


def tshark(file, shown, *fields):
    # RTPS is known by its first bytes. An ephemeral port may be another protocol's own, which must not be asked first.
    command = ["tshark", "-r", str(file), "-o", "udp.try_heuristic_first:TRUE", "-Y", shown, "-T", "fields"]
    command += [one for field in fields for one in ("-e", field)]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    return [line.split("\t") for line in result.stdout.splitlines()]


def main(program):
    if not shutil.which("tshark"):
        sys.exit("capture_test: needs Debian's tshark")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "wire.pcap"
        environment = {**os.environ, "CYCLONEDDS_URI": LOOPBACK.replace("FILE", str(file))}
        drive = subprocess.run([program, "--gtest_filter=Topics.ReachFastDds*"], env=environment, check=False, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if drive.returncode != 0:
            sys.exit(f"capture_test: exit code {drive.returncode}\n{drive.stdout}")
        # A topic's own messages: tshark finds their topic by the writer that discovery announced.
        data = tshark(file, "rtps.sm.id == 0x15 || rtps.sm.id == 0x16", "rtps.param.topicName", "rtps.param.typeName",
                      "rtps.sm.wrEntityId")
        seen = {}
        for topics, types, writers in data:
            for topic, kind, writer in zip(topics.split(","), types.split(","), writers.split(",")):
                if int(writer, 16) & 0xFF == 0x03:  # an application's writer
                    seen.setdefault(topic, set()).add(kind)
        malformed = tshark(file, "_ws.malformed", "frame.number")
        print(f"capture_test: {len(data)} messages, {len(malformed)} malformed")
        missing = [topic for topic, kind in TOPICS.items() if seen.get(topic) != {kind}]
        if missing or malformed:
            sys.exit(f"capture_test: not decoded: {missing}; malformed: {len(malformed)}; seen: {seen}")


if __name__ == "__main__":
    main(*sys.argv[1:])
