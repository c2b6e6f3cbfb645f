"""ROS 2: ros2 launch asdic_ros asdic.launch.py scenario:=deep_ocean.toml"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("scenario"),
        Node(package="asdic_ros", executable="asdic_node2", name="asdic", output="screen",
             remappings=[("~/odometry", "/odometry")],
             parameters=[{"scenario": LaunchConfiguration("scenario"),
                          "receiver_options": "--target-depth 125m --from 10"}]),
    ])
