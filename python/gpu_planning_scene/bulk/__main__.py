"""python3 -m gpu_planning_scene.bulk"""
from gpu_planning_scene.bulk.command_line import main

if __name__ == "__main__":
    main()
