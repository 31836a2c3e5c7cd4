// Proofs by the balls of covers (src/collision/filter/proofs/ball_cover.h): outer balls contain a shape, inner balls
// are inside it. If all outer balls of two shapes are apart, so are the shapes; if two inner balls overlap, the shapes
// collide. Outer and inner balls: Weller and Zachmann, "Inner sphere trees", 2009. docs/error_bounds.md derives the
// bounds. Lengths are in metres.
#include "common/comparisons.glsl"
#include "geometry/solid.glsl"

// For each robot instance COVER_TEXELS texels: first the layer, the thickness and the COVER_* bits of its cover; then,
// for each ball, the outer ball (centre, radius), and the inner ball (witness, radius). Unused places hold copies.
layout(binding = UNIT_COVERS) uniform usamplerBuffer cover_texels;

struct Cover
{
  uint first;       // texel of the first ball
  float layer;      // the balls may leave a layer below the surface uncovered, which is at most this deep
  float thickness;  // each component of the shape contains a ball of this radius
  uint bits;
};

Cover fetchCover(uint robot)
{
  const uint at = robot * COVER_TEXELS;
  const uvec4 head = texelFetch(cover_texels, int(at));
  return Cover(at + 1u, uintBitsToFloat(head.x), uintBitsToFloat(head.y), head.z);
}

vec4 outerBall(Cover cover, uint ball)
{
  return uintBitsToFloat(texelFetch(cover_texels, int(cover.first + 2u * ball)));
}

vec4 innerBall(Cover cover, uint ball)
{
  return uintBitsToFloat(texelFetch(cover_texels, int(cover.first + 2u * ball + 1u)));
}

// Each level has the balls from levelBegin(level) to levelBegin(level + 1) - 1.
uint levelBegin(uint level)
{
  return level == 0u ? 0u : level == 1u ? COVER_COARSE_BALLS : COVER_BALLS;
}

// True if two points are proven to be farther apart than `reach`, up to the errors of their positions.
bool pointsApart(vec3 a, vec3 b, float reach)
{
  const vec3 between = vectorBetween(a, b);
  return provenGreater(dot(between, between), reach * reach * (1.0 + 32.0 * u));
}

// True if two points are proven to be nearer than `reach`, up to the errors of their positions. A negative reach proves
// nothing.
bool pointsNear(vec3 a, vec3 b, float reach)
{
  const vec3 between = vectorBetween(a, b);
  return reach > LEAST_SQUARED && provenGreater(reach * reach * (1.0 - 32.0 * u), dot(between, between));
}

// The lengths that decide a pair, in addition to the radii of the balls.
struct CoverReach
{
  float apart;  // apart: the distance is larger than the outer radii plus this
  float near;   // colliding: the distance is smaller than the inner radii plus this
};

// `layer`: the depth of the uncovered layer that matters for this pair; `distance`: the required distance.
CoverReach coverReach(RootPair pair, float distance, float layer)
{
  return CoverReach(boxMargin(pair.gap + layer, pair.error),
                    distance * (1.0 - 16.0 * u) - 2.0 * boxError(pair.error) - CONTRACT_BAND);
}

// True if a ball around `center` is proven to be more than `reach` away from the contents of a node, which is a solid
// or a box. All are in the frame of the node's tree.
bool centerBeyond(Instance solid, bool is_solid, OrientedNode node, vec3 center, float reach)
{
  if (is_solid)
    return boxBeyondSolid(solid, center, mat3(1.0), vec3(0.0), reach);
  const vec3 beyond =
      max(abs(vectorBetween(node.box.center, center) * node.axes) - node.box.extent, vec3(0.0));
  const float margin = reach * (1.0 + 64.0 * u) + 512.0 * u * dot(node.box.extent, vec3(1.0));
  return provenGreater(dot(beyond, beyond), margin * margin * (1.0 + 32.0 * u));
}

// The results of the proofs: STATE_HIT, 0 if the pair is apart, or STATE_UNDECIDED if nothing is proven.

// Of a robot instance and an object of the world, by the coarse balls, then by the fine ones. `node`: the root node of
// the object, or the node of the solid.
uint proveWorldPair(RootPair pair, Instance object, bool is_solid, OrientedNode node, float distance)
{
  const Cover cover = fetchCover(pairRobot(pair.pair));
  if ((cover.bits & COVER_UNUSABLE) != 0u)
    return STATE_UNDECIDED;
  // A primitive that is thicker than the layer cannot hide in it.
  const bool can_hide = !is_solid || !(innerRadius(object) * (1.0 - 64.0 * u) > cover.layer);
  const CoverReach reach = coverReach(pair, distance, can_hide ? cover.layer : 0.0);
  const vec3 core = coreSize(object, 0.0);
  const float rounding = 32.0 * u * length(node.box.extent);
  for (uint level = 0u; level < 2u; ++level)
  {
    bool apart = true;
    for (uint i = levelBegin(level); i < levelBegin(level + 1u); ++i)
    {
      const vec4 outer = outerBall(cover, i);
      const vec3 center = apply(pair.pose, outer.xyz);
      apart = apart && centerBeyond(object, is_solid, node, center, outer.w + reach.apart);
      if (!is_solid)
        continue;
      const vec4 inner = innerBall(cover, i);
      vec3 witness = center;
      if ((cover.bits & COVER_SAME_CENTERS) == 0u)
        witness = apply(pair.pose, inner.xyz);
      const float near = inner.w * (1.0 - 16.0 * u) + reach.near - (rounding + 32.0 * u * length(witness));
      if (pointsNear(witness, projectToCore(object.kind, core, witness), near))
        return STATE_HIT;
    }
    if (apart)
      return 0u;
  }
  return STATE_UNDECIDED;
}

// The depth of the uncovered layer of `outer` that can hide the whole of `inner`.
float openLayer(Cover outer, Cover inner)
{
  return inner.thickness > max(outer.layer, inner.layer) ? 0.0 : outer.layer;
}

// Of two robot instances, by their coarse balls. Pairs of fine balls would cost as much as the trees, and they decide
// few of the pairs that joint tables leave open.
uint proveSelfPair(RootPair pair, float distance)
{
  const Cover a = fetchCover(pairOther(pair.pair));
  const Cover b = fetchCover(pairRobot(pair.pair));
  if (((a.bits | b.bits) & COVER_UNUSABLE) != 0u)
    return STATE_UNDECIDED;
  const CoverReach reach = coverReach(pair, distance, max(openLayer(a, b), openLayer(b, a)));
  bool apart = true;
  for (uint j = 0u; j < COVER_COARSE_BALLS; ++j)
  {
    const vec4 outer_b = outerBall(b, j);
    const vec4 inner_b = innerBall(b, j);
    const vec3 center = apply(pair.pose, outer_b.xyz);
    vec3 witness = center;
    if ((b.bits & COVER_SAME_CENTERS) == 0u)
      witness = apply(pair.pose, inner_b.xyz);
    for (uint i = 0u; i < COVER_COARSE_BALLS; ++i)
    {
      const vec4 outer_a = outerBall(a, i);
      const vec4 inner_a = innerBall(a, i);
      apart = apart && pointsApart(center, outer_a.xyz, outer_a.w + outer_b.w + reach.apart);
      if (pointsNear(witness, inner_a.xyz, (inner_a.w + inner_b.w) * (1.0 - 16.0 * u) + reach.near))
        return STATE_HIT;
    }
  }
  return apart ? 0u : STATE_UNDECIDED;
}
