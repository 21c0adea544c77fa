# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""An excavator of OPERA: ns is that of its topics."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("ns", default_value="zx120"),
        DeclareLaunchArgument("points", default_value="/points"),
        DeclareLaunchArgument("site_frame", default_value="base_link"),
        DeclareLaunchArgument("site", default_value=""),  # folder that remembers the ground
        Node(package="excavplan_ros", executable="excavplan_node", name="excavplan",
             namespace=LaunchConfiguration("ns"), output="screen",
             remappings=[("points", LaunchConfiguration("points")),
                         ("start_dig", "/start_dig"), ("end_dig", "/end_dig")],
             parameters=[{"machine": "zx120", "soil": "loam",
                          "site_frame": LaunchConfiguration("site_frame"),
                          "site": LaunchConfiguration("site")}]),
    ])
