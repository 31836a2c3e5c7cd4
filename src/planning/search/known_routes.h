#pragma once

#include <vector>

#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

namespace gpu_planning_scene::core
{
/// Ways from a start to a goal along known paths, in motions no longer than `range`. From the start, a route goes
/// straight to the nearest place of a known path, along the path to the place that is nearest to a goal, and straight
/// to this goal. Returns at most two routes, those with the shortest straight parts first; none whose straight parts
/// are together longer than half the distance from the start to the goal. Nothing is checked.
std::vector<ompl::geometric::PathGeometric> knownRoutes(const ompl::base::SpaceInformationPtr& information,
                                                        const std::vector<ompl::geometric::PathGeometric>& known,
                                                        const std::vector<const ompl::base::State*>& starts,
                                                        const std::vector<const ompl::base::State*>& goals,
                                                        double range);
}  // namespace gpu_planning_scene::core
