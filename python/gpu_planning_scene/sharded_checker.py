"""A client of several planning_scene_nodes with the same scene: see docs/replicas.md.

It is the C++ class ShardedChecker (sharded_checker.h). This file converts genpy's messages. No other module of the package
needs a ROS master, and this one needs no rospy.init_node().
"""
import io
import sys

from gpu_planning_scene._client import Client
from gpu_planning_scene.srv import CheckStatesRequest, CheckStatesResponse

__all__ = ["ShardedChecker"]


class ShardedChecker:
    """Calls ~check_states of several nodes as if they were one: a leader and nodes that follow it (~follow).

    nodes: the names of the nodes, the leader first, for example ["/planning_scene", "/planning_scene_1"].
    part_states: most states of a part. timeout: seconds; a node that has not answered a call by then, with the time to
    connect to it, counts as failed. patience: seconds to try on while no node answers. Wrong values are ValueErrors.
    Threads may share a checker.

        check = ShardedChecker(["/planning_scene", "/planning_scene_1"])
        answer = check(joint_names=["shoulder", "elbow"], positions=[0.0, 0.1, 0.2, 0.3])
    """

    def __init__(self, nodes, part_states=16384, timeout=30.0, patience=10.0):
        names = nodes if isinstance(nodes, str) else list(nodes)  # a str is a TypeError, and not a list of letters
        self._client = Client(names, part_states=part_states, timeout=timeout, patience=patience, arguments=sys.argv)

    def __call__(self, *args, **kwargs):
        """As a rospy.ServiceProxy of ~check_states: a CheckStatesRequest, or its fields. Returns a CheckStatesResponse.

        If no node can answer, success is False; status and message have the reason: see sharded_checker.h. Ctrl-C ends
        the call.
        """
        if args and isinstance(args[0], CheckStatesRequest):
            if len(args) > 1 or kwargs:
                raise TypeError("a CheckStatesRequest is the only argument; set its fields instead")
            request = args[0]
        else:
            request = CheckStatesRequest(*args, **kwargs)
        buffer = io.BytesIO()
        request.serialize(buffer)
        return CheckStatesResponse().deserialize(self._client.check(buffer.getvalue()))
