#pragma once
// All messages and services of this package, for programs that use its libraries too. Two messages have the names of
// library types, as ROS puts both into the package's namespace; here they are PlanningSceneMessage and
// AllowedCollisionMatrixMessage. Include this instead of the generated headers, or before them.

#define PlanningScene PlanningSceneMessage
#define AllowedCollisionMatrix AllowedCollisionMatrixMessage
#include <gpu_planning_scene/AllowedCollisionMatrix.h>
#include <gpu_planning_scene/PlanningScene.h>
#undef AllowedCollisionMatrix
#undef PlanningScene

#include <gpu_planning_scene/ApplyPlanningScene.h>
#include <gpu_planning_scene/CheckMotions.h>
#include <gpu_planning_scene/CheckStates.h>
#include <gpu_planning_scene/Clear.h>
#include <gpu_planning_scene/ContactInformation.h>
#include <gpu_planning_scene/GetPlanningScene.h>
#include <gpu_planning_scene/GetReport.h>
#include <gpu_planning_scene/PlanMotion.h>
#include <gpu_planning_scene/PlanningSceneComponents.h>
#include <gpu_planning_scene/ShowTreeLevel.h>
