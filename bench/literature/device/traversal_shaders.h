#pragma once

/// The compute shaders of the traversal in all_pairs_on_device.cpp, and the bindings that both sides use.
namespace gpu_planning_scene::core::literature
{
constexpr unsigned kNodesABinding = 0;  ///< of both shaders
constexpr unsigned kNodesBBinding = 1;
constexpr unsigned kListBinding = 2;
constexpr unsigned kMarksBinding = 3;
constexpr unsigned kTrianglesABinding = 4;  ///< of the tests
constexpr unsigned kTrianglesBBinding = 5;
constexpr unsigned kPosesBinding = 6;
constexpr unsigned kNextBinding = 4;  ///< of the lists
constexpr unsigned kFoundBinding = 5;
constexpr unsigned kCountersBinding = 6;
constexpr int kCountLocation = 0;
constexpr int kNextCapacityLocation = 1;
constexpr int kFoundCapacityLocation = 2;

/// The beginning of both shaders.
extern const char* const kTraversalDeclarations;
/// One invocation tests one entry of the list: the boxes of two nodes, and the triangles if both are leaves.
extern const char* const kTestShader;
/// One invocation writes the children of one entry to the next list, or its triangles to the found pairs.
extern const char* const kListShader;
}  // namespace gpu_planning_scene::core::literature
