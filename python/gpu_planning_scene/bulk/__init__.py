"""Bulk checking and planning: python3 -m gpu_planning_scene.bulk --help, and docs/bulk.md.

The modules, from the lowest layer up:
    bundle        a robot and a scene with the content of all their files
    states        the states of a shard: random, or from a file
    plans         the planning problems of a shard
    work          the answer of a shard, in the process of a worker
    local         runs shards on the devices of this machine
    cluster       runs shards on a Dask cluster
    dispatch      gives shards to workers, and again if a worker is lost; compares workers
    output        shard files and the index, which a later run resumes
    progress      the progress bar
    run           a run, from the inputs to the files
    options       the options of the program
    command_line  the program
"""
from gpu_planning_scene.bulk.bundle import RobotBundle, SceneBundle

__all__ = ["RobotBundle", "SceneBundle"]
