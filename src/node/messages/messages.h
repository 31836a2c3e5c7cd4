#pragma once
// All messages and services of this package. ROS puts them into the namespace gpu_planning_scene, so their names can be
// used in gpu_planning_scene::core without a prefix. Some names are also classes of the library; the aliases below
// name the messages.

#include <gpu_planning_scene/AllowedCollisionMatrix.h>
#include <gpu_planning_scene/AnswerStatus.h>
#include <gpu_planning_scene/ApplyPlanningScene.h>
#include <gpu_planning_scene/BodyDistance.h>
#include <gpu_planning_scene/CheckMotions.h>
#include <gpu_planning_scene/CheckStates.h>
#include <gpu_planning_scene/CheckTrajectory.h>
#include <gpu_planning_scene/Clear.h>
#include <gpu_planning_scene/ComputeCartesianPath.h>
#include <gpu_planning_scene/ComputeFk.h>
#include <gpu_planning_scene/ComputeIk.h>
#include <gpu_planning_scene/Constraints.h>
#include <gpu_planning_scene/ContactInformation.h>
#include <gpu_planning_scene/ExcludeFromSensors.h>
#include <gpu_planning_scene/GetPlanningScene.h>
#include <gpu_planning_scene/GetReport.h>
#include <gpu_planning_scene/NearestPair.h>
#include <gpu_planning_scene/PlanMotion.h>
#include <gpu_planning_scene/PlanningScene.h>
#include <gpu_planning_scene/PlanningSceneComponents.h>
#include <gpu_planning_scene/ShowTreeLevel.h>
#include <gpu_planning_scene/WatchState.h>
#include <gpu_planning_scene/WatchTrajectory.h>

namespace gpu_planning_scene::core
{
using AllowedCollisionMatrixMessage = gpu_planning_scene::AllowedCollisionMatrix;
using ObjectTypeMessage = gpu_planning_scene::ObjectType;
using BodyDistanceMessage = gpu_planning_scene::BodyDistance;
using NearestPairMessage = gpu_planning_scene::NearestPair;
using PlanningSceneMessage = gpu_planning_scene::PlanningScene;
}  // namespace gpu_planning_scene::core
