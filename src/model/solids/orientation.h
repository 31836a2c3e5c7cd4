#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// A directed edge that the triangles of a surface run along once more often than against it.
struct BoundaryEdge
{
  std::uint32_t from;
  std::uint32_t to;
};

/// A surface whose triangles were turned so that neighbours agree.
struct OrientedSurface
{
  std::vector<Corners> triangles;      ///< in the order of the input; turned: the last two corners are exchanged
  std::vector<BoundaryEdge> boundary;  ///< the signed boundary; an edge may be there several times; empty: closed
  bool even = true;                    ///< each edge has an even number of triangles
};

/// Turns the triangles of a surface so that two triangles that share an edge alone run along it in opposite directions.
/// Triangles that are connected by such edges form a patch. In a patch, the larger area keeps its direction. Then
/// patches are turned as long as that shortens the signed boundary. The triangles must have distinct corners.
OrientedSurface orient(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles);

/// The surface with the directions that the triangles have. They must have distinct corners.
OrientedSurface asOriented(std::vector<Corners> triangles);

/// The signed boundary of triangles with distinct corners.
std::vector<BoundaryEdge> signedBoundary(const std::vector<Corners>& triangles);

/// The normal at the front of a triangle. Its length is twice the area.
Eigen::Vector3d areaNormal(const std::vector<Eigen::Vector3d>& points, const Corners& triangle);

/// The area of a triangle, in square metres.
double areaOf(const std::vector<Eigen::Vector3d>& points, const Corners& triangle);
}  // namespace gpu_planning_scene::core
