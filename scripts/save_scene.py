#!/usr/bin/python3
"""Writes the objects of a planning_scene_node's scene to a .scene file. RViz's MotionPlanning plugin reads it too."""
import argparse
import sys

SHAPES = {1: "box", 2: "sphere", 3: "cylinder", 4: "cone"}


def pose_lines(pose):
    position, rotation = pose.position, pose.orientation
    return [f"{position.x!r} {position.y!r} {position.z!r}",
            f"{rotation.x!r} {rotation.y!r} {rotation.z!r} {rotation.w!r}"]


def primitive_lines(primitive):
    """Cylinders and cones have the height before the radius in a message, and after it in a file."""
    dimensions = list(primitive.dimensions)
    if SHAPES[primitive.type] in ("cylinder", "cone"):
        dimensions.reverse()
    return [SHAPES[primitive.type], " ".join(map(repr, dimensions))]


def mesh_lines(mesh):
    return ["mesh", f"{len(mesh.vertices)} {len(mesh.triangles)}",
            *(f"{vertex.x!r} {vertex.y!r} {vertex.z!r}" for vertex in mesh.vertices),
            *(" ".join(map(str, triangle.vertex_indices)) for triangle in mesh.triangles)]


def object_lines(item, color):
    """`color`: its components as a line of the file."""
    shapes = [(primitive_lines(shape), pose) for shape, pose in zip(item.primitives, item.primitive_poses)]
    shapes += [(mesh_lines(shape), pose) for shape, pose in zip(item.meshes, item.mesh_poses)]
    shapes += [(["plane", " ".join(map(repr, shape.coef))], pose) for shape, pose in zip(item.planes, item.plane_poses)]
    lines = [f"* {item.id}", *pose_lines(item.pose), str(len(shapes))]
    for shape, pose in shapes:
        lines += [*shape, *pose_lines(pose), color]
    lines.append(str(len(item.subframe_names)))
    for name, pose in zip(item.subframe_names, item.subframe_poses):
        lines += [name, *pose_lines(pose)]
    return lines


def require_name(kind, name, is_word):
    """The format has each name of an object in a line, and each name of a subframe as a word."""
    if not name or name != name.strip() or "\n" in name or (is_word and len(name.split()) != 1):
        sys.exit(f"save_scene.py: the {kind} '{name}' cannot be written to a .scene file; give it a name "
                 f"{'without spaces' if is_word else 'in one line'}")


def scene_text(scene):
    """The text of the file for a gpu_planning_scene/PlanningScene message of the node."""
    colors = {item.id: f"{item.color.r!r} {item.color.g!r} {item.color.b!r} {item.color.a!r}"
              for item in scene.object_colors}
    lines = [scene.name or "(noname)"]
    for item in scene.world.collision_objects:
        require_name("object", item.id, False)
        for name in item.subframe_names:
            require_name("subframe", name, True)
        lines += object_lines(item, colors.get(item.id, "0 0 0 0"))
    return "\n".join([*lines, "."]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", help="its name ends in .scene")
    parser.add_argument("--node", default="/planning_scene", help="name of the node (default /planning_scene)")
    arguments = parser.parse_args()
    if not arguments.file.endswith(".scene"):
        parser.error(f"the file is '{arguments.file}'; its name must end in .scene")
    import rospy
    from gpu_planning_scene.srv import GetPlanningScene

    service = arguments.node + "/get_planning_scene"
    try:
        rospy.wait_for_service(service, 5)
        answer = rospy.ServiceProxy(service, GetPlanningScene)()
    except (rospy.ROSException, rospy.ServiceException) as error:
        sys.exit(f"save_scene.py: {service} does not answer: {error}")
    if not answer.success:
        sys.exit(f"save_scene.py: {answer.message}")
    scene = answer.scene
    text = scene_text(scene)  # before the file is opened: after an error, an old file stays
    with open(arguments.file, "w", encoding="utf-8") as file:
        file.write(text)
    carried = [attached.object.id for attached in scene.robot_state.attached_collision_objects]
    if carried:
        print(f"not written, because links carry them: {', '.join(carried)}", file=sys.stderr)
    ruled = [solid.id for solid in scene.solids]
    if ruled:
        print(f"not written, because the format has no rules for the inside of meshes (solids): {', '.join(ruled)}",
              file=sys.stderr)
    if scene.world.octomap.octomap.data:
        print("not written, because the format has no octomaps: <octomap>", file=sys.stderr)
    print(f"{len(scene.world.collision_objects)} objects of revision {scene.scene_revision} in {arguments.file}")


if __name__ == "__main__":
    main()
