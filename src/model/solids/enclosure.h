#pragma once

#include "model/solids/orientation.h"
#include "model/solids/welded_triangles.h"

namespace gpu_planning_scene::core
{
/// A surface that encloses chambers, in a part of a mesh.
struct Enclosure
{
  Numbers members;          ///< none: nothing is enclosed
  OrientedSurface surface;  ///< of the members, without signed boundary
  Numbers with_walls;       ///< the distinct triangles of the surface and of what it encloses
  Numbers rest;             ///< the other triangles of the part, for example a fin
  bool is_certain = true;   ///< false: `with_walls` seem to enclose more than the surface does, see countMissedPlaces
};

/// Finds what a part with edges of more than two triangles encloses. The part stays as it is in the file, if it has no
/// signed boundary. If that misses a place, the outer shell is tried. `part`: distinct triangles.
Enclosure enclosureOf(const WeldedTriangles& triangles, const Numbers& part);
}  // namespace gpu_planning_scene::core
