// Fits an oriented box to the triangles of a node. Of four boxes, it chooses the one with the smallest surface. The
// axes of the boxes are:
// - the axes of the frame;
// - the main axes of the corners (Gottschalk, Lin and Manocha 1996, "OBBTree");
// - the normal of the largest triangle and its edge of middle length, which is a side if the triangle is half a
//   rectangle;
// - the same normal and the axis of the frame that is nearest to the plane of the triangle.
// src/collision/geometry/oriented_box.cpp does the same in double. All coordinates are relative to `origin`, the centre
// of the node's axis-aligned box, in metres.
#include "common/comparisons.glsl"
#include "geometry/quaternion.glsl"

#define FIT_BOXES 4

// Sums over the corners of triangles, from which the axes are chosen.
struct Spread
{
  vec3 sum;
  vec3 squares;   // xx, yy, zz
  vec3 products;  // yz, zx, xy
  float largest;  // squared length of the largest triangle's normal
  uint triangle;
};

struct Extents
{
  vec3 low[FIT_BOXES];
  vec3 high[FIT_BOXES];
};

Spread emptySpread(uint triangle)
{
  return Spread(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, triangle);
}

Extents emptyExtents()
{
  const vec3 least = vec3(-3.4e38);
  return Extents(vec3[](-least, -least, -least, -least), vec3[](least, least, least, least));
}

void fetchAround(uint triangle, vec3 origin, out vec3 corners[3])
{
  fetchTriangle(triangle, corners);
  for (int i = 0; i < 3; ++i)
  {
    precise const vec3 around = corners[i] - origin;
    corners[i] = around;
  }
}

void add(inout Spread spread, vec3 corners[3], uint triangle)
{
  for (int i = 0; i < 3; ++i)
  {
    spread.sum += corners[i];
    spread.squares += corners[i] * corners[i];
    spread.products += corners[i].yzx * corners[i].zxy;
  }
  const vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float size = dot(normal, normal);
  if (size > spread.largest)
  {
    spread.largest = size;
    spread.triangle = triangle;
  }
}

void join(inout Spread spread, Spread other)
{
  spread.sum += other.sum;
  spread.squares += other.squares;
  spread.products += other.products;
  const bool larger = other.largest > spread.largest;
  spread.triangle = larger ? other.triangle : spread.triangle;
  spread.largest = larger ? other.largest : spread.largest;
}

// The main axes, by Jacobi's method. Each rotation removes the largest off-diagonal entry. A box along any axes is
// valid, so the convergence does not affect correctness.
vec4 mainAxes(mat3 covariance)
{
  vec4 q = vec4(0.0, 0.0, 0.0, 1.0);
  for (int step = 0; step < 8; ++step)
  {
    const mat3 axes = rotationOf(q);
    const mat3 m = transpose(axes) * covariance * axes;
    const vec3 beside = vec3(m[1].z, m[2].x, m[0].y);  // yz, zx, xy
    const vec3 sizes = abs(beside);
    const bool about_x = sizes.x >= sizes.y && sizes.x >= sizes.z;
    const bool about_y = !about_x && sizes.y >= sizes.z;
    const vec3 axis = about_x ? vec3(1.0, 0.0, 0.0) : about_y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    const float off = dot(axis, beside);
    const float difference = about_x ? m[2].z - m[1].y : about_y ? m[0].x - m[2].z : m[1].y - m[0].x;
    if (!(abs(off) > 1e-6 * (abs(difference) + abs(off))))
      break;
    const float theta = difference / (2.0 * off);
    const float tangent = (theta < 0.0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1.0));
    const float cosine = inversesqrt(tangent * tangent + 1.0);
    const float half_cosine = sqrt(0.5 + 0.5 * cosine);
    q = normalize(product(q, vec4(axis * (-0.5 * tangent * cosine / half_cosine), half_cosine)));
  }
  return q;
}

// Axes with this z, of unit length, and with x as near to `direction` as possible.
vec4 axesFrom(vec3 direction, vec3 z)
{
  const vec3 x = normalize(direction - dot(z, direction) * z);
  return quaternionOf(mat3(x, cross(z, x), z));
}

vec3 middleEdge(vec3 corners[3])
{
  const vec3 edges[3] = vec3[](corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]);
  const vec3 sizes = vec3(dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2]));
  const float least = min(sizes.x, min(sizes.y, sizes.z));
  const float most = max(sizes.x, max(sizes.y, sizes.z));
  const float middle = sizes.x + sizes.y + sizes.z - least - most;
  const vec3 off = abs(sizes - middle);
  return off.x <= off.y && off.x <= off.z ? edges[0] : off.y <= off.z ? edges[1] : edges[2];
}

// The axis of the frame that is nearest to the plane with this normal.
vec3 nearestAxis(vec3 normal)
{
  const vec3 n = abs(normal);
  return n.x <= n.y && n.x <= n.z ? vec3(1.0, 0.0, 0.0) : n.y <= n.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
}

void chooseAxes(Spread spread, uint count, vec3 origin, out vec4 axes[FIT_BOXES])
{
  const vec3 mean = spread.sum / float(3u * count);
  const vec3 squares = spread.squares / float(3u * count) - mean * mean;
  const vec3 products = spread.products / float(3u * count) - mean.yzx * mean.zxy;
  vec3 corners[3];
  fetchAround(spread.triangle, origin, corners);
  axes[0] = vec4(0.0, 0.0, 0.0, 1.0);
  axes[1] = mainAxes(mat3(squares.x, products.z, products.y, products.z, squares.y, products.x, products.y, products.x,
                          squares.z));
  const vec3 edge = middleEdge(corners);
  const vec3 normal = normalize(cross(normalize(corners[1] - corners[0]), corners[2] - corners[0]));
  axes[2] = axesFrom(edge, normal);
  axes[3] = axesFrom(nearestAxis(normal), normal);
}

void extend(inout Extents extents, vec3 corners[3], mat3 axes[FIT_BOXES])
{
  for (int box = 0; box < FIT_BOXES; ++box)
    for (int i = 0; i < 3; ++i)
    {
      const vec3 along = corners[i] * axes[box];
      extents.low[box] = min(extents.low[box], along);
      extents.high[box] = max(extents.high[box], along);
    }
}

float halfSurface(vec3 sizes)
{
  return sizes.x * sizes.y + sizes.y * sizes.z + sizes.z * sizes.x;
}

// Writes the box with the smallest surface. A surface that is NaN is never the smallest. The half edge lengths are
// rounded outwards. This covers the rounding of the corners, which are at most `radius` from `origin`, the errors of
// the axes (25 u per entry), and the rounding of the centre.
void writeBest(uint at, TreeNode node, Extents extents, vec4 axes[FIT_BOXES])
{
  int best = 0;
  for (int box = 1; box < FIT_BOXES; ++box)
    if (provenGreater(halfSurface(extents.high[best] - extents.low[best]),
                      halfSurface(extents.high[box] - extents.low[box])))
      best = box;
  const vec3 low = extents.low[best];
  const vec3 high = extents.high[best];
  const float radius = node.box.extent.x + node.box.extent.y + node.box.extent.z;
  const vec3 center = node.box.center + rotationOf(axes[best]) * (0.5 * (low + high));
  const float off = UNIT_ROUNDOFF * (128.0 * radius + 4.0 * (abs(center.x) + abs(center.y) + abs(center.z))) + 1e-37;
  writeOriented(at, node, center, 0.5 * (high - low) + off, axes[best]);
}
