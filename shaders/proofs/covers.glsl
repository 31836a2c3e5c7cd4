// The balls of covers (src/collision/proofs/ball_cover.h): outer balls contain a shape, inner balls are inside
// it. If all outer balls of two shapes are apart, so are the shapes; if two inner balls overlap, the shapes collide.
// Outer and inner balls: Weller and Zachmann, "Inner sphere trees", 2009. docs/error_bounds.md derives the thresholds.
layout(binding = UNIT_FRAMES) uniform usamplerBuffer frame_texels;  // see state_proofs.glsl

struct FrameRows
{
  vec4 x;
  vec4 y;
  vec4 z;
};

FrameRows fetchFrame(uint state, uint frame)
{
  const uint at = 3u * frame * state_count + state;
  return FrameRows(uintBitsToFloat(texelFetch(frame_texels, int(at))),
                   uintBitsToFloat(texelFetch(frame_texels, int(at + state_count))),
                   uintBitsToFloat(texelFetch(frame_texels, int(at + 2u * state_count))));
}

vec3 placedIn(FrameRows frame, vec3 point)
{
  return placedBy(frame.x, frame.y, frame.z, point);
}

struct ProofInstance
{
  uint at;  // its first texel
  uint frame;
  bool same_centers;  // each witness is the centre of its outer ball
};

ProofInstance fetchProofInstance(uint first, uint instance)
{
  const uint at = first + INSTANCE_RECORD_TEXELS * instance;
  const uvec4 head = proofWords(at);
  return ProofInstance(at, head.x, head.y != 0u);
}

// xyz: the centre; w: the radius.
vec4 outerBall(ProofInstance instance, uint ball)
{
  return proofNumbers(instance.at + INSTANCE_BALLS + ball);
}

// Of four inner balls, from `ball` on.
vec4 innerRadii(ProofInstance instance, uint ball)
{
  return proofNumbers(instance.at + INSTANCE_RADII + ball / TEXEL_WORDS);
}

// The centre of an inner ball, if it is not that of the outer ball.
vec3 witness(ProofInstance instance, uint ball)
{
  return proofNumbers(instance.at + INSTANCE_WITNESSES + ball).xyz;
}

// A frame in the frame of an object.
FrameRows inObject(ProofObject object, FrameRows frame)
{
  FrameRows placed;
  for (int column = 0; column < 4; ++column)
  {
    const vec3 part = vec3(frame.x[column], frame.y[column], frame.z[column]);
    const vec3 moved = column == 3 ? vec3(object.x.w, object.y.w, object.z.w) : vec3(0.0);
    precise const vec3 sum = vec3(dot(object.x.xyz, part), dot(object.y.xyz, part), dot(object.z.xyz, part)) + moved;
    placed.x[column] = sum.x;
    placed.y[column] = sum.y;
    placed.z[column] = sum.z;
  }
  return placed;
}
