#include "gpu_planning_scene/planning/state_validity_checker.h"
