#!/usr/bin/python3
"""Allows or forbids collisions of two bodies in the scene of a running planning_scene_node. Other pairs stay."""
import argparse
import sys


def default_of(matrix, first, second):
    """Whether the defaults of two bodies allow their collision. As in MoveIt, all of their defaults must."""
    defaults = dict(zip(matrix.default_entry_names, matrix.default_entry_values))
    found = [defaults[name] for name in (first, second) if name in defaults]
    return bool(found) and all(found)


def set_entry(matrix, first, second, is_allowed, make_row):
    """`make_row`: makes the row of a body from its values. A body without entries gets a row of its defaults."""
    for name in (first, second):
        if name in matrix.entry_names:
            continue
        for other, row in zip(matrix.entry_names, matrix.entry_values):
            row.enabled.append(default_of(matrix, name, other))
        matrix.entry_values.append(make_row([default_of(matrix, name, other) for other in [*matrix.entry_names, name]]))
        matrix.entry_names.append(name)
    i, j = matrix.entry_names.index(first), matrix.entry_names.index(second)
    matrix.entry_values[i].enabled[j] = matrix.entry_values[j].enabled[i] = is_allowed


def set_default(matrix, name, is_allowed):
    """Sets the default of a body: it decides for all pairs of the body without an entry, also with later bodies."""
    names, values = list(matrix.default_entry_names), list(matrix.default_entry_values)
    if name not in names:
        names.append(name)
        values.append(is_allowed)
    values[names.index(name)] = is_allowed
    matrix.default_entry_names, matrix.default_entry_values = names, values


def require_known(scene, robot_bodies, names):
    """Ends the program if a name is neither a link nor an object, because its entry would apply to no body."""
    known = robot_bodies | {item.id for item in scene.world.collision_objects} | {"<octomap>"}
    known |= {item.object.id for item in scene.robot_state.attached_collision_objects}
    for name in names:
        if name not in known:
            sys.exit(f"allow_collision.py: '{name}' is neither a link nor an object of the scene; there are: "
                     + ", ".join(sorted(known - {"<octomap>"})))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bodies", nargs=2, metavar="BODY", help="a link, an object or an attached object; '*' as one "
                        "of the two: all bodies without an entry for the other one, also those of later")
    parser.add_argument("--forbid", action="store_true", help="forbid the collision, so that the pair is checked")
    parser.add_argument("--node", default="/planning_scene", help="name of the node (default /planning_scene)")
    arguments = parser.parse_args()
    if arguments.bodies[0] == arguments.bodies[1]:
        parser.error("the two bodies are the same")
    import rospy
    from gpu_planning_scene.msg import AllowedCollisionEntry, PlanningScene
    from gpu_planning_scene.srv import ApplyPlanningScene, GetPlanningScene

    try:
        rospy.wait_for_service(arguments.node + "/apply_planning_scene", 5)
        got = rospy.ServiceProxy(arguments.node + "/get_planning_scene", GetPlanningScene)()
        if not got.success:
            sys.exit("allow_collision.py: " + got.message)
        scene = got.scene
        named = [body for body in arguments.bodies if body != "*"]
        require_known(scene, {item.link_name for item in scene.link_padding}, named)
        matrix = scene.allowed_collision_matrix
        if len(named) == 1:
            set_default(matrix, named[0], not arguments.forbid)
        else:
            set_entry(matrix, *named, not arguments.forbid, AllowedCollisionEntry)
        change = PlanningScene(is_diff=True, allowed_collision_matrix=matrix)
        change.robot_state.is_diff = True
        answer = rospy.ServiceProxy(arguments.node + "/apply_planning_scene", ApplyPlanningScene)(change)
    except (rospy.ROSException, rospy.ServiceException) as error:
        sys.exit(f"allow_collision.py: {arguments.node} does not answer: {error}")
    if not answer.success:
        sys.exit("allow_collision.py: " + answer.message)
    print("done" + (f"; the node answers: {answer.message}" if answer.message else ""))


if __name__ == "__main__":
    main()
