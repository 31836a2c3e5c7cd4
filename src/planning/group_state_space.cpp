#include "gpu_planning_scene/planning/group_state_space.h"
