#include "gpu_planning_scene/planning/motion_validator.h"
